#include "interp_bridge/parameter_file.h"

#include <gtest/gtest.h>

#include "tests/base/temporary_folder.h"

namespace kerf {
namespace {

class ParameterFiles : public ::testing::Test {
 protected:
  std::string messages(const std::string& text) {
    diagnostics_.clear();
    path_ = folder_ / "mill.var";
    write_file(path_, text);
    file_ = read_parameter_file(path_, diagnostics_).value();
    std::string out;
    for (const Diagnostic& d : diagnostics_) {
      out += std::to_string(d.line) + ":" + std::to_string(d.column) + ": " + d.message + "\n";
    }
    return out;
  }
  TemporaryFolder folder_;
  std::string path_;
  ParameterFile file_;
  Diagnostics diagnostics_;
};

TEST_F(ParameterFiles, OffsetsOfEverySystem) {
  EXPECT_EQ(messages("5210\t1.000000\n5211\t0.5\n5213\t-0.25\n5220\t2.000000\n"
                     "5221\t12.5\n5222\t-7.25\n5223\t-60\n5230\t15\n"
                     "5241\t1\r\n  5242 2  \n5244 30\n\n5250 0\n"),
            "");
  EXPECT_EQ(file_.work_offset_index(), 2);
  const WorkpieceFrame g54 = file_.frame(1, 1);
  EXPECT_EQ(g54.g5x_mm, Vec3(12.5, -7.25, -60));
  EXPECT_EQ(g54.g92_mm, Vec3(0.5, 0, -0.25));
  EXPECT_EQ(g54.rotation_deg, 15);
  const WorkpieceFrame g55 = file_.frame(2, 25.4);
  EXPECT_EQ(g55.g5x_mm, Vec3(25.4, 50.8, 0));
  EXPECT_EQ(g55.g92_mm, Vec3(12.7, 0, -6.35));
  EXPECT_EQ(g55.offset_abc_deg[0], 30);
  EXPECT_EQ(g55.rotation_deg, 0);
}

TEST_F(ParameterFiles, G92CountsOnlyWhileItIsInForce) {
  messages("5210 0\n5211 5\n5221 1\n");
  EXPECT_EQ(file_.frame(1, 1).g92_mm, Vec3(0));
  EXPECT_EQ(file_.work_offset_index(), 1);
}

TEST_F(ParameterFiles, LengthsInAnotherUnit) {
  messages(
      "500\t8\n5163\t-10\n5181\t20\n5210\t1\n5213\t30\n5220\t2\n5221\t40\n5224\t50\n"
      "5230\t15\n5389\t60\n");
  file_.scale_lengths(0.5);
  EXPECT_EQ(file_.values, (std::map<int, double>{{500, 8},
                                                 {5163, -5},
                                                 {5181, 10},
                                                 {5210, 1},
                                                 {5213, 15},
                                                 {5220, 2},
                                                 {5221, 20},
                                                 {5224, 50},
                                                 {5230, 15},
                                                 {5389, 30}}));
}

TEST_F(ParameterFiles, FaultsSayWhere) {
  EXPECT_EQ(messages("5221 1\nnonsense\n5222 1 2\n5223\n99999 1\n5221 2\n"),
            "2:1: is not a parameter: a number from 1 to 5601 and its value are expected\n"
            "3:8: is not a parameter: a number from 1 to 5601 and its value are expected\n"
            "4:5: is not a parameter: a number from 1 to 5601 and its value are expected\n"
            "5:1: is not a parameter: a number from 1 to 5601 and its value are expected\n"
            "6:1: parameter 5221 after 5221: LinuxCNC wants them in rising order\n");
  EXPECT_EQ(read_parameter_file(folder_ / "none", diagnostics_).error(),
            "reading " + folder_.path() + "/none: No such file or directory");
}

}  // namespace
}  // namespace kerf
