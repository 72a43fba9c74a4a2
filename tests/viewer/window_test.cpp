#include "viewer/window/window.h"

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>

#include "base/translate.h"
#include "tests/viewer/window_fixture.h"

namespace kerf {
namespace {

constexpr Rgb kCurrentLine{52, 84, 62};
constexpr Rgb kErrorText{245, 115, 102};
constexpr Rgb kWarningText{242, 184, 82};
constexpr Rgb kMeasured{30, 92, 170};
constexpr Rgb kBreakpoint{214, 72, 62};

Picture read_png_file(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return picture;
  image.format = PNG_FORMAT_RGB;
  picture.width_px = static_cast<int>(image.width);
  picture.height_px = static_cast<int>(image.height);
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0) picture = {};
  return picture;
}

/// Against a picture that was looked at and found good. After a wanted change of the looks:
///     KERF_UPDATE_GOLDEN=1 ctest -R WindowTest.LooksAsItDid
/// then look at tests/golden/window.png before it is committed.
TEST_F(WindowTest, LooksAsItDid) {
  if (access("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", R_OK) != 0) {
    GTEST_SKIP() << "the font is not installed (Debian package fonts-dejavu-core)";
  }
  // Drivers differ along edges, versions of Dear ImGui in letters: of 255, mean over all channels.
  constexpr double kMeanDifference = 1.5;
  open();
  const Picture found = window_->read();
  const std::string path = std::string(KERF_GOLDEN_FOLDER) + "/window.png";
  if (std::getenv("KERF_UPDATE_GOLDEN") != nullptr) {
    const Done done = write_png(path, found);
    ASSERT_TRUE(done) << done.error();
  }
  const Picture golden = read_png_file(path);
  ASSERT_EQ(golden.width_px, kWidth) << path;
  const double difference = mean_difference(golden, found, kWhole);
  EXPECT_GE(difference, 0.0);
  EXPECT_LT(difference, kMeanDifference);
}

TEST_F(WindowTest, RestsWhileNothingHappens) {
  open();
  const std::uint64_t before = frames();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(window_->frame(0.01));
  EXPECT_EQ(frames(), before);
}

TEST_F(WindowTest, DraggingTurnsThePictureAndFitBringsTheViewBack) {
  open();
  key("7");
  settle();
  const Picture before = window_->read();
  drag({600, 200}, {700, 260});
  EXPECT_GT(mean_difference(before, window_->read(), kScene), 1.0);
  // A drag is no click: nothing is asked for.
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<PickCommand>(command));
  }
  key("7");
  move_to(320, 60);
  EXPECT_EQ(mean_difference(before, window_->read(), kWhole), 0.0);
}

TEST_F(WindowTest, WheelZoomsToTheCursor) {
  open();
  commands_.take();
  click(640, 420);
  const std::optional<PickCommand> before = next<PickCommand>();
  ASSERT_TRUE(before);
  const Picture picture = window_->read();
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(xdotool("click 4"));
  const std::optional<DetailCommand> detail = next<DetailCommand>();
  ASSERT_TRUE(detail);
  settle();
  EXPECT_GT(mean_difference(picture, window_->read(), kScene), 1.0);
  click(640, 420);
  const std::optional<PickCommand> after = next<PickCommand>();
  ASSERT_TRUE(after);
  // Exact in the plane of the target alone, and the point lies near it.
  EXPECT_NEAR(before->point_mm.x, after->point_mm.x, 12.0);
  EXPECT_NEAR(before->point_mm.y, after->point_mm.y, 12.0);
}

TEST_F(WindowTest, SpacePlaysAndPauses) {
  open();
  key("space");
  EXPECT_TRUE(next<PlayCommand>());
  Moment moment = test_moment();
  moment.state = PlayState::kPlaying;
  publish(moment);
  settle();
  key("space");
  EXPECT_TRUE(next<PauseCommand>());
}

TEST_F(WindowTest, KeysReachThePlayer) {
  open();
  key("Right");
  const auto step = next<StepBlockCommand>();
  ASSERT_TRUE(step);
  EXPECT_EQ(step->blocks, 1);
  key("n");
  EXPECT_TRUE(next<NextFindingCommand>());
  key("t");
  EXPECT_TRUE(next<NextToolCommand>());
  key("x");
  EXPECT_TRUE(next<StopCommand>());
  key("plus");
  const auto faster = next<SpeedCommand>();
  ASSERT_TRUE(faster);
  EXPECT_EQ(faster->factor, 2.0);
  key("b");
  const auto breakpoint = next<BreakpointCommand>();
  ASSERT_TRUE(breakpoint);
  EXPECT_EQ(breakpoint->line, 42);
  EXPECT_TRUE(breakpoint->set);
}

TEST_F(WindowTest, SliderSeeksWhereItIsClicked) {
  open();
  click(kWidth / 2, kSliderY);
  const auto seek = next<SeekTimeCommand>();
  ASSERT_TRUE(seek);
  EXPECT_NEAR(seek->time_s, 100.0, 0.5);
}

TEST_F(WindowTest, AClickCountsWhereItWasThoughTheMouseHasLeft) {
  open();
  commands_.take();
  const Picture before = window_->read_scene();
  // All of it between two frames.
  ASSERT_TRUE(xdotool("mousemove 640 " + std::to_string(kSliderY) +
                      " click 1 mousemove 600 300 mousemove 700 200"));
  const auto seek = next<SeekTimeCommand>();
  ASSERT_TRUE(seek);
  EXPECT_NEAR(seek->time_s, 100.0, 0.5);
  settle();
  EXPECT_EQ(before.rgb, window_->read_scene().rgb);
}

TEST_F(WindowTest, EveryButtonOfThePlayerDoesSomethingOfItsOwn) {
  open();
  std::set<std::size_t> kinds;
  commands_.take();
  for (int x = 18; x < 460; x += 26) {
    click(x, kButtonsY);
    settle();
    for (const ViewerCommand& command : commands_.take()) kinds.insert(command.index());
  }
  const auto has = [&](const ViewerCommand& command) { return kinds.count(command.index()) == 1; };
  EXPECT_TRUE(has(SeekTimeCommand{}));
  EXPECT_TRUE(has(StepBlockCommand{}));
  EXPECT_TRUE(has(PlayCommand{}));
  EXPECT_TRUE(has(StopCommand{}));
  EXPECT_TRUE(has(SeekEndCommand{}));
  EXPECT_TRUE(has(NextToolCommand{}));
  EXPECT_TRUE(has(NextFindingCommand{}));
  EXPECT_TRUE(has(SpeedCommand{}));
}

TEST_F(WindowTest, ClickInTheProgramSeeksThatLineAndItIsMarked) {
  open();
  click(150, 400);
  const auto seek = next<SeekLineCommand>();
  ASSERT_TRUE(seek);
  EXPECT_EQ(seek->file, "");
  ASSERT_GT(seek->line, 42);
  Moment moment = test_moment();
  moment.line = seek->line;
  publish(moment);
  const PixelBox row{200, 400, 260, 401};
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), row, kCurrentLine) == 60; }));
}

TEST_F(WindowTest, ClickOnALineNumberSetsABreakpoint) {
  open();
  click(30, 400);
  const auto set = next<BreakpointCommand>();
  ASSERT_TRUE(set);
  EXPECT_EQ(set->file, "test.ngc");
  EXPECT_TRUE(set->set);
  Moment moment = test_moment();
  moment.breakpoints = {{0, 44}, {0, set->line}};
  publish(moment);
  const PixelBox dot{8, 390, 26, 410};
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), dot, kBreakpoint) > 20; }));
  click(30, 400);
  const auto cleared = next<BreakpointCommand>();
  ASSERT_TRUE(cleared);
  EXPECT_EQ(cleared->line, set->line);
  EXPECT_FALSE(cleared->set);
}

TEST_F(WindowTest, SubroutinesHaveBreakpointsOfTheirOwn) {
  open();
  const PixelBox dots{8, 60, 26, 700};
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), dots, kBreakpoint) > 20; }));
  const Picture main = window_->read();
  Moment moment = test_moment();  // its breakpoint is in the main program
  moment.file = 1;
  moment.line = 7;
  publish(moment);
  ASSERT_TRUE(turn_until_changed(main, kCode));
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), dots, kBreakpoint) == 0; }));
  key("b");
  const auto of_key = next<BreakpointCommand>();
  ASSERT_TRUE(of_key);
  EXPECT_EQ(of_key->file, "subroutines/pocket.ngc");
  EXPECT_EQ(of_key->line, 7);
  EXPECT_TRUE(of_key->set);
  moment.breakpoints = {{0, 44}, {1, 7}};
  publish(moment);
  ASSERT_TRUE(turn_until([&] { return count_pixels(window_->read(), dots, kBreakpoint) > 20; }));
  const std::optional<glm::ivec2> row = find_pixel(window_->read(), dots, kBreakpoint);
  ASSERT_TRUE(row);
  click(30, row->y + 3);
  const auto of_click = next<BreakpointCommand>();
  ASSERT_TRUE(of_click);
  EXPECT_EQ(of_click->file, "subroutines/pocket.ngc");
  EXPECT_EQ(of_click->line, 7);
  EXPECT_FALSE(of_click->set);
}

TEST_F(WindowTest, SubroutineComesToTheFrontWhileItRuns) {
  open();
  const Picture main = window_->read();
  Moment moment = test_moment();
  moment.file = 1;
  moment.line = 7;
  publish(moment);
  ASSERT_TRUE(turn_until_changed(main, kCode));
  settle();
  const std::optional<glm::ivec2> row = find_pixel(window_->read(), kCode, kCurrentLine);
  ASSERT_TRUE(row);
  click(200, row->y + 6);
  const auto seek = next<SeekLineCommand>();
  ASSERT_TRUE(seek);
  EXPECT_EQ(seek->file, "subroutines/pocket.ngc");
  EXPECT_EQ(seek->line, 7);
  publish(test_moment());
  move_to(320, 60);
  EXPECT_TRUE(turn_until([&] { return mean_difference(main, window_->read(), kCode) == 0.0; }));
}

TEST_F(WindowTest, AMillionLinesAreScrolledToTheLast) {
  open();
  std::string text;
  for (int line = 1; line <= 1'000'000; ++line) text += "G1 X1\n";
  ProgramText program;
  program.files.emplace_back("long.ngc", std::move(text));
  SceneUpdate update;
  update.program = std::make_shared<const ProgramText>(std::move(program));
  mailbox_.publish(std::move(update));
  settle();
  drag({276, 100}, {276, 714});
  click(150, 700);
  const auto seek = next<SeekLineCommand>();
  ASSERT_TRUE(seek);
  EXPECT_GE(seek->line, 999'998);
  EXPECT_LE(seek->line, 1'000'001);
}

TEST_F(WindowTest, ClickOnAFindingSeeksIt) {
  open();
  const auto at = find_pixel(window_->read(), {980, 200, 1060, 500}, kWarningText);
  ASSERT_TRUE(at);
  click(at->x + 2, at->y + 4);
  const auto seek = next<SeekFindingCommand>();
  ASSERT_TRUE(seek);
  EXPECT_EQ(seek->index, 1);
}

TEST_F(WindowTest, HelpComesAndGoes) {
  open();
  const Picture before = window_->read();
  key("question");
  ASSERT_TRUE(turn_until_changed(before, kScene));
  key("Escape");
  EXPECT_TRUE(turn_until([&] { return mean_difference(before, window_->read(), kWhole) == 0.0; }));
}

TEST_F(WindowTest, GoesToTheLineThatIsTyped) {
  open();
  commands_.take();
  key("g");
  settle();
  ASSERT_TRUE(xdotool("key 3 0 7 Return"));
  const auto seek = next<SeekLineCommand>();
  ASSERT_TRUE(seek);
  EXPECT_EQ(seek->line, 307);
}

TEST_F(WindowTest, ShrinksToOnePixelAndComesBack) {
  open();
  const Picture before = window_->read();
  const auto resize = [&](int width, int height) {
    ASSERT_TRUE(xdotool("search --onlyvisible --name kerf windowsize " + std::to_string(width) +
                        " " + std::to_string(height) + " >/dev/null"));
    ASSERT_TRUE(turn_until([&] { return window_->read().width_px == width; }));
  };
  resize(1, 1);
  resize(kWidth, kHeight);
  key("7");  // the camera is fitted anew; both views are then of the same
  settle();
  const Picture after = window_->read();
  key("7");
  settle();
  EXPECT_EQ(mean_difference(after, window_->read(), kWhole), 0.0);
  EXPECT_EQ(mean_difference(before, after, kCode), 0.0);
}

TEST_F(WindowTest, KeyClosesIt) {
  open();
  commands_.take();
  key("Q");
  bool is_open = true;
  for (int i = 0; i < 500 && is_open; ++i) {
    const Result<bool> turned = window_->frame(0.02);
    ASSERT_TRUE(turned) << turned.error();
    is_open = *turned;
  }
  EXPECT_FALSE(is_open);
  const auto commands = commands_.take();
  ASSERT_FALSE(commands.empty());
  EXPECT_TRUE(std::holds_alternative<CloseCommand>(commands.back()));
}

TEST_F(WindowTest, ClickOnTheWorkpieceTellsWhoCutItAndJumpsThere) {
  open();
  click(640, 420);
  const auto pick = next<PickCommand>();
  ASSERT_TRUE(pick);
  EXPECT_NEAR(pick->point_mm.z, 0.0, 0.5);
  settle();
  const Picture asked = window_->read();
  PickedPoint picked;
  picked.point_mm = pick->point_mm;
  picked.tool = 3;
  picked.tool_name = "ball 10";
  picked.line = 33;
  SceneUpdate update;
  update.picked = std::make_shared<const PickedPoint>(std::move(picked));
  mailbox_.publish(std::move(update));
  ASSERT_TRUE(turn_until_changed(asked, kInfo));
  commands_.take();
  std::optional<SeekLineCommand> seek;
  for (int y = 250; y < 450 && !seek; y += 9) {
    click(1100, y);
    settle();
    for (const ViewerCommand& command : commands_.take()) {
      if (const auto* found = std::get_if<SeekLineCommand>(&command)) seek = *found;
    }
  }
  ASSERT_TRUE(seek);
  EXPECT_EQ(seek->line, 33);
}

TEST_F(WindowTest, MeasuresBetweenTwoClicks) {
  open();
  commands_.take();
  key("m");
  settle();
  ASSERT_EQ(count_pixels(window_->read(), kScene, kMeasured), 0);
  click(600, 420);
  settle();
  click(760, 360);
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), kScene, kMeasured) > 100; }));
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<PickCommand>(command));
  }
  key("m");
  EXPECT_TRUE(turn_until([&] { return count_pixels(window_->read(), kScene, kMeasured) == 0; }));
}

/// Half: what lies before the axis; a quarter: the upper part of that.
TEST_F(WindowTest, OfAPartThatTurnsTheSectionIsHalfThenAQuarter) {
  open();
  SceneSetup setup;
  setup.title = "shaft.ngc";
  setup.bounds_mm = {Vec3(-20, -20, -60), Vec3(20, 20, 0)};
  setup.turns = true;
  setup.standing = Standing::kInLathe;
  SceneUpdate update;
  update.setup = std::make_shared<const SceneSetup>(setup);
  mailbox_.publish(std::move(update));
  settle();
  const DrawOptions& drawing = window_->settings().drawing;
  EXPECT_FALSE(drawing.section);
  key("z");
  settle();
  EXPECT_EQ(drawing.section, (SectionPlane{Vec3(0, 1, 0), 0.0}));
  EXPECT_FALSE(drawing.section_beside);
  key("z");
  settle();
  EXPECT_EQ(drawing.section, (SectionPlane{Vec3(0, 1, 0), 0.0}));
  EXPECT_EQ(drawing.section_beside, (SectionPlane{Vec3(1, 0, 0), 0.0}));
  key("z");
  settle();
  EXPECT_FALSE(drawing.section);
  EXPECT_FALSE(drawing.section_beside);
}

TEST_F(WindowTest, ASectionThatIsAskedForIsThereAtOnce) {
  WindowOptions options;
  options.section = SectionKind::kQuarter;
  open(options);
  EXPECT_TRUE(window_->settings().drawing.section);
  EXPECT_TRUE(window_->settings().drawing.section_beside);
}

TEST_F(WindowTest, SectionHidesHalfOfTheWorkpiece) {
  open();
  const Picture before = window_->read_scene();
  key("z");
  settle();
  ASSERT_TRUE(window_->settings().drawing.section);
  EXPECT_EQ(window_->settings().drawing.section->normal, Vec3(0, -1, 0));
  EXPECT_EQ(window_->settings().drawing.section->offset_mm, -90.0);
  EXPECT_NE(before.rgb, window_->read_scene().rgb);
  key("z");
  settle();
  EXPECT_EQ(before.rgb, window_->read_scene().rgb);
}

TEST_F(WindowTest, ColoursAreAskedForInTurn) {
  open();
  // Deviations are for those who have a design: see the next test.
  for (const ColorBy mode : {ColorBy::kHeight, ColorBy::kTool, ColorBy::kRemovalRate,
                             ColorBy::kLineRange, ColorBy::kPlain}) {
    key("v");
    const auto asked = next<ColorCommand>();
    ASSERT_TRUE(asked);
    EXPECT_EQ(asked->mode, mode);
    EXPECT_EQ(asked->last_line, 500);
    settle();
    EXPECT_EQ(window_->settings().drawing.color_by, mode);
  }
}

TEST_F(WindowTest, DeviationsAreForThoseWhoHaveADesign) {
  open();
  const auto show = [this](const std::string& title, std::optional<double> tolerance_mm) {
    SceneSetup setup;
    setup.title = title;
    setup.bounds_mm = {Vec3(0, 0, -20), Vec3(200, 180, 0)};
    setup.tolerance_mm = tolerance_mm;
    SceneUpdate update;
    update.setup = std::make_shared<const SceneSetup>(setup);
    mailbox_.publish(std::move(update));
    settle();
  };
  show("with a design", 0.1);
  EXPECT_EQ(window_->settings().drawing.color_by, ColorBy::kDeviation);
  show("without", std::nullopt);
  EXPECT_EQ(window_->settings().drawing.color_by, ColorBy::kPlain);
}

TEST_F(WindowTest, TheNextProgramIsInSpaceAgain) {
  open();
  key("o");
  settle();
  ASSERT_EQ(window_->settings().flat, FlatView::kXy);
  for (const bool keeps_eye : {true, false}) {
    SceneSetup setup;
    setup.title = keeps_eye ? "the same, changed" : "another";
    setup.keeps_eye = keeps_eye;
    SceneUpdate update;
    update.setup = std::make_shared<const SceneSetup>(setup);
    mailbox_.publish(std::move(update));
    settle();
    EXPECT_EQ(window_->settings().flat, keeps_eye ? FlatView::kXy : FlatView::kNone);
  }
}

TEST_F(WindowTest, KeysHideFeedsAndTraversesAndAllButTheLastMoves) {
  open();
  const Picture all = window_->read_scene();
  for (const char* name : {"k", "j", "u"}) {
    key(name);
    settle();
    EXPECT_NE(all.rgb, window_->read_scene().rgb) << name;
    key(name);
    settle();
    EXPECT_EQ(all.rgb, window_->read_scene().rgb) << name;
  }
}

TEST_F(WindowTest, FlatViewMovesButDoesNotTurn) {
  open();
  key("o");
  settle();
  click(640, 380);
  const auto before = next<PickCommand>();
  ASSERT_TRUE(before);
  drag({640, 380}, {690, 350});
  click(690, 350);
  const auto after = next<PickCommand>();
  ASSERT_TRUE(after);
  EXPECT_NEAR(before->point_mm.x, after->point_mm.x, 0.5);
  EXPECT_NEAR(before->point_mm.y, after->point_mm.y, 0.5);
  const Picture picture = window_->read_scene();
  key("1");  // looking from the front is for a space
  settle();
  EXPECT_EQ(window_->settings().flat, FlatView::kXy);
  key("o");
  settle();
  EXPECT_EQ(window_->settings().flat, FlatView::kZx);
  EXPECT_NE(picture.rgb, window_->read_scene().rgb);
}

TEST_F(WindowTest, HowNearTheToolIsStandsInThePanel) {
  open();
  Moment moment = test_moment();
  publish(moment);
  settle();
  const Picture without = window_->read();
  moment.clearance = SceneClearance{3.214, false, "holder", "vise"};
  publish(moment);
  settle();
  const Picture near = window_->read();
  EXPECT_GT(mean_difference(without, near, kInfo), 0.0);
  EXPECT_EQ(mean_difference(without, near, kScene), 0.0);
  const PixelBox values{980, 0, 1280, 260};
  EXPECT_EQ(count_pixels(near, values, kErrorText), 0);
  moment.clearance = SceneClearance{0, false, "holder", "vise"};
  publish(moment);
  settle();
  EXPECT_GT(count_pixels(window_->read(), values, kErrorText), 20) << "they touch";
  moment.clearance = SceneClearance{20, true, "", ""};
  publish(moment);
  settle();
  EXPECT_EQ(count_pixels(window_->read(), values, kErrorText), 0);
  EXPECT_GT(mean_difference(near, window_->read(), kInfo), 0.0);
}

TEST_F(WindowTest, FixturesAreHiddenByAKey) {
  open();
  const auto is_shown = [this] {
    return window_->settings()
        .drawing.looks[static_cast<std::size_t>(SceneObject::kFixtures)]
        .is_visible;
  };
  EXPECT_TRUE(is_shown());
  key("e");
  settle();
  EXPECT_FALSE(is_shown());
  key("e");
  settle();
  EXPECT_TRUE(is_shown());
}

TEST_F(WindowTest, AgeOfALostSourceGrowsOnTheScreen) {
  open();
  Moment moment = test_moment();
  moment.state = PlayState::kFollowing;
  moment.source = SourceFreshness::kLost;
  moment.source_name = "modbus";
  moment.source_age_s = 1.0;
  const Picture before = window_->read();
  publish(moment);
  ASSERT_TRUE(turn_until([&] {
    return count_pixels(window_->read(), {980, 0, 1280, 260}, kErrorText) > 20;
  }));
  const Picture lost = window_->read();
  EXPECT_TRUE(turn_until_changed(lost, kInfo));  // no news came
}

TEST_F(WindowTest, PlayerKeysAreToldThatTheMachineLeads) {
  open();
  Moment moment = test_moment();
  moment.state = PlayState::kFollowing;
  publish(moment);
  settle();
  commands_.take();
  constexpr PixelBox kStatus{0, 745, kWidth, kHeight};
  ASSERT_EQ(count_pixels(window_->read(), kStatus, kWarningText), 0);
  key("space");
  settle();
  EXPECT_GT(count_pixels(window_->read(), kStatus, kWarningText), 50);
  for (const ViewerCommand& command : commands_.take()) {
    EXPECT_FALSE(std::holds_alternative<PlayCommand>(command));
  }
  publish(test_moment());  // it leads no longer
  settle();
  EXPECT_EQ(count_pixels(window_->read(), kStatus, kWarningText), 0);
}

/// What stands in the status line is the same sentence in every language.
TEST_F(WindowTest, TheMachineNoLongerLeadsInAnotherLanguage) {
  setenv("TEXTDOMAINDIR", KERF_LOCALES, 1);
  open();
  Moment moment = test_moment();
  moment.state = PlayState::kFollowing;
  publish(moment);
  settle();
  key("space");
  settle();
  constexpr PixelBox kStatus{0, 745, kWidth, kHeight};
  const Picture english = window_->read();
  ASSERT_GT(count_pixels(english, kStatus, kWarningText), 50);
  ASSERT_TRUE(use_language("de"));
  publish(moment);
  settle();
  EXPECT_GT(mean_difference(english, window_->read(), kStatus), 0.1);  // it is said in German
  publish(test_moment());
  settle();
  EXPECT_EQ(count_pixels(window_->read(), kStatus, kWarningText), 0);
  use_language("en");
}

/// The picture has four times the pixels, and so has what its lines cover.
TEST_F(WindowTest, LinesGrowWithTheDisplay) {
  std::array<int, 2> line_px{};
  for (const int scale : {1, 2}) {
    WindowOptions options;
    options.scale = static_cast<float>(scale);
    options.width_px = 640 * scale;
    options.height_px = 400 * scale;
    open(options);
    Moment moment = test_moment();
    moment.past_vertices = 100'000;
    publish(moment);
    settle();
    const Picture picture = window_->read();
    // Traverses, with their rims; nothing else is red in the middle.
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
      const int x = static_cast<int>(i / 3) % picture.width_px;
      const int y = static_cast<int>(i / 3) / picture.width_px;
      if (std::abs(2 * x - picture.width_px) > picture.width_px / 2) continue;
      if (std::abs(2 * y - picture.height_px) > picture.height_px / 2) continue;
      const int others = std::max(picture.rgb[i + 1], picture.rgb[i + 2]);
      if (picture.rgb[i] > others + 50) ++line_px[static_cast<std::size_t>(scale - 1)];
    }
    window_.reset();
  }
  ASSERT_GT(line_px[0], 20);
  EXPECT_GT(line_px[1], 3 * line_px[0]);
}

/// At scale 2 the buttons beside both panels need several rows: the last one opens the help.
TEST_F(WindowTest, AllButtonsAreAtHandOnAFineDisplay) {
  WindowOptions options;
  options.scale = 2.0f;
  options.width_px = 1600;
  options.height_px = 1000;
  open(options);
  const Picture before = window_->read();
  click(731, 196);  // the last, in the fourth row
  settle();
  EXPECT_GT(mean_difference(before, window_->read(), {580, 240, 1000, 830}), 10.0);
}

TEST_F(WindowTest, TheDisplaySaysHowFineItIs) {
  Result<VirtualDisplay> display = VirtualDisplay::start();
  ASSERT_TRUE(display) << display.error();
  ASSERT_TRUE(display->set_resources("Xft.dpi:\t192\n"));
  WindowOptions options;
  options.width_px = 700;
  options.height_px = 450;
  open(options);
  const Picture picture = window_->read();
  EXPECT_EQ(picture.width_px, 1400);
  EXPECT_EQ(picture.height_px, 900);
  // The letters of the toolbar reach below where they would at scale 1.
  options.scale = 1.0f;
  window_.reset();
  open(options);
  EXPECT_GT(mean_difference(picture, window_->read(), {0, 36, 290, 72}), 1.0);
  window_.reset();  // before its display
}

/// As after a larger screen, or where a fine one has doubled it.
TEST_F(WindowTest, IsNotLargerThanTheScreen) {
  WindowOptions options;
  options.width_px = 3000;
  options.height_px = 2000;
  open(options);
  EXPECT_TRUE(turn_until([&] {
    const Picture picture = window_->read();
    return picture.width_px == 1600 && picture.height_px == 1000;
  }));
}

TEST_F(WindowTest, EverythingIsLargerOnAFineDisplay) {
  WindowOptions options;
  options.scale = 2.0f;
  options.width_px = 1600;
  options.height_px = 1000;
  open(options);
  const Picture picture = window_->read();
  ASSERT_EQ(picture.width_px, 1600);
  // The program panel is twice as wide, and a line in it twice as high.
  click(400, 500);
  const auto first = next<SeekLineCommand>();
  ASSERT_TRUE(first);
  settle();
  click(400, 500 + 34);
  const auto second = next<SeekLineCommand>();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->line, first->line + 1);
}

TEST_F(WindowTest, ChangedNumbersDoNotRedrawThePicture) {
  open();
  const DrawCounters before = window_->counters();
  Moment moment = test_moment();
  moment.time_s = 64.0;
  moment.axes[0].work = 81.0;
  const Picture picture = window_->read();
  publish(moment);
  ASSERT_TRUE(turn_until_changed(picture, kInfo));
  EXPECT_EQ(window_->counters().full.frames, before.full.frames);
}

}  // namespace
}  // namespace kerf
