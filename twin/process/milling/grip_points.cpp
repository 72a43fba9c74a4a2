#include "twin/process/milling/grip_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "base/mesh_patch.h"
#include "twin/collision/solid.h"

namespace kerf {
namespace {

/// Nearer than that they touch: what is drawn and measured by hand, and walls of cells.
constexpr double kTouches_mm = 0.05;
/// Places of a triangle that are looked at are no farther apart, and so many at most along a side.
constexpr double kApart_mm = 1;
constexpr int kMostAlong = 64;
/// A face that looks down more than that lies on something.
constexpr double kLooksDown = -0.7;
/// So many are enough for any piece to have one.
constexpr std::size_t kMostPoints = 20'000;

bool overlaps(const Box& a, const Box& b, double margin_mm) {
  return box_gap_mm(a, b) <= margin_mm;
}

bool touches(const Fixture& fixture, const Vec3& point) {
  const std::array<Vec3, 1> corner{point};
  MovingConvex moving;
  moving.solid.kind = Convex::Kind::kHull;
  moving.solid.corners = corner;
  moving.from = moving.to = fixture.fixture_from_workpiece;
  if (fixture.solid->gap_to(moving, kTouches_mm, kTouches_mm / 10).high_mm <= kTouches_mm)
    return true;
  return fixture.solid->encloses(fixture.fixture_from_workpiece.point(point));
}

}  // namespace

std::vector<Vec3> grip_points(const StockModel& stock, const FixtureList& fixtures) {
  std::vector<Vec3> out;
  if (!fixtures) return out;
  const double inside_mm = stock.cell_mm() / 2;
  for (const Fixture& fixture : *fixtures) {
    if (!fixture.on.empty()) continue;
    const Box box = box_around(fixture.workpiece_from_fixture, fixture.solid->box_mm());
    if (!overlaps(box, stock.bounds_mm(), kTouches_mm)) continue;
    for (std::uint32_t tile = 0; tile < stock.tile_count(); ++tile) {
      if (!overlaps(box, stock.tile_box(tile), stock.cell_mm())) continue;
      const MeshPatch patch = stock.patch(tile, 0);
      const std::span<const std::uint32_t> indices = patch.surface_indices();
      for (std::size_t n = 0; n + 2 < indices.size() && out.size() < kMostPoints; n += 3) {
        const Vec3 a(patch.vertices[indices[n]].position_mm);
        const Vec3 u = Vec3(patch.vertices[indices[n + 1]].position_mm) - a;
        const Vec3 v = Vec3(patch.vertices[indices[n + 2]].position_mm) - a;
        const Vec3 cross = glm::cross(u, v);
        const double area = glm::length(cross);
        if (area == 0 || cross.z / area < kLooksDown) continue;
        Box around;
        for (const Vec3& corner : {a, a + u, a + v}) around.extend(corner);
        if (!overlaps(around, box, kTouches_mm)) continue;
        const double longest = std::max({glm::length(u), glm::length(v), glm::length(u - v)});
        const int along =
            std::clamp(static_cast<int>(std::ceil(longest / kApart_mm)), 1, kMostAlong);
        // Middles of the small triangles that stand as it does: never on its border.
        for (int i = 0; i < along; ++i) {
          for (int j = 0; i + j < along; ++j) {
            const Vec3 at = a + (i + 1.0 / 3) / along * u + (j + 1.0 / 3) / along * v;
            if (touches(fixture, at)) out.push_back(at - inside_mm / area * cross);
          }
        }
      }
    }
  }
  return out;
}

}  // namespace kerf
