#include "twin/scene/player_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <thread>

#include "tests/twin/playback/tracks.h"
#include "tests/twin/scene/machine_with_arm.h"

namespace kerf {
namespace {

/// A window without a screen: takes what the view publishes, says what a user would.
class PlayerViewTest : public testing::Test {
 protected:
  void open(const MotionList& program, std::vector<std::string> files = {"/nc/part.ngc"},
            const CollisionWishes& collisions = {},
            std::shared_ptr<const MachineModel> machine = nullptr) {
    PlayerProgram played;
    played.track = test::track_of(program.list());
    played.blank = test::block_40(0.2);
    played.tools = test::two_tools();
    played.checks.collisions = collisions;
    ViewedProgram shown;
    shown.collisions = collisions;
    shown.machine = std::move(machine);
    shown.title = "part.ngc";
    shown.files = std::move(files);
    shown.work_offset = "G54";
    shown.tools = {{1, "ball 6"}, {2, "bull 4 1"}};
    shown.cuts = std::make_shared<const CutQuery>(played.track, test::two_tools());
    view_ = std::make_unique<PlayerView>(std::move(played), PlayerOptions{}, std::move(shown),
                                         mailbox_, commands_);
    thread_ = std::thread([this] { view_->run(stop_.get_token()); });
  }

  void TearDown() override {
    if (!thread_.joinable()) return;
    commands_.push(CloseCommand{});
    thread_.join();
  }

  /// Takes news until `wanted` holds of what is known by then.
  template <class Wanted>
  bool until(Wanted wanted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
      if (auto update = mailbox_.take()) {
        for (const auto& patch : update->patches) patches_[patch->tile] = patch;
        merge(&known_, std::move(*update));
      }
      if (wanted()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  bool at_line(int line) {
    return until([&] {
      return known_.moment && known_.moment->line == line &&
             known_.moment->state == PlayState::kPaused;
    });
  }

  SceneMailbox mailbox_;
  CommandQueue commands_;
  std::stop_source stop_;
  SceneUpdate known_;
  std::map<std::uint32_t, std::shared_ptr<const MeshPatch>> patches_;
  std::unique_ptr<PlayerView> view_;
  std::thread thread_;
};

MotionList two_slots() {
  MotionList program;
  program.at({-5, 10, 5}).tool(1).spindle(true);  // line 1
  program.feed({-5, 10, -2}).feed({45, 10, -2});  // 2, 3
  program.traverse({45, 10, 5}).tool(2);          // 4, 5
  program.traverse({45, 30, 5});                  // 6
  program.feed({45, 30, -2}).feed({-5, 30, -2});  // 7, 8
  return program;
}

TEST_F(PlayerViewTest, ShowsTheBlankThePathAndTheText) {
  open(two_slots());
  ASSERT_TRUE(until([&] {
    return known_.setup && known_.moment && known_.program && known_.timeline &&
           patches_.size() == view_->player().state()->stock->tile_count() && !known_.path.empty();
  }));
  EXPECT_EQ(known_.setup->title, "part.ngc");
  EXPECT_EQ(known_.setup->bounds_mm.max.x, 40);
  ASSERT_EQ(known_.timeline->tools.size(), 2u);
  EXPECT_EQ(known_.timeline->tools[1].name, "bull 4 1");
  EXPECT_GT(known_.timeline->tools[1].time_s, known_.timeline->tools[0].time_s);
}

TEST_F(PlayerViewTest, ShowsWhatTheProgramDoesWhen) {
  open(two_slots());
  ASSERT_TRUE(until([&] { return known_.timeline != nullptr; }));
  EXPECT_TRUE(known_.timeline->has_curves);
  ASSERT_TRUE(until([&] {
    return known_.curves && known_.curves->known_until_s >= known_.timeline->duration_s - 1e-9;
  }));
  double removed_mm3 = 0;
  for (const float rate : known_.curves->mm3_per_s)
    removed_mm3 += static_cast<double>(rate) * known_.curves->step_s;
  commands_.push(SeekEndCommand{});
  ASSERT_TRUE(until([&] { return known_.moment && known_.moment->state == PlayState::kEnded; }));
  EXPECT_TRUE(until([&] { return std::abs(known_.moment->removed_mm3 / removed_mm3 - 1) < 1e-3; }));
}

TEST_F(PlayerViewTest, GoesToALineAndShowsWhatIsCutThere) {
  open(two_slots());
  commands_.push(SeekLineCommand{"/nc/part.ngc", 8});
  ASSERT_TRUE(at_line(8));
  EXPECT_EQ(known_.moment->tool, 2);
  EXPECT_EQ(known_.moment->tool_name, "bull 4 1");
  ASSERT_TRUE(known_.moment->tool_pose);
  EXPECT_EQ(known_.moment->tool_pose->tip_mm, Vec3(45, 30, -2));
  EXPECT_EQ(known_.moment->spindle_rpm, 10000);
  ASSERT_EQ(known_.moment->axes.size(), 3u);
  EXPECT_EQ(*known_.moment->axes[0].to_go, -50);
  EXPECT_TRUE(until([&] { return known_.moment->removed_mm3 > 100; })) << "the first slot";
  ASSERT_TRUE(until([&] { return static_cast<bool>(known_.tool_shape); }));
  EXPECT_NEAR(known_.tool_shape->cutter.back().radius_mm, 2, 1e-5);
}

TEST_F(PlayerViewTest, AFixtureOnALinkGoesWithIt) {
  const FixtureSpec post[] = {parse_fixture("post=box:0,0,0:1,1,1:at=100,0,0:on=frame").value()};
  Diagnostics diagnostics;
  CollisionWishes collisions;
  collisions.fixtures = load_fixtures(post, diagnostics);
  open(two_slots(), {"/nc/part.ngc"}, collisions, test::drawn_with_arm({0, 0, 0}));
  // The table takes the workpiece away under the tool: the frame goes by the other way.
  commands_.push(SeekLineCommand{"/nc/part.ngc", 3});
  ASSERT_TRUE(at_line(3));
  ASSERT_EQ(known_.moment->tool_pose->tip_mm.x, -5);
  ASSERT_EQ(known_.moment->fixture_poses.size(), 1u);
  EXPECT_NEAR(known_.moment->fixture_poses[0][3].x, 95, 1e-4);
  commands_.push(SeekLineCommand{"/nc/part.ngc", 8});
  ASSERT_TRUE(at_line(8));
  ASSERT_EQ(known_.moment->tool_pose->tip_mm.x, 45);
  EXPECT_NEAR(known_.moment->fixture_poses[0][3].x, 145, 1e-4);
}

TEST_F(PlayerViewTest, AChosenCollisionIsJumpedToAndItsBodiesAreMarked) {
  // The ball of 6 mm meets the post in the first slot, with its tip at X38.
  const FixtureSpec post[] = {parse_fixture("post=box:41,0,-10:50,20,10:in-blank").value()};
  Diagnostics diagnostics;
  CollisionWishes collisions;
  collisions.fixtures = load_fixtures(post, diagnostics);
  open(two_slots(), {"/nc/part.ngc"}, collisions);
  ASSERT_TRUE(until([&] { return known_.findings && !known_.findings->findings.empty(); }));
  ASSERT_TRUE(known_.fixtures);
  ASSERT_EQ(known_.fixtures->links.size(), 1u);
  EXPECT_EQ(known_.fixtures->links[0].name, "post");
  commands_.push(SeekLineCommand{"/nc/part.ngc", 3});
  ASSERT_TRUE(at_line(3));
  EXPECT_EQ(known_.moment->fixture_poses.size(), 1u);
  EXPECT_TRUE(known_.moment->contacts.empty());
  ASSERT_TRUE(known_.moment->clearance);
  EXPECT_TRUE(known_.moment->clearance->is_beyond) << "46 mm to go";
  const auto& findings = known_.findings->findings;
  std::size_t contact = 0;
  while (contact < findings.size() && findings[contact].line != 3) ++contact;
  ASSERT_LT(contact, findings.size());
  commands_.push(SeekFindingCommand{static_cast<int>(contact)});
  ASSERT_TRUE(until([&] { return !known_.moment->contacts.empty(); }));
  EXPECT_EQ(known_.moment->contacts[0].piece, ToolPiece::kCutter);
  EXPECT_EQ(known_.moment->contacts[0].fixture, std::size_t{0});
  EXPECT_NEAR(known_.moment->tool_pose->tip_mm.x, 38, 0.05);
  EXPECT_LT(known_.moment->clearance->mm, 0.01);
  EXPECT_EQ(known_.moment->clearance->fixture, "post");
}

TEST_F(PlayerViewTest, StepsAndTools) {
  open(two_slots());
  commands_.push(NextToolCommand{1});
  ASSERT_TRUE(at_line(5));
  commands_.push(StepBlockCommand{1});
  ASSERT_TRUE(at_line(6));
  commands_.push(StepBlockCommand{-2});
  ASSERT_TRUE(at_line(4));
  commands_.push(StopCommand{});
  ASSERT_TRUE(at_line(1));
}

TEST_F(PlayerViewTest, StopsAtABreakpointAndSaysSo) {
  open(two_slots());
  commands_.push(BreakpointCommand{"/nc/part.ngc", 7, true});
  commands_.push(SpeedCommand{1000});
  commands_.push(PlayCommand{});
  ASSERT_TRUE(at_line(7));
  EXPECT_EQ(known_.moment->breakpoints, (std::vector<CodeLine>{{0, 7}}));
  EXPECT_EQ(known_.moment->speed, 1000);
  EXPECT_FALSE(known_.moment->notice.empty());
  commands_.push(BreakpointCommand{"/nc/part.ngc", 7, false});
  commands_.push(PlayCommand{});
  ASSERT_TRUE(until([&] { return known_.moment->state == PlayState::kEnded; }));
  EXPECT_TRUE(known_.moment->breakpoints.empty());
}

TEST_F(PlayerViewTest, StopsInASubroutineEachTimeItIsCalled) {
  // Two calls from the main program of a file with the lines 2 and 3.
  MotionList program;
  program.at({-5, 10, 5}).tool(1).spindle(true);
  for (const double y : {10.0, 30.0}) {
    program.traverse({-5, y, 5});
    program.feed({-5, y, -2}).last().source = {1, 2};
    program.feed({45, y, -2}).last().source = {1, 3};
    program.traverse({45, y, 5});
  }
  open(program, {"/nc/part.ngc", "/nc/slot.ngc"});
  commands_.push(BreakpointCommand{"/nc/slot.ngc", 3, true});
  commands_.push(SpeedCommand{1000});
  for (const double y : {10.0, 30.0}) {
    commands_.push(PlayCommand{});
    ASSERT_TRUE(at_line(3) && until([&] {
                  const auto& pose = known_.moment->tool_pose;
                  return pose && pose->tip_mm == Vec3(-5, y, -2);
                }))
        << y;
    EXPECT_EQ(known_.moment->file, 1);
    EXPECT_EQ(known_.moment->breakpoints, (std::vector<CodeLine>{{1, 3}}));
  }
  commands_.push(PlayCommand{});
  ASSERT_TRUE(until([&] { return known_.moment->state == PlayState::kEnded; }));
}

TEST_F(PlayerViewTest, RunsToALine) {
  open(two_slots());
  commands_.push(RunToLineCommand{"", 7});
  ASSERT_TRUE(at_line(7));
}

TEST_F(PlayerViewTest, KnowsWhoCutAPoint) {
  open(two_slots());
  commands_.push(SeekEndCommand{});
  ASSERT_TRUE(until([&] { return known_.moment && known_.moment->state == PlayState::kEnded; }));
  commands_.push(PickCommand{Vec3(20, 10, -2)});
  ASSERT_TRUE(until([&] { return static_cast<bool>(known_.picked); }));
  EXPECT_EQ(known_.picked->line, 3);
  EXPECT_EQ(known_.picked->tool, 1);
  EXPECT_EQ(known_.picked->tool_name, "ball 6");
  known_.picked.reset();
  commands_.push(PickCommand{Vec3(20, 20, 0)});
  ASSERT_TRUE(until([&] { return static_cast<bool>(known_.picked); }));
  EXPECT_EQ(known_.picked->line, 0);
  EXPECT_FALSE(known_.picked->tool);
}

TEST_F(PlayerViewTest, AnUnknownFileOrLineChangesNothing) {
  open(two_slots());
  commands_.push(SeekLineCommand{"/nc/other.ngc", 3});
  commands_.push(SeekLineCommand{"", -1});
  commands_.push(StepBlockCommand{1});
  ASSERT_TRUE(at_line(2));
}

TEST_F(PlayerViewTest, EndsWhenItIsStopped) {
  open(two_slots());
  stop_.request_stop();
  thread_.join();
}

TEST(SceneMailbox, IsFullUntilItsNewsAreTaken) {
  SceneMailbox mailbox;
  EXPECT_FALSE(mailbox.is_full());
  mailbox.publish(SceneUpdate{});
  mailbox.publish(SceneUpdate{});
  EXPECT_TRUE(mailbox.is_full());
  EXPECT_TRUE(mailbox.take());
  EXPECT_FALSE(mailbox.is_full());
  EXPECT_FALSE(mailbox.take());
}

TEST_F(PlayerViewTest, ModesGetTheirValuesAndTheMeshComesBack) {
  MotionList program;
  program.at({5, 5, 5}).tool(1).spindle(true);
  program.feed({5, 5, -2}).feed({35, 5, -2}).feed({35, 35, -2});
  open(program);
  ASSERT_TRUE(until([&] { return !patches_.empty(); }));
  commands_.push(DrawModeCommand{DrawMode::kRaycast});
  ASSERT_TRUE(until([&] { return known_.draw_mode && known_.heights; }));
  EXPECT_TRUE(known_.draw_mode->is_drawn());
  patches_.clear();
  commands_.push(SeekEndCommand{});
  ASSERT_TRUE(until([&] { return known_.heights->height(100, 25) < -1.9f; }));
  EXPECT_TRUE(patches_.empty()) << "nobody would draw them";
  commands_.push(DrawModeCommand{DrawMode::kMesh});
  ASSERT_TRUE(until([&] { return !patches_.empty(); }));
}

}  // namespace
}  // namespace kerf
