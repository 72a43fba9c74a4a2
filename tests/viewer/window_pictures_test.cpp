// Pictures and films that the window saves: where they go, and what becomes of them. Films by a
// false ffmpeg, which writes down what it is given, and by the real one where there is one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/viewer/png_reader.h"
#include "tests/viewer/window_fixture.h"
#include "viewer/film_writer.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Another PATH while it lives, with an ffmpeg of one's own before it or with nothing in it.
class OtherPath {
 public:
  explicit OtherPath(const std::string& script) {
    if (!script.empty()) {
      const std::string path = folder_.path() + "/ffmpeg";
      std::ofstream(path) << "#!/bin/sh\n" << script;
      fs::permissions(path, fs::perms::owner_all);
    }
    const std::string rest = script.empty() ? "" : ":" + was_;
    setenv("PATH", (folder_.path() + rest).c_str(), 1);
  }
  ~OtherPath() { setenv("PATH", was_.c_str(), 1); }

 private:
  TemporaryFolder folder_;
  std::string was_ = std::getenv("PATH");
};

/// Its words, and how many bytes came, into what is to be the film.
constexpr const char* kNotesWhatComes =
    "for last; do :; done\necho \"$@\" > \"$last\"\nwc -c >> \"$last\"\n";

/// Bytes that a film of kNotesWhatComes was given.
std::size_t bytes_of(const std::string& film) {
  const std::string text = content_of(film);
  return std::stoul(text.substr(text.find('\n')));
}

Picture grey(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 90)};
}

TEST(FilmWriter, IsAsLongAsItWasShown) {
  const OtherPath path(kNotesWhatComes);
  const TemporaryFolder folder;
  const std::string name = folder.path() + "/a.mp4";
  auto film = FilmWriter::start(name, grey(8, 6), {});
  ASSERT_TRUE(film) << film.error();
  const auto begin = std::chrono::steady_clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  (*film)->show(grey(80, 2));  // the window has become another one
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(names_in(folder.path()) == std::vector<std::string>{} ||
              names_in(folder.path()) == std::vector<std::string>{"a.mp4.part"});
  const Done done = (*film)->finish();
  const double shown_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_TRUE(done) << done.error();
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a.mp4"});
  EXPECT_NE(content_of(name).find("-video_size 8x6 -framerate 25"), std::string::npos);
  const std::size_t bytes = bytes_of(name), frame = 3 * 8 * 6;
  EXPECT_EQ(bytes % frame, 0u);
  EXPECT_GE(bytes / frame, 0.6 * FilmWriter::kFramesPerS);
  EXPECT_LE(bytes / frame, shown_s * FilmWriter::kFramesPerS + 2);
}

TEST(FilmWriter, SaysWhatFfmpegSays) {
  const OtherPath path("echo \"Unknown encoder 'libx264'\" >&2\nexit 1\n");
  const TemporaryFolder folder;
  auto film = FilmWriter::start(folder.path() + "/a.mp4", grey(640, 480), {});
  ASSERT_TRUE(film) << film.error();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!(*film)->has_failed() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_TRUE((*film)->has_failed());
  const Done done = (*film)->finish();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error(), "ffmpeg: Unknown encoder 'libx264'");
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{});
}

TEST(FilmWriter, LeavesNothingWhenItIsDropped) {
  const OtherPath path(kNotesWhatComes);
  const TemporaryFolder folder;
  {
    auto film = FilmWriter::start(folder.path() + "/a.webm", grey(8, 6), {});
    ASSERT_TRUE(film) << film.error();
  }
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{});
}

TEST(FilmWriter, ByTheRealFfmpeg) {
  if (!FilmWriter::is_possible()) GTEST_SKIP() << "ffmpeg is not installed";
  const TemporaryFolder folder;
  const std::string name = folder.path() + "/a.mp4";
  auto film = FilmWriter::start(name, grey(65, 49), {});  // odd edges
  ASSERT_TRUE(film) << film.error();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Done done = (*film)->finish();
  ASSERT_TRUE(done) << done.error();
  EXPECT_EQ(content_of(name).substr(4, 4), "ftyp");
}

class WindowPictures : public WindowTest {
 protected:
  void open_for_pictures() {
    WindowOptions options;
    options.picture_folder = folder_.path();
    open(options);
  }
  bool turn_until_names(std::size_t count) {
    return turn_until([&] {
      const std::vector<std::string> names = names_in(folder_.path());
      // AtomicFile writes to ".NAME.XXXXXX" before it renames.
      const bool is_whole = std::none_of(names.begin(), names.end(), [](const std::string& name) {
        return name.starts_with('.') || name.ends_with(".part");
      });
      return names.size() == count && is_whole;
    });
  }
  TemporaryFolder folder_;
};

TEST_F(WindowPictures, EnterSavesThePictureOfTheScene) {
  open_for_pictures();
  const Picture scene = window_->read_scene();
  key("s");
  settle();
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{}) << "it asks first";
  key("Return");
  ASSERT_TRUE(turn_until_names(1));
  const std::string name = names_in(folder_.path()).front();
  EXPECT_TRUE(name.starts_with("kerf-") && name.ends_with(".png")) << name;
  EXPECT_EQ(read_png_file(folder_.path() + "/" + name).rgb, scene.rgb);
  settle();
  // Both keys before a frame is drawn; in the same second, perhaps: two pictures all the same.
  key("s Return");
  EXPECT_TRUE(turn_until_names(2));
}

TEST_F(WindowPictures, EscapeSavesNothing) {
  open_for_pictures();
  const Picture before = window_->read();
  key("s");
  settle();
  EXPECT_NE(mean_difference(before, window_->read(), kScene), 0.0) << "the question";
  key("Escape");
  settle();
  EXPECT_EQ(mean_difference(before, window_->read(), kScene), 0.0);
  key("Return");
  settle();
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{});
}

TEST_F(WindowPictures, TheWholeWindowIsWithoutTheQuestion) {
  open_for_pictures();
  const Picture before = window_->read();
  key("S");
  settle();
  key("Return");
  ASSERT_TRUE(turn_until_names(1));
  const Picture saved = read_png_file(folder_.path() + "/" + names_in(folder_.path()).front());
  EXPECT_EQ(saved.width_px, kWidth);
  EXPECT_EQ(mean_difference(before, saved, kScene), 0.0);
}

TEST_F(WindowPictures, ANameThatIsTypedAndItsFolderIsRemembered) {
  const TemporaryFolder home, other;
  settings_file_ = home.path() + "/view.conf";
  std::ofstream(other.path() + "/taken.png") << "not a picture";
  open();
  key("s");
  settle();
  const auto type = [this](const std::string& text) {
    key("ctrl+a");
    settle();
    ASSERT_TRUE(xdotool("type --delay 20 '" + text + "'"));
    settle();
    key("Return");
    settle();
  };
  type(other.path() + "/none/part");
  type(other.path() + "/taken");
  EXPECT_EQ(names_in(other.path()), std::vector<std::string>{"taken.png"});
  EXPECT_EQ(content_of(other.path() + "/taken.png"), "not a picture");
  type(other.path() + "/part");
  ASSERT_TRUE(turn_until([&] { return fs::exists(other.path() + "/part.png"); }));
  EXPECT_EQ(window_->settings().picture_folder, other.path());
  settle();
  key("s");
  settle();
  key("Return");
  EXPECT_TRUE(turn_until([&] { return names_in(other.path()).size() == 3; }));
  settle();
  window_.reset();
  Diagnostics faults;
  EXPECT_EQ(load_settings(settings_file_, &faults).picture_folder, other.path());
  EXPECT_TRUE(faults.empty());
}

TEST_F(WindowPictures, AFilmOfThePlayingEndsWithIt) {
  const OtherPath path(kNotesWhatComes);
  open_for_pictures();
  key("F");
  settle();
  commands_.take();
  key("Return");
  ASSERT_TRUE(next<PlayCommand>()) << "it plays at once";
  Moment moment = test_moment();
  for (int step = 0; step < 5; ++step) {
    moment.state = PlayState::kPlaying;
    moment.time_s += 1.0;
    moment.tool_pose->tip_mm.x += 2.0;
    publish(moment);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
    turn_until([&] { return std::chrono::steady_clock::now() > end; });
  }
  moment.state = PlayState::kEnded;
  publish(moment);
  ASSERT_TRUE(turn_until_names(1));
  const std::string film = folder_.path() + "/" + names_in(folder_.path()).front();
  EXPECT_TRUE(film.ends_with(".mp4")) << film;
  const Picture scene = window_->read_scene();
  const auto frame = static_cast<std::size_t>(3 * scene.width_px * scene.height_px);
  const std::size_t bytes = bytes_of(film);
  EXPECT_EQ(bytes % frame, 0u);
  EXPECT_GE(bytes / frame, 0.5 * FilmWriter::kFramesPerS);
}

TEST_F(WindowPictures, TheKeyEndsAFilm) {
  const OtherPath path(kNotesWhatComes);
  open_for_pictures();
  key("F Return");
  ASSERT_TRUE(next<PlayCommand>());
  settle();
  EXPECT_LE(names_in(folder_.path()).size(), 1u);
  key("F");
  EXPECT_TRUE(turn_until_names(1));
}

/// While it is cut as fast as can be the processor is for the cutting: pictures come, but not one
/// after the other.
/// Six parts of seven are for cutting. How long a picture takes is the machine's affair; panels may
/// add to it.
TEST_F(WindowTest, WhileItHurriesMostOfTheTimeIsNotForDrawing) {
  most_frames_per_s_ = 100'000;  // a fast processor makes more than a thousand
  open();
  const auto share_of_drawing = [this](PlayState state) {
    using Clock = std::chrono::steady_clock;
    Moment moment = test_moment();
    moment.state = state;
    moment.is_behind = state == PlayState::kHurrying;
    publish(moment);
    settle();
    std::uint64_t pictures = 0;
    Clock::duration drawing{};
    const Clock::time_point begin = Clock::now();
    while (Clock::now() < begin + std::chrono::seconds(1)) {
      moment.tool_pose->tip_mm.x += 0.01;
      publish(moment);
      const std::uint64_t before = frames();
      const Clock::time_point call = Clock::now();
      EXPECT_TRUE(window_->frame(0.0));
      if (frames() == before) continue;
      ++pictures;
      drawing += Clock::now() - call;
    }
    EXPECT_GE(pictures, 3u);
    return std::chrono::duration<double>(drawing) / (Clock::now() - begin);
  };
  const double playing = share_of_drawing(PlayState::kPlaying);
  const double hurrying = share_of_drawing(PlayState::kHurrying);
  EXPECT_LT(hurrying, 0.6 * playing) << playing << ", playing";
}

TEST_F(WindowPictures, WithoutFfmpegThereIsNoFilm) {
  open_for_pictures();
  const Picture before = window_->read();
  {
    const std::string tool = find_program("xdotool");
    const OtherPath path("");
    ASSERT_EQ(std::system((tool + " key F").c_str()), 0);
    ASSERT_TRUE(turn_until_changed(before, {0, 776, 600, 800})) << "the status line says so";
  }
  key("Return");
  settle();
  EXPECT_EQ(mean_difference(before, window_->read(), kScene), 0.0) << "nothing is asked";
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{});
}

}  // namespace
}  // namespace kerf
