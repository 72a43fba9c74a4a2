// What goes wrong around the window: displays, drivers, its settings.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/translate.h"
#include "tests/viewer/window_fixture.h"
#include "viewer/window/settings.h"

namespace kerf {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::string reason_for_no_window() {
  SceneMailbox mailbox;
  CommandQueue commands;
  WindowOptions options;
  options.settings_file.clear();
  const Result<Window> window = Window::create(options, &mailbox, &commands);
  return window ? "" : window.error();
}

class WindowFaultTest : public WindowTest {};

TEST_F(WindowFaultTest, WithoutADisplayItSaysSo) {
  unsetenv("DISPLAY");
  EXPECT_EQ(reason_for_no_window(),
            "no window: there is no display (DISPLAY is not set); pictures need no display: "
            "--png FILE");
}

TEST_F(WindowFaultTest, ADisplayThatIsNotThereIsNamed) {
  setenv("DISPLAY", ":9876", 1);
  const std::string reason = reason_for_no_window();
  EXPECT_NE(reason.find("no window: the display DISPLAY=:9876 cannot be opened"), std::string::npos)
      << reason;
  EXPECT_NE(reason.find("--png FILE"), std::string::npos) << reason;
}

TEST_F(WindowFaultTest, WithoutOpenGlItSaysWhatIsNeeded) {
  const Result<VirtualDisplay> display = VirtualDisplay::start({"-extension", "GLX"});
  ASSERT_TRUE(display) << display.error();
  const std::string reason = reason_for_no_window();
  EXPECT_NE(reason.find("no window: OpenGL 3.3 is needed"), std::string::npos) << reason;
  EXPECT_NE(reason.find("no OpenGL at all"), std::string::npos) << reason;
  EXPECT_NE(reason.find("--png FILE"), std::string::npos) << reason;
}

/// Drivers are told through the environment, which they read once: a process of its own.
TEST_F(WindowFaultTest, AnOldOpenGlIsNamed) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
        std::fprintf(stderr, "%s\n", reason_for_no_window().c_str());
        std::exit(0);
      },
      testing::ExitedWithCode(0), "OpenGL 3.3 is needed; the display .* has OpenGL 2.1");
}

/// The server dies while the window is open.
TEST_F(WindowFaultTest, ALostDisplayEndsItCleanly) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        {
          Result<VirtualDisplay> display = VirtualDisplay::start();
          if (!display) std::exit(1);
          open();
          display->kill_server();
          for (int i = 0; i < 1000; ++i) {
            const Result<bool> is_open = window_->frame(0.01);
            if (is_open) continue;
            std::fprintf(stderr, "%s\n", is_open.error().c_str());
            break;
          }
          const auto commands = commands_.take();
          if (commands.empty() || !std::holds_alternative<CloseCommand>(commands.back())) {
            std::exit(2);
          }
          window_.reset();
        }
        std::exit(0);
      },
      testing::ExitedWithCode(0), "the window is gone: the connection to the display .* broke");
}

/// Another program destroys it, without asking: as if its user had closed it.
TEST_F(WindowFaultTest, ADestroyedWindowIsAClosedOne) {
  const TemporaryFolder folder;
  settings_file_ = folder.path() + "/kerf/view.conf";
  open();
  key("p");
  settle();
  static_cast<void>(commands_.take());
  ASSERT_TRUE(xdotool("search --onlyvisible --name kerf windowclose >/dev/null"));
  bool is_open = true;
  for (int i = 0; i < 1000 && is_open; ++i) {
    const Result<bool> frame = window_->frame(0.01);
    ASSERT_TRUE(frame) << frame.error();
    is_open = *frame;
  }
  EXPECT_FALSE(is_open);
  const auto commands = commands_.take();
  ASSERT_FALSE(commands.empty());
  EXPECT_TRUE(std::holds_alternative<CloseCommand>(commands.back()));
  const ViewSettings before = window_->settings();
  window_.reset();
  Diagnostics faults;
  const ViewSettings settings = load_settings(settings_file_, &faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_FALSE(settings.is_perspective);
  EXPECT_EQ(settings.width_px, before.width_px) << "it has no size to remember any more";
}

TEST_F(WindowFaultTest, SettingsAreRemembered) {
  const TemporaryFolder folder;
  settings_file_ = folder.path() + "/kerf/view.conf";
  open();
  key("p");
  key("h");
  key("d");
  settle();
  ASSERT_TRUE(xdotool("search --onlyvisible --name kerf windowsize 1000 700 >/dev/null"));
  ASSERT_TRUE(turn_until([&] { return window_->read().width_px == 1000; }));
  window_.reset();
  Diagnostics faults;
  const ViewSettings settings = load_settings(settings_file_, &faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_FALSE(settings.is_perspective);
  EXPECT_FALSE(settings.drawing.looks[static_cast<std::size_t>(SceneObject::kHolder)].is_visible);
  EXPECT_TRUE(settings.shows_counters);
  EXPECT_EQ(settings.width_px, 1000);
  EXPECT_EQ(settings.height_px, 700);
}

TEST_F(WindowFaultTest, DamagedSettingsAreNamedAndKept) {
  const TemporaryFolder folder;
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  settings_file_ = folder.path() + "/view.conf";
  const std::string damaged = "width = 1000\nperspective = perhaps\nlanguage = de\n\xff\xfe\n";
  write_file(settings_file_, damaged);
  open();
  EXPECT_EQ(window_->settings().language, "de");
  EXPECT_STREQ(tr("Play"), "Abspielen");
  use_language("en");
  ASSERT_EQ(window_->settings_faults().size(), 2u);
  EXPECT_EQ(to_string(window_->settings_faults()[0]),
            settings_file_ +
                ":2:15: warning: perspective: 'perhaps' is not allowed; must be on or off\n"
                "     2 | perspective = perhaps\n"
                "       |               ^\n"
                "   hint: the default is used; when the window closes, the file is kept as " +
                settings_file_ + ".damaged and a new one is written\n");
  EXPECT_EQ(window_->settings_faults()[1].line, 4);
  EXPECT_TRUE(window_->settings().is_perspective);
  window_.reset();
  EXPECT_EQ(content_of(settings_file_ + ".damaged"), damaged);
  Diagnostics faults;
  EXPECT_EQ(load_settings(settings_file_, &faults).width_px, 1000);
  EXPECT_TRUE(faults.empty());
}

TEST(SettingsTest, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/view.conf";
  ViewSettings settings;
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  settings.language = "de";
  settings.flat = FlatView::kZx;
  settings.text_scale = 1.25;
  settings.section.axis = 2;
  settings.section.is_flipped = true;
  settings.drawing.color_by = ColorBy::kRemovalRate;
  settings.drawing.tolerance_mm = 0.02;
  settings.drawing.is_dark = true;
  settings.drawing.looks[0] = {false, 0.5f};
  const Done done = save_settings(path, settings);
  ASSERT_TRUE(done) << done.error();
  Diagnostics faults;
  const ViewSettings read = load_settings(path, &faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(read.language, settings.language);
  EXPECT_EQ(read.flat, settings.flat);
  EXPECT_EQ(read.text_scale, settings.text_scale);
  EXPECT_EQ(read.section.axis, 2);
  EXPECT_TRUE(read.section.is_flipped);
  EXPECT_EQ(read.drawing, settings.drawing);
}

TEST(SettingsTest, SetsAsideUnderANameThatIsFree) {
  const TemporaryFolder folder;
  const std::string path = folder.path() + "/view.conf";
  for (const std::string kept : {".damaged", ".damaged-2"}) {
    write_file(path, kept);
    const Result<std::string> name = set_aside(path);
    ASSERT_TRUE(name) << name.error();
    EXPECT_EQ(*name, path + kept);
    EXPECT_EQ(content_of(*name), kept);
  }
  EXPECT_FALSE(set_aside(path));  // it is not there
}

}  // namespace
}  // namespace kerf
