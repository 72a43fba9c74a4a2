#include "stock/zmap/tip_traces.h"

#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "mesh/mesh_lows.h"
#include "stock/zmap/cutter_components.h"
#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

/// A tool that rises by no more within half a cell's diagonal is not remembered, but counted as
/// uncertainty: a part of the tolerance of contacts.
constexpr double kLittleRise_mm = 0.002;
/// Arcs become chords within this: far within a cell, which the bound has to spare.
constexpr double kTraceChord_mm = 0.001;

}  // namespace

TipTraces::TipTraces(const TileGrid& grid)
    : x0_(grid.bounds_mm().min.x),
      y0_(grid.bounds_mm().min.y),
      cell_x_(grid.cell_x_mm()),
      cell_y_(grid.cell_y_mm()),
      half_diagonal_(0.5 * portable::hypot(cell_x_, cell_y_)),
      nx_(grid.nx()),
      ny_(grid.ny()),
      tiles_x_(grid.tiles_x()),
      tiles_(grid.tile_count()),
      own_(grid.tile_count(), 0) {}

TipTraces::TipTraces(const TipTraces& other)
    : x0_(other.x0_),
      y0_(other.y0_),
      cell_x_(other.cell_x_),
      cell_y_(other.cell_y_),
      half_diagonal_(other.half_diagonal_),
      nx_(other.nx_),
      ny_(other.ny_),
      tiles_x_(other.tiles_x_),
      any_(other.any_),
      rims_(other.rims_),
      border_full_(other.border_full_),
      boxes_(other.boxes_),
      slack_mm_(other.slack_mm_),
      tiles_(other.tiles_),
      own_(other.own_.size(), 0) {
  std::fill(other.own_.begin(), other.own_.end(), std::uint8_t{0});
}

void TipTraces::follow_sides(std::span<const BlankBody> bodies) {
  rims_ = RimTraces(bodies, std::max(cell_x_, cell_y_));
  border_full_ = bodies.size() == 1 && bodies[0].kind == BlankBody::Kind::kBox;
  boxes_.clear();
  for (const BlankBody& body : bodies) {
    if (body.kind == BlankBody::Kind::kBox) boxes_.push_back(body.bounds_mm);
  }
}

void TipTraces::follow_mesh(const TileGrid& grid, const MeshBody& body) {
  /// Less is rounding.
  constexpr double kLower_mm = 1e-4;
  rims_ = {};
  border_full_ = true;
  boxes_.clear();
  each_low_over_cells(body, {grid.bounds_mm(), nx_, ny_}, [&](std::size_t cell, double low_mm) {
    const int i = static_cast<int>(cell % static_cast<std::size_t>(nx_));
    const int j = static_cast<int>(cell / static_cast<std::size_t>(nx_));
    if (low_mm < static_cast<double>(grid.height(i, j)) - kLower_mm) lower(i, j, low_mm);
  });
}

/// How high a box was over all of the cell.
double TipTraces::full_to_mm(int i, int j) const {
  constexpr double kRounding_mm = 1e-6;
  const double x = x0_ + i * cell_x_, y = y0_ + j * cell_y_;
  double top = -std::numeric_limits<double>::infinity();
  for (const Box& box : boxes_) {
    const bool holds = box.min.x <= x + kRounding_mm && box.max.x >= x + cell_x_ - kRounding_mm &&
                       box.min.y <= y + kRounding_mm && box.max.y >= y + cell_y_ - kRounding_mm;
    if (holds) top = std::max(top, box.max.z);
  }
  return top;
}

TipTraces::Tip TipTraces::tip_of(std::span<const ConvexTool> tools) const {
  Tip tip;
  tip.low_mm = std::numeric_limits<double>::infinity();
  for (const ConvexTool& tool : tools) {
    const double low = surface_height(tool, 0);
    tip.low_mm = std::min(tip.low_mm, low);
    tip.radius_mm = std::max(tip.radius_mm, tool.radius);
    const bool thin = tool.radius < half_diagonal_;
    const double rise = thin ? 0 : surface_height(tool, half_diagonal_) - low;
    if (thin || rise > kLittleRise_mm) {
      tip.pointed = true;
    } else {
      tip.rise_mm = std::max(tip.rise_mm, rise);
    }
  }
  return tip;
}

double TipTraces::depth_mm(const TileGrid& grid, const Tip& tip, const CutMove& move,
                           const std::optional<Way>& held, double clear_mm) const {
  if (move.arc || !knows()) return 0;
  const Vec3 &a = move.from_mm, step = move.to_mm - move.from_mm;
  const auto is_clear = [&](double t) {
    if (!held) return true;
    const Vec2 way(held->second - held->first), at(a + t * step - held->first);
    const double length2 = glm::dot(way, way);
    const double along = length2 > 0 ? std::clamp(glm::dot(at, way) / length2, 0.0, 1.0) : 0.0;
    return glm::length(at - along * way) > clear_mm + 3 * half_diagonal_;
  };
  double depth = 0;
  each_cell(a, move.to_mm, [&](const Passage& p) {
    const double t = step.z < 0 ? p.t1 : p.t0;  // where it is lowest over the cell
    const double tip_z = std::max(a.z + t * step.z + tip.low_mm, grid.bounds_mm().min.z);
    if (!p.inside || tip_z + depth >= grid.bounds_mm().max.z || !is_clear(t)) return;
    depth = std::max(depth, lower_bound_mm(grid, p.i, p.j, 0) - tip_z);
  });
  return depth;
}

void TipTraces::add(const Tip& tip, const CutMove& move) {
  if (!knows()) return;
  slack_mm_ = std::max(slack_mm_, tip.rise_mm);
  const bool leaves = leaves_grid(move);
  const double beyond_mm = move.arc ? 2 * glm::length(move.from_mm - move.arc->center_mm) +
                                          glm::length(move.to_mm - move.from_mm)
                                    : 0;
  const bool rims =
      !rims_.empty() && rims_.is_near(move.from_mm, move.to_mm, beyond_mm, tip.radius_mm);
  if (!tip.pointed && !leaves && !rims) return;
  const auto add_way = [&](const Vec3& a, const Vec3& b) {
    if (rims) rims_.add(a, b, tip.radius_mm, tip.low_mm);
    if (tip.pointed) trace(tip, a, b);
    if (leaves) trace_border(tip, a, b);
  };
  if (!move.arc) return add_way(move.from_mm, move.to_mm);
  Vec3 from = move.from_mm;
  for (const Vec3& to : arc_chord_points(move, kTraceChord_mm)) {
    add_way(from, to);
    from = to;
  }
}

/// Some of the tip's way may be beside the grid.
bool TipTraces::leaves_grid(const CutMove& move) const {
  const Vec3 &a = move.from_mm, &b = move.to_mm;
  double beyond = 0;
  if (move.arc) beyond = glm::length(a - move.arc->center_mm) + glm::length(b - a);
  return std::min(a.x, b.x) - beyond < x0_ || std::min(a.y, b.y) - beyond < y0_ ||
         std::max(a.x, b.x) + beyond > x0_ + nx_ * cell_x_ ||
         std::max(a.y, b.y) + beyond > y0_ + ny_ * cell_y_;
}

void TipTraces::trace(const Tip& tip, const Vec3& a, const Vec3& b) {
  each_cell(a, b, [&](const Passage& p) {
    lower(p.i, p.j, a.z + std::min(p.t0 * (b.z - a.z), p.t1 * (b.z - a.z)) + tip.low_mm);
  });
}

void TipTraces::trace_border(const Tip& tip, const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 2; ++axis)
    for (const bool upper : {false, true}) trace_side(tip, a, b, axis, upper);
}

/// The cells along one side of the grid, as far as a tool reaches them whose tip is beyond it.
void TipTraces::trace_side(const Tip& tip, const Vec3& a, const Vec3& b, int axis, bool upper) {
  const double low[2] = {x0_, y0_}, edge[2] = {cell_x_, cell_y_};
  const int count[2] = {nx_, ny_}, along = 1 - axis;
  const double side = upper ? low[axis] + count[axis] * edge[axis] : low[axis];
  // Beyond the side, and no farther than the radius: out is 0 .. radius.
  const auto out = [&](const Vec3& p) { return upper ? p[axis] - side : side - p[axis]; };
  const double from = out(a), step = out(b) - from;
  double t0 = 0, t1 = 1;
  if (step == 0) {
    if (from < 0 || from > tip.radius_mm) return;
  } else {
    const double near = -from / step, far = (tip.radius_mm - from) / step;
    t0 = std::max(t0, std::min(near, far));
    t1 = std::min(t1, std::max(near, far));
    if (t0 > t1) return;
  }
  const Vec3 p = a + t0 * (b - a), q = a + t1 * (b - a);
  const auto cell = [&](double place) {
    return static_cast<int>(std::clamp(std::floor((place - low[along]) / edge[along]), -1.0,
                                       static_cast<double>(count[along])));
  };
  const int first = std::max(0, cell(std::min(p[along], q[along]) - tip.radius_mm));
  const int last = std::min(count[along] - 1, cell(std::max(p[along], q[along]) + tip.radius_mm));
  const double z = std::min(p.z, q.z) + tip.low_mm;
  const int border = upper ? count[axis] - 1 : 0;
  for (int n = first; n <= last; ++n) lower(axis == 0 ? border : n, axis == 0 ? n : border, z);
}

void TipTraces::lower(int i, int j, double z) {
  const std::size_t index = tile_index(i, j);
  std::shared_ptr<Tile>& tile = tiles_[index];
  if (!own_[index]) {
    const std::shared_ptr<Tile> shared = tile;
    tile = shared ? std::make_shared<Tile>(*shared) : std::make_shared<Tile>();
    if (!shared) tile->fill(std::numeric_limits<float>::infinity());
    own_[index] = 1;
    any_ = true;
  }
  float& lowest = (*tile)[TileGrid::offset(i, j)];
  lowest = std::min(lowest, static_cast<float>(z));
}

double TipTraces::lower_bound_mm(const TileGrid& grid, int i, int j, double margin_mm) const {
  const auto around = [&](double cell_mm) {
    return static_cast<int>(std::ceil((margin_mm + half_diagonal_) / cell_mm));
  };
  const int wide_x = around(cell_x_), wide_y = around(cell_y_);
  double lowest = std::numeric_limits<double>::infinity();
  for (int y = std::max(0, j - wide_y); y <= std::min(ny_ - 1, j + wide_y); ++y) {
    for (int x = std::max(0, i - wide_x); x <= std::min(nx_ - 1, i + wide_x); ++x) {
      lowest = std::min(lowest, static_cast<double>(grid.height(x, y)));
      if (any_) lowest = std::min(lowest, at(x, y));
    }
  }
  const bool at_border = i < wide_x || j < wide_y || i >= nx_ - wide_x || j >= ny_ - wide_y;
  if (at_border && !border_full_) lowest = std::min(lowest, full_to_mm(i, j));
  return std::max(lowest - slack_mm_, static_cast<double>(grid.floor_mm()));
}

}  // namespace kerf
