// Pictures by rays: local against full, one thread against two, and against OpenGL's.
#include "viewer/raycast/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/matrix.hpp>

#include "tests/stock/random_part.h"
#include "tests/viewer/raycast/sample_grids.h"
#include "tests/viewer/test_scene.h"
#include "viewer/gl_context.h"
#include "viewer/raycast/tool_rays.h"
#include "viewer/window/scene_renderer.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{200, 150};

bool same(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

TEST(RayFrame, RaysPassThroughWhatProjectsToTheirPixel) {
  for (int number = 0; number < 16; ++number) {
    const Projection view = test::view_of({Vec3(0), Vec3(24, 18, 8)}, number, kSize_px);
    const RayFrame frame(view.clip_from_world, kSize_px);
    for (const Vec3& point : {Vec3(1, 2, 3), Vec3(20, 1, 8), Vec3(12, 17, -3)}) {
      const glm::dvec4 clip = glm::dmat4(view.clip_from_world) * glm::dvec4(point, 1);
      const Vec3 ndc = Vec3(clip) / clip.w;
      const Ray ray = frame.ray((0.5 + 0.5 * ndc.x) * kSize_px.x, (0.5 - 0.5 * ndc.y) * kSize_px.y);
      const Vec3 arm = point - ray.origin_mm;
      const double t =
          glm::dot(arm, ray.direction_mm) / glm::dot(ray.direction_mm, ray.direction_mm);
      EXPECT_LT(glm::length(arm - t * ray.direction_mm), 1e-9 * glm::length(arm) + 1e-9);
      EXPECT_GT(t, ray.t_min);
      EXPECT_NEAR(static_cast<double>(frame.depth(ray, t)), std::clamp(0.5 + 0.5 * ndc.z, 0.0, 1.0),
                  1e-7);
    }
  }
}

class LocalCast : public testing::TestWithParam<int> {};

TEST_P(LocalCast, GivesThePictureOfAFullCastBitForBit) {
  const int number = GetParam();
  const std::unique_ptr<ZMap> part =
      test::random_part(static_cast<unsigned>(number), 0.1, number % 2 == 1);
  std::mt19937 random(static_cast<unsigned>(100 + number));
  RayCaster local(2), full(1);
  const Projection view = test::view_of(part->bounds_mm(), number, kSize_px);
  const Cutter cutter = *parse_shape("ball:1.2");
  std::vector<std::uint8_t> last;
  Vec3 at(12, 9, -2);
  for (int step = 0; step < 8; ++step) {
    const std::vector<CutMove> moves =
        test::random_path(random, {at - Vec3(3, 3, 3), at + Vec3(3, 3, 1.5)}, 4);
    test::cut(*part, cutter, moves);
    test::finish(*part);
    at = moves.back().to_mm;
    const auto shape = test_tool(0.6f);
    for (RayCaster* caster : {&local, &full}) {
      if (step == 2) caster->set_tool_shape(shape);
      // A snapshot each, so that what has changed is found by the tiles alone.
      caster->set_workpiece(part->snapshot()->height_grid());
      if (step != 5) caster->set_tool_pose(ToolPose{at, glm::normalize(Vec3(0.1 * step, 0, 1))});
    }
    const RayCounters counters = local.draw(view);
    full.draw(view, false);
    ASSERT_EQ(local.picture().rgb, full.picture().rgb) << "step " << step;
    ASSERT_TRUE(same(local.depths(), full.depths())) << "step " << step;
    ASSERT_TRUE(same(local.workpiece_depths(), full.workpiece_depths())) << "step " << step;
    EXPECT_EQ(counters.is_full, step == 0);
    if (step > 0) {
      EXPECT_LT(counters.cast_px, static_cast<std::size_t>(kSize_px.x * kSize_px.y)) << step;
    }
    if (step > 1 && step != 5 && number % 8 < 6) {
      EXPECT_NE(local.picture().rgb, last) << "step " << step;
    }
    last = local.picture().rgb;
  }
  const RayCounters still = local.draw(view);
  EXPECT_EQ(still.cast_px + still.copied_px, 0u);
}

INSTANTIATE_TEST_SUITE_P(Views, LocalCast, testing::Range(0, 12));

TEST(RayCaster, AnotherWorkpieceOrViewOrNoneIsCastWhole) {
  const auto big = test::random_part(1, 0.2), small = test::random_part(2, 0.4);
  const Projection view = test::view_of(big->bounds_mm(), 0, kSize_px);
  RayCaster caster, fresh;
  caster.set_workpiece(big->height_grid());
  caster.draw(view);
  caster.set_workpiece(small->height_grid());
  caster.draw(view);
  fresh.set_workpiece(small->height_grid());
  fresh.draw(view);
  EXPECT_EQ(caster.picture().rgb, fresh.picture().rgb);
  const Projection other = test::view_of(big->bounds_mm(), 9, {160, 100});
  EXPECT_TRUE(caster.draw(other).is_full);
  fresh.draw(other);
  EXPECT_EQ(caster.picture().rgb, fresh.picture().rgb);
  EXPECT_EQ(caster.picture().rgb.size(), 3u * 160 * 100);
  EXPECT_TRUE(caster.pick({80, 50}));
  EXPECT_FALSE(caster.pick({80, 100}));
  caster.set_workpiece(nullptr);
  caster.draw(other);
  for (const float depth : caster.depths()) ASSERT_EQ(depth, 1.0f);
  EXPECT_FALSE(caster.pick({80, 50}));
}

TEST(ToolRays, AreMetOnTheOutline) {
  ToolShape shape;
  shape.cutter = {{0.0f, 0.0f}, {2.0f, 1.0f}, {2.0f, 9.0f}};
  shape.holder = {{3.0f, 12.0f}, {6.0f, 20.0f}};
  const Vec3 tip(1, 2, 3), axis = glm::normalize(Vec3(0.3, -0.2, 1));
  const ToolRays tool(shape, {tip, axis});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1, 1);
  int hits[3] = {};
  for (int n = 0; n < 20000; ++n) {
    const Vec3 from = tip + 40.0 * Vec3{share(random), share(random), share(random)};
    const Vec3 to = tip + 10 * (share(random) + 1) * axis + 3 * share(random);
    const Ray ray{from, to - from, 0.0};
    const std::optional<ToolHit> hit = tool.trace(ray, 1e9);
    if (!hit) continue;
    ++hits[static_cast<int>(hit->part)];
    const Vec3 p = from + hit->t * (to - from) - tip;
    const double z = glm::dot(p, axis), r = glm::length(p - z * axis);
    if (hit->part == ToolPart::kCutter) {
      // Cone, cylinder or the disc on top.
      ASSERT_TRUE(std::abs(r - 2 * z) < 1e-8 || std::abs(r - 2) < 1e-8 || std::abs(z - 9) < 1e-8);
      ASSERT_TRUE(z > -1e-8 && z < 9 + 1e-8 && r < 2 + 1e-8);
    } else {
      ASSERT_TRUE(std::abs(r - (3 + 0.375 * (z - 12))) < 1e-8 || std::abs(z - 12) < 1e-8 ||
                  std::abs(z - 20) < 1e-8);
      ASSERT_TRUE(z > 12 - 1e-8 && z < 20 + 1e-8 && r < 6 + 1e-8);
    }
    const bool is_inside = r < 2 && z > 0.5 * r && z < 9;
    if (!is_inside && glm::length(from - tip) > 25) {
      ASSERT_LT(glm::dot(Vec3(hit->normal), to - from), 1e-6) << n;
    }
    ASSERT_FALSE(tool.trace(ray, hit->t));  // nothing before it
  }
  EXPECT_GT(hits[0], 2000);
  EXPECT_EQ(hits[1], 0);
  EXPECT_GT(hits[2], 2000);
  EXPECT_FALSE(ToolRays({}, {tip}).trace({Vec3(9, 9, 9), tip - Vec3(9)}, 1e9));
}

/// The window's renderer, with patches of the same workpiece, draws the same picture. It lights the
/// corners of triangles and the rays what they meet: colours differ a little within those triangles
/// whose corners face in different directions.
class AgainstMeshes : public testing::TestWithParam<int> {};

TEST_P(AgainstMeshes, DepthAndColorAgreeExceptAtSilhouettes) {
  const int number = GetParam();
  unsetenv("DISPLAY");
  Result<GlContext> context = GlContext::create_offscreen();
  ASSERT_TRUE(context) << context.error();
  const std::unique_ptr<ZMap> part =
      test::random_part(static_cast<unsigned>(number), 0.15, number % 4 == 1);
  const Projection view = test::view_of(part->bounds_mm(), number, kSize_px);
  RayCaster caster;
  caster.set_workpiece(part->height_grid());
  caster.draw(view);

  Result<SceneRenderer> meshes = SceneRenderer::create();
  ASSERT_TRUE(meshes) << meshes.error();
  SceneUpdate update;
  for (std::uint32_t tile = 0; tile < part->tile_count(); ++tile)
    update.patches.push_back(std::make_shared<const MeshPatch>(part->patch(tile, 0)));
  meshes->apply(update);
  DrawOptions options;
  options.upload_bytes_per_frame = std::size_t{1} << 30;
  const Done done = meshes->draw(view, options);
  ASSERT_TRUE(done) << done.error();
  const Picture drawn = meshes->read();

  // Depth in mm along the view: rows of the inverse would do, two points of the pixel's ray do too.
  const glm::dmat4 world_from_clip = glm::inverse(glm::dmat4(view.clip_from_world));
  const double pixel_mm = 40.0 / kSize_px.y;  // about
  int covered = 0, near = 0, alike = 0, similar = 0, silhouettes = 0, off = 0;
  for (int y = 0; y < kSize_px.y; ++y) {
    for (int x = 0; x < kSize_px.x; ++x) {
      const auto pixel = static_cast<std::size_t>(y * kSize_px.x + x);
      const std::optional<Vec3> theirs = meshes->pick({x, y});
      const float depth = caster.workpiece_depths()[pixel];
      if (!theirs && depth == 1.0f) continue;
      ++covered;
      const glm::dvec4 at = world_from_clip * glm::dvec4(2 * (x + 0.5) / kSize_px.x - 1,
                                                         1 - 2 * (y + 0.5) / kSize_px.y,
                                                         2 * static_cast<double>(depth) - 1, 1);
      const bool agrees =
          theirs && depth < 1.0f && glm::length(Vec3(at) / at.w - *theirs) < 0.1 * pixel_mm;
      near += agrees;
      int worst = 0;
      for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k)
        worst = std::max(worst, std::abs(int{drawn.rgb[k]} - int{caster.picture().rgb[k]}));
      alike += agrees && worst <= 3;
      similar += agrees && worst <= 24;
      if (agrees) continue;
      // Allowed where a neighbouring ray meets what the mesh shows here, or nothing.
      bool is_silhouette = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::optional<Vec3> other = caster.pick({x + dx, y + dy});
          is_silhouette |= other.has_value() != theirs.has_value() ||
                           (other && glm::length(*other - *theirs) < 2 * pixel_mm);
        }
      }
      (is_silhouette ? silhouettes : off) += 1;
    }
  }
  EXPECT_GT(covered, 4000);
  EXPECT_EQ(off, 0) << silhouettes << " at silhouettes";
  EXPECT_GE(near, covered - covered / 1000);
  EXPECT_GE(alike, covered - covered / 50);
  EXPECT_GE(similar, covered - covered / 500);
}

INSTANTIATE_TEST_SUITE_P(Views, AgainstMeshes, testing::Range(0, 16));

}  // namespace
}  // namespace kerf
