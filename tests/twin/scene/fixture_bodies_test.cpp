#include "twin/scene/fixture_bodies.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>

#include "twin/job/fixtures.h"

namespace kerf {
namespace {

std::vector<Fixture> fixtures_of(const std::vector<std::string>& texts) {
  std::vector<FixtureSpec> specs;
  for (const std::string& text : texts) specs.push_back(parse_fixture(text).value());
  Diagnostics diagnostics;
  const FixtureList list = load_fixtures(specs, diagnostics);
  EXPECT_TRUE(list) << (diagnostics.empty() ? "" : diagnostics[0].message);
  return *list;
}

/// Of a closed mesh whose triangles run counter-clockwise seen from outside.
double volume_mm3(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions_mm[t[0]]), b(mesh.positions_mm[t[1]]),
        c(mesh.positions_mm[t[2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

/// Each edge is run along once in each direction.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

TEST(FixtureBodies, AreAsLargeAsWhatIsChecked) {
  // A polygon of 72 corners has n / 2 sin(2 pi / n) / pi of its circle.
  const double round = 36 * std::sin(2 * kPi / 72) / kPi;
  const struct {
    const char* text;
    double volume_mm3, within;
  } kCases[] = {
      {"box:0,0,0:10,20,30", 6000, 1e-3},
      {"cylinder:5,5,0:10:8", kPi * 16 * 10 * round, 0.01},
      {"cylinder:5,5,0:10:8:x", kPi * 16 * 5 * round, 0.01},
      {"cylinder:5,5,0:10:8:y", kPi * 16 * 5 * round, 0.01},
      {"tube:0,0,0:10:20:16", kPi * (100 - 64) * 10, 0.1},
      {"clamp:30:20:12", 30 * 20 * 12, 1e-2},
      {"screw:4:12", kPi * 4 * 12 * round + kPi * 16 * 4 * round, 0.1},
  };
  for (const auto& c : kCases) {
    const TriangleMesh mesh = drawn_mesh(*fixtures_of({c.text})[0].solid);
    EXPECT_TRUE(is_closed(mesh)) << c.text;
    EXPECT_NEAR(volume_mm3(mesh), c.volume_mm3, c.within) << c.text;
  }
}

TEST(FixtureBodies, StandWhereTheFixturesDo) {
  const auto fixtures =
      fixtures_of({"box:0,0,0:10,2,3:at=100,50,-20:turn=90", "post=cylinder:0,0,0:9:8"});
  const SceneMachine scene = scene_fixtures(fixtures);
  ASSERT_EQ(scene.links.size(), 2u);
  EXPECT_EQ(scene.links[1].name, "post");
  EXPECT_LT(scene.links[0].color >> 24, 0xffu) << "the part is to be seen through it";
  const std::vector<glm::mat4> poses = fixture_poses(fixture_places(fixtures, {}, {}));
  ASSERT_EQ(poses.size(), 2u);
  const glm::vec4 far_end = poses[0] * glm::vec4(10, 0, 0, 1);
  EXPECT_NEAR(far_end.x, 100, 1e-4);
  EXPECT_NEAR(far_end.y, 60, 1e-4);
  EXPECT_NEAR(far_end.z, -20, 1e-4);
  EXPECT_EQ(picture_bodies(fixtures)[0].pose, poses[0]);
}

TEST(FixtureBodies, OnALinkAreNotInThePictureOfAPart) {
  const auto fixtures = fixtures_of({"vise=box:0,0,0:1,1,1:on=table", "post=cylinder:0,0,0:9:8"});
  const std::vector<PictureBody> bodies = picture_bodies(fixtures);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].mesh->triangles.size(), drawn_mesh(*fixtures[1].solid).triangles.size());
}

}  // namespace
}  // namespace kerf
