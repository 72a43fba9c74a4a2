#include "viewer/csg/csg_blank.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/viewer/csg/cylinder_blank.h"

namespace kerf {
namespace {

const Box kBox{Vec3(0.0), Vec3(10, 20, 30)};

std::string why(const CsgBlank& blank) {
  const Done done = check(blank);
  return done ? "" : done.error();
}

TEST(CsgBlank, BoxAndCylinderAreClosedAndConvex) {
  EXPECT_EQ(why(box_blank(kBox)), "");
  for (const char axis : {'X', 'Y', 'Z'}) {
    EXPECT_EQ(why(cylinder_blank(Vec3(1, 2, 3), axis, 10, 40, 0.01)), "") << axis;
  }
}

TEST(CsgBlank, CornersAtEqualPlacesCountAsOne) {
  CsgBlank blank = box_blank(kBox);
  TriangleMesh loose;  // as STL files have it
  for (const auto& triangle : blank.mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.positions_mm.size());
    for (const std::uint32_t i : triangle) {
      loose.positions_mm.push_back(blank.mesh.positions_mm[i]);
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  blank.mesh = loose;
  EXPECT_EQ(why(blank), "");
}

TEST(CsgBlank, FaultsAreNamed) {
  EXPECT_EQ(why(CsgBlank{}), "the blank has no triangles");
  CsgBlank blank = box_blank(kBox);
  blank.mesh.triangles.pop_back();
  EXPECT_EQ(why(blank), "the blank is not closed: 3 edges do not join two triangles");
  blank = box_blank(kBox);
  std::swap(blank.mesh.triangles[0][0], blank.mesh.triangles[0][1]);
  EXPECT_EQ(why(blank), "the blank is not closed: 3 edges do not join two triangles");
  blank = box_blank(kBox);
  blank.convexity = 9;
  EXPECT_EQ(why(blank), "convexity 9 of the blank is not allowed; must be 1 to 8");
  blank = box_blank(kBox);
  blank.mesh.triangles[3][1] = 8;
  EXPECT_EQ(why(blank), "the blank names corner 8, but has 8 only");
  blank = box_blank(kBox);
  blank.mesh.positions_mm[0].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(why(blank), "the blank has a corner that is not finite");
}

}  // namespace
}  // namespace kerf
