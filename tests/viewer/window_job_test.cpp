// Opening programs, changing what they are cut with, and finding one's way in them.

#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/viewer/window_fixture.h"

namespace kerf {
namespace {

constexpr Rgb kFoundLine{96, 82, 30};
constexpr int kTabsY = 225;

class WindowJobTest : public WindowTest {
 protected:
  void publish_job(const std::string& program, LengthUnit unit = LengthUnit::kMm) {
    ViewedJob job;
    job.unit = unit;
    job.program = program;
    job.stock = "box:0,0,-5:10,10,0";
    job.models = {"auto", "zmap", "octree"};
    job.tools = {{1, "", "flat:6", "comment in line 3"}};
    job.command = "kerf view " + program;
    SceneUpdate update;
    update.job = std::make_shared<const ViewedJob>(job);
    mailbox_.publish(std::move(update));
    settle();
  }
  void type(const std::string& text) {
    ASSERT_TRUE(xdotool("type --delay 20 '" + text + "'"));
    settle();
  }

  TemporaryFolder folder_;
};

TEST_F(WindowJobTest, ADroppedFileIsOpened) {
  open();
  publish_job("");
  GLFWwindow* const window = glfwGetCurrentContext();
  const GLFWdropfun drop = glfwSetDropCallback(window, nullptr);
  ASSERT_NE(drop, nullptr);
  glfwSetDropCallback(window, drop);
  const char* path = "/somewhere/part.ngc";
  drop(window, 1, &path);
  const auto asked = next<OpenCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->path, path);
}

TEST_F(WindowJobTest, TheFieldsSayTheirUnits) {
  open();
  publish_job(folder_ / "part.ngc");
  click(1137, kTabsY);
  settle();
  const Picture mm = window_->read();
  publish_job(folder_ / "part.ngc");
  EXPECT_EQ(mean_difference(mm, window_->read(), kInfo), 0.0);
  publish_job(folder_ / "part.ngc", LengthUnit::kInch);
  EXPECT_GT(mean_difference(mm, window_->read(), kInfo), 0.01);
}

TEST_F(WindowJobTest, BesideAMachineNothingIsOpened) {
  open();
  key("ctrl+o");
  settle();
  type("x\n");
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<OpenCommand>(command));
  }
}

TEST_F(WindowJobTest, AFileOfTheFolderIsOpenedByItsName) {
  std::ofstream(folder_ / "other.ngc") << "G0 X1\n";
  open();
  publish_job(folder_ / "part.ngc");
  const Picture before = window_->read();
  key("ctrl+o");
  settle();
  EXPECT_GT(mean_difference(before, window_->read(), kScene), 1.0);
  type("none.ngc");
  key("Return");
  settle();
  type("other.ngc");  // what is wrong stays open, and marked to be written over or not
  key("Return");
  settle();
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<OpenCommand>(command)) << "there is no such file";
  }
  key("Escape");
  settle();
  key("ctrl+o");
  settle();
  type("other.ngc");
  key("Return");
  const auto asked = next<OpenCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->path, folder_ / "other.ngc");
  settle();
  EXPECT_EQ(mean_difference(before, window_->read(), kScene), 0.0);
}

TEST_F(WindowJobTest, SetupsAreChosenByKeyAndInTheirList) {
  open();
  publish_job("/somewhere/job.yaml");
  const Picture without = window_->read();
  key("Next");
  settle();
  const auto asks_for_none = [&] {
    const std::vector<ViewerCommand> commands = commands_.take();
    return std::ranges::none_of(commands, [](const ViewerCommand& command) {
      return std::holds_alternative<SetupCommand>(command);
    });
  };
  EXPECT_TRUE(asks_for_none()) << "there is one program";
  const auto publish_setups = [&](std::size_t shown) {
    ViewedJob job;
    job.program = "/somewhere/job.yaml";
    job.setups = {"1  top", "2  bottom", "3  end"};
    job.setup = shown;
    SceneUpdate update;
    update.job = std::make_shared<const ViewedJob>(job);
    mailbox_.publish(std::move(update));
    settle();
  };
  publish_setups(1);
  EXPECT_GT(mean_difference(without, window_->read(), kCode), 0.1) << "the list is there";
  key("Next");
  auto asked = next<SetupCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->setup, 2u);
  key("Prior");
  asked = next<SetupCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->setup, 0u);
  publish_setups(2);
  key("Next");
  settle();
  EXPECT_TRUE(asks_for_none()) << "it is the last";
  click(140, 18);
  settle();
  click(140, 40);  // the first of the list that opens beneath
  asked = next<SetupCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->setup, 0u);
}

TEST_F(WindowJobTest, AnEmptyWindowSaysSo) {
  open();
  publish_job("/somewhere/part.ngc");
  const Picture before = window_->read_scene();
  const Picture with_program = window_->read();
  publish_job("");
  EXPECT_GT(mean_difference(with_program, window_->read(), kScene), 0.5);
  EXPECT_EQ(before.rgb, window_->read_scene().rgb);
}

TEST_F(WindowJobTest, TheBlankIsChangedInItsField) {
  open();
  publish_job("/somewhere/part.ngc");
  click(1137, kTabsY);
  settle();
  click(1100, kTabsY + 45);
  settle();
  key("ctrl+a");
  settle();
  type("box:0,0,-7:20,20,0");
  key("Return");
  const auto asked = next<JobCommand>();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->stock, "box:0,0,-7:20,20,0");
  EXPECT_TRUE(asked->tools.empty());
}

TEST_F(WindowJobTest, ProgramsThatWereShownAreRemembered) {
  settings_file_ = folder_ / "view.conf";
  open();
  publish_job("/a/first.ngc");
  publish_job("/b/second.ngc");
  publish_job("/a/first.ngc");
  window_.reset();
  Diagnostics faults;
  const ViewSettings settings = load_settings(settings_file_, &faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(settings.recent, (std::vector<std::string>{"/a/first.ngc", "/b/second.ngc"}));
}

TEST_F(WindowJobTest, SearchGoesToTheLineAndOnToTheNext) {
  open();
  ASSERT_EQ(count_pixels(window_->read(), kCode, kFoundLine), 0);
  key("ctrl+f");
  settle();
  type("x33");  // of 33, 133, 233, 330 to 339, 433: the first
  const int one_line = count_pixels(window_->read(), kCode, kFoundLine);
  EXPECT_GT(one_line, 1000);
  const Picture first = window_->read();
  key("Return");  // 330
  settle();
  EXPECT_GT(count_pixels(window_->read(), kCode, kFoundLine), 1000);
  EXPECT_GT(mean_difference(first, window_->read(), kCode), 1.0);
  key("shift+Return");
  settle();
  EXPECT_GT(count_pixels(window_->read(), kCode, kFoundLine), 1000);
  key("Escape");
  settle();
  key("Escape");
  settle();
  EXPECT_EQ(count_pixels(window_->read(), kCode, kFoundLine), 0);
  // What was typed was for the search alone.
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<StopCommand>(command));
  }
}

TEST_F(WindowJobTest, PanelsAreMadeWiderAndRemembered) {
  settings_file_ = folder_ / "view.conf";
  open();
  drag({290, 400}, {410, 400});
  EXPECT_NEAR(window_->settings().code_width_px, 410.0, 3.0);
  drag({980, 400}, {900, 400});
  EXPECT_NEAR(window_->settings().info_width_px, 380.0, 3.0);
  move_to(320, 60);  // where it is in a new one
  const Picture before = window_->read();
  window_.reset();
  open();
  EXPECT_EQ(mean_difference(before, window_->read(), kWhole), 0.0);
}

TEST_F(WindowJobTest, LongFindingsAreWrapped) {
  open();
  const auto with = [this](const std::string& text) {
    SceneUpdate update;
    update.findings = std::make_shared<const FindingList>(
        FindingList{{{Severity::kError, "test.ngc", 30, 40.0, std::nullopt, text}}});
    mailbox_.publish(std::move(update));
    settle();
    // Below the first line of the list.
    return count_pixels(window_->read(), {1040, kTabsY + 40, 1280, kTabsY + 140}, {222, 224, 230});
  };
  EXPECT_EQ(with("traverse touches"), 0);
  EXPECT_GT(with("traverse touches the workpiece, 2.31 mm deep at X12.40 Y3.00 Z-1.20 (tool 3), "
                 "and this goes on for a while"),
            30);
}

}  // namespace
}  // namespace kerf
