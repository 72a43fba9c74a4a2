// Machines that turn the tool or the workpiece, watched: the workpiece is that of the dry run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/twin/live/rotary_shop.h"
#include "twin/machine/kinematics/switched_motions.h"

namespace kerf {
namespace {

using Positions = RotaryShop::Positions;

/// Pieces of curved ways are off by 0.01 mm on either side (ToolPathTolerance::of_cell): what is
/// removed by that times the surface that was cut, some 600 mm2. A corner of the mesh follows from
/// the faces around it, and may be off by more where they hardly lean.
constexpr double kDeviation_mm = 0.1;
constexpr double kVolume_mm3 = 0.01 * 600;

struct Case {
  const char* name;
  std::shared_ptr<const MachineKinematics> machine;
  WorkpieceFrame frame;
  std::vector<Motion> program;
};

/// Tilted and turning moves, a turn on the spot, and an arc on which the machine turns.
std::vector<Motion> carving(std::array<double, 3> tilt, std::array<double, 3> far, double tool_mm) {
  TurningProgram program(tool_mm);
  program.at({-25, 0, 10}).rapid({-14, -8, 6}, {}).feed({-10, -8, -2}, tilt);
  program.feed({10, -6, -3}, far).feed({10, -6, -3}, tilt).feed({8, 8, -2}, {});
  program.arc({-8, 8, -2}, tilt, {{0, 8, -2}, {0, 0, 1}, kPi});
  program.feed({-8, 8, 8}, tilt).rapid({-8, 8, 12}, {});
  return program.list();
}

/// What a fourth axis under X Y Z is for: round the workpiece, with X along it.
std::vector<Motion> wrapping() {
  TurningProgram program(40);
  program.at({-25, 0, 20}).rapid({-10, 0, 20}, {}).feed({-10, 0, 8}, {});
  program.feed({-10, 0, 8}, {180, 0, 0})
      .feed({10, 3, 9}, {200, 0, 0})
      .rapid({10, 3, 25}, {200, 0, 0});
  return program.list();
}

std::vector<Case> cases() {
  WorkpieceFrame work;
  work.g5x_mm = {12, -7, 30};
  WorkpieceFrame turned = work;
  turned.rotation_deg = 25;
  turned.offset_abc_deg = {3, -2, 5};
  const KinematicsGeometry trt{{"x-rot-point", 10},
                               {"y-rot-point", -5},
                               {"z-rot-point", 20},
                               {"y-offset", 4},
                               {"z-offset", 12}};
  return {
      {"trivkins XYZA", turning_machine("trivkins", "XYZA", {}, {RotarySide::kTable, {0, -7, 15}}),
       work, wrapping()},
      {"trivkins, head", turning_machine("trivkins", "XYZBC", {}, {RotarySide::kHead, {0, 0, 0}}),
       work, carving({0, 20, 0}, {0, 20, 60}, 50)},
      {"xyzac-trt", turning_machine("xyzac-trt-kins", "", trt), turned,
       carving({-25, 0, 10}, {-25, 0, 100}, 50)},
      {"5axiskins", turning_machine("5axiskins", "", {{"pivot-length", 150}}), work,
       carving({0, 25, 0}, {0, 10, 120}, 50)},
  };
}

TEST(RotaryLive, TheWorkpieceIsThatOfTheDryRun) {
  const std::vector<Case> all = cases();
  for (const Case& one : all) {
    const RotaryShop shop(
        one.machine, one.frame,
        one.program.size() > 6 ? "box:-15,-15,-20:15,15,0" : "cylinder:-15,0,0:30:24:x");
    const auto wanted = shop.dry_run(one.program);
    const double removed_mm3 = wanted->blank_mm3() - wanted->remaining_mm3();
    ASSERT_GT(removed_mm3, 100) << one.name;
    for (const Positions positions : {Positions::kJoints, Positions::kAxes}) {
      for (const bool followed : {false, true}) {
        // By axes the way is another one only as far as the frame.
        if (positions == Positions::kAxes && (followed || &one != &all.back())) continue;
        // A thousand samples a second of one machine are enough.
        // (Between two samples a corner is cut: half a step.)
        const double rate_hz = &one == &all[2] ? 1000 : 400;
        const RotaryShop::Watched seen = shop.watch(one.program, rate_hz, positions, followed);
        const std::string what =
            fmt::format("{} by {}{}", one.name, positions == Positions::kJoints ? "joints" : "axes",
                        followed ? ", followed" : "");
        EXPECT_NEAR(seen.stock->remaining_mm3(), wanted->remaining_mm3(), kVolume_mm3) << what;
        EXPECT_LT(surface_deviation_mm(*seen.stock, *wanted), kDeviation_mm) << what;
        EXPECT_EQ(seen.facts.off_path, 0U) << what;
        EXPECT_EQ(seen.facts.gaps, 0U) << what;
        if (followed) {
          EXPECT_GT(seen.facts.on_path, seen.facts.samples * 9 / 10) << what;
        }
      }
    }
  }
}

/// Ten samples a second say as much as a thousand where a controller turns evenly: between two of
/// them the machine is taken to go as its kinematics do.
TEST(RotaryLive, AChordTurnsAsTheControllerDoes) {
  TurningProgram program(50);
  program.at({-25, 0, 10}).rapid({-26, -9, -2}, {-20, 0, 0}).feed({26, 9, -4}, {-20, 0, 90});
  const auto machine = turning_machine("xyzac-trt-kins", "", {{"y-offset", 4}, {"z-offset", 12}});
  const RotaryShop shop(machine, {});
  const auto wanted = shop.dry_run(program.list());
  const RotaryShop::Watched seen =
      shop.watch(program.list(), 10, RotaryShop::Positions::kJoints, false);
  EXPECT_LT(surface_deviation_mm(*seen.stock, *wanted), kDeviation_mm);
}

std::vector<FindingId> ids(const FindingLog& log) {
  std::vector<FindingId> out;
  for (const Finding& f : log.kept()) out.push_back(f.id);
  return out;
}

/// Kinematics that are switched while the table is turned: the machine stands, its numbers change.
TEST(RotaryLive, SwitchedKinematicsAreThoseOfTheProgram) {
  const auto machine =
      turning_machine("xyzac-trt-kins sparm=identityfirst", "", {{"z-offset", 12}});
  TurningProgram raw;
  raw.at({-25, 0, 10}).rapid({-10, 0, 6}, {}).feed({-10, 0, -2}, {}).feed({-10, 0, -2}, {0, 0, 40});
  raw.switched(1, {-10, 0, -2}).feed({-10, 0, -2}, {}).feed({-10, 6, -2}, {});
  raw.feed({-10, 6, -2}, {-20, 0, 20}).feed({-10, 6, 8}, {-20, 0, 20});
  SwitchedMotions switched(machine);
  const auto span = switched.follow(raw.list(), {});
  const std::vector<Motion> program(span.begin(), span.end());
  const RotaryShop shop(machine, {});
  const auto wanted = shop.dry_run(program);
  for (const bool followed : {false, true}) {
    const RotaryShop::Watched seen =
        shop.watch(program, 1000, RotaryShop::Positions::kJoints, followed);
    EXPECT_LT(surface_deviation_mm(*seen.stock, *wanted), kDeviation_mm) << followed;
    EXPECT_EQ(seen.facts.off_path, 0U);
    EXPECT_EQ(seen.facts.gaps, 0U);
    // Where the tool really is.
    const auto path = ToolPath::create(*machine, {}, {});
    const Pose end = path->pose_at(program.back(), 1);
    EXPECT_LT(glm::length(seen.place.tip_mm - end.origin_mm), 1e-6);
    EXPECT_LT(glm::length(seen.place.spindle - path->spindle_at(program.back(), 1)), 1e-9);
  }
}

TEST(RotaryLive, ThePoleIsToldOfOnceThePassedMotionIsWhole) {
  TurningProgram program(50);
  program.at({-25, 0, 10})
      .rapid({-14, 0, 2}, {})
      .feed({-12, 0, -2}, {})
      .feed({12, 0, -2}, {0, 0, 90});
  program.feed({12, 0, 6}, {0, 0, 90});
  const RotaryShop shop(turning_machine("xyzac-trt-kins"), {});
  const auto seen = shop.watch(program.list(), 1000, RotaryShop::Positions::kJoints, true, true);
  const std::vector<FindingId> found = ids(seen.log);
  EXPECT_EQ(std::count(found.begin(), found.end(), FindingId::kSingularPose), 1);
}

/// What a program has not turned stands where the machine has it, and is no reason to be off the
/// path.
TEST(RotaryLive, AnAxisThatTheProgramDoesNotNameStandsWhereItStands) {
  TurningProgram flat;
  flat.at({-25, 0, 10}).rapid({-14, 0, 6}, {}).feed({-10, 0, -2}, {}).feed({10, 0, -2}, {});
  TurningProgram tilted;
  const std::array<double, 3> a20{20, 0, 0};
  tilted.at({-25, 0, 10}, a20).rapid({-14, 0, 6}, a20).feed({-10, 0, -2}, a20);
  tilted.feed({10, 0, -2}, a20);
  const RotaryShop shop(turning_machine("xyzac-trt-kins"), {});
  const auto wanted = shop.dry_run(tilted.list());
  const auto seen =
      shop.watch(tilted.list(), 1000, RotaryShop::Positions::kJoints, true, false, &flat.list());
  EXPECT_EQ(seen.facts.off_path, 0U);
  EXPECT_LT(surface_deviation_mm(*seen.stock, *wanted), kDeviation_mm);
}

TEST(RotaryLive, AnAxisWhosePositionsDoNotComeIsToldOnce) {
  TurningProgram program;
  program.at({-25, 0, 10}).rapid({-14, 0, 6}, {}).feed({-10, 0, -2}, {}).feed({10, 0, -2}, {});
  const RotaryShop shop(turning_machine("trivkins", "XYZA"), {});
  const auto seen = shop.watch(program.list(), 100, RotaryShop::Positions::kSlides, false);
  ASSERT_EQ(ids(seen.log), std::vector<FindingId>{FindingId::kRotaryIgnored});
  EXPECT_NE(seen.log.kept().front().text.find("the machine turns about A"), std::string::npos);
}

}  // namespace
}  // namespace kerf
