// What was set for a program in the window is there the next time.

#include "twin/cli/program_setup.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/base/temporary_folder.h"
#include "twin/cli/live_window.h"

namespace kerf {
namespace {

const ProgramSetup kSetup{"box:0,0,-20:100,60,0",
                          "0.1",
                          "zmap",
                          {{1, "flat:6"}, {12, "ball:4:flute=10"}},
                          {"vise:100:60:30"}};

std::string text_in(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class SetupMemoryTest : public testing::Test {
 protected:
  std::optional<ProgramSetup> found(const std::string& program) const {
    const auto found = memory_.find(program);
    EXPECT_TRUE(found) << (found ? "" : found.error());
    return found ? *found : std::nullopt;
  }
  TemporaryFolder folder_;
  std::string path_ = folder_ / "state/kerf/programs.json";
  SetupMemory memory_{path_};
};

TEST_F(SetupMemoryTest, WhatWasKeptIsFound) {
  EXPECT_FALSE(found("/nc/part.ngc"));
  ASSERT_TRUE(memory_.keep("/nc/part.ngc", kSetup));
  EXPECT_EQ(found("/nc/part.ngc"), kSetup);
  EXPECT_EQ(found("/nc/sub/../part.ngc"), kSetup) << "it is the same file";
  EXPECT_FALSE(found("/nc/other.ngc"));
  ProgramSetup other = kSetup;
  other.stock = "cylinder:0,0,-10:0:40";
  ASSERT_TRUE(memory_.keep("/nc/part.ngc", other));
  EXPECT_EQ(found("/nc/part.ngc"), other);
  ASSERT_TRUE(memory_.keep("/nc/part.ngc", {}));
  EXPECT_FALSE(found("/nc/part.ngc")) << "nothing is set any more";
}

TEST_F(SetupMemoryTest, TheOldestGoFirst) {
  for (std::size_t n = 0; n <= SetupMemory::kMost; ++n)
    ASSERT_TRUE(memory_.keep("/nc/" + std::to_string(n) + ".ngc", kSetup));
  EXPECT_FALSE(found("/nc/0.ngc"));
  EXPECT_TRUE(found("/nc/1.ngc"));
  EXPECT_TRUE(found("/nc/" + std::to_string(SetupMemory::kMost) + ".ngc"));
}

/// Cut off or damaged anywhere: it is read as what it says, or refused and left as it is.
TEST_F(SetupMemoryTest, ADamagedFileIsNeverWrittenOver) {
  ASSERT_TRUE(memory_.keep("/nc/part.ngc", kSetup));
  const std::string whole = text_in(path_);
  int refused = 0;
  const auto check = [&](const std::string& text) {
    std::ofstream(path_, std::ios::trunc) << text;
    if (memory_.find("/nc/part.ngc")) return;
    ++refused;
    const Done kept = memory_.keep("/nc/other.ngc", kSetup);
    ASSERT_FALSE(kept);
    EXPECT_NE(kept.error().find("programs.json"), std::string::npos) << kept.error();
    ASSERT_EQ(text_in(path_), text);
  };
  for (std::size_t bytes = 0; bytes + 2 < whole.size(); ++bytes) check(whole.substr(0, bytes));
  EXPECT_EQ(refused, static_cast<int>(whole.size()) - 2) << "half a file is none";
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    check(damaged);
  }
  check("[]");
  check(R"({"schema": "kerf-report/1", "programs": []})");
}

TEST(ProgramSetup, LiesOverWhatWasWritten) {
  WrittenOptions options;
  options.set("--stock", "box:0,0,-5:10,10,0");
  options.set("--cell", "0.2");
  options.set_all("--tool", {"1=flat:3", "4=vee:6:90"});
  options.set_all("--fixture", {"clamp:40:20:15"});
  EXPECT_EQ(setup_of(options).tools,
            (std::vector<std::pair<int, std::string>>{{1, "flat:3"}, {4, "vee:6:90"}}));
  lay_over({"", "", "", {{1, "ball:6"}}, {}}, options);
  EXPECT_EQ(options.text("--stock"), "box:0,0,-5:10,10,0") << "nothing was set";
  EXPECT_EQ(options.texts("--tool"), std::vector<std::string>{"1=ball:6"});
  EXPECT_EQ(options.texts("--fixture"), std::vector<std::string>{"clamp:40:20:15"});
  lay_over(kSetup, options);
  EXPECT_EQ(setup_of(options), kSetup);
}

class EditedSetupTest : public testing::Test {
 protected:
  EditedSetupTest() {
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    std::ofstream(folder_ / "part.ngc") << "G21 G0 X1\nM2\n";
    arguments_.command = kShadow;
    arguments_.options.add("--set", "source.type=hal");
    arguments_.options.set("--stock", "box:0,0,-5:10,10,0");
    arguments_.options.set("--program", folder_ / "part.ngc");
  }
  ~EditedSetupTest() override { unsetenv("XDG_STATE_HOME"); }
  std::shared_ptr<const ViewedJob> shown() { return mailbox_.take()->job; }

  TemporaryFolder folder_;
  Arguments arguments_;
  SceneMailbox mailbox_;
  CommandQueue commands_;
};

TEST_F(EditedSetupTest, WhatIsSetIsRememberedAndCounts) {
  LiveWindow window(mailbox_, commands_, arguments_);
  int set = 0;
  window.publish_job();
  EXPECT_TRUE(shown()->is_fixed) << "nobody follows a program here";
  window.edit_setups([&] { ++set; });
  window.publish_job();
  const auto before = shown();
  EXPECT_FALSE(before->is_fixed);
  EXPECT_EQ(before->stock, "box:0,0,-5:10,10,0");
  const std::string said =
      window.set_up({"box:0,0,-20:30,30,0", "", "", {{1, "flat:6"}}, {"vise:100:60:30"}});
  EXPECT_EQ(said, "set for part.ngc, and remembered");
  EXPECT_EQ(set, 1);
  LiveWindow next(mailbox_, commands_, arguments_);
  const WrittenOptions options = next.options_of(folder_ / "part.ngc");
  EXPECT_EQ(options.text("--stock"), "box:0,0,-20:30,30,0");
  EXPECT_EQ(options.texts("--tool"), std::vector<std::string>{"1=flat:6"});
  EXPECT_EQ(options.texts("--fixture"), std::vector<std::string>{"vise:100:60:30"});
  EXPECT_EQ(next.options_of(folder_ / "other.ngc").text("--stock"), "box:0,0,-5:10,10,0");
}

TEST(JobTools, AreThoseOfTheProgramAndThoseThatWereGiven) {
  ProgramSetup setup;
  setup.tools = {{3, "ball:4"}, {2, "flat:8"}};
  const std::vector<JobTool> tools =
      job_tools({{7, "old", "drill:5", "comment in line 3"}, {2, "", "", ""}}, setup);
  ASSERT_EQ(tools.size(), 3U);
  EXPECT_EQ(tools[0].number, 2);
  EXPECT_EQ(tools[0].given, "flat:8");
  EXPECT_EQ(tools[0].in_use, "") << "the program uses it, and nobody knows it";
  EXPECT_EQ(tools[1].number, 3);
  EXPECT_EQ(tools[1].given, "ball:4");
  EXPECT_EQ(tools[2].given, "") << "not given any more";
  EXPECT_EQ(tools[2].in_use, "drill:5");
}

TEST_F(EditedSetupTest, WhatWasNotChangedIsNotRemembered) {
  LiveWindow window(mailbox_, commands_, arguments_);
  window.edit_setups([] {});
  window.set_up({"box:0,0,-5:10,10,0", "", "", {{1, "flat:6"}}, {}});
  arguments_.options.set("--stock", "box:0,0,-9:10,10,0");
  const LiveWindow next(mailbox_, commands_, arguments_);
  const WrittenOptions options = next.options_of(folder_ / "part.ngc");
  EXPECT_EQ(options.text("--stock"), "box:0,0,-9:10,10,0");
  EXPECT_EQ(options.texts("--tool"), std::vector<std::string>{"1=flat:6"});
}

TEST_F(EditedSetupTest, WhatIsWrongIsSaidAndNotRemembered) {
  LiveWindow window(mailbox_, commands_, arguments_);
  int set = 0;
  window.edit_setups([&] { ++set; });
  const std::string said = window.set_up({"bax:1", "", "", {}, {}});
  EXPECT_NE(said.find("bax"), std::string::npos) << said;
  EXPECT_EQ(set, 0);
  const auto job = shown();
  ASSERT_TRUE(job);
  EXPECT_EQ(job->faults.size(), 1U);
  EXPECT_EQ(job->stock, "bax:1") << "it is to be mended where it was written";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "state"));
  window.set_up({"", "", "", {{2, "flat:4"}}, {}});
  EXPECT_EQ(set, 1) << "and then it counts";
}

}  // namespace
}  // namespace kerf
