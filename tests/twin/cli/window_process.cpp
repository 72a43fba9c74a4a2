#include "tests/twin/cli/window_process.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <utility>

#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{40};
/// For the end after it was asked for.
constexpr std::chrono::seconds kEndPatience{30};
constexpr std::chrono::milliseconds kPause{10};

template <class Ready>
bool wait_for(const Ready& ready, std::chrono::seconds patience) {
  for (const auto end = Clock::now() + patience; Clock::now() < end;) {
    if (ready()) return true;
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

/// What xdotool prints, without the newlines at the end; empty if it fails.
std::string ask_xdotool(const std::string& arguments) {
  std::FILE* const out = popen(fmt::format("xdotool {} 2>/dev/null", arguments).c_str(), "re");
  if (out == nullptr) return "";
  std::string text;
  for (int c = 0; (c = std::fgetc(out)) != EOF;) text += static_cast<char>(c);
  pclose(out);
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

KerfCall with_window(KerfCall call, const TestFolder& home, const std::string& settings) {
  std::filesystem::create_directory(home.file("kerf"));
  // A curve comes when the program has been checked, at any time.
  home.write("kerf/view.conf", settings + "curve = none\n");
  if (display_trouble().empty()) call.environment["DISPLAY"] = std::getenv("DISPLAY");
  call.environment["XDG_CONFIG_HOME"] = home.path();
  call.environment.insert_or_assign("LC_ALL", std::string(1, 'C'));
  call.folder = home.path();
  return call;
}

/// The screenshot that lies in a folder, if it is written already.
std::string picture_in(const std::string& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("kerf-") && name.ends_with(".png")) return entry.path().string();
  }
  return "";
}

}  // namespace

const std::string& display_trouble() {
  static const Result<VirtualDisplay> display = VirtualDisplay::start();
  static const std::string trouble = display ? std::string() : display.error();
  return trouble;
}

std::size_t different_pixels(const Picture& a, const Picture& b) {
  constexpr int kSlack = 8;
  if (a.width_px != b.width_px || a.height_px != b.height_px) {
    return std::max(a.rgb.size(), b.rgb.size()) / 3;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < a.rgb.size(); i += 3) {
    const auto differs = [&](std::size_t at) { return std::abs(a.rgb[at] - b.rgb[at]) > kSlack; };
    if (differs(i) || differs(i + 1) || differs(i + 2)) ++count;
  }
  return count;
}

WindowedKerf::WindowedKerf(KerfCall call, const std::string& settings)
    : kerf_(with_window(std::move(call), home_, settings)) {}

bool WindowedKerf::is_titled(const std::string& begin) const {
  const std::string question = fmt::format("search --onlyvisible --name '^{}'", begin);
  return wait_for([&] { return !ask_xdotool(question).empty(); }, kEndPatience);
}

void WindowedKerf::type(const std::string& text) const {
  EXPECT_TRUE(xdotool(fmt::format("type --delay 30 '{}'", text)));
}

void WindowedKerf::open_file(const std::string& path) const {
  // It is there when it has been drawn: that takes processor time, which an idle window takes none
  // of, and a caret that blinks hardly any.
  constexpr double kBegins_s = 0.003, kDrawing_s = 0.03;
  const double before_s = process().cpu_s();
  key("ctrl+o");
  EXPECT_TRUE(wait_for([&] { return process().cpu_s() > before_s + kBegins_s; }, kPatience));
  // What it had still to draw of before may have been that.
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_TRUE(wait_for(
      [&] {
        const double drawing_s = process().cpu_s();
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        return process().cpu_s() < drawing_s + kDrawing_s;
      },
      kPatience));
  type(path);
  key("Return");
}

bool WindowedKerf::opens() {
  // The title comes with what there is to be drawn.
  is_titled("kerf - ");
  return shows([](const Picture& picture) { return picture.width_px > 0; });
}

void WindowedKerf::click(int x_px, int y_px, int button) const {
  EXPECT_TRUE(xdotool(fmt::format("mousemove {} {} sleep 0.3 click {}", x_px, y_px, button)));
}

bool WindowedKerf::choose(int x_px, int y_px, int row_x_px, int row_y_px,
                          const std::function<bool(const Picture&)>& wanted) {
  constexpr std::chrono::seconds kAnswer{4}, kTriesPatience{100};
  std::chrono::milliseconds pause{300};
  bool seen = false;
  const auto is_chosen = [&] {
    click(x_px, y_px, 3);
    std::this_thread::sleep_for(pause);
    pause *= 2;
    click(row_x_px, row_y_px);
    wait_for([&] { return (seen = wanted(screenshot("S"))) || has_ended(); }, kAnswer);
    return seen || has_ended();
  };
  wait_for(is_chosen, kTriesPatience);
  return seen;
}

void WindowedKerf::key(const std::string& name) const {
  EXPECT_TRUE(xdotool(fmt::format("key {}", name)));
}

Picture WindowedKerf::screenshot(const std::string& by_key) {
  // A window that is not on the screen yet gets no keys: asked again.
  std::string path;
  for (int tries = 0; tries < 20 && path.empty() && !has_ended(); ++tries) {
    key(by_key + " Return");  // under the name that is proposed
    wait_for([&] { return !(path = picture_in(home_.path())).empty(); }, std::chrono::seconds(3));
  }
  Picture picture = read_png_file(path);
  if (!path.empty()) std::filesystem::remove(path);
  return picture;
}

bool WindowedKerf::shows(const std::function<bool(const Picture&)>& wanted,
                         const std::string& by_key) {
  bool seen = false;
  wait_for([&] { return (seen = wanted(screenshot(by_key))) || has_ended(); }, kPatience);
  return seen;
}

bool WindowedKerf::waits_for_end() const {
  return wait_for([&] { return has_ended(); }, kEndPatience);
}

Picture WindowedKerf::settled() {
  Picture before;
  EXPECT_TRUE(shows([&](const Picture& now) {
    const bool same = before.width_px > 0 && different_pixels(before, now) == 0;
    before = now;
    return same;
  }));
  return before;
}

bool WindowedKerf::changes_from(const Picture& before, std::size_t pixels) {
  return shows([&](const Picture& now) { return different_pixels(before, now) >= pixels; });
}

KerfResult WindowedKerf::finish() {
  const bool ended = waits_for_end();
  EXPECT_TRUE(ended) << "it goes on";
  if (!ended) kerf_.send(SIGKILL);
  return kerf_.finish();
}

}  // namespace kerf
