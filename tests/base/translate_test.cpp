// Texts in their language: found, filled in, chosen by the environment, changed while others ask.
#include "base/translate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "base/catalogue_file.h"
#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

class Translate : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
    for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG", "LANGUAGE"}) unsetenv(name);
    use_language("en");
    unsetenv("LANGUAGE");
  }
  void TearDown() override { use_language("en"); }

  /// A catalogue `xx` of these entries, made by msgfmt.
  void make_catalogue(const std::string& entries) {
    const std::string folder = folder_.path() + "/xx/LC_MESSAGES";
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/kerf.po") << "msgid \"\"\nmsgstr \"Content-Type: text/plain; "
                                          "charset=UTF-8\\nPlural-Forms: nplurals=3; "
                                          "plural=(n==1 ? 0 : n<5 ? 1 : 2);\\n\"\n\n"
                                       << entries;
    ASSERT_EQ(std::system(("msgfmt -o " + folder + "/kerf.mo " + folder + "/kerf.po").c_str()), 0);
    setenv("TEXTDOMAINDIR", folder_.path().c_str(), 1);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Translate, EnglishIsTheTextItself) {
  const char* const text = "traverse touches the workpiece";
  EXPECT_EQ(tr(text), text);
  EXPECT_EQ(trf("{} is a log", "a.csv"), "a.csv is a log");
  EXPECT_EQ(trnf("{} error", "{} errors", 1), "1 error");
  EXPECT_EQ(trnf("{} error", "{} errors", 0), "0 errors");
}

TEST_F(Translate, GermanComesFromItsCatalogue) {
  ASSERT_TRUE(use_language("de"));
  EXPECT_EQ(language(), "de");
  EXPECT_STREQ(tr("traverse touches the workpiece"), "Eilgang berührt das Werkstück");
  EXPECT_EQ(trnf("{} warning", "{} warnings", 1), "1 Warnung");
  EXPECT_EQ(trnf("{} warning", "{} warnings", 7), "7 Warnungen");
  EXPECT_STREQ(tr("nobody has ever written this"), "nobody has ever written this");
  EXPECT_STREQ(tr(""), "") << "not the catalogue's head";
  ASSERT_TRUE(use_language("en"));
  EXPECT_STREQ(tr("traverse touches the workpiece"), "traverse touches the workpiece");
}

TEST_F(Translate, WhatALanguageDoesNotHaveYetIsEnglish) {
  ASSERT_TRUE(use_language("fr"));
  EXPECT_STREQ(tr("traverse touches the workpiece"), "un déplacement rapide touche la pièce");
  EXPECT_STREQ(tr("nobody has ever written this"), "nobody has ever written this");
  ASSERT_TRUE(use_language("zh_CN"));
  EXPECT_STREQ(tr("traverse touches the workpiece"), "快速移动碰到工件");
}

TEST_F(Translate, ACatalogueLiesWhereItsTextsComeFrom) {
  EXPECT_EQ(catalogue_file("fr"), std::string(KERF_LOCALES) + "/fr/LC_MESSAGES/kerf.mo");
  EXPECT_TRUE(std::filesystem::exists(catalogue_file("fr")));
  EXPECT_EQ(catalogue_file("en"), "");
}

TEST_F(Translate, ALanguageThatIsNotThereChangesNothing) {
  ASSERT_TRUE(use_language("de"));
  EXPECT_FALSE(use_language("tlh"));
  EXPECT_FALSE(use_language("../de"));
  EXPECT_EQ(language(), "de");
}

TEST_F(Translate, LanguagesAreThoseOfTheFolder) {
  EXPECT_EQ(languages(), (std::vector<std::string>{"en", "de", "es", "fr", "zh_CN"}));
  EXPECT_EQ(name_of_language("de"), "Deutsch");
  EXPECT_EQ(name_of_language("es"), "Español");
  EXPECT_EQ(name_of_language("fr"), "Français");
  EXPECT_EQ(name_of_language("zh_CN"), "中文");
  EXPECT_EQ(name_of_language("en"), "English");
  EXPECT_STREQ(tr("Play"), "Play") << "asking for a name changes nothing";
  setenv("TEXTDOMAINDIR", "/nonexistent", 1);
  EXPECT_EQ(languages(), std::vector<std::string>{"en"});
}

TEST_F(Translate, TheEnvironmentAsksInItsOrder) {
  EXPECT_EQ(language_of_environment(), "en");
  setenv("LANG", "de_AT.UTF-8", 1);
  EXPECT_EQ(language_of_environment(), "de");
  setenv("LC_MESSAGES", "fi_FI.UTF-8", 1);
  EXPECT_EQ(language_of_environment(), "en") << "there is no Finnish";
  setenv("LC_ALL", "de", 1);
  EXPECT_EQ(language_of_environment(), "de");
  setenv("LANGUAGE", "fi:en_GB:de", 1);
  EXPECT_EQ(language_of_environment(), "en");
  setenv("LANGUAGE", "fi:de", 1);
  EXPECT_EQ(language_of_environment(), "de");
  unsetenv("LANGUAGE");
  setenv("LC_ALL", "zh_CN.UTF-8", 1);
  EXPECT_EQ(language_of_environment(), "zh_CN");
  setenv("LC_ALL", "zh_TW.UTF-8", 1);
  EXPECT_EQ(language_of_environment(), "en") << "other letters";
  for (const char* plain : {"C", "POSIX", "C.UTF-8"}) {
    setenv("LC_ALL", plain, 1);
    EXPECT_EQ(language_of_environment(), "en") << plain;
  }
}

TEST_F(Translate, ATranslationMayChangeTheOrder) {
  make_catalogue("msgid \"{} of {:.1f} mm\"\nmsgstr \"{1:.1f} mm: {0}\"\n");
  ASSERT_TRUE(use_language("xx"));
  EXPECT_EQ(trf("{} of {:.1f} mm", "flat", 6.0), "6.0 mm: flat");
}

TEST_F(Translate, PluralsAreTheLanguages) {
  make_catalogue(
      "msgid \"{} error\"\nmsgid_plural \"{} errors\"\nmsgstr[0] \"{} one\"\nmsgstr[1] \"{} few\"\n"
      "msgstr[2] \"{} many\"\n");
  ASSERT_TRUE(use_language("xx"));
  EXPECT_EQ(trnf("{} error", "{} errors", 1), "1 one");
  EXPECT_EQ(trnf("{} error", "{} errors", 3), "3 few");
  EXPECT_EQ(trnf("{} error", "{} errors", 5), "5 many");
}

TEST_F(Translate, ATranslationThatDoesNotFitIsTheTextItself) {
  make_catalogue(
      "msgid \"{} is a log\"\nmsgstr \"{} {} {}\"\n\nmsgid \"{} motions\"\nmsgstr \"{:d} {\"\n");
  ASSERT_TRUE(use_language("xx"));
  EXPECT_EQ(trf("{} is a log", "a.csv"), "a.csv is a log");
  EXPECT_EQ(trf("{} motions", 12), "12 motions");
}

TEST_F(Translate, ChangesWhileOthersAsk) {
  ASSERT_TRUE(use_language("de"));
  std::atomic<bool> ends{false};
  std::atomic<int> wrong{0};
  std::vector<std::thread> others;
  for (int i = 0; i < 3; ++i) {
    others.emplace_back([&] {
      while (!ends) {
        const std::string text = trf("{} is a log", "a.csv");
        if (!text.starts_with("a.csv ")) ++wrong;
      }
    });
  }
  for (int i = 0; i < 200; ++i) use_language(i % 2 == 0 ? "en" : "de");
  ends = true;
  for (std::thread& other : others) other.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace kerf
