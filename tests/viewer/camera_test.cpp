#include "viewer/camera.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "base/geometry.h"

namespace kerf {
namespace {

const Vec3 kDirection{0.6, -1.0, 0.86};
constexpr glm::ivec2 kPicture_px{800, 600};
constexpr Margins kMargins{40, 60, 20, 80};
/// Projection is in single precision.
constexpr float kTolerance_px = 0.05f;

std::vector<Vec3> corners(const Box& box) {
  std::vector<Vec3> points;
  for (unsigned corner = 0; corner < 8; ++corner) {
    points.push_back({(corner & 1u) ? box.max.x : box.min.x, (corner & 2u) ? box.max.y : box.min.y,
                      (corner & 4u) ? box.max.z : box.min.z});
  }
  return points;
}

struct Extent {
  glm::vec2 low{1e9f};
  glm::vec2 high{-1e9f};
};

Extent project_all(const Camera& camera, const std::vector<Vec3>& points) {
  Extent extent;
  for (const Vec3& point : points) {
    const glm::vec3 p = camera.project(point);
    EXPECT_GT(p.z, 0.0f);
    EXPECT_LT(p.z, 1.0f);
    extent.low = {std::min(extent.low.x, p.x), std::min(extent.low.y, p.y)};
    extent.high = {std::max(extent.high.x, p.x), std::max(extent.high.y, p.y)};
  }
  return extent;
}

TEST(CameraTest, FitsWithinMarginsAndTouchesTheTighterPair) {
  for (const Vec3& size : {Vec3(100, 100, 50), Vec3(1000, 20, 5), Vec3(3, 2, 400)}) {
    const std::vector<Vec3> points = corners(Box{Vec3(500, -70, 3), Vec3(500, -70, 3) + size});
    const Camera camera = Camera::fit(points, kDirection, 24.0, kPicture_px, kMargins);
    const Extent extent = project_all(camera, points);
    const float left = extent.low.x - 40.0f, right = 740.0f - extent.high.x;
    const float top = extent.low.y - 20.0f, bottom = 520.0f - extent.high.y;
    EXPECT_GE(std::min({left, right, top, bottom}), -kTolerance_px);
    EXPECT_NEAR(std::min(std::max(left, right), std::max(top, bottom)), 0.0f, kTolerance_px);
  }
}

TEST(CameraTest, FitsASinglePoint) {
  const std::vector<Vec3> points = {{7, 8, 9}};
  const Camera camera = Camera::fit(points, kDirection, 24.0, kPicture_px, kMargins);
  const glm::vec3 p = camera.project(points[0]);
  EXPECT_NEAR(p.x, 0.5f * (40 + 740), 1.0f);
  EXPECT_NEAR(p.y, 0.5f * (20 + 520), 1.0f);
}

TEST(CameraTest, LooksFromFrontRightAboveWithZUp) {
  const std::vector<Vec3> points = corners(Box{{0, 0, 0}, {10, 10, 10}});
  const Camera camera = Camera::fit(points, kDirection, 24.0, kPicture_px, kMargins);
  const glm::vec3 origin = camera.project({0, 0, 0});
  EXPECT_GT(camera.project({10, 0, 0}).x, origin.x);           // +X to the right
  EXPECT_GT(camera.project({0, 10, 0}).z, origin.z);           // +Y away
  EXPECT_LT(camera.project({0, 0, 10}).y, origin.y - 100.0f);  // +Z up the picture
}

TEST(CameraTest, UnprojectUndoesProject) {
  const std::vector<Vec3> points = corners(Box{{0, 0, -50}, {100, 80, 0}});
  const Camera camera = Camera::fit(points, kDirection, 24.0, kPicture_px, kMargins);
  for (const Vec3& point : points) {
    const glm::vec3 p = camera.project(point);
    const glm::vec4 u = camera.unproject();
    const float distance_mm = 1.0f / (u.z + u.w * p.z);
    const glm::vec2 ndc(p.x / 400.0f - 1.0f, 1.0f - p.y / 300.0f);
    const glm::vec3 view(ndc.x * u.x * distance_mm, ndc.y * u.y * distance_mm, -distance_mm);
    const glm::vec3 expected(camera.view_from_world() * glm::vec4(glm::vec3(point), 1.0f));
    EXPECT_LT(glm::length(view - expected), 0.02f);
  }
}

}  // namespace
}  // namespace kerf
