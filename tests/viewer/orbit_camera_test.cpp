#include "viewer/orbit_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/geometry.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{1280, 800};

/// Edge of a pixel at `at`, by moving aside until that is a hundredth of a pixel to be seen.
double seen_pixel_mm(const OrbitCamera& camera, const Box& content, const Vec3& at) {
  const Projection projection = camera.projection(content, kSize_px);
  const auto px = [&](const Vec3& point) {
    const glm::dvec4 clip = glm::dmat4(projection.clip_from_world) * glm::dvec4(point, 1.0);
    return 0.5 * glm::dvec2(clip) / clip.w * glm::dvec2(kSize_px);
  };
  const glm::dmat4 view(projection.view_from_world);
  const Vec3 right = glm::normalize(Vec3(view[0][0], view[1][0], view[2][0]));
  constexpr double kStep_mm = 0.1;
  return kStep_mm / glm::length(px(at + kStep_mm * right) - px(at));
}

TEST(OrbitCamera, DetailIsWhatThePictureShowsOfAPlace) {
  const Box content{{10, 20, -30}, {110, 90, 5}};
  for (const bool perspective : {true, false}) {
    for (const StandardView view :
         {StandardView::kIsometric, StandardView::kTop, StandardView::kLeft}) {
      OrbitCamera camera;
      camera.set_perspective(perspective);
      camera.look_from(view);
      camera.fit(content, kSize_px);
      camera.zoom(1.7, {300, 200}, kSize_px);
      const ViewDetail detail = camera.detail(kSize_px);
      for (const Vec3& at : {content.min, content.max, Vec3(60, 50, 0)}) {
        const double seen = seen_pixel_mm(camera, content, at);
        EXPECT_NEAR(detail.at(at), seen, 0.002 * seen);
      }
      EXPECT_EQ(detail.per_mm == Vec3(0.0), !perspective);
      EXPECT_LE(detail.smallest_in(content), detail.at(content.min));
      EXPECT_GE(detail.largest_in(content), detail.at(content.max));
    }
  }
}

/// What is to the right, up and towards the eye in the picture, as axes of the workpiece.
struct Seen {
  Vec3 right, up, back;
};
Seen seen_from(StandardView view, Standing standing) {
  OrbitCamera camera;
  camera.set_standing(standing);
  camera.look_from(view);
  const glm::dmat4 rows(
      glm::transpose(camera.projection({Vec3(-10), Vec3(10)}, kSize_px).view_from_world));
  return {Vec3(rows[0]), Vec3(rows[1]), Vec3(rows[2])};
}

void expect_same(const Vec3& found, const Vec3& wanted) {
  EXPECT_LT(glm::distance(found, wanted), 1e-6)
      << found.x << ' ' << found.y << ' ' << found.z << " instead of " << wanted.x << ' '
      << wanted.y << ' ' << wanted.z;
}

TEST(OrbitCamera, OfALatheTheFrontViewHasZToTheRightAndXUp) {
  const Seen front = seen_from(StandardView::kFront, Standing::kInLathe);
  expect_same(front.right, {0, 0, 1});
  expect_same(front.up, {1, 0, 0});
  expect_same(front.back, {0, 1, 0});
  const Seen end = seen_from(StandardView::kRight, Standing::kInLathe);  // what the tailstock sees
  expect_same(end.back, {0, 0, 1});
  expect_same(end.up, {1, 0, 0});
  expect_same(seen_from(StandardView::kTop, Standing::kInLathe).back, {1, 0, 0});
  const Seen iso = seen_from(StandardView::kIsometric, Standing::kInLathe);
  expect_same(iso.back, Vec3(1) / std::sqrt(3.0));
}

TEST(OrbitCamera, ALatheAroundItStandsOnItsBed) {
  const Seen front = seen_from(StandardView::kFront, Standing::kOnLatheBed);
  expect_same(front.right, {0, 0, 1});
  expect_same(front.up, {0, 1, 0});
  expect_same(front.back, {-1, 0, 0});
}

TEST(OrbitCamera, EachWayUpIsATurnAndNoMirror) {
  for (const Standing standing : {Standing::kOnTable, Standing::kInLathe, Standing::kOnLatheBed}) {
    const Vec3 x = in_workpiece({1, 0, 0}, standing), y = in_workpiece({0, 1, 0}, standing);
    expect_same(glm::cross(x, y), up_of(standing));
  }
}

}  // namespace
}  // namespace kerf
