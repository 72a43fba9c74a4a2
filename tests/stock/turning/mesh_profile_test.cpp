// Blanks that turn, from meshes.
#include "stock/turning/mesh_profile.h"

#include <gtest/gtest.h>

#include <memory>

#include "stock/turning/turned_blank.h"
#include "tests/mesh/sample_meshes.h"

namespace kerf {
namespace {

Result<TurnedProfile> profile_of(const TriangleMesh& mesh) {
  Blank blank;
  blank.mesh.emplace();
  blank.mesh->file = "a.stl";
  blank.mesh->body = std::make_shared<const MeshBody>(test::body_of(mesh));
  return turned_profile_of(blank);
}

/// By Pappus, of rings that are even-odd and counter-clockwise outside.
double turned_mm3(const TurnedProfile& profile) {
  double sum = 0;
  for (const auto& ring : profile) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
      sum -= kPi / 3 * (q.x - p.x) * (p.y * p.y + p.y * q.y + q.y * q.y);
    }
  }
  return std::abs(sum);
}

TEST(TurnedMesh, corners_are_the_profile) {
  // A tube with a groove and a cone; facets do not make it smaller.
  const Vec2 section[] = {{-40, 12}, {-40, 20}, {-25, 20}, {-25, 17},
                          {-20, 17}, {-20, 20}, {0, 15},   {0, 12}};
  const auto profile = profile_of(test::ring_of(section, 120));
  ASSERT_TRUE(profile) << profile.error();
  const double exact =
      kPi * (15 * (400 - 144) + 5 * (289 - 144)) + kPi * 20 * ((400 + 300 + 225) / 3.0 - 144);
  EXPECT_NEAR(turned_mm3(*profile), exact, 0.02);
  TriangleMesh bar;
  test::add_prism(bar, test::circle(10, 90), -50, 0);
  EXPECT_NEAR(turned_mm3(*profile_of(bar)), kPi * 100 * 50, 0.02);
  EXPECT_NEAR(turned_mm3(*profile_of(test::sphere(Vec3(0, 0, -9), 9, 90))), 4.0 / 3 * kPi * 729,
              0.0025 * 4.0 / 3 * kPi * 729);
}

TEST(TurnedMesh, what_does_not_turn_is_told) {
  const auto fault = [](const TriangleMesh& mesh) {
    const auto profile = profile_of(mesh);
    return profile ? std::string() : profile.error();
  };
  EXPECT_NE(fault(test::box_of({-5, -5, 0}, {5, 5, 10})).find("a.stl: does not turn about X0 Y0"),
            std::string::npos);
  TriangleMesh beside;
  test::add_prism(beside, test::circle(10, 90), 0, 5);
  for (auto& p : beside.positions_mm) p.x += 1;
  EXPECT_NE(fault(beside).find("does not turn about X0 Y0 along Z"), std::string::npos)
      << fault(beside);
  // One flat: a few corners of the circle are left out.
  std::vector<Vec2> flat = test::circle(10, 90);
  flat.erase(flat.begin() + 10, flat.begin() + 15);
  TriangleMesh bar;
  test::add_prism(bar, flat, -50, 0);
  EXPECT_NE(fault(bar).find("within 0.05 mm: look at X"), std::string::npos) << fault(bar);
  TriangleMesh coarse;
  test::add_prism(coarse, test::circle(10, 16), -50, 0);
  EXPECT_NE(fault(coarse), "") << "its facets are 0.19 mm deep";
}

}  // namespace
}  // namespace kerf
