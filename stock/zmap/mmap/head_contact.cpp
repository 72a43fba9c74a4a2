#include "stock/zmap/mmap/head_contact.h"

#include <glm/geometric.hpp>
#include <vector>

#include "stock/zmap/contact_sweep.h"
#include "stock/zmap/path_builder.h"

namespace kerf {
namespace {

constexpr double kNoContact = ShrunkSweep::kNone;

struct Found {
  double t = kNoContact;
  double depth = 0;
};

/// The part of t0..t1 in which a convex height is below a level; empty if `from` > `to`.
struct Span {
  double from = 1, to = 0;
};

/// Both sides of a head over one column. The upper one is turned over (HeadedTool::upper).
class ColumnSweep {
 public:
  ColumnSweep(const ShrunkSweep& sweep, double x, double y, double t0, double t1)
      : sweep_(sweep), x_(x), y_(y), t0_(t0), t1_(t1), t_low_(sweep.lowest(x, y, t0, t1)) {
    for (const double t : {t0, t1})
      if (sweep.height(x, y, t) < sweep.height(x, y, t_low_)) t_low_ = t;
    lowest_ = sweep.height(x, y, t_low_);
  }
  double lowest() const { return lowest_; }
  Span below(double level) const {
    if (!(lowest_ < level)) return {};
    return {edge(t0_, level), edge(t1_, level)};
  }

 private:
  /// Between `end` and the lowest point, where the height passes the level.
  double edge(double end, double level) const {
    if (sweep_.height(x_, y_, end) < level) return end;
    double above = end, below = t_low_;
    for (int i = 0; i < 50; ++i) {
      const double t = 0.5 * (above + below);
      (sweep_.height(x_, y_, t) < level ? below : above) = t;
    }
    return below;
  }
  const ShrunkSweep& sweep_;
  double x_, y_, t0_, t1_, t_low_, lowest_ = 0;
};

/// A straight piece of a move.
class HeadScan {
 public:
  HeadScan(const TileGrid& grid, const GapGrid& gaps, const HeadedTool& tool, const Vec3& from,
           const Vec3& to, double tolerance)
      : grid_(grid), gaps_(gaps), from_(from), to_(to), tolerance_(tolerance) {
    const Vec3 step = to - from;
    for (const ConvexTool& side : tool.lower) lower_.push_back({side, tolerance, from, step});
    const Vec3 from_over(from.x, from.y, -from.z), step_over(step.x, step.y, -step.z);
    for (const ConvexTool& side : tool.upper)
      upper_.push_back({side, tolerance, from_over, step_over});
    reach_ = tool.radius_mm - tolerance;
    low_z_ = std::min(from.z, to.z) + tolerance;
  }

  Found run() {
    const Box& box = grid_.bounds_mm();
    if (reach_ <= 0 || low_z_ >= box.max.z) return found_;
    const auto cell = [](double at, double origin, double edge, int count) {
      return static_cast<int>(
          std::clamp(std::floor((at - origin) / edge), -1.0, static_cast<double>(count)));
    };
    const auto column = [&](double x) { return cell(x, box.min.x, grid_.cell_x_mm(), grid_.nx()); };
    const auto row = [&](double y) { return cell(y, box.min.y, grid_.cell_y_mm(), grid_.ny()); };
    const int i0 = std::max(0, column(std::min(from_.x, to_.x) - reach_));
    const int i1 = std::min(grid_.nx() - 1, column(std::max(from_.x, to_.x) + reach_));
    const int j0 = std::max(0, row(std::min(from_.y, to_.y) - reach_));
    const int j1 = std::min(grid_.ny() - 1, row(std::max(from_.y, to_.y) + reach_));
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i)
        if (static_cast<double>(grid_.height(i, j)) > low_z_) scan_cell(i, j);
    }
    return found_;
  }

 private:
  void scan_cell(int i, int j) {
    const Box& box = grid_.bounds_mm();
    if (!(grid_.height(i, j) > grid_.floor_mm())) return;
    const double x = box.min.x + (i + 0.5) * grid_.cell_x_mm();
    const double y = box.min.y + (j + 0.5) * grid_.cell_y_mm();
    for (const ShrunkSweep& low : lower_) {
      double low0, low1;
      if (!low.over(x, y, low0, low1)) continue;
      const ColumnSweep lower(low, x, y, low0, low1);
      for (const ShrunkSweep& high : upper_) {
        double high0, high1;
        if (!high.over(x, y, high0, high1)) continue;
        check(i, j, lower, ColumnSweep(high, x, y, high0, high1));
      }
    }
  }

  void check(int i, int j, const ColumnSweep& lower, const ColumnSweep& upper) {
    const double swept_low = lower.lowest(), swept_high = -upper.lowest();
    if (!(swept_low < swept_high)) return;
    double top = static_cast<double>(grid_.height(i, j)), depth = 0;
    const auto material = [&](double bottom) {
      if (top <= swept_low || bottom >= swept_high) return;
      const Span from_above = lower.below(top), from_below = upper.below(-bottom);
      const double t = std::max(from_above.from, from_below.from);
      if (t > std::min(from_above.to, from_below.to)) return;
      depth += std::min(top, swept_high) - std::max(bottom, swept_low);
      found_.t = std::min(found_.t, t);
    };
    const std::size_t tile =
        static_cast<std::size_t>(j / kTileCells * grid_.tiles_x() + i / kTileCells);
    if (const GapTile* const gaps = gaps_.tile(tile)) {
      gaps->each(TileGrid::offset(i, j), [&](const Gap& gap) {
        material(static_cast<double>(gap.high));
        top = static_cast<double>(gap.low);
      });
    }
    if (top > static_cast<double>(grid_.floor_mm()))
      material(static_cast<double>(grid_.floor_mm()));
    if (depth > 0) found_.depth = std::max(found_.depth, depth + tolerance_);
  }

  const TileGrid& grid_;
  const GapGrid& gaps_;
  Vec3 from_, to_;
  double tolerance_, reach_ = 0;
  double low_z_ = 0;  ///< the head is nowhere below
  std::vector<ShrunkSweep> lower_, upper_;
  Found found_;
};

/// How far along a move a point of its path lies, as a number that grows.
double order_along(const CutMove& move, const Vec3& point) {
  if (!move.arc) return glm::dot(point - move.from_mm, move.to_mm - move.from_mm);
  const std::vector<Vec3> points = arc_chord_points(move, kChordTolerance_mm);
  double best = 0, nearest = kNoContact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = glm::length(points[i] - point);
    if (distance >= nearest) continue;
    nearest = distance;
    best = static_cast<double>(i);
  }
  return best;
}

}  // namespace

std::optional<Contact> find_head_contact(const TileGrid& grid, const GapGrid& gaps,
                                         const HeadedTool& tool, const CutMove& move,
                                         double tolerance_mm) {
  std::optional<Contact> contact;
  if (tool.upper.empty()) return contact;
  const std::vector<Vec3> points =
      move.arc ? arc_chord_points(move, tolerance_mm / 4) : std::vector<Vec3>{move.to_mm};
  Vec3 from = move.from_mm;
  for (const Vec3& to : points) {
    const Found found = HeadScan(grid, gaps, tool, from, to, tolerance_mm).run();
    if (found.t != kNoContact) {
      if (!contact) contact = Contact{from + found.t * (to - from), 0};
      contact->depth_mm = std::max(contact->depth_mm, found.depth);
    }
    from = to;
  }
  return contact;
}

std::optional<Contact> earlier_contact(const CutMove& move, const std::optional<Contact>& a,
                                       const std::optional<Contact>& b) {
  if (!a || !b) return a ? a : b;
  Contact first = order_along(move, a->tip_mm) <= order_along(move, b->tip_mm) ? *a : *b;
  first.depth_mm = std::max(a->depth_mm, b->depth_mm);
  return first;
}

}  // namespace kerf
