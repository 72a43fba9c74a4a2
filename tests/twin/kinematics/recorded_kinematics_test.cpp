// The chains against what LinuxCNC's own modules said, recorded by record_kinematics.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/twin/kinematics/recorded_places.h"

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
