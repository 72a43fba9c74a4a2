// The window in other languages: which letters their texts need, which font has them, and what
// becomes of a language without one.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/translate.h"
#include "tests/base/temporary_folder.h"
#include "tests/viewer/window_fixture.h"
#include "viewer/window/letters.h"
#include "viewer/window/texts.h"

namespace kerf {
namespace {

constexpr Rgb kNoticeText{242, 184, 82};

/// Fonts are looked for in `folder` alone.
void look_for_fonts_in(const std::string& folder) {
  setenv("XDG_DATA_HOME", folder.c_str(), 1);
  setenv("XDG_DATA_DIRS", folder.c_str(), 1);
}

/// Not a Chinese font, but a font, by the name of one.
std::string put_font(const TemporaryFolder& folder, const std::string& name) {
  std::filesystem::path path = folder.path() + "/fonts/" + name;
  std::filesystem::create_directories(path.parent_path());
  write_file(path, "a font");
  return path;
}

TEST(Letters, AreEachThereOnceAndInOrder) {
  EXPECT_EQ(letters_in("Fräse, Größe, é, ä"), (std::vector<char16_t>{u'ß', u'ä', u'é', u'ö'}));
  EXPECT_EQ(letters_in("进给, 刀柄 進"),
            (std::vector<char16_t>{u'刀', u'柄', u'给', u'进', u'進'}));
  EXPECT_TRUE(letters_in("feed").empty());
  EXPECT_TRUE(letters_in("").empty());
}

TEST(Letters, ArePassedOverWhereTheyAreNone) {
  // Cut off, without their first byte, longer than they need be, beyond U+FFFF.
  for (const char* bytes : {"\xE8\xBF", "\xBF\x9B", "\xC3", "\xC1\xA1", "\xE0\x81\xA1", "\xC3x"}) {
    EXPECT_TRUE(letters_in(bytes).empty());
  }
  EXPECT_TRUE(letters_in("\xF0\x9F\x98\x80").empty());
  EXPECT_EQ(letters_in(std::string("\xE4\0\xC3\xA9\xE8", 5)), std::vector<char16_t>{u'é'});
}

TEST(Letters, OfEastAsiaNeedAFontOfTheirOwn) {
  for (const char16_t letter : u"进给、（カ한") {
    if (letter == 0) continue;
    EXPECT_TRUE(is_east_asian(letter)) << int{letter};
  }
  for (const char16_t letter : u"Aéœñ¿ßЖΩ…“”→") EXPECT_FALSE(is_east_asian(letter)) << int{letter};
}

TEST(Letters, OfALanguageAreThoseOfItsCatalogue) {
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  EXPECT_FALSE(
      has_east_asian(letters_in(read_file(std::string(KERF_LOCALES) + "/fr/LC_MESSAGES/kerf.mo"))));
  const std::vector<char16_t> chinese = letters_of("zh_CN");
  for (const char16_t letter : {u'进', u'给', u'，', u'ñ'}) {  // the last one of Español
    EXPECT_TRUE(std::binary_search(chinese.begin(), chinese.end(), letter)) << int{letter};
  }
  EXPECT_LT(chinese.size(), 2000u) << "letters, not all that bytes can be";
}

TEST(EastAsianFont, IsTheBestOneOfThoseInstalled) {
  const TemporaryFolder folder;
  look_for_fonts_in(folder.path());
  EXPECT_FALSE(east_asian_font());
  const std::string plain = put_font(folder, "truetype/wqy/wqy-zenhei.ttc");
  ASSERT_TRUE(east_asian_font());
  EXPECT_EQ(east_asian_font()->path, plain);
  EXPECT_EQ(east_asian_font()->face, 0);
  const std::string noto = put_font(folder, "opentype/noto/NotoSansCJK-Regular.ttc");
  EXPECT_EQ(east_asian_font()->path, noto);
  EXPECT_EQ(east_asian_font()->face, 2) << "simplified Chinese";
}

TEST(EastAsianFont, IsNeededForChineseAlone) {
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  const TemporaryFolder folder;
  look_for_fonts_in(folder.path());
  for (const char* code : {"en", "de", "fr", "es"}) EXPECT_TRUE(can_show(code)) << code;
  EXPECT_FALSE(can_show("zh_CN"));
  put_font(folder, "wqy-zenhei.ttc");
  EXPECT_TRUE(can_show("zh_CN"));
}

class WindowLanguageTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
    look_for_fonts_in(folder_.path());
  }
  void TearDown() override { use_language("en"); }

  void open_in(const std::string& code) {
    settings_file_ = folder_.path() + "/view.conf";
    write_file(settings_file_,
               "width = 1280\nheight = 800\nkeys-seen = on\nlanguage = " + code + "\n");
    open();
  }

  TemporaryFolder folder_;
  static constexpr PixelBox kStatus{0, 745, kWidth, kHeight};
};

TEST_F(WindowLanguageTest, StaysInEnglishWhereLettersAreMissing) {
  open_in("zh_CN");
  EXPECT_EQ(language(), "en");
  EXPECT_GT(count_pixels(window_->read(), kStatus, kNoticeText), 50) << "it says so";
  EXPECT_EQ(window_->settings().language, "zh_CN") << "the choice stands, for when there is a font";
  EXPECT_NE(missing_letters_text("zh_CN").find("fonts-wqy-zenhei"), std::string::npos);
}

TEST_F(WindowLanguageTest, SpeaksAsIsRememberedWhereThereAreLetters) {
  for (const char* code : {"fr", "es"}) {
    open_in(code);
    EXPECT_EQ(language(), code);
    EXPECT_EQ(count_pixels(window_->read(), kStatus, kNoticeText), 0);
    EXPECT_STRNE(text(Text::kFeed), "Feed");
    window_.reset();
  }
}

TEST_F(WindowLanguageTest, SpeaksChineseWithAFontForIt) {
  const std::string latin = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  if (access(latin.c_str(), R_OK) != 0) GTEST_SKIP() << "needs " << latin;
  const std::string path = put_font(folder_, "wqy-zenhei.ttc");
  std::filesystem::copy_file(latin, path, std::filesystem::copy_options::overwrite_existing);
  open_in("zh_CN");
  EXPECT_EQ(language(), "zh_CN");
  EXPECT_STREQ(text(Text::kFeed), "进给");
  EXPECT_EQ(count_pixels(window_->read(), kStatus, kNoticeText), 0);
}

}  // namespace
}  // namespace kerf
