#include "stock/zmap/contact.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "stock/zmap/contact_sweep.h"
#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

constexpr double kNone = ShrunkSweep::kNone;
/// Tiles within so many cells of a cell count for it where they are hollow.
constexpr int kAround = 2;

/// t < 0: in a piece before.
struct Found {
  double t = kNone;
  double depth = 0;
};

/// A convex tool on a straight piece of a move. Goes on from what has been found.
class Scan {
 public:
  Scan(const ContactField& field, const ConvexTool& tool, double tolerance, const Vec3& from,
       const Vec3& step, const Found& found)
      : grid_(field.grid), field_(field), sweep_{tool, tolerance, from, step}, found_(found) {
    lowest_z_ = std::min(from.z, from.z + step.z);
    low_z_ = lowest_z_ + surface_height(tool, 0) + tolerance;
    half_diagonal_ = 0.5 * portable::hypot(grid_.cell_x_mm(), grid_.cell_y_mm());
    floor_z_ = std::max(grid_.bounds_mm().min.z, static_cast<double>(grid_.floor_mm()));
  }
  Found run();

 private:
  void scan_tile(int i0, int i1, int j0, int j1);
  bool tile_rises_above(const float* tile) const;
  double nearest(double x, double y) const;
  /// Nothing is met earlier than at the start, and this not deeper than what was.
  bool says_nothing_new(double material, double low) const {
    return found_.t <= 0 && material - std::max(low, floor_z_) <= found_.depth + 1e-9;
  }
  void check_middle(double x, double y, double near, double material);
  void check_area(int i, int j, double x, double y, double near);
  bool is_hollow_around(int i, int j) const;

  const TileGrid& grid_;
  const ContactField& field_;
  ShrunkSweep sweep_;
  double lowest_z_ = 0;  ///< of the tip
  double low_z_ = 0;     ///< nothing below is told
  double half_diagonal_ = 0;
  /// Of the blank, as a cell has it that is cut through: heights are floats, and may be above.
  double floor_z_ = 0;
  Found found_;
};

bool Scan::tile_rises_above(const float* tile) const {
  const float level = static_cast<float>(low_z_);
  bool above = false;
  for (int i = 0; i < kTileFloats; ++i) above |= tile[i] > level;
  return above;
}

void Scan::check_middle(double x, double y, double near, double material) {
  if (near > sweep_.reach()) return;
  const double radius = std::min(near + sweep_.tolerance, sweep_.tool.radius);
  const double low = lowest_z_ + surface_height(sweep_.tool, radius) + sweep_.tolerance;
  if (material <= low || says_nothing_new(material + sweep_.tolerance, low)) return;
  double t0, t1;
  if (sweep_.reach() <= 0 || !sweep_.over(x, y, t0, t1)) return;
  const double t_low = sweep_.lowest(x, y, t0, t1);
  const double lowest = std::min(sweep_.height(x, y, t_low),
                                 std::min(sweep_.height(x, y, t0), sweep_.height(x, y, t1)));
  const double bottom = std::max(lowest, floor_z_);
  if (material <= bottom) return;
  found_.depth = std::max(found_.depth, material - bottom + sweep_.tolerance);
  if (t0 < found_.t) found_.t = std::min(found_.t, sweep_.first_below(x, y, material, t0, t_low));
}

/// How far the tool's axis stays from (x, y).
double Scan::nearest(double x, double y) const {
  const double length2 = sweep_.step.x * sweep_.step.x + sweep_.step.y * sweep_.step.y;
  const double px = x - sweep_.from.x, py = y - sweep_.from.y;
  const double along =
      length2 > 0 ? std::clamp((px * sweep_.step.x + py * sweep_.step.y) / length2, 0.0, 1.0) : 0.0;
  const double dx = px - along * sweep_.step.x, dy = py - along * sweep_.step.y;
  return std::sqrt(dx * dx + dy * dy);
}

/// With gaps below the heights the bound of TipTraces does not hold.
bool Scan::is_hollow_around(int i, int j) const {
  if (!field_.is_hollow) return false;
  for (const int y : {std::max(0, j - kAround), std::min(grid_.ny() - 1, j + kAround)}) {
    for (const int x : {std::max(0, i - kAround), std::min(grid_.nx() - 1, i + kAround)}) {
      if (field_.is_hollow(static_cast<std::size_t>(y / kTileCells * grid_.tiles_x()) +
                           static_cast<std::size_t>(x / kTileCells)))
        return true;
    }
  }
  return false;
}

void Scan::check_area(int i, int j, double x, double y, double near) {
  const double top = static_cast<double>(grid_.height(i, j));
  const double radius = std::min(std::max(0.0, near - half_diagonal_), sweep_.tool.radius);
  const double low = lowest_z_ + surface_height(sweep_.tool, radius);
  if (top - sweep_.tolerance <= low || says_nothing_new(top, low)) return;
  const double material = field_.traces.lower_bound_mm(grid_, i, j, sweep_.tolerance);
  if (material <= low_z_ || material <= floor_z_ + sweep_.tolerance) return;
  if (is_hollow_around(i, j)) return;
  // What is no deeper than the tolerance in the sides of the blank is not told.
  const double half_x = 0.5 * grid_.cell_x_mm(), half_y = 0.5 * grid_.cell_y_mm();
  const double in = std::min({sweep_.tolerance, half_x, half_y});
  const AreaSweep area{sweep_.tool,
                       sweep_.from,
                       sweep_.step,
                       x - half_x + (i == 0 ? in : 0),
                       y - half_y + (j == 0 ? in : 0),
                       x + half_x - (i + 1 == grid_.nx() ? in : 0),
                       y + half_y - (j + 1 == grid_.ny() ? in : 0)};
  double t0, t1;
  if (!area.over(t0, t1)) return;
  const double t_low = area.lowest(t0, t1);
  const double bottom = area.height(t_low), level = material - sweep_.tolerance;
  if (bottom >= level) return;
  found_.depth = std::max(found_.depth, material - std::max(bottom, floor_z_));
  if (t0 < found_.t) found_.t = std::min(found_.t, area.first_below(level, t0, t_low));
}

void Scan::scan_tile(int i0, int i1, int j0, int j1) {
  const Box& box = grid_.bounds_mm();
  for (int j = j0; j < j1; ++j) {
    const double y = box.min.y + (j + 0.5) * grid_.cell_y_mm();
    for (int i = i0; i < i1; ++i) {
      const double material = static_cast<double>(grid_.height(i, j));
      if (material <= low_z_ || material <= floor_z_) continue;
      const double x = box.min.x + (i + 0.5) * grid_.cell_x_mm();
      const double near = nearest(x, y);
      if (near > sweep_.tool.radius + half_diagonal_) continue;
      if (field_.middles) check_middle(x, y, near, material);
      check_area(i, j, x, y, near);
    }
  }
}

Found Scan::run() {
  const Box& box = grid_.bounds_mm();
  const Vec3 &from = sweep_.from, to = from + sweep_.step;
  if (low_z_ >= box.max.z) return found_;
  const auto cell = [](double position, double origin, double edge, int count) {
    return static_cast<int>(
        std::clamp(std::floor((position - origin) / edge), -1.0, static_cast<double>(count)));
  };
  const auto column = [&](double x) { return cell(x, box.min.x, grid_.cell_x_mm(), grid_.nx()); };
  const auto row = [&](double y) { return cell(y, box.min.y, grid_.cell_y_mm(), grid_.ny()); };
  const double r = sweep_.tool.radius;
  const int i0 = std::max(0, column(std::min(from.x, to.x) - r));
  const int i1 = std::min(grid_.nx() - 1, column(std::max(from.x, to.x) + r));
  const int j0 = std::max(0, row(std::min(from.y, to.y) - r));
  const int j1 = std::min(grid_.ny() - 1, row(std::max(from.y, to.y) + r));
  for (int ty = j0 / kTileCells; ty <= j1 / kTileCells && j0 <= j1; ++ty) {
    for (int tx = i0 / kTileCells; tx <= i1 / kTileCells && i0 <= i1; ++tx) {
      if (!tile_rises_above(grid_.tile(tx, ty))) continue;
      scan_tile(std::max(i0, tx * kTileCells), std::min(i1 + 1, (tx + 1) * kTileCells),
                std::max(j0, ty * kTileCells), std::min(j1 + 1, (ty + 1) * kTileCells));
    }
  }
  return found_;
}

}  // namespace

std::optional<Contact> find_first_contact(const ContactField& field,
                                          std::span<const ConvexTool> tools, const CutMove& move,
                                          double tolerance_mm) {
  std::vector<Vec3> points;
  if (move.arc)
    points = arc_chord_points(move, tolerance_mm / 4);
  else
    points.push_back(move.to_mm);

  std::optional<Contact> contact;
  Vec3 from = move.from_mm;
  for (const Vec3& to : points) {
    Found first;
    if (contact) first = {-1, contact->depth_mm};
    for (const ConvexTool& tool : tools) {
      first = Scan(field, tool, tolerance_mm, from, to - from, first).run();
      const RimTraces::Touch rim =
          field.traces.rims().first_touch(tool, {from, to - from}, tolerance_mm);
      first.t = std::min(first.t, rim.t);
      first.depth = std::max(first.depth, rim.depth_mm);
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
