#include "twin/diff/part_diff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/translate.h"
#include "surface/height_grid.h"
#include "twin/compare/design_part.h"

namespace kerf {
namespace {

/// Points of a surface that are looked at: a cell apart, or so that there are no more.
constexpr double kMostPoints = 2e6;
constexpr double kPointsWithoutCells_mm = 0.1;
/// Of distances: none is.
constexpr double kBeyond_mm = 1e6;

/// Of the cells around (i, j), itself included.
struct HeightRange {
  float least = 0, most = 0;
  HeightRange(const HeightGrid& grid, int i, int j) {
    least = most = grid.height(i, j);
    for (int y = std::max(0, j - 1); y <= std::min(grid.ny() - 1, j + 1); ++y) {
      for (int x = std::max(0, i - 1); x <= std::min(grid.nx() - 1, i + 1); ++x) {
        const float height = grid.height(x, y);
        least = std::min(least, height);
        most = std::max(most, height);
      }
    }
  }
  bool holds(double height, double slack) const {
    return height >= double{least} - slack && height <= double{most} + slack;
  }
};

bool same_cells(const HeightGrid& a, const HeightGrid& b) {
  return a.nx() == b.nx() && a.ny() == b.ny() && a.bounds_mm().min == b.bounds_mm().min &&
         a.bounds_mm().max == b.bounds_mm().max;
}

std::optional<CutLabel> cut_at(const DiffedPart& part, const Vec3& at_mm) {
  if (part.labels == nullptr) return std::nullopt;
  const std::optional<std::uint32_t> id = part.stock->cut_id_at(at_mm);
  if (!id || *id >= part.labels->all().size()) return std::nullopt;
  return part.labels->all()[*id];
}

void diff_heights(const DiffedPart& a, const DiffedPart& b, const HeightGrid& heights_a,
                  const HeightGrid& heights_b, double tolerance_mm, PartDiff& out) {
  const double cell_mm2 = heights_a.cell_x_mm() * heights_a.cell_y_mm();
  const Vec3 corner = heights_a.bounds_mm().min;
  Vec3 at_a{0}, at_b{0};
  for (int j = 0; j < heights_a.ny(); ++j) {
    for (int i = 0; i < heights_a.nx(); ++i) {
      const double height_a = double{heights_a.height(i, j)};
      const double height_b = double{heights_b.height(i, j)};
      const double apart_mm = std::abs(height_a - height_b);
      if (apart_mm <= tolerance_mm) {
        out.most_mm = std::max(out.most_mm, apart_mm);
        continue;
      }
      out.area_mm2 += cell_mm2;
      (height_a > height_b ? out.a_more_mm3 : out.b_more_mm3) += apart_mm * cell_mm2;
      if (HeightRange(heights_a, i, j).holds(height_b, tolerance_mm) &&
          HeightRange(heights_b, i, j).holds(height_a, tolerance_mm)) {
        ++out.wall_cells;
        continue;
      }
      if (apart_mm <= out.most_mm) continue;
      out.most_mm = apart_mm;
      const Vec3 middle{corner.x + (i + 0.5) * heights_a.cell_x_mm(),
                        corner.y + (j + 0.5) * heights_a.cell_y_mm(), 0};
      at_a = {middle.x, middle.y, height_a};
      at_b = {middle.x, middle.y, height_b};
    }
  }
  out.by_heights = true;
  if (out.most_mm <= tolerance_mm) return;
  out.at_mm = at_a.z < at_b.z ? at_a : at_b;
  out.a_cut = cut_at(a, at_a);
  out.b_cut = cut_at(b, at_b);
}

using Corners = std::array<Vec3, 3>;

/// The corners, the longest edge between the first two.
Corners corners_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  Corners c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = Vec3(mesh.positions_mm[triangle[i]]);
  std::size_t longest = 0;
  const auto edge_mm = [&](std::size_t i) { return glm::length(c[(i + 1) % 3] - c[i]); };
  for (std::size_t i = 1; i < 3; ++i) longest = edge_mm(i) > edge_mm(longest) ? i : longest;
  std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(longest), c.end());
  return c;
}

double area_mm2(const Corners& c) { return glm::length(glm::cross(c[1] - c[0], c[2] - c[0])) / 2; }

/// Points all over a triangle, its corners among them: in rows along its longest edge, rows and
/// points at most `spacing_mm` apart.
template <class Point>
void for_each_point(const Corners& c, double spacing_mm, const Point& point) {
  const auto parts = [&](double length_mm) {
    return std::max(1, static_cast<int>(std::ceil(length_mm / spacing_mm)));
  };
  const double base_mm = glm::length(c[1] - c[0]);
  const int rows = base_mm > 0 ? parts(2 * area_mm2(c) / base_mm) : 1;
  for (int row = 0; row <= rows; ++row) {
    const double up = static_cast<double>(row) / rows;
    const Vec3 from = c[0] + up * (c[2] - c[0]), to = c[1] + up * (c[2] - c[1]);
    const int steps = row == rows ? 0 : parts(glm::length(to - from));
    for (int i = 0; i <= steps; ++i) {
      point(steps == 0 ? from : from + (static_cast<double>(i) / steps) * (to - from));
    }
  }
}

/// Of the points of a surface those that are farthest from the other one.
void farthest(const TriangleMesh& mesh, const DesignPart& other, double cell_mm, PartDiff& out) {
  double whole_mm2 = 0;
  for (const auto& triangle : mesh.triangles) whole_mm2 += area_mm2(corners_of(mesh, triangle));
  const double spacing_mm = std::max(cell_mm, std::sqrt(whole_mm2 / kMostPoints));
  DesignProbe probe(other);
  for (const auto& triangle : mesh.triangles) {
    for_each_point(corners_of(mesh, triangle), spacing_mm, [&](const Vec3& place) {
      const double mm = std::abs(probe.distance_mm(place, kBeyond_mm));
      if (mm <= out.most_mm) return;
      out.most_mm = mm;
      out.at_mm = place;
    });
  }
}

void diff_meshes(const DiffedPart& a, const DiffedPart& b, double tolerance_mm, PartDiff& out) {
  const double mesh_mm = tolerance_mm / 4;
  const TriangleMesh mesh_a = a.stock->mesh(mesh_mm), mesh_b = b.stock->mesh(mesh_mm);
  if (mesh_a.triangles.empty() || mesh_b.triangles.empty()) {
    out.not_compared = tr("nothing is left of one of them");
    return;
  }
  Diagnostics unheard;  // of holes in meshes of our own there is nothing to say
  // Of models without cells (sheets, turned parts) the points need a distance all the same.
  const double cell_mm = out.cell_mm > 0 ? out.cell_mm : kPointsWithoutCells_mm;
  farthest(mesh_a, DesignPart(mesh_b, "B", unheard), cell_mm, out);
  farthest(mesh_b, DesignPart(mesh_a, "A", unheard), cell_mm, out);
  if (out.most_mm <= tolerance_mm) return;
  out.a_cut = cut_at(a, out.at_mm);
  out.b_cut = cut_at(b, out.at_mm);
}

}  // namespace

PartDiff diff_parts(const DiffedPart& a, const DiffedPart& b, double tolerance_mm,
                    bool walls_count) {
  PartDiff out;
  out.a_mm3 = a.stock->remaining_mm3();
  out.b_mm3 = b.stock->remaining_mm3();
  out.cell_mm = std::max(a.stock->cell_mm(), b.stock->cell_mm());
  out.equal_bits = a.stock->name() == b.stock->name() && a.stock->digest() == b.stock->digest();
  if (out.equal_bits) {
    out.same = true;
    return out;
  }
  const auto heights_a = a.stock->height_grid(), heights_b = b.stock->height_grid();
  // Heights from above tell nothing of undercuts.
  const bool plain = a.stock->name() == "zmap" && b.stock->name() == "zmap";
  if (plain && heights_a && heights_b && same_cells(*heights_a, *heights_b)) {
    diff_heights(a, b, *heights_a, *heights_b, tolerance_mm, out);
    out.same = out.most_mm <= tolerance_mm && (out.wall_cells == 0 || !walls_count);
  } else {
    diff_meshes(a, b, tolerance_mm, out);
    out.same = out.not_compared.empty() && out.most_mm <= tolerance_mm;
  }
  return out;
}

}  // namespace kerf
