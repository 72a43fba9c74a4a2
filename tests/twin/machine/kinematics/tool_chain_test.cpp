// Derivatives along a chain against differences, and their bounds against what is seen.
#include "twin/machine/kinematics/tool_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "twin/machine/kinematics/known_kinematics.h"

namespace kerf {
namespace {

constexpr double kStep = 1e-4;
const Vec3 kEnd{3, -4, -55};
const Vec3 kDirection{0, 0, 1};

struct Course {
  AxisValues from{}, rate{}, bend{};
  InputJet at(double t) const {
    InputJet jet;
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      jet.value[i] = from[i] + t * rate[i] + t * t / 2 * bend[i];
      jet.rate[i] = rate[i] + t * bend[i];
      jet.acceleration[i] = bend[i];
    }
    return jet;
  }
};

Course random_course(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  Course course;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    course.from[i] = 90 * draw(random);
    course.rate[i] = 60 * draw(random);
    if (i < 3) course.bend[i] = 20 * draw(random);
  }
  return course;
}

std::vector<ToolChain> chains() {
  return {ToolChain(straight_chain("XYZABC", RotarySide::kTable, {3, 5, 7}), "XYZABC"),
          ToolChain(straight_chain("XYZABCW", RotarySide::kHead, {3, 5, 7}), "XYZABCW"),
          ToolChain(xyzac_trt_chain({1, 2, 3}, 20, 10), "XYZAC"),
          ToolChain(bridge_5axis_chain(150), "XYZBCW"), ToolChain(max_chain(60), "XYZABCUVW")};
}

TEST(ToolChain, IsTheWayFromWorkpieceToTool) {
  std::mt19937 random(3);
  const KinematicChain tree = xyzac_trt_chain({1, 2, 3}, 20, 10);
  const ToolChain flat(tree, "XYZAC");
  for (int i = 0; i < 20; ++i) {
    const AxisValues axes = random_course(random).from;
    const Pose a = tree.workpiece_from_tool({axes, {}});
    const Pose b = flat.pose(axes);
    EXPECT_LT(glm::distance(a.origin_mm, b.origin_mm), 1e-10);
    EXPECT_LT(glm::distance(a.direction(kDirection), b.direction(kDirection)), 1e-13);
  }
}

TEST(ToolChain, LinksThatJointsDriveFollowTheirAxes) {
  const ChainLink table{"t", "", JointKind::kFixed, 0, false, {0, 0, 1}, Vec3(0)};
  const ChainLink slide{"y", "", JointKind::kPrismatic, 2, true, {0, 1, 0}, Vec3(0)};
  const auto tree = KinematicChain::create({table, slide}, "t", "y");
  ASSERT_TRUE(tree);
  EXPECT_EQ(ToolChain(*tree, "XYYZ").pose({1, 20, 300}).origin_mm, Vec3(0, 20, 0));
}

TEST(ToolChain, DerivativesAreThoseOfThePath) {
  std::mt19937 random(4);
  for (const ToolChain& chain : chains()) {
    for (int round = 0; round < 10; ++round) {
      const Course course = random_course(random);
      const auto point = [&](double t) { return chain.pose(course.at(t).value).point(kEnd); };
      const auto spindle = [&](double t) {
        return chain.pose(course.at(t).value).direction(kDirection);
      };
      const double t = 0.4;
      const PoseJet jet = chain.jet(course.at(t), kEnd);
      EXPECT_LT(glm::distance(jet.pose.origin_mm, point(t)), 1e-9);
      const Vec3 velocity = (point(t + kStep) - point(t - kStep)) / (2 * kStep);
      const Vec3 bend = (point(t + kStep) - 2.0 * point(t) + point(t - kStep)) / (kStep * kStep);
      EXPECT_LT(glm::distance(jet.velocity_mm, velocity), 1e-4);
      EXPECT_LT(glm::distance(jet.acceleration_mm, bend), 1e-3);
      const Vec3 turned =
          (spindle(t + kStep) - 2.0 * spindle(t) + spindle(t - kStep)) / (kStep * kStep);
      EXPECT_LT(glm::distance(jet.bend(kDirection), turned), 1e-5);
    }
  }
}

TEST(ToolChain, BoundsHoldOverTheWholePiece) {
  std::mt19937 random(5);
  const double h = 0.3;
  for (const ToolChain& chain : chains()) {
    for (int round = 0; round < 10; ++round) {
      const Course course = random_course(random);
      InputBounds inputs;
      for (std::size_t i = 0; i < kAxisCount; ++i) {
        inputs.rate[i] = std::abs(course.rate[i]) + std::abs(course.bend[i]);
        inputs.acceleration[i] = std::abs(course.bend[i]);
      }
      const PathBounds bounds = chain.bounds(course.at(0.5).value, inputs, h, kEnd);
      double most = 0;
      double jerk = 0;
      Vec3 before = chain.jet(course.at(0.5 - h / 2), kEnd).acceleration_mm;
      for (int i = 1; i <= 60; ++i) {
        const Vec3 now = chain.jet(course.at(0.5 - h / 2 + h * i / 60), kEnd).acceleration_mm;
        most = std::max(most, glm::length(now));
        jerk = std::max(jerk, glm::length(now - before) * 60 / h);
        before = now;
      }
      EXPECT_LE(most, bounds.acceleration_mm);
      EXPECT_LE(jerk, bounds.jerk_mm);
      EXPECT_GT(bounds.acceleration_mm, 0);
    }
  }
}

}  // namespace
}  // namespace kerf
