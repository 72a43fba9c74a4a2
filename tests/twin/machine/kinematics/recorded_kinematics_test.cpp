// The chains against what LinuxCNC's own modules said, recorded by record_kinematics.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/twin/machine/kinematics/recorded_places.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

/// The places are written with 9 decimals.
constexpr double kTolerance = 1e-6;

class RecordedKinematics : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedKinematics, IsThatOfLinuxCnc) {
  const RecordedMachine recorded =
      read_recorded(std::string(RECORDED_FOLDER) + "/" + GetParam() + ".csv");
  ASSERT_GE(recorded.places.size(), 20u);
  const auto machine = known_machine(recorded.kinematics, "", recorded.geometry, {});
  ASSERT_TRUE(machine) << machine.error();
  const KinematicsErrors errors = errors_of(recorded, *machine);
  EXPECT_LT(errors.axes, kTolerance);
  EXPECT_LT(errors.joints, kTolerance);
}

/// 5axiskins and maxkins have no slides for U, V, W: the head is rigid, and the tip is where the
/// joints of X Y Z A B C put it, with a tool as long as that of W's tool offset (0 here).
TEST(RecordedHeads, UvwMoveTheToolAlongItsOwnAxes) {
  for (const char* name : {"5axiskins", "maxkins"}) {
    const RecordedMachine recorded =
        read_recorded(std::string(RECORDED_FOLDER) + "/" + name + ".csv");
    const MachineKinematics machine =
        known_machine(recorded.kinematics, "", recorded.geometry, {}).value();
    ASSERT_TRUE(machine.uvw_by_xyz);
    for (const WorkpieceFrame& frame : {WorkpieceFrame{}, WorkpieceFrame{.g5x_mm = {20, -30, 40},
                                                          .rotation_deg = 35,
                                                          .offset_abc_deg = {0, 5, -12},
                                                          .offset_uvw_mm = {3, -4, 25}}}) {
      const auto path = ToolPath::create(machine, frame, {});
      ASSERT_TRUE(path);
      const Pose work = machine_from_workpiece(frame);
      std::size_t with_slides = 0;
      for (const RecordedPlace& place : recorded.places) {
        if (place.type != 0) continue;
        const Vec3 uvw{place.axes[6], place.axes[7], place.axes[8]};
        if (uvw != Vec3(0)) ++with_slides;
        Motion m;
        m.torch.analog[machine.switch_output] = 0;
        m.to_mm = work.inverse().point({place.axes[0], place.axes[1], place.axes[2]});
        m.to_uvw_mm = uvw - frame.offset_uvw_mm;
        for (std::size_t i = 0; i < 3; ++i) {
          m.to_abc_deg[i] = place.axes[3 + i] - frame.offset_abc_deg[i];
        }
        m.start_known = false;
        // The head as it stands, without slides that nothing drives.
        MachinePosition stands;
        stands.joints = place.joints;
        for (std::size_t i = machine.joint_letters.size(); i-- > 0;) {
          const auto axis = std::string("XYZABCUVW").find(machine.joint_letters[i]);
          if (axis < 6) stands.axes[axis] = place.joints[i];
        }
        const Pose rigid =
            path->link_from_workpiece().inverse() * machine.chain.workpiece_from_tool(stands);
        const Pose tool = path->pose_at(m, 1);
        EXPECT_LT(glm::length(tool.origin_mm - rigid.origin_mm), kTolerance) << name;
        EXPECT_LT(glm::length(path->spindle_at(m, 1) - rigid.direction({0, 0, 1})), kTolerance);
      }
      EXPECT_GE(with_slides, 19u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Modules, RecordedKinematics,
                         ::testing::Values("trivkins_a", "trivkins_xyyz", "corexykins",
                                           "rotatekins", "maxkins", "xyzac-trt-kins",
                                           "xyzbc-trt-kins", "xyzab_tdr_kins", "5axiskins",
                                           "millturn", "scarakins", "pumakins", "genserkins"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace kerf
