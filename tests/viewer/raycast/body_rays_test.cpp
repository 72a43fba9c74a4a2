// Bodies by rays: against closed forms, and against what the window's renderer draws.
#include "viewer/raycast/body_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "viewer/gl_context.h"
#include "viewer/raycast/scene_light.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{200, 150};

std::shared_ptr<const TriangleMesh> cube(double edge_mm) {
  auto mesh = std::make_shared<TriangleMesh>();
  const auto e = static_cast<float>(edge_mm);
  for (unsigned i = 0; i < 8; ++i)
    mesh->positions_mm.emplace_back(i & 1u ? e : 0.0f, i & 2u ? e : 0.0f, i & 4u ? e : 0.0f);
  const std::uint32_t faces[6][4]{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh->triangles.push_back({f[0], f[1], f[2]});
    mesh->triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

TEST(MeshRays, TheFirstFrontIsThatOfAllTriangles) {
  const MeshRays rays(cube(10));
  const auto hit = rays.first_front({5, 4, 30}, {0, 0, -2}, 1e9);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 10, 1e-12);
  EXPECT_FALSE(rays.first_front({5, 4, 30}, {0, 0, -2}, 9.5)) << "before there";
  EXPECT_FALSE(rays.first_front({5, 4, 5}, {0, 0, -2}, 1e9)) << "from inside it shows its back";
  EXPECT_FALSE(rays.first_front({5, 4, 30}, {0, 0, 2}, 1e9));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-20, 30);
  for (int n = 0; n < 500; ++n) {
    const Vec3 from{place(random), place(random), place(random)};
    const Vec3 to{place(random), place(random), place(random)};
    const Vec3 way = to - from;
    // By slabs: the ray comes into the box at the last of the planes it comes in through.
    double in = 0, out = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (0 - from[axis]) / way[axis], b = (10 - from[axis]) / way[axis];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    const auto met = rays.first_front(from, way, 1e9);
    const bool is_met = in < out && in > 0;
    ASSERT_EQ(met.has_value(), is_met) << n;
    if (met) {
      EXPECT_NEAR(met->t, in, 1e-9);
    }
  }
}

SceneMachine one_cube() {
  SceneMachine scene;
  scene.links.push_back({"cube", cube(10), 0xa8b08a5a});
  return scene;
}

OrbitCamera camera_at(const Box& box, bool is_perspective) {
  OrbitCamera camera;
  camera.set_perspective(is_perspective);
  camera.fit(box, kSize_px);
  return camera;
}

class BodyRaysTest : public testing::TestWithParam<bool> {};

/// The window's renderer, with a fixture and nothing else.
TEST_P(BodyRaysTest, LooksAsInTheWindow) {
  unsetenv("DISPLAY");
  Result<GlContext> context = GlContext::create_offscreen();
  ASSERT_TRUE(context) << context.error();
  Result<SceneRenderer> renderer = SceneRenderer::create();
  ASSERT_TRUE(renderer) << renderer.error();
  const glm::mat4 pose(glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                       glm::vec4(3, -4, 2, 1));
  SceneUpdate update;
  auto setup = std::make_shared<SceneSetup>();
  setup->bounds_mm = {{0, -10, 0}, {20, 10, 15}};
  update.setup = setup;
  update.fixtures = std::make_shared<const SceneMachine>(one_cube());
  auto moment = std::make_shared<Moment>();
  moment->fixture_poses = {pose};
  update.moment = moment;
  renderer->apply(update);
  const Projection projection =
      camera_at(setup->bounds_mm, GetParam()).projection(renderer->depth_box(), kSize_px);
  DrawOptions options;
  options.upload_bytes_per_frame = std::numeric_limits<std::size_t>::max();
  do {
    ASSERT_TRUE(renderer->draw(projection, options));
  } while (renderer->has_waiting());
  const Picture window = renderer->read();

  BodyRays rays;
  rays.set_bodies(one_cube());
  Picture picture{kSize_px.x, kSize_px.y, {}};
  for (int y = 0; y < kSize_px.y; ++y) {
    const glm::vec3 ground = scene_light::background(1.0f - (static_cast<float>(y) + 0.5f) /
                                                                static_cast<float>(kSize_px.y));
    for (int x = 0; x < 3 * kSize_px.x; ++x)
      picture.rgb.push_back(static_cast<std::uint8_t>(ground[x % 3] * 255.0f + 0.5f));
  }
  const Picture empty = picture;
  const std::vector<float> depths(picture.rgb.size() / 3, 1.0f);
  const glm::mat4 poses[] = {pose};
  rays.draw(projection, poses, setup->bounds_mm, depths, 2, &picture);
  int covered = 0, differs = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    covered += picture.rgb[i] != empty.rgb[i] ? 1 : 0;
    differs += std::abs(int{picture.rgb[i]} - int{window.rgb[i]}) > 3 ? 1 : 0;
  }
  EXPECT_GT(covered, 5000);
  EXPECT_LT(differs, covered / 50) << "edges alone";

  // What lies before it hides it; a body of which nobody knows where it is is not drawn.
  Picture hidden = empty;
  rays.draw(projection, poses, setup->bounds_mm, std::vector<float>(depths.size(), 0.0f), 2,
            &hidden);
  EXPECT_EQ(hidden.rgb, empty.rgb);
  const glm::mat4 nowhere[] = {kNotDrawn};
  rays.draw(projection, nowhere, setup->bounds_mm, depths, 2, &hidden);
  EXPECT_EQ(hidden.rgb, empty.rgb);
}

INSTANTIATE_TEST_SUITE_P(Eyes, BodyRaysTest, testing::Bool());

}  // namespace
}  // namespace kerf
