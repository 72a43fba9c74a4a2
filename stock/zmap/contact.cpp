#include "stock/zmap/contact.h"

#include <algorithm>
#include <cmath>

#include "stock/zmap/contact_sweep.h"
#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

constexpr double kNone = ShrunkSweep::kNone;

struct Found {
  double t = kNone;
  double depth = 0;
};

void scan_tile(const TileGrid& grid, const ShrunkSweep& sweep, int i0, int i1, int j0, int j1,
               double low_z, Found& found) {
  const Box& box = grid.bounds_mm();
  for (int j = j0; j < j1; ++j) {
    const double y = box.min.y + (j + 0.5) * grid.cell_y_mm();
    for (int i = i0; i < i1; ++i) {
      const double material = static_cast<double>(grid.height(i, j));
      if (material <= low_z || material <= box.min.z) continue;
      const double x = box.min.x + (i + 0.5) * grid.cell_x_mm();
      double t0, t1;
      if (!sweep.over(x, y, t0, t1)) continue;
      const double t_low = sweep.lowest(x, y, t0, t1);
      const double lowest = std::min(sweep.height(x, y, t_low),
                                     std::min(sweep.height(x, y, t0), sweep.height(x, y, t1)));
      const double bottom = std::max(lowest, box.min.z);
      if (material <= bottom) continue;
      found.depth = std::max(found.depth, material - bottom + sweep.tolerance);
      if (t0 < found.t) found.t = std::min(found.t, sweep.first_below(x, y, material, t0, t_low));
    }
  }
}

bool tile_rises_above(const float* tile, double z) {
  const float level = static_cast<float>(z);
  bool above = false;
  for (int i = 0; i < kTileFloats; ++i) above |= tile[i] > level;
  return above;
}

Found scan(const TileGrid& grid, const ShrunkSweep& sweep) {
  Found found;
  const Box& box = grid.bounds_mm();
  const Vec3 to = sweep.from + sweep.step;
  const double low_z =
      std::min(sweep.from.z, to.z) + surface_height(sweep.tool, 0) + sweep.tolerance;
  if (low_z >= box.max.z || sweep.reach() <= 0) return found;
  const auto cell = [](double position, double origin, double edge, int count) {
    return static_cast<int>(
        std::clamp(std::floor((position - origin) / edge), -1.0, static_cast<double>(count)));
  };
  const double r = sweep.reach();
  const int i0 =
      std::max(0, cell(std::min(sweep.from.x, to.x) - r, box.min.x, grid.cell_x_mm(), grid.nx()));
  const int i1 = std::min(grid.nx() - 1, cell(std::max(sweep.from.x, to.x) + r, box.min.x,
                                              grid.cell_x_mm(), grid.nx()));
  const int j0 =
      std::max(0, cell(std::min(sweep.from.y, to.y) - r, box.min.y, grid.cell_y_mm(), grid.ny()));
  const int j1 = std::min(grid.ny() - 1, cell(std::max(sweep.from.y, to.y) + r, box.min.y,
                                              grid.cell_y_mm(), grid.ny()));
  for (int ty = j0 / kTileCells; ty <= j1 / kTileCells && j0 <= j1; ++ty) {
    for (int tx = i0 / kTileCells; tx <= i1 / kTileCells && i0 <= i1; ++tx) {
      if (!tile_rises_above(grid.tile(tx, ty), low_z)) continue;
      scan_tile(grid, sweep, std::max(i0, tx * kTileCells), std::min(i1 + 1, (tx + 1) * kTileCells),
                std::max(j0, ty * kTileCells), std::min(j1 + 1, (ty + 1) * kTileCells), low_z,
                found);
    }
  }
  return found;
}

}  // namespace

std::optional<Contact> find_first_contact(const TileGrid& grid, std::span<const ConvexTool> tools,
                                          const CutMove& move, double tolerance_mm) {
  std::vector<Vec3> points;
  if (move.arc)
    points = arc_chord_points(move, tolerance_mm / 4);
  else
    points.push_back(move.to_mm);

  std::optional<Contact> contact;
  Vec3 from = move.from_mm;
  for (const Vec3& to : points) {
    Found first;
    for (const ConvexTool& tool : tools) {
      const Found found = scan(grid, {tool, tolerance_mm, from, to - from});
      first.t = std::min(first.t, found.t);
      first.depth = std::max(first.depth, found.depth);
    }
    if (first.t != kNone) {
      if (!contact) contact = Contact{from + first.t * (to - from), 0};
      contact->depth_mm = std::max(contact->depth_mm, first.depth);
    }
    from = to;
  }
  return contact;
}

}  // namespace kerf
