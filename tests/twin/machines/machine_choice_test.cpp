#include "twin/machines/machine_choice.h"

#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

MachineFacts facts(const char* letters, double travel_mm = 400) {
  MachineFacts out;
  out.joint_letters = letters;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.limits.axes[axis].present = true;
    out.limits.axes[axis].min = -travel_mm / 2;
    out.limits.axes[axis].max = travel_mm / 2;
  }
  return out;
}

TEST(MachineChoice, TheUsualMachineOfAxesAndTravels) {
  EXPECT_EQ(usual_machine_kind(facts("XYZ")), MachineKind::kKneeMill);
  EXPECT_EQ(usual_machine_kind(facts("XYZA")), MachineKind::kKneeMill);
  EXPECT_EQ(usual_machine_kind(facts("XYZ", 600)), MachineKind::kKneeMill);
  EXPECT_EQ(usual_machine_kind(facts("XYZ", 601)), MachineKind::kGantry);
  EXPECT_EQ(usual_machine_kind(facts("XYYZ")), MachineKind::kGantry);
  EXPECT_EQ(usual_machine_kind(facts("XZ")), MachineKind::kLathe);
  EXPECT_EQ(usual_machine_kind(facts("XZC")), MachineKind::kLathe);
  EXPECT_EQ(usual_machine_kind(facts("XYZBC")), MachineKind::kTrunnion);
  EXPECT_EQ(usual_machine_kind(facts("XY")), MachineKind::kNone);
  MachineFacts other = facts("XYZAC");
  other.kinematics = "xyzac-trt-kins";
  EXPECT_EQ(usual_machine_kind(other), MachineKind::kTrunnion);
  other.kinematics = "5axiskins";
  EXPECT_EQ(usual_machine_kind(other), MachineKind::kBridgeMill);
  other.kinematics = "maxkins";
  EXPECT_EQ(usual_machine_kind(other), MachineKind::kSwivelMill);
  other.kinematics = "genhexkins";
  EXPECT_EQ(usual_machine_kind(other), MachineKind::kNone);
  MachineFacts plasma = facts("XYYZ");
  plasma.is_plasma = true;
  EXPECT_EQ(usual_machine_kind(plasma), MachineKind::kPlasma);
  // Limits that are not known are no long travel.
  MachineFacts open = facts("XYZ");
  open.limits.axes[0] = AxisLimits{};
  open.limits.axes[0].present = true;
  EXPECT_EQ(usual_machine_kind(open), MachineKind::kKneeMill);
}

TEST(MachineChoice, FactsComeFromTheIni) {
  const TemporaryFolder folder;
  const std::string path = folder / "plasma.ini";
  std::ofstream(path) << "[DISPLAY]\nDISPLAY = qtvcp qtplasmac_4x3\n"
                         "[KINS]\nKINEMATICS = trivkins coordinates=XYYZ\n"
                         "[AXIS_X]\nMIN_LIMIT = 0\nMAX_LIMIT = 1250\n";
  MachineSetup setup;
  Diagnostics diagnostics;
  ASSERT_TRUE(read_machine_setup(path, setup, diagnostics));
  const MachineFacts found = machine_facts(setup);
  EXPECT_TRUE(found.is_plasma);
  EXPECT_EQ(found.joint_letters, "XYYZ");
  EXPECT_EQ(usual_machine_kind(found), MachineKind::kPlasma);
}

TEST(MachineChoice, TheWorkOffsetIsWhereTheProgramLies) {
  WorkpieceFrame frame;
  frame.g5x_mm = {100, 200, -50};
  frame.g92_mm = {1, 0, 0};
  frame.rotation_deg = 90;
  const Pose pose = machine_from_workpiece(frame);
  // As LinuxCNC adds them up: G92, then the turn, then G54.
  EXPECT_LT(glm::length(pose.point({10, 0, 5}) - Vec3(100, 211, -45)), 1e-12);
}

TEST(MachineChoice, RoomsTakeTheLimitsThatAreKnown) {
  MachineSetup setup;
  setup.joint_letters = "XYZBC";
  AxisLimits& x = setup.timeline.limits.axes[0];
  x.present = true;
  x.min = -10;
  x.max = 300;
  const MachineRoom room = machine_room(&setup, {}, {{0, 0, 0}, {1, 1, 1}}, {}, 80);
  ASSERT_TRUE(room.travel[0]);
  EXPECT_EQ(room.travel[0]->max, 300);
  EXPECT_FALSE(room.travel[1]);
  EXPECT_TRUE(room.trunnion.tilts_about_y);
  EXPECT_FALSE(room.head_pivot_mm);
  setup.timeline.kinematics = std::make_shared<const MachineKinematics>(
      known_machine("5axiskins", "", {{"pivot-length", 150}}, {}).value());
  EXPECT_EQ(machine_room(&setup, {}, {{0, 0, 0}, {1, 1, 1}}, {}, 80).head_pivot_mm, 150);
}

TEST(MachineChoice, LinksWinAndNoneIsNone) {
  Diagnostics diagnostics;
  MachineChoice choice;
  const std::optional<MachineModel> usual = make_machine(choice, facts("XZ"), {}, diagnostics);
  ASSERT_TRUE(usual);
  EXPECT_EQ(usual->name, "lathe");
  choice.kind = MachineKind::kPunch;
  EXPECT_EQ(make_machine(choice, facts("XZ"), {}, diagnostics)->name, "punch press");
  choice.kind = MachineKind::kNone;
  EXPECT_FALSE(make_machine(choice, facts("XZ"), {}, diagnostics));
  EXPECT_TRUE(diagnostics.empty());
  LinkedMachine& links = choice.links.emplace();
  links.links.emplace_back().chain.name = "floor";
  links.workpiece_on = links.tool_on = "floor";
  EXPECT_EQ(make_machine(choice, facts("XZ"), {}, diagnostics)->name, "machine");
}

}  // namespace
}  // namespace kerf
