#include "twin/scene/punch_pose.h"

#include <gtest/gtest.h>

#include "stock/sheet/punch_hits.h"
#include "stock/sheet/punch_shape.h"
#include "tests/twin/process/motions.h"
#include "twin/machines/builtin_models.h"

namespace kerf {
namespace {

constexpr double kThrough_mm = -3;

/// Stations 2, 5, 7 and 9; clamps that move by 40 mm at M120.
TurretPointer turret(const char* trigger) {
  auto out = std::make_shared<Turret>();
  for (const int number : {2, 5, 7, 9}) {
    Cutter punch =
        std::move(*punch_cutter("punch:square:10", *parse_punch_shape("square:10", 0.01)));
    out->stations.emplace(
        number, TurretStation{number, "", "square:10", std::move(punch), 0, number == 7, 0});
  }
  out->trigger = std::move(*PunchTrigger::parse(trigger));
  out->regrips.push_back({.user_code = 120, .line = 0, .shift_mm = {40, -3}});
  return out;
}

/// 0 tool, 1 traverse, 2 M3, 3 M5, 4 traverse, 5 M120, 6 traverse, 7 M101.
std::shared_ptr<const ProgramTrack> track() {
  MotionList program;
  program.at({0, 0, 5}).tool(7).turned({0, 0, 30});
  program.traverse({50, 20, 5}).spindle(true).signal().spindle(false).signal();
  program.traverse({80, 20, 5}).signal(120).traverse({90, 20, 5}).signal(101);
  ProgramTrackBuilder builder;
  Timeline timeline(TimelineOptions{}, builder);
  for (const Motion& m : program.list()) timeline.push(m);
  timeline.finish();
  return builder.build({"part.ngc"}, {});
}

PlayerState state_at(const ProgramTrack& track, std::size_t motion) {
  PlayerState state;
  state.place = track.place_before(motion);
  state.motion = track.motion(std::min(motion, track.size() - 1));
  state.tip_mm = motion == 0 ? Vec3(0, 0, 5) : track.to_mm(motion - 1);
  return state;
}

TEST(PunchPose, TheRamIsDownWhileTheTriggerHolds) {
  const auto path = track();
  const PunchPose pose(turret("m3"), *path, kThrough_mm);
  for (std::size_t i = 0; i <= path->size(); ++i) {
    const PlayerState state = state_at(*path, i);
    EXPECT_EQ(pose.is_down(*path, state.place), i == 3) << i;
    EXPECT_EQ(pose.tip_mm(*path, state).z, i == 3 ? kThrough_mm : 5) << i;
    EXPECT_EQ(pose.joints(*path, state)[kStroke], i == 3 ? kThrough_mm - 5 : 0) << i;
  }
  const PunchPose by_code(turret("m101"), *path, kThrough_mm);
  for (std::size_t i = 0; i <= path->size(); ++i) {
    EXPECT_EQ(by_code.is_down(*path, path->place_before(i)), i == 8) << i;
  }
}

TEST(PunchPose, TurretAndClampsAreWhereTheProgramHasThem) {
  const auto path = track();
  const PunchPose pose(turret("m3"), *path, kThrough_mm);
  EXPECT_EQ(pose.joints(*path, state_at(*path, 4))[kTurret], 180) << "the third of four";
  EXPECT_EQ(pose.joints(*path, state_at(*path, 5))[kGripX], 0);
  EXPECT_EQ(pose.joints(*path, state_at(*path, 6))[kGripX], 40);
  EXPECT_EQ(pose.joints(*path, state_at(*path, 8))[kGripY], -3);
}

TEST(PunchPose, ThePunchThatWorksIsUnderTheRam) {
  const auto path = track();
  MachineRoom room;
  room.blank_mm = {{0, 0, -2}, {200, 100, 0}};
  room.turret = turret("m3");
  const MachineModel model = builtin_machine(MachineKind::kPunch, room);
  const PunchPose pose(room.turret, *path, kThrough_mm);
  std::vector<glm::mat4> poses(model.links.size(), glm::mat4(1.0f));
  pose.place_punch(model, *path, state_at(*path, 3), poses);
  const glm::vec4 corner =
      poses[*model.chain.find(punch_link(7))] * glm::vec4(10, 0, 0, 1);  // turned by C30
  EXPECT_NEAR(corner.x, 50 + 10 * std::cos(kPi / 6), 1e-4);
  EXPECT_NEAR(corner.y, 20 + 5, 1e-4);
  EXPECT_NEAR(corner.z, kThrough_mm, 1e-6);
  EXPECT_EQ(poses[*model.chain.find(punch_link(5))], glm::mat4(1.0f));
}

}  // namespace
}  // namespace kerf
