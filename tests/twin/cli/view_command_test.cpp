// kerf view, run --view, replay and shadow with their window on a virtual display, and the pictures
// that need none.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "tests/machine_io/simulator/machine_process.h"
#include "tests/twin/cli/watched_program.h"
#include "tests/twin/cli/window_process.h"
#include "tests/viewer/virtual_display.h"

namespace kerf {
namespace {

const std::vector<std::string> kWork = {"--stock", "box:-10,-10,-6:40,30,0", "--tool", "1=flat:6",
                                        "--tool",  "2=drill:5:118",          "--cell", "0.1"};

KerfCall call_of(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) {
  KerfCall call;
  call.arguments = std::move(arguments);
  call.arguments.insert(call.arguments.end(), more.begin(), more.end());
  return call;
}

/// Of `kerf view`, without a window.
class ViewFiles : public ::testing::Test {
 protected:
  KerfResult view(std::vector<std::string> arguments, bool with_work = true) {
    arguments.insert(arguments.begin(), "view");
    return run_kerf(call_of(std::move(arguments), with_work ? kWork : std::vector<std::string>()));
  }
  /// A small picture; of an empty size if there is none.
  Picture picture(std::vector<std::string> arguments, int expected_exit = 0,
                  bool with_work = true) {
    const std::string path = folder_.file("picture.png");
    std::remove(path.c_str());
    for (const char* word : {"--png", path.c_str(), "--size", "320x240"}) {
      arguments.emplace_back(word);
    }
    last_ = view(std::move(arguments), with_work);
    EXPECT_EQ(last_.exit_code, expected_exit) << last_.err;
    return read_png_file(path);
  }
  std::string err_of(std::vector<std::string> arguments, int expected_exit) {
    const KerfResult result = view(std::move(arguments), false);
    EXPECT_EQ(result.exit_code, expected_exit) << result.err;
    return result.err;
  }

  TestFolder folder_;
  std::string program_ = folder_.write("part.ngc", kWatchedProgram);
  KerfResult last_;
};

TEST_F(ViewFiles, WithoutADisplayItSaysSoAndNamesTheWayWithoutOne) {
  EXPECT_EQ(err_of({program_}, 4),
            "kerf: error: no window: there is no display (DISPLAY is not set); pictures need no "
            "display: --png FILE\n");
  const KerfResult run = run_kerf(call_of({"run", program_, "--view"}, kWork));
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("--view: no window"), std::string::npos) << run.err;
}

TEST_F(ViewFiles, ModesOfTheWindowAfterARunAreNamedAndNeedTheWindow) {
  const KerfResult wrong = run_kerf(call_of({"run", program_, "--view", "--draw", "voxels"}));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.err,
            "kerf: error: --draw: 'voxels' is not allowed; must be mesh, raycast or csg\n");
  const KerfResult alone = run_kerf(call_of({"run", program_, "--draw", "csg"}));
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(alone.err, "kerf: error: --draw: is for the window; there is no --view\n");
}

TEST_F(ViewFiles, PicturesWantAProgram) {
  EXPECT_EQ(err_of({"--png", "x.png"}, 2),
            "kerf: error: PROGRAM is required: --png and --frames draw one\n"
            "   hint: kerf view --help lists what there is\n");
}

TEST_F(ViewFiles, FaultsOfTheCommandLineComeAtOnce) {
  EXPECT_EQ(
      err_of({program_, "--speed", "0"}, 2),
      "kerf: error: --speed: 0 is not allowed; must be at least 0.1 and at most 1000 (program "
      "seconds a second)\n");
  EXPECT_EQ(err_of({program_, "--png", "x.png", "--size", "10"}, 2),
            "kerf: error: --size: '10' is not allowed; must be WIDTHxHEIGHT, each from 1 to 16384 "
            "(pixels), as 1280x720\n");
  EXPECT_EQ(err_of({program_, "--png", "x.png", "--view", "up"}, 2),
            "kerf: error: --view: 'up' is not allowed; must be iso, top, bottom, front, back, "
            "left or right\n");
  EXPECT_EQ(err_of({program_, "--size", "10x10"}, 2),
            "kerf: error: --size: is for --png and --frames\n");
  EXPECT_EQ(err_of({program_, "--fps", "5"}, 2), "kerf: error: --fps: there is no --frames DIR\n");
  EXPECT_EQ(err_of({program_, "--png", "a.png", "--frames", "film"}, 2),
            "kerf: error: --png: there is --frames already: one of the two\n");
  EXPECT_EQ(err_of({program_, "--png", "a.png", "--speed", "2"}, 2),
            "kerf: error: --speed: is for the window and for --frames; a picture stands still\n");
  EXPECT_EQ(err_of({program_, "--frames", "film", "--speed", "max"}, 2),
            "kerf: error: --speed: max has no frames a second; --frames wants a number\n");
  EXPECT_EQ(err_of({program_, "--png", "a.png", "--full-redraw"}, 2),
            "kerf: error: --full-redraw: is for the window; files get the whole picture every "
            "time\n");
  EXPECT_EQ(err_of({program_, "--at-line", "0"}, 2),
            "kerf: error: --at-line: 0 is not allowed; must be at least 1 and at most 4e+09 "
            "(lines)\n");
  EXPECT_NE(err_of({program_, "--set", "machine.model=boat"}, 2).find("'boat' is not allowed"),
            std::string::npos);
  EXPECT_EQ(listing(folder_.path()), "part.ngc");
}

TEST_F(ViewFiles, ColoursOfForcesWantAMaterial) {
  EXPECT_EQ(err_of({program_, "--png", "x.png", "--color", "force"}, 2),
            "kerf: error: --color: force is worked out of the material, which nobody has said\n"
            "   hint: --material NAME says it; docs/cutting-forces.md lists them\n");
  EXPECT_EQ(err_of({program_, "--png", "x.png", "--color", "chip"}, 2),
            "kerf: error: --color: chip is not measured\n"
            "   hint: --engagement or --material NAME measures it\n");
  EXPECT_NE(
      err_of({program_, "--png", "x.png", "--color", "blue"}, 2).find("'blue' is not allowed"),
      std::string::npos);
  EXPECT_NE(err_of({program_, "--png", "x.png", "--color-on", "path"}, 2).find("--color-on"),
            std::string::npos);
  EXPECT_NE(err_of({program_, "--png", "x.png", "--draw", "raycast", "--color", "tool"}, 2)
                .find("raycast shows no colours"),
            std::string::npos);
  EXPECT_NE(err_of({program_, "--spindle-power", "2", "--png", "x.png"}, 2).find("--material"),
            std::string::npos);
  EXPECT_NE(err_of({program_, "--material", "cheese", "--png", "x.png"}, 2).find("cheese"),
            std::string::npos);
}

/// Path and surface, with a legend on them; with the same findings as `kerf run` the window's tests
/// have to do.
TEST_F(ViewFiles, ColoursOfForcesAreInThePicture) {
  const std::vector<std::string> shop{program_,
                                      "--stock",
                                      "box:-10,-10,-6:40,30,0",
                                      "--tool",
                                      "1=flat:6:teeth=3",
                                      "--tool",
                                      "2=drill:5:118:teeth=2",
                                      "--cell",
                                      "0.2",
                                      "--material",
                                      "aluminium"};
  const auto seen = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = shop;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return picture(arguments, 0, false);
  };
  const Picture plain = seen({}), surface = seen({"--color", "force"});
  EXPECT_EQ(last_.err, "");
  EXPECT_GT(different_pixels(plain, surface), 1000U);
  const Picture path = seen({"--color", "force", "--color-on", "path"});
  EXPECT_GT(different_pixels(plain, path), 100U);
  EXPECT_GT(different_pixels(surface, path), 500U);
}

TEST_F(ViewFiles, WhatCannotBeReadIsNamed) {
  const std::string missing = folder_.file("none.ngc");
  EXPECT_EQ(err_of({missing, "--png", folder_.file("x.png")}, 4),
            missing + ": error: cannot be read: No such file or directory\n");
  EXPECT_EQ(listing(folder_.path()), "part.ngc");
}

TEST_F(ViewFiles, ABrokenProgramIsShownUpToWhereItBreaks) {
  std::string text = kWatchedProgram;
  text.replace(text.find("J10"), 3, "J99");
  const std::string broken = folder_.write("broken.ngc", text);
  const Picture found = picture({broken}, 4);
  EXPECT_NE(last_.err.find(broken + ":6: error: interpreter-error: Radius to end of arc"),
            std::string::npos)
      << last_.err;
  const Picture until = picture({program_, "--until-line", "5"});
  ASSERT_EQ(until.width_px, 320);
  EXPECT_LT(different_pixels(found, until), 100U) << "the same slot";
  EXPECT_GT(different_pixels(found, picture({program_})), 300U);
}

TEST_F(ViewFiles, APictureIsOfTheEndOrOfALine) {
  const Picture end = picture({program_});
  ASSERT_EQ(end.width_px, 320);
  ASSERT_EQ(end.height_px, 240);
  const Picture at_line = picture({program_, "--at-line", "5"});
  EXPECT_GT(different_pixels(end, at_line), 300U);
  EXPECT_EQ(different_pixels(end, picture({program_})), 0U) << "the same again";
  EXPECT_GT(different_pixels(end, picture({program_, "--view", "top"})), 3000U);
  EXPECT_EQ(picture({program_, "--at-line", "99"}, 2).width_px, 0);
  EXPECT_NE(last_.err.find("kerf: error: --at-line 99: "), std::string::npos) << last_.err;
}

TEST_F(ViewFiles, AFolderThatIsMissingOrFullLeavesNoHalfFile) {
  const KerfResult result = view({program_, "--png", folder_.file("none/part.png")});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("none/part.png: folder "), std::string::npos) << result.err;
  KerfCall call = call_of({"view", program_, "--png", folder_.file("part.png")}, kWork);
  call.file_size_limit = 4096;
  const KerfResult full = run_kerf(call);
  EXPECT_EQ(full.exit_code, 4);
  EXPECT_NE(full.err.find("File too large"), std::string::npos) << full.err;
  EXPECT_EQ(listing(folder_.path()), "part.ngc");
}

TEST_F(ViewFiles, AFilmEndsWithThePictureOfTheEnd) {
  const std::string film = folder_.file("film");
  const KerfResult result =
      view({program_, "--frames", film, "--fps", "2", "--speed", "0.5", "--size", "320x240"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const KerfResult run = run_kerf(call_of({"run", program_, "--json", "-"}, kWork));
  const double duration_s = Json::parse(run.out)["motion"]["duration_s"];
  // A quarter of a second of the program a frame, and the end.
  const int frames = static_cast<int>(std::ceil(duration_s / 0.25)) + 1;
  std::istringstream names(listing(film));
  std::string name, last;
  int count = 0;
  for (; names >> name; last = name) EXPECT_EQ(name, fmt::format("frame_{:06}.png", count++));
  EXPECT_EQ(count, frames);
  EXPECT_NE(result.out.find(fmt::format("{} frames in {}", frames, film)), std::string::npos)
      << result.out;
  const Picture end = read_png_file(film + "/" + last);
  ASSERT_EQ(end.width_px, 320);
  EXPECT_LT(different_pixels(end, picture({program_})), 100U);
  EXPECT_GT(different_pixels(end, read_png_file(film + "/frame_000000.png")), 500U);
}

TEST_F(ViewFiles, ASavedWorkpiece) {
  const std::string state = folder_.file("part.state");
  ASSERT_EQ(run_kerf(call_of({"run", program_, "--state", state, "--quiet"}, kWork)).exit_code, 0);
  const Picture saved = picture({state}, 0, false);
  ASSERT_EQ(saved.width_px, 320);
  // Without tool and path.
  const Picture blank = picture({program_, "--at-line", "1"});
  EXPECT_GT(different_pixels(saved, blank), 500U);
  EXPECT_EQ(picture({state, "--at-line", "5"}, 2, false).width_px, 0);
  EXPECT_NE(last_.err.find("kerf: error: --at-line 5: "), std::string::npos) << last_.err;
}

TEST_F(ViewFiles, TheMachineOfAConfigurationIsAroundThePart) {
  const Picture bare = picture({program_});
  const std::string config = std::string(KERF_CONFIGS) + "/machine_model.yaml";
  const Picture mill = picture({program_, "-c", config});
  EXPECT_GT(different_pixels(bare, mill), 3000U);
  const Picture gantry = picture({program_, "-c", config, "--set", "machine.model=gantry"});
  EXPECT_GT(different_pixels(mill, gantry), 3000U);
  EXPECT_LT(
      different_pixels(bare, picture({program_, "-c", config, "--set", "machine.model=none"})),
      100U);
}

TEST_F(ViewFiles, LinksThatCannotBeReadAreAllNamedAndNothingIsBegun) {
  folder_.write("broken.stl", "solid nothing\nfacet whatever\n");
  const std::string config = folder_.write("machine.yaml",
                                           "machine:\n"
                                           "  links:\n"
                                           "    - {name: table, stl: broken.stl}\n"
                                           "    - {name: head, stl: none.stl}\n"
                                           "  workpiece_on: table\n"
                                           "  tool_on: head\n");
  EXPECT_EQ(picture({program_, "-c", config}, 2).width_px, 0);
  EXPECT_NE(last_.err.find("broken.stl:2: 'whatever' found where 'normal' is due"),
            std::string::npos)
      << last_.err;
  EXPECT_NE(last_.err.find("none.stl: No such file or directory"), std::string::npos) << last_.err;
  // A dry run holds them against each other; who does not want that does not ask for them.
  const KerfResult run = run_kerf(call_of({"run", program_, "-c", config, "--quiet"}, kWork));
  EXPECT_EQ(run.exit_code, 2) << run.err;
  const KerfResult unasked = run_kerf(
      call_of({"run", program_, "-c", config, "--set", "machine.collisions=no", "--quiet"}, kWork));
  EXPECT_EQ(unasked.exit_code, 0) << unasked.err;
}

TEST_F(ViewFiles, ALogWantsAWindowOrReplay) {
  const std::string log = folder_.write("run.csv", "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,2,3,4\n");
  EXPECT_NE(err_of({log, "--png", "a.png"}, 2).find("kerf replay LOG --png FILE"),
            std::string::npos);
  EXPECT_EQ(err_of({log, "--at-line", "3"}, 2),
            "kerf: error: --at-line: is for programs, not for logs\n");
}

TEST_F(ViewFiles, ALogWithoutADisplayNamesTheWayWithoutOne) {
  const std::string log = folder_.write("run.csv", "t_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,2,3,4\n");
  const KerfResult result = view({log, "--quiet"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err,
            "kerf: error: no window: there is no display (DISPLAY is not set); pictures need no "
            "display: --png FILE\n"
            "   hint: kerf replay LOG needs no window; with --png FILE it draws what the log "
            "leaves\n");
  EXPECT_EQ(result.out, "") << "it has not been replayed";
}

/// With a window.
/// As a panel is, with its letters, and nothing of the scene.
bool is_dark(const Picture& picture, glm::ivec2 from_px, glm::ivec2 to_px) {
  double sum = 0;
  for (int y = from_px.y; y < to_px.y; ++y) {
    for (int x = from_px.x; x < to_px.x; ++x)
      sum += picture.rgb.at(3 * std::size_t(y * picture.width_px + x));
  }
  return sum < 80.0 * (to_px.x - from_px.x) * (to_px.y - from_px.y);
}

class ViewWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!display_trouble().empty()) GTEST_SKIP() << display_trouble();
  }
  void open(std::vector<std::string> arguments) {
    kerf_ = std::make_unique<WindowedKerf>(call_of(std::move(arguments), kWork));
    ASSERT_TRUE(kerf_->opens()) << (kerf_->has_ended() ? kerf_->finish().err : "");
  }
  void expect_end(int exit_code) {
    const KerfResult result = kerf_->finish();
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    result_ = result;
  }

  /// A log of a machine that goes there and back along X for a minute, as kerf records it.
  std::string write_log() {
    std::string text = "t_s,x_mm,y_mm,z_mm,tool\n";
    for (int i = 0; i <= 6000; ++i) {
      const double t_s = 0.01 * i;
      text += fmt::format("{:.2f},{:.4f},10,-1,1\n", t_s, 15 + 15 * std::sin(t_s));
    }
    return folder_.write("run.csv", text);
  }
  std::vector<Json> statuses() const {
    std::vector<Json> out;
    std::istringstream text(read_file(folder_.file("events")));
    for (std::string line; std::getline(text, line);) {
      Json event = Json::parse(line, nullptr, false);
      if (!event.is_discarded() && event["event"] == "status") out.push_back(std::move(event));
    }
    return out;
  }
  double last_t_s() const {
    const std::vector<Json> all = statuses();
    return all.empty() ? -1 : all.back()["t_s"].get<double>();
  }
  /// Ten more have been told; whether time went on from the first to the last of them.
  bool time_goes_on() {
    const std::size_t seen = statuses().size();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (statuses().size() < seen + 10 && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const std::vector<Json> all = statuses();
    EXPECT_GE(all.size(), seen + 10);
    return all.size() > seen && all.back()["t_s"] > all[seen]["t_s"];
  }

  TestFolder folder_;
  std::string program_ = folder_.write("part.ngc", kWatchedProgram);
  std::unique_ptr<WindowedKerf> kerf_;
  KerfResult result_;
};

TEST_F(ViewWindow, PlaysStepsAndCloses) {
  open({"view", program_});
  const Picture start = kerf_->settled();
  kerf_->key("space");
  ASSERT_TRUE(kerf_->changes_from(start)) << "it plays";
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(start));
  const Picture end = kerf_->settled();
  kerf_->key("Home");
  ASSERT_TRUE(kerf_->changes_from(end));
  EXPECT_LT(different_pixels(kerf_->settled(), start), 30U) << "uncut again";
  kerf_->key("Q");
  expect_end(0);
  EXPECT_EQ(result_.err, "");
}

TEST_F(ViewWindow, PlaysAtOnceAtTheSpeedAskedFor) {
  open({"view", program_});
  const Picture start = kerf_->settled();
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(start, 2000));
  const Picture end = kerf_->settled();
  kerf_->key("Q");
  expect_end(0);
  for (const char* speed : {"1000", "max"}) {
    open({"view", program_, "--speed", speed});
    EXPECT_TRUE(kerf_->shows([&](const Picture& now) { return different_pixels(now, end) < 300; }))
        << speed;
    kerf_->key("Q");
    expect_end(0);
    EXPECT_EQ(result_.err, "");
  }
}

TEST_F(ViewWindow, ADestroyedWindowIsAClosedOne) {
  open({"view", program_});
  kerf_->settled();
  ASSERT_TRUE(xdotool("search --onlyvisible --name '^kerf - part.ngc$' windowclose"));
  expect_end(0);
  EXPECT_EQ(result_.err, "");
}

TEST_F(ViewWindow, ShowsAtOnceTheLineAskedFor) {
  open({"view", program_, "--at-line", "9"});
  const Picture at_line = kerf_->settled();
  kerf_->key("Home");
  EXPECT_TRUE(kerf_->changes_from(at_line));
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, ColoursOfLastTimeAreThereAgain) {
  open({"view", program_, "--at-line", "14"});
  const Picture plain = kerf_->settled();
  kerf_->key("v");
  kerf_->key("v");
  ASSERT_TRUE(kerf_->changes_from(plain)) << "by tool";
  const Picture by_tool = kerf_->settled();
  kerf_->key("Q");
  // Closing writes the settings.
  ASSERT_TRUE(kerf_->waits_for_end());
  const std::string settings = read_file(kerf_->home() + "/kerf/view.conf");
  expect_end(0);
  kerf_ = std::make_unique<WindowedKerf>(call_of({"view", program_, "--at-line", "14"}, kWork),
                                         settings);
  ASSERT_TRUE(kerf_->opens());
  EXPECT_TRUE(
      kerf_->shows([&](const Picture& now) { return different_pixels(now, by_tool) < 30; }));
  kerf_->key("Q");
  expect_end(0);
}

/// The mesh has what is left of the blank darker, CSG what is cut in other colours: what is the
/// same is where the room behind is seen.
TEST_F(ViewWindow, ThreeModesShowTheSamePart) {
  constexpr double kMostOfOutline = 0.005;
  const auto is_room = [](const Picture& picture, std::size_t at) {
    return picture.rgb[at + 2] > picture.rgb[at] && picture.rgb[at] > 195;
  };
  const auto outlines_apart = [&](const Picture& a, const Picture& b) {
    std::size_t apart = 0;
    for (std::size_t i = 0; i + 2 < std::min(a.rgb.size(), b.rgb.size()); i += 3) {
      apart += is_room(a, i) != is_room(b, i) ? 1 : 0;
    }
    return static_cast<double>(apart) / (static_cast<double>(a.rgb.size()) / 3);
  };
  open({"view", program_, "--at-line", "14", "--draw", "raycast"});
  const Picture first = kerf_->settled();
  kerf_->key("r");
  kerf_->key("r");
  ASSERT_TRUE(kerf_->changes_from(first)) << "it was not the mesh";
  const Picture mesh = kerf_->settled();
  for (const char* draw_mode : {"raycast", "csg"}) {
    kerf_->key("r");
    EXPECT_TRUE(kerf_->shows([&](const Picture& now) {
      return different_pixels(now, mesh) > 300 && outlines_apart(now, mesh) < kMostOfOutline;
    })) << draw_mode;
  }
  kerf_->key("Q");
  expect_end(0);
  EXPECT_EQ(result_.err, "");
}

TEST_F(ViewWindow, AnInterruptEndsIt) {
  for (const int signal : {SIGINT, SIGTERM}) {
    open({"view", program_, "--speed", "0.1"});
    kerf_->send(signal);
    expect_end(0);
  }
}

/// The interpreter goes round without a move, or a blank is filled: nobody asks what the window
/// wants.
TEST_F(ViewWindow, ClosedWhileAProgramLoadsItEndsAtOnce) {
  const std::string silent = folder_.write(
      "silent.ngc", "G21 G90\n#1=0\no1 while [#1 LT 1e9]\n#1=[#1+1]\no1 endwhile\nM2\n");
  const std::vector<std::vector<std::string>> commands = {
      {"view", silent},
      {"view", program_, "--stock", "cylinder:0,0,-300:0:400", "--model", "octree", "--cell",
       "0.2"}};
  for (const std::vector<std::string>& arguments : commands) {
    kerf_ = std::make_unique<WindowedKerf>(call_of(arguments));
    ASSERT_TRUE(kerf_->opens()) << (kerf_->has_ended() ? kerf_->finish().err : "");
    const double spent_s = kerf_->process().cpu_s();
    const auto begin = std::chrono::steady_clock::now();
    kerf_->key("Q");
    kerf_->process().wait_for_end();
    // The window is drawn by this process, too, and the key comes by another one.
    EXPECT_LE(kerf_->process().cpu_s() - spent_s, 0.8);
    EXPECT_LE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    expect_end(0);
  }
}

TEST_F(ViewWindow, AProgramThatIsGoneIsStillShown) {
  open({"view", program_});
  const Picture start = kerf_->settled();
  std::remove(program_.c_str());
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(start));
  kerf_->key("Home");
  EXPECT_TRUE(kerf_->shows([&](const Picture& now) { return different_pixels(now, start) < 30; }));
  kerf_->key("Q");
  expect_end(0);
}

/// The eye was moved, the program stands at its end: both stay, and what is shown is what a fresh
/// window shows of the new program.
TEST_F(ViewWindow, AChangedProgramIsReadAgainWhereItStood) {
  std::string deeper = kWatchedProgram;
  deeper.replace(deeper.find("Z-2"), 3, "Z-5");
  folder_.write("deeper.ngc", deeper);
  open({"view", folder_.file("deeper.ngc")});
  const Picture at_start = kerf_->settled();
  kerf_->key("5");
  ASSERT_TRUE(kerf_->changes_from(at_start));
  const Picture from_above = kerf_->settled();
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(from_above));
  const Picture wanted = kerf_->settled();
  kerf_->key("Q");
  expect_end(0);
  open({"view", program_});
  const Picture start = kerf_->settled();
  kerf_->key("5");
  ASSERT_TRUE(kerf_->changes_from(start));
  const Picture above = kerf_->settled();
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(above));
  const Picture before = kerf_->settled();
  ASSERT_GT(different_pixels(before, wanted), 300U);
  folder_.write("part.ngc", deeper);
  EXPECT_TRUE(kerf_->shows([&](const Picture& now) { return different_pixels(now, wanted) < 30; }));
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, AProgramThatIsBrokenMeanwhileStaysAsItWasUntilItIsMended) {
  open({"view", program_, "--tool-table", folder_.write("tool.tbl", "T1 P1 D6\nT2 P2 D5\n")});
  const Picture start = kerf_->settled();
  kerf_->key("End");
  ASSERT_TRUE(kerf_->changes_from(start));
  const Picture before = kerf_->settled();
  std::remove(program_.c_str());
  folder_.write("tool.tbl", "T1 P1 Dsix\n");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_LT(different_pixels(before, kerf_->settled()), 30U);
  std::string deeper = kWatchedProgram;
  deeper.replace(deeper.find("Z-2"), 3, "Z-5");
  folder_.write("part.ngc", deeper);
  folder_.write("tool.tbl", "T1 P1 D6\nT2 P2 D5\n");
  EXPECT_TRUE(kerf_->changes_from(before));
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, AnEmptyWindowOpensAProgramByName) {
  kerf_ = std::make_unique<WindowedKerf>(call_of({"view"}));
  ASSERT_TRUE(kerf_->is_titled("kerf$"));
  const Picture empty = kerf_->settled();
  kerf_->open_file(program_);
  ASSERT_TRUE(kerf_->is_titled("kerf - part.ngc"));
  EXPECT_TRUE(kerf_->changes_from(empty));
  kerf_->key("Q");
  expect_end(0);
  EXPECT_NE(read_file(kerf_->home() + "/kerf/view.conf").find("recent.1 = " + program_),
            std::string::npos);
}

TEST_F(ViewWindow, AProgramThatCannotBeReadEndsIt) {
  kerf_ = std::make_unique<WindowedKerf>(call_of({"view", folder_.file("none.ngc")}));
  expect_end(4);
  EXPECT_NE(result_.err.find("none.ngc: error: cannot be read"), std::string::npos);
}

TEST_F(ViewWindow, ABrokenProgramIsShownUpToWhereItBreaks) {
  std::string text = kWatchedProgram;
  text.replace(text.find("J10"), 3, "J99");
  open({"view", folder_.write("broken.ngc", text)});
  const Picture start = kerf_->settled();
  kerf_->key("End");
  EXPECT_TRUE(kerf_->changes_from(start, 100));
  kerf_->key("Q");
  expect_end(0);
  EXPECT_NE(result_.err.find("broken.ngc:6: error: interpreter-error: "), std::string::npos)
      << result_.err;
}

TEST_F(ViewWindow, RunShowsTheResult) {
  open({"run", program_, "--view", "--json", folder_.file("part.json")});
  const Picture end = kerf_->settled();
  EXPECT_GT(Json::parse(read_file(folder_.file("part.json")))["stock"]["removed_mm3"], 100);
  kerf_->key("Home");
  EXPECT_TRUE(kerf_->changes_from(end));
  kerf_->key("Q");
  expect_end(0);
  EXPECT_NE(result_.out.find("removed"), std::string::npos) << result_.out;
}

TEST_F(ViewWindow, RunShowsTheMachineOfItsConfiguration) {
  open({"run", program_, "--view"});
  const Picture bare = kerf_->settled();
  kerf_->key("Q");
  expect_end(0);
  open({"run", program_, "--view", "-c", std::string(KERF_CONFIGS) + "/machine_model.yaml"});
  EXPECT_GT(different_pixels(bare, kerf_->settled()), 3000U);
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, RunShowsTheResultInTheModeAskedFor) {
  open({"run", program_, "--view", "--draw", "csg"});
  const Picture first = kerf_->settled();
  kerf_->key("r");
  ASSERT_TRUE(kerf_->changes_from(first)) << "it was not the mesh, which comes after CSG";
  kerf_->settled();
  kerf_->key("r");
  kerf_->key("r");
  EXPECT_TRUE(kerf_->shows([&](const Picture& now) { return different_pixels(now, first) < 30; }))
      << "CSG again";
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, ALogIsHeldAndGoesOn) {
  open({"replay", write_log(), "--events", folder_.file("events")});
  EXPECT_TRUE(time_goes_on());
  kerf_->key("space");
  const Picture held = kerf_->settled();
  EXPECT_FALSE(time_goes_on());
  kerf_->key("space");
  EXPECT_TRUE(kerf_->changes_from(held));
  EXPECT_TRUE(time_goes_on());
  kerf_->key("Q");
  // A log that is not run to its end is a partial result.
  expect_end(4);
}

TEST_F(ViewWindow, ALogAtItsEndStaysUntilItIsClosedOrInterrupted) {
  for (const bool closes : {true, false}) {
    open({"view", write_log(), "--speed", "1000"});
    kerf_->settled();
    if (closes) {
      kerf_->key("Q");
    } else {
      kerf_->send(SIGINT);
    }
    expect_end(0);
    EXPECT_NE(result_.out.find("6001 samples"), std::string::npos) << result_.out;
  }
}

TEST_F(ViewWindow, WhatALogCutIsColouredByTool) {
  // The first tool's colour is a blue; the path is blue, too, but thin.
  const auto blue = [](const Picture& picture) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
      if (picture.rgb[i + 2] > picture.rgb[i] + 60) ++count;
    }
    return count;
  };
  open({"view", write_log(), "--speed", "1000"});
  const std::size_t plain = blue(kerf_->settled());
  kerf_->key("v");
  kerf_->key("v");
  EXPECT_TRUE(kerf_->shows([&](const Picture& now) { return blue(now) > plain + 4000; }));
  kerf_->key("Q");
  expect_end(0);
}

TEST_F(ViewWindow, ALogIsInterrupted) {
  open({"replay", write_log()});
  kerf_->send(SIGINT);
  expect_end(4);
}

/// What is watched matters more than the window.
TEST_F(ViewWindow, ALogGoesOnWhenTheDisplayIsGone) {
  const std::string shared_display = std::getenv("DISPLAY");
  Result<VirtualDisplay> display = VirtualDisplay::start();
  ASSERT_TRUE(display) << display.error();
  open({"replay", write_log(), "--speed", "8"});
  // While a window is being opened, what it is drawn by takes no loss of the display.
  Picture first;
  kerf_->shows([&first](const Picture& now) {
    first = now;
    return true;
  });
  EXPECT_TRUE(kerf_->changes_from(first));
  display->kill_server();
  setenv("DISPLAY", shared_display.c_str(), 1);
  expect_end(0);
  EXPECT_NE(result_.err.find("going on without a window"), std::string::npos) << result_.err;
  EXPECT_NE(result_.out.find("6001 samples"), std::string::npos) << result_.out;
}

TEST_F(ViewWindow, AMachineIsFollowed) {
  MachineProcess machine({program_, "--modbus-tcp", "127.0.0.1:0", "--frame", "workpiece", "--hold",
                          "--wait-for-reader", "--start-delay", "1"});
  const std::string listening = machine.wait_line("listening");
  ASSERT_NE(listening, "") << machine.err();
  const std::string config = folder_.write(
      "machine.yaml",
      fmt::format("source:\n"
                  "  type: modbus\n"
                  "  tcp: 127.0.0.1:{}\n"
                  "  poll_hz: 200\n"
                  "  frame: workpiece\n"
                  "  coordinates: axes\n"
                  "  map:\n"
                  "    X: {{register: 0, type: int32, word_order: cdab, scale: 0.001}}\n"
                  "    Y: {{register: 2, type: int32, word_order: cdab, scale: 0.001}}\n"
                  "    Z: {{register: 4, type: int32, word_order: cdab, scale: 0.001}}\n"
                  "    tool: {{register: 12, type: uint16}}\n",
                  listening.substr(listening.rfind(':') + 1)));
  open({"shadow", "-c", config, "--program", program_, "--json", folder_.file("live.json")});
  ASSERT_NE(machine.wait_line("finished"), "");
  kerf_->settled();
  // A start at line 7 from where it stands now: the answer lies over the part.
  EXPECT_TRUE(kerf_->choose(100, 143, 140, 177, [](const Picture& p) {
    return is_dark(p, {320, 150}, {500, 200});
  }));
  kerf_->key("Q");
  expect_end(0);
  EXPECT_GT(Json::parse(read_file(folder_.file("live.json")))["stock"]["removed_mm3"], 100);
}

}  // namespace
}  // namespace kerf
