// The tool's way in the workpiece: closed forms, and the bound of the subdivision against dense
// sampling over random machines and motions.
#include "twin/machine/kinematics/tool_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr double kExact = 1e-9;
constexpr double kRadians = kPi / 180;

MachineKinematics machine_of(const std::string& kinematics, const std::string& letters,
                             const KinematicsGeometry& geometry = {},
                             const RotaryPlacement& placement = {}) {
  auto machine = known_machine(kinematics, letters, geometry, placement);
  EXPECT_TRUE(machine) << machine.error();
  return std::move(machine.value());
}

ToolPath path_of(MachineKinematics machine, const WorkpieceFrame& frame = {},
                 const ToolPathTolerance& tolerance = {}) {
  auto path = ToolPath::create(std::move(machine), frame, tolerance);
  EXPECT_TRUE(path) << path.error();
  return std::move(path.value());
}

Motion feed(const Vec3& from, const Vec3& to, const std::array<double, 3>& from_abc = {},
            const std::array<double, 3>& to_abc = {}) {
  Motion m;
  m.kind = MotionKind::kFeed;
  m.from_mm = from;
  m.to_mm = to;
  m.from_abc_deg = from_abc;
  m.to_abc_deg = to_abc;
  return m;
}

std::vector<CutMove> moves_of(const ToolPath& path, const Motion& m, double reach_mm = 30) {
  std::vector<CutMove> out;
  path.moves_of(m, reach_mm, 7, out);
  return out;
}

/// Turns `a` towards `b` by the fraction u of the angle between them.
Vec3 turned_towards(const Vec3& a, const Vec3& b, double u) {
  const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  if (angle < 1e-12) return a;
  return (std::sin((1 - u) * angle) * a + std::sin(u * angle) * b) / std::sin(angle);
}

TEST(ToolPath, ATableThatTurnsUnderAStandingToolMakesAnArc) {
  // The tip 20 mm above the axis of A: as seen from the part it goes right-handed about X.
  const ToolPath path = path_of(machine_of("trivkins", "XYZA"));
  const Motion m = feed({5, 0, 20}, {5, 0, 20}, {0, 0, 0}, {90, 0, 0});
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const Pose pose = path.pose_at(m, t);
    const double a = 90 * t * kRadians;
    EXPECT_LT(glm::distance(pose.origin_mm, Vec3(5, -20 * std::sin(a), 20 * std::cos(a))), kExact);
    EXPECT_LT(glm::distance(path.spindle_at(m, t), Vec3(0, -std::sin(a), std::cos(a))), kExact);
  }
  const std::vector<CutMove> moves = moves_of(path, m, 0.0);
  // Chords of a circle of 20 mm within 0.01 mm: 0.0632 rad each, so 25 of them are needed.
  EXPECT_GE(moves.size(), 25u);
  EXPECT_LE(moves.size(), 28u);
}

TEST(ToolPath, AWrappedHelixStaysOnItsCylinder) {
  const ToolPath path = path_of(machine_of("trivkins coordinates=xyza", ""));
  const Motion m = feed({0, 0, 15}, {40, 0, 15}, {0, 0, 0}, {720, 0, 0});
  const std::vector<CutMove> moves = moves_of(path, m);
  double length = 0;
  for (const CutMove& move : moves) {
    for (const Vec3& tip : {move.from_mm, move.to_mm}) {
      EXPECT_NEAR(std::hypot(tip.y, tip.z), 15, kExact);
      const double a = tip.x / 40 * 720 * kRadians;
      EXPECT_LT(glm::distance(tip, Vec3(tip.x, -15 * std::sin(a), 15 * std::cos(a))), 1e-8);
    }
    length += glm::distance(move.from_mm, move.to_mm);
  }
  const double helix = std::hypot(40.0, 15 * 4 * kPi);
  EXPECT_NEAR(length, helix, 2e-4 * helix);
}

TEST(ToolPath, WhereTheTipIsFollowedItGoesStraight) {
  const ToolPath path =
      path_of(machine_of("xyzac-trt-kins", "", {{"y-offset", 20}, {"z-offset", 10}}));
  const Motion m = feed({10, 0, 5}, {-10, 8, 7}, {0, 0, 0}, {30, 0, 0});
  const std::vector<CutMove> moves = moves_of(path, m);
  ASSERT_EQ(moves.size(), 1u);  // straight tip, and A alone goes along a great circle
  EXPECT_EQ(moves[0].from_mm, m.from_mm);
  EXPECT_EQ(moves[0].to_mm, m.to_mm);
  EXPECT_EQ(moves[0].axis_from, Vec3(0, 0, 1));
  // The table turns right-handed, the tool as seen from it left-handed.
  EXPECT_LT(glm::distance(moves[0].axis_to, Vec3(0, 0.5, std::cos(30 * kRadians))), kExact);
}

TEST(ToolPath, AConeIsNoGreatCircle) {
  // Table tilted by 30 degrees, C by 90: the spindle goes round a cone about the part's Z.
  const ToolPath path = path_of(machine_of("xyzac-trt-kins", ""));
  const Motion m = feed({0, 0, 0}, {0, 0, 0}, {30, 0, 0}, {30, 0, 90});
  const std::vector<CutMove> moves = moves_of(path, m, 40);
  EXPECT_GT(moves.size(), 5u);
  for (const CutMove& move : moves) EXPECT_NEAR(move.axis_to.z, std::cos(30 * kRadians), kExact);
}

TEST(ToolPath, WhereNothingTurnsTheMoveIsTheMotionsOwn) {
  WorkpieceFrame frame;
  frame.g5x_mm = {0.1, 0.2, 0.3};
  frame.rotation_deg = 12.3;
  for (const char* kinematics : {"trivkins", "xyzac-trt-kins", "5axiskins", "maxkins", "corexykins",
                                 "millturn", "scarakins", "xyzab_tdr_kins"}) {
    const ToolPath path = path_of(machine_of(kinematics, "XYZABC"), frame);
    Motion m = feed({0.1, 0.7, -3.3}, {12.3, -4.5, 1.1});
    m.tool_offset_mm = {0, 0, 51.3};
    ASSERT_TRUE(path.is_upright(m)) << kinematics;
    const std::vector<CutMove> moves = moves_of(path, m);
    ASSERT_EQ(moves.size(), 1u) << kinematics;
    EXPECT_EQ(moves[0].from_mm, m.from_mm) << kinematics;
    EXPECT_EQ(moves[0].to_mm, m.to_mm) << kinematics;
    EXPECT_TRUE(moves[0].is_vertical()) << kinematics;
    EXPECT_EQ(moves[0].id, 7u);
  }
}

TEST(ToolPath, AStandingTiltMovesArcsRigidly) {
  const ToolPath path =
      path_of(machine_of("trivkins", "XYZA", {}, {RotarySide::kTable, {0, 3, 4}}));
  Motion m = feed({10, 0, 20}, {-10, 0, 20}, {90, 0, 0}, {90, 0, 0});
  m.kind = MotionKind::kArc;
  m.arc = {{0, 0, 20}, {0, 0, 1}, kPi};
  const std::vector<CutMove> moves = moves_of(path, m);
  ASSERT_EQ(moves.size(), 1u);
  ASSERT_TRUE(moves[0].arc);
  // (y, z) about (3, 4) by 90 degrees: (3 - (z - 4), 4 + (y - 3)).
  EXPECT_LT(glm::distance(moves[0].from_mm, Vec3(10, -13, 1)), kExact);
  EXPECT_LT(glm::distance(moves[0].arc->center_mm, Vec3(0, -13, 1)), kExact);
  EXPECT_LT(glm::distance(moves[0].arc->axis, Vec3(0, -1, 0)), kExact);
  EXPECT_EQ(moves[0].arc->sweep_rad, kPi);
  EXPECT_LT(glm::distance(moves[0].axis_from, Vec3(0, -1, 0)), kExact);
}

TEST(ToolPath, TheProgramsZeroLiesInTheBlankWhateverTheOffsets) {
  WorkpieceFrame frame;
  frame.g5x_mm = {100, -50, 20};
  frame.offset_abc_deg = {35, 0, 0};
  frame.rotation_deg = 30;
  const ToolPath path =
      path_of(machine_of("trivkins", "XYZA", {}, {RotarySide::kTable, {0, 12, -30}}), frame);
  const Motion m = feed({1, 2, 3}, {4, 5, 6});
  EXPECT_LT(glm::distance(path.pose_at(m, 0).origin_mm, m.from_mm), kExact);
  // Machine coordinates: X Y Z by the offset, A by its own.
  const AxisValues axes = path.axes_at(m, 1);
  EXPECT_NEAR(axes[0], 100 + 4 * std::cos(kPi / 6) - 5 * std::sin(kPi / 6), kExact);
  EXPECT_NEAR(axes[3], 35, kExact);
  // And a turn by 90 degrees is one about the table's axis, as it lies in the part.
  const Motion turned = feed({1, 2, 3}, {1, 2, 3}, {0, 0, 0}, {90, 0, 0});
  const Vec3 tip = path.pose_at(turned, 1).origin_mm;
  EXPECT_GT(glm::distance(tip, turned.to_mm), 1.0);
  const auto at = path.machine_at(turned, 1);
  ASSERT_TRUE(at);
  const Pose link = path.machine().chain.workpiece_from_tool(*at);
  EXPECT_LT(glm::distance(path.link_from_workpiece().point(tip), link.origin_mm), kExact);
}

TEST(ToolPath, ATiltedHeadCarriesTheToolsLength) {
  const ToolPath path = path_of(machine_of("trivkins", "XYZB", {}, {RotarySide::kHead, Vec3(0)}));
  Motion m = feed({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 90, 0});
  m.tool_offset_mm = {0, 0, 50};
  // The nose stands 50 mm above the program's zero; B90 points it along X, the tip to -X.
  const Pose pose = path.pose_at(m, 1);
  EXPECT_LT(glm::distance(pose.origin_mm, Vec3(-50, 0, 50)), kExact);
  EXPECT_LT(glm::distance(path.spindle_at(m, 1), Vec3(1, 0, 0)), kExact);
}

TEST(ToolPath, AToolThatTheModuleIsNotToldOfLagsBehind) {
  MachineKinematics machine = machine_of("5axiskins", "", {{"pivot-length", 200}});
  machine.told_tool_mm = 0;
  const ToolPath path = path_of(std::move(machine));
  Motion m = feed({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 90, 0});
  m.tool_offset_mm = {0, 0, 50};
  // The module holds the nose at Z50 still; B90 C0 of 5axiskins points the tool to +X.
  EXPECT_LT(glm::distance(path.pose_at(m, 1).origin_mm, Vec3(50, 0, 50)), kExact);
}

TEST(ToolPath, AQuillCarriesTheToolAlongZ) {
  WorkpieceFrame frame;
  frame.offset_uvw_mm = {0, 0, 40};
  const ToolPath path = path_of(machine_of("trivkins", "XYZW"), frame);
  Motion m = feed({1, 2, 3}, {5, 2, 3});
  EXPECT_TRUE(path.is_upright(m)) << "its zero is that of the work offset";
  m.to_uvw_mm.z = -10;
  EXPECT_FALSE(path.is_upright(m));
  EXPECT_TRUE(path.stays_upright(m));
  std::vector<CutMove> moves = moves_of(path, m);
  ASSERT_EQ(moves.size(), 1u) << "straight is straight";
  EXPECT_EQ(moves[0].from_mm, Vec3(1, 2, 3));
  EXPECT_EQ(moves[0].to_mm, Vec3(5, 2, -7));
  EXPECT_TRUE(moves[0].is_vertical());
  EXPECT_EQ(path.axes_at(m, 1)[8], 30);
  EXPECT_EQ(path.machine_at(m, 1)->joints[3], 30);
  // An arc on which the quill goes is a helix, in chords; one beside which it stands is an arc.
  m.kind = MotionKind::kArc;
  m.to_mm = {-1, 2, 3};
  m.arc = {{0, 2, 3}, {0, 0, 1}, kPi};
  moves = moves_of(path, m);
  EXPECT_GT(moves.size(), 5u);
  EXPECT_EQ(moves.back().to_mm, Vec3(-1, 2, -7));
  for (const CutMove& move : moves) {
    EXPECT_NEAR(std::hypot(move.to_mm.x, move.to_mm.y - 2), 1, kExact);
    EXPECT_TRUE(move.is_vertical());
  }
  m.from_uvw_mm.z = -10;
  moves = moves_of(path, m);
  ASSERT_EQ(moves.size(), 1u);
  ASSERT_TRUE(moves[0].arc);
  EXPECT_EQ(moves[0].arc->center_mm, Vec3(0, 2, -7));
}

TEST(ToolPath, WDrillsAlongATiltedTool) {
  // 5axiskins: B90 C0 points the tool to +X. W has no slide: X Y Z go, and the tip with them.
  const ToolPath path = path_of(machine_of("5axiskins", "", {{"pivot-length", 200}}));
  Motion m = feed({0, 0, 0}, {0, 0, 0}, {0, 90, 0}, {0, 90, 0});
  m.to_uvw_mm = {0, 0, -10};
  std::vector<CutMove> moves = moves_of(path, m);
  ASSERT_EQ(moves.size(), 1u);
  EXPECT_LT(glm::distance(moves[0].to_mm, Vec3(10, 0, 0)), kExact);
  EXPECT_LT(glm::distance(moves[0].axis_to, Vec3(-1, 0, 0)), kExact);
  // Under identity kinematics W is a number that moves nothing.
  m.torch.analog[3] = 1;
  EXPECT_EQ(path.pose_at(m, 0).origin_mm, path.pose_at(m, 1).origin_mm);
}

/// Links of the user's own: a slide that is there, under kinematics that follow the tip.
TEST(ToolPath, ARealSlideLeavesAFollowedTipWhereItIs) {
  MachineKinematics machine = machine_of("5axiskins", "", {{"pivot-length", 200}});
  machine.uvw_by_xyz = false;
  const ToolPath path = path_of(std::move(machine));
  Motion m = feed({1, 2, 3}, {1, 2, 3}, {0, 40, 0}, {0, 40, 0});
  m.to_uvw_mm = {0, 0, -10};
  EXPECT_LT(glm::distance(path.pose_at(m, 1).origin_mm, Vec3(1, 2, 3)), kExact);
  EXPECT_NE(path.machine_at(m, 0)->axes[2], path.machine_at(m, 1)->axes[2]);
}

TEST(ToolPath, SwitchedKinematicsAreInForceMotionByMotion) {
  const ToolPath path = path_of(machine_of("xyzac-trt-kins sparm=identityfirst", ""));
  Motion m = feed({10, 0, 0}, {10, 0, 0}, {0, 0, 0}, {0, 0, 90});
  m.torch.analog[3] = 0;  // identity: the table turns under the tool
  EXPECT_LT(glm::distance(path.pose_at(m, 1).origin_mm, Vec3(0, -10, 0)), kExact);
  m.torch.analog[3] = 1;
  EXPECT_EQ(path.pose_at(m, 1).origin_mm, Vec3(10, 0, 0));
  // Switched while the table stands turned: the machine stays, the numbers change.
  Motion before = feed({0, 0, 0}, {10, 0, 0}, {0, 0, 90}, {0, 0, 90});
  Motion next = feed({10, 0, 0}, {0, 0, 0}, {0, 0, 90}, {0, 0, 90});
  next.torch.analog[3] = 1;
  path.take_up(before, next);
  EXPECT_LT(glm::distance(next.from_mm, Vec3(0, -10, 0)), kExact);
  EXPECT_LT(glm::distance(path.pose_at(next, 0).origin_mm, path.pose_at(before, 1).origin_mm),
            kExact);
}

TEST(ToolPath, MotionsJoinBitForBit) {
  const ToolPath path =
      path_of(machine_of("trivkins", "XYZAC", {}, {RotarySide::kTable, {1, 2, 3}}));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(-50, 50);
  std::vector<CutMove> moves;
  Motion m = feed({0, 0, 0}, {1, 2, 3}, {1, 0, 2}, {3, 0, 4});
  for (int i = 0; i < 50; ++i) {
    path.moves_of(m, 20, 0, moves);
    m.from_mm = m.to_mm;
    m.from_abc_deg = m.to_abc_deg;
    m.to_mm = {draw(random), draw(random), draw(random)};
    m.to_abc_deg = {draw(random), 0, draw(random)};
  }
  for (std::size_t i = 1; i < moves.size(); ++i) {
    ASSERT_EQ(moves[i].from_mm, moves[i - 1].to_mm) << i;
    ASSERT_EQ(moves[i].axis_from, moves[i - 1].axis_to) << i;
  }
}

TEST(ToolPath, ChainsWithSlidesThatAreNotSquareAreRefused) {
  MachineKinematics machine = machine_of("trivkins", "XYZ");
  auto chain =
      KinematicChain::create({{"t", "", JointKind::kFixed, 0, false, {0, 0, 1}, Vec3(0)},
                              {"x", "", JointKind::kPrismatic, 0, false, {1, 0, 0}, Vec3(0)},
                              {"y", "x", JointKind::kPrismatic, 1, false, {0.1, 1, 0}, Vec3(0)},
                              {"z", "y", JointKind::kPrismatic, 2, false, {0, 0, 1}, Vec3(0)}},
                             "t", "z");
  ASSERT_TRUE(chain);
  machine.chain = chain.value();
  const auto path = ToolPath::create(machine, {}, {});
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error(),
            "the machine's X, Y and Z are not at right angles (right-handed): the program's frame "
            "has no place on it");
}

// ---- the bound

struct RandomCase {
  MachineKinematics machine;
  WorkpieceFrame frame;
  Motion motion;
};

RandomCase random_case(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  const std::array<const char*, 10> kinematics{"trivkins coordinates=xyzabc",
                                               "trivkins coordinates=xyza",
                                               "xyzac-trt-kins",
                                               "xyzbc-trt-kins sparm=identityfirst",
                                               "5axiskins",
                                               "maxkins",
                                               "xyzab_tdr_kins",
                                               "pumakins",
                                               "rotatekins",
                                               "trivkins coordinates=xyzacw"};
  const KinematicsGeometry geometry{{"x-rot-point", 20 * draw(random)},
                                    {"z-rot-point", 20 * draw(random)},
                                    {"y-offset", 20 * draw(random)},
                                    {"x-offset", 20 * draw(random)},
                                    {"pivot-length", 150.0}};
  RandomCase out;
  const auto side = random() % 2 == 0 ? RotarySide::kTable : RotarySide::kHead;
  const char* const name = kinematics[random() % kinematics.size()];
  const Vec3 rotary{9 * draw(random), 30 * draw(random), 40 * draw(random)};
  out.machine = machine_of(name, "XYZ", geometry, {side, rotary});
  if (random() % 3 == 0) out.machine.told_tool_mm = 0;
  out.frame.g5x_mm = {100 * draw(random), 100 * draw(random), 50 * draw(random)};
  out.frame.rotation_deg = random() % 2 == 0 ? 0 : 40 * draw(random);
  out.frame.offset_abc_deg = {20 * draw(random), 0, 30 * draw(random)};
  out.frame.offset_uvw_mm = {5 * draw(random), 9 * draw(random), 20 * draw(random)};
  const double turn = std::pow(10.0, 1.2 * draw(random) + 1);  // 0.6 to 160 degrees
  Motion& m = out.motion;
  m = feed({60 * draw(random), 60 * draw(random), 30 * draw(random)}, Vec3(0));
  m.to_mm = m.from_mm + Vec3{30 * draw(random), 30 * draw(random), 10 * draw(random)};
  for (std::size_t i = 0; i < 3; ++i) {
    m.from_abc_deg[i] = 90 * draw(random);
    m.to_abc_deg[i] = m.from_abc_deg[i] + (random() % 2 == 0 ? turn * draw(random) : 0);
  }
  if (random() % 2 == 0) {
    m.from_uvw_mm = {9 * draw(random), 9 * draw(random), 20 * draw(random)};
    m.to_uvw_mm = {9 * draw(random), 9 * draw(random), 20 * draw(random)};
  }
  if (random() % 4 == 0) {  // an arc, of which the end follows from centre and sweep
    m.kind = MotionKind::kArc;
    m.arc.center_mm = m.from_mm + Vec3{20 * draw(random), 20 * draw(random), 0};
    m.arc.sweep_rad = 6 * draw(random);
    const Pose turned = shift(m.arc.center_mm) * kerf::turn({0, 0, 1}, m.arc.sweep_rad / kRadians) *
                        shift(-m.arc.center_mm);
    m.to_mm = turned.point(m.from_mm) + Vec3(0, 0, 5 * draw(random));
  }
  m.tool_offset_mm = {0, 0, 40 + 30 * draw(random)};
  m.torch.analog[3] = static_cast<float>(random() % 2);
  return out;
}

/// 2777.7 turns on 40 mm: each place of the true path has one at the same angle within turn_mm.
TEST(ToolPath, TurnsInPlentyAreLeftOut) {
  ToolPathTolerance tolerance{0.01, 0.01};
  const Motion m = feed({20, 3, -1}, {-20, 3, -1}, {0, 20, 0}, {0, 999999, 0});
  tolerance.turn_mm = 0.1;
  const ToolPath path = path_of(machine_of("trivkins", "XYZB"), {}, tolerance);
  std::vector<CutMove> moves;
  std::vector<double> ends;
  path.moves_of(m, 24, 0, moves, &ends);
  EXPECT_LT(moves.size(), 45000u);
  EXPECT_GT(moves.size(), 10000u);
  EXPECT_EQ(ends.back(), 1.0);
  const double turns = (999999.0 - 20) / 360;
  // Parts of the motion that moves go along, but for those that go across.
  std::vector<std::pair<double, double>> kept;
  double t = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (i > 0) {
      ASSERT_EQ(moves[i].from_mm, moves[i - 1].to_mm);
      ASSERT_EQ(moves[i].axis_from, moves[i - 1].axis_to);
    }
    ASSERT_GT(ends[i], t);
    EXPECT_LT(glm::distance(moves[i].to_mm, path.pose_at(m, ends[i]).origin_mm), 1e-6);
    const bool across = (ends[i] - t) * turns > 0.9;
    if (across) {
      EXPECT_LE(glm::distance(moves[i].from_mm, moves[i].to_mm), 2 * tolerance.turn_mm);
    } else {
      if (kept.empty() || kept.back().second != t)
        kept.emplace_back(t, ends[i]);
      else
        kept.back().second = ends[i];
    }
    t = ends[i];
  }
  EXPECT_NEAR(kept.front().second * turns, 1, 1e-6);
  EXPECT_GE((1 - kept.back().first) * turns, 1);
  double worst = 0;
  for (int k = 0; k <= 20000; ++k) {
    const double at = k / 20000.0;
    const Vec3 place = path.pose_at(m, at).origin_mm;
    double nearest = 1e9;
    for (const auto& [begin, end] : kept) {
      // At the same angle: whole turns away.
      const double whole = std::ceil((begin - at) * turns - 1e-9);
      const double same = at + whole / turns;
      if (same > end + 1e-9) continue;
      nearest = std::min(nearest, glm::distance(place, path.pose_at(m, same).origin_mm));
    }
    worst = std::max(worst, nearest);
  }
  EXPECT_LE(worst, tolerance.turn_mm + 1e-9);
  EXPECT_GT(worst, tolerance.turn_mm / 4);
}

/// Two axes turn: what the slower one does between two turns of the faster counts.
TEST(ToolPath, TurnsThatLieApartAreKept) {
  ToolPathTolerance tolerance{0.01, 0.01};
  tolerance.turn_mm = 0.1;
  for (const auto& to : {std::array<double, 3>{0, 36000, 36000}, {0, 36000, 3600}}) {
    const Motion m = feed({20, 3, -1}, {20, 3, -1.5}, {}, to);
    const auto few = moves_of(path_of(machine_of("trivkins", "XYZBC"), {}, tolerance), m);
    const auto all = moves_of(path_of(machine_of("trivkins", "XYZBC")), m);
    EXPECT_EQ(few.size(), all.size());
  }
}

/// Greatest distances between the moves and the true path at equal times.
TEST(ToolPath, NoPieceLeavesItsTolerance) {
  std::mt19937 random(20);
  const ToolPathTolerance tolerance{0.01, 0.02};
  const double reach_mm = 35;
  double worst_tip = 0;
  double worst_top = 0;
  std::size_t pieces = 0;
  for (int round = 0; round < 150; ++round) {
    const RandomCase one = random_case(random);
    const ToolPath path = path_of(one.machine, one.frame, tolerance);
    std::vector<CutMove> moves;
    std::vector<double> ends;
    path.moves_of(one.motion, reach_mm, 0, moves, &ends);
    ASSERT_EQ(moves.size(), ends.size());
    ASSERT_EQ(ends.back(), 1.0);
    pieces += moves.size();
    if (moves[0].arc) continue;
    double t = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const CutMove& move = moves[i];
      const double end = ends[i];
      for (int k = 1; k < 16; ++k) {
        const double u = k / 16.0;
        const Pose pose = path.pose_at(one.motion, t + u * (end - t));
        const Vec3 tip = move.from_mm + u * (move.to_mm - move.from_mm);
        const Vec3 axis = turned_towards(move.axis_from, move.axis_to, u);
        const Vec3 true_axis = pose.direction(one.machine.nose_from_tip);
        worst_tip = std::max(worst_tip, glm::distance(tip, pose.origin_mm));
        worst_top = std::max(
            worst_top, glm::distance(tip + reach_mm * axis, pose.origin_mm + reach_mm * true_axis));
      }
      t = end;
    }
  }
  EXPECT_LE(worst_tip, tolerance.tip_mm);
  EXPECT_LE(worst_top, tolerance.top_mm);
  // And the bound is not idle.
  EXPECT_GT(worst_tip, 0.5 * tolerance.tip_mm);
  EXPECT_GT(worst_top, 0.5 * tolerance.top_mm);
  RecordProperty("pieces", static_cast<int>(pieces));
}

}  // namespace
}  // namespace kerf
