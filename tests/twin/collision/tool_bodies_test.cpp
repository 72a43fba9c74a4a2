#include "twin/collision/tool_bodies.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

std::vector<ToolBody> bodies_of(std::string_view shape) {
  return tool_bodies(parse_shape(shape).value(), {}, 0);
}

/// Whether a ball of no size at that distance from the axis and height is in the tool.
bool is_in(const std::vector<ToolBody>& bodies, double r, double z) {
  const std::vector<RoundedDisc> point{{0, 0, 1e-6}};
  Convex speck;
  speck.kind = Convex::Kind::kRevolved;
  speck.discs = point;
  speck.origin_mm = {r, 0, z};
  for (const ToolBody& body : bodies)
    if (body.solid->gap_to({speck, Pose{}, Pose{}}, 0, 1e-7).low_mm <= 0) return true;
  return false;
}

TEST(ToolBodies, AreWhatTheCutterIs) {
  for (const char* const shape :
       {"flat:6:flute=20", "ball:6:flute=20", "bull:10:2:flute=22", "drill:8:118:flute=40",
        "cone:6:60:1:flute=20", "tslot:20:4:8:flute=30", "dovetail:12:60:5:flute=20",
        "lollipop:8:4:flute=30"}) {
    const Result<Cutter> cutter = parse_shape(shape);
    if (!cutter) continue;  // not each of these is a shape of this version
    const std::vector<ToolBody> bodies = tool_bodies(*cutter, {}, 0);
    ASSERT_FALSE(bodies.empty()) << shape;
    const double radius = cutter->radius_mm();
    for (double r = 0.05; r < radius + 1; r += 0.17) {
      for (double z = -1; z < 18; z += 0.23) {
        const double low = cutter->height_mm(r);
        double high = 1e9;
        if (cutter->undercuts()) {
          high = cutter->upper_height_mm(r);
          if (r < *cutter->neck_radius_mm()) high = 1e9;
        }
        const bool inside = z > low + 0.01 && z < high - 0.01;
        const bool outside = z < low - 0.01 || z > high + 0.01;
        if (!inside && !outside) continue;
        EXPECT_EQ(is_in(bodies, r, z), inside) << shape << " r" << r << " z" << z;
      }
    }
  }
}

TEST(ToolBodies, StandOnEachOther) {
  const auto bodies = bodies_of("flat:6:flute=20:shank=8:holder=er20:stickout=40");
  ASSERT_EQ(bodies.size(), 3U);
  EXPECT_EQ(bodies[0].part, ToolPart::kCutter);
  EXPECT_DOUBLE_EQ(bodies[0].solid->box_mm().max.z, 20);
  EXPECT_EQ(bodies[1].part, ToolPart::kShank);
  EXPECT_DOUBLE_EQ(bodies[1].width_mm, 8);
  EXPECT_DOUBLE_EQ(bodies[1].solid->box_mm().max.z, 40);
  EXPECT_EQ(bodies[2].part, ToolPart::kHolder);
  EXPECT_DOUBLE_EQ(bodies[2].from_z_mm, 40);
}

TEST(ToolBodies, TheSpindleBeginsAtItsNoseOrAboveTheHolder) {
  const Cutter cutter = parse_shape("flat:6:flute=20:holder=30x20:stickout=40").value();
  const std::vector<ToolSection> spindle{{80, 0, 60}};
  EXPECT_DOUBLE_EQ(tool_bodies(cutter, spindle, 0).back().from_z_mm, 60);
  EXPECT_DOUBLE_EQ(tool_bodies(cutter, spindle, 95).back().from_z_mm, 95);
  const Cutter bare = parse_shape("flat:6:flute=20").value();
  EXPECT_NE(tool_bodies(bare, spindle, 0).back().part, ToolPart::kSpindle);
  EXPECT_EQ(tool_bodies(bare, spindle, 70).back().part, ToolPart::kSpindle);
}

}  // namespace
}  // namespace kerf
