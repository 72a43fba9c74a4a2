#include "stock/octree/part_contact.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "base/portable_math.h"
#include "stock/octree/blank_contact.h"
#include "stock/octree/brick_cut.h"
#include "stock/octree/brick_finder.h"
#include "stock/octree/part_bodies.h"
#include "stock/octree/part_points.h"
#include "stock/octree/sweep.h"

namespace kerf::octree {
namespace {

/// Where part and flutes come to a point within so much of their way, the flutes were first: there
/// they meet.
constexpr double kAtOnce_mm = 0.001;
/// Times and depths are found to 2^-n of the way, and of the depths that there can be.
constexpr int kHalvings = 24;
constexpr int kDeepest =
    40;  ///< of halving a move; its last part is shorter than kAtOnce_mm before

double turn_of(const CutMove& move) {
  return portable::atan2(glm::length(glm::cross(move.axis_from, move.axis_to)),
                         glm::dot(move.axis_from, move.axis_to));
}

/// No point of a tool within `reach_mm` of its tip goes farther.
double way_of(const CutMove& move, double reach_mm) {
  double way = glm::length(move.to_mm - move.from_mm);
  if (move.arc) {
    const double radius = std::max(glm::length(move.from_mm - move.arc->center_mm),
                                   glm::length(move.to_mm - move.arc->center_mm));
    way += radius * std::abs(move.arc->sweep_rad);
  }
  return way + turn_of(move) * reach_mm;
}

class PartSearch {
 public:
  PartSearch(const PartField& field, std::span<const ToolBody> flutes, const CarriedPart& part,
             const CutMove& move, double tolerance_mm)
      : field_(field),
        flutes_(flutes.begin(), flutes.end()),
        part_(part),
        move_(move),
        tolerance_mm_(tolerance_mm),
        blank_(field.tree.lattice(), field.kernel, field.blank) {
    const Lattice& lattice = field.tree.lattice();
    bounds_ = lattice.bounds_mm;
    bounds_.min -= lattice.cell_mm;
    bounds_.max += lattice.cell_mm;
    reach_mm_ = glm::length(bounds_.size()) + glm::length(move.to_mm - move.from_mm);
    way_mm_ = way_of(move, reach_mm_);
  }
  std::optional<PartContact> run();

 private:
  double depth_mm();
  std::vector<Sweep> sweeps_of(const std::vector<ToolBody>& bodies, const CutMove& move,
                               double shrink_mm) const {
    std::vector<Sweep> sweeps;
    const double chord = chord_mm(glm::length(field_.tree.lattice().cell_mm));
    append_sweeps(bodies, move, 0, {bounds_, chord, shrink_mm}, sweeps);
    return sweeps;
  }
  bool is_reached(const std::vector<Sweep>& cut, const Box& block) const;
  void collect();
  void look_at_blank(int bx, int by, int bz, const std::vector<Sweep>& part,
                     const std::vector<Sweep>& cut);
  bool touches(double until, double raised_mm);
  bool meets(const std::vector<ToolBody>& part, PartPoints& points, double from, double to,
             int level);
  std::vector<ToolBody> raised(double by_mm) const { return {part_body(part_, by_mm)}; }

  const PartField& field_;
  std::vector<ToolBody> flutes_;
  CarriedPart part_;
  CutMove move_;
  double tolerance_mm_;
  BlankContact blank_;
  Box bounds_;
  double reach_mm_ = 0, way_mm_ = 0;
  PartPoints points_;        ///< of material within the part's sweep
  std::vector<Box> blocks_;  ///< untouched, not reached by the flutes, and the part touches there
};

/// By any of what the flutes sweep.
bool PartSearch::is_reached(const std::vector<Sweep>& cut, const Box& block) const {
  PartPoints middle;
  middle.add(0.5 * (block.min + block.max));
  std::vector<double> f;
  field_of(field_.kernel, cut, middle, f);
  return f[0] <= 0.5 * glm::length(block.size());
}

void PartSearch::look_at_blank(int bx, int by, int bz, const std::vector<Sweep>& part,
                               const std::vector<Sweep>& cut) {
  for (unsigned bits = field_.tree.untouched(bx, by, bz); bits != 0; bits &= bits - 1) {
    const Box block = blank_.block_of(bx, by, bz, std::countr_zero(bits));
    for (const Sweep& sweep : part) {
      const std::optional<Vec3> point = blank_.point_in(sweep, block);
      if (!point) continue;
      if (!is_reached(cut, block)) {
        blocks_.push_back(block);
        break;
      }
      points_.add(*point);
    }
  }
}

void PartSearch::collect() {
  const std::vector<ToolBody> body = raised(0);
  const std::vector<Sweep> part = sweeps_of(body, move_, tolerance_mm_);
  if (part.empty()) return;
  BrickFinder finder(field_.tree, field_.kernel);
  struct Place {
    int z, y, x;
    bool operator==(const Place&) const = default;
    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places;
  double within = 0;
  for (const Sweep& sweep : part)
    finder.find(sweep, within, [&](int bx, int by, int bz, const BrickRef&, double) {
      places.push_back({bz, by, bx});
    });
  if (places.empty()) return;
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const std::vector<Sweep> cut = sweeps_of(flutes_, move_, -tolerance_mm_);
  PartPoints material;
  std::vector<double> f;
  for (const Place& at : places) {
    material.clear();
    add_material(field_.tree, at.x, at.y, at.z, material);
    field_of(field_.kernel, part, material, f);
    for (std::size_t n = 0; n < material.size(); ++n)
      if (f[n] < 0) points_.add(material.at(n));
    if (!field_.blank.empty()) look_at_blank(at.x, at.y, at.z, part, cut);
  }
}

/// Does the part come to any of the points, between these parts of the move, before the flutes do?
/// Leaves those that neither has come to.
bool PartSearch::meets(const std::vector<ToolBody>& part, PartPoints& points, double from,
                       double to, int level) {
  if (points.empty()) return false;
  const CutMove piece = middle_part(move_, from, to);
  std::vector<double> in_part, in_cut;
  field_of(field_.kernel, sweeps_of(part, piece, tolerance_mm_), points, in_part);
  field_of(field_.kernel, sweeps_of(flutes_, piece, -tolerance_mm_), points, in_cut);
  PartPoints neither, both;
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (in_part[n] < 0 && in_cut[n] >= 0) return true;
    if (in_part[n] < 0)
      both.add(points.at(n));
    else if (in_cut[n] >= 0)
      neither.add(points.at(n));
  }
  points = std::move(neither);
  if (both.empty() || way_mm_ * (to - from) < kAtOnce_mm || level == kDeepest) return false;
  const double middle = 0.5 * (from + to);
  if (meets(part, both, from, middle, level + 1) || meets(part, both, middle, to, level + 1))
    return true;
  for (std::size_t n = 0; n < both.size(); ++n) points.add(both.at(n));
  return false;
}

bool PartSearch::touches(double until, double raised_mm) {
  if (part_.from_z_mm + raised_mm >= part_.to_z_mm) return false;
  const std::vector<ToolBody> part = raised(raised_mm);
  if (!blocks_.empty()) {
    const std::vector<Sweep> sweeps = sweeps_of(part, first_part(move_, until), tolerance_mm_);
    for (const Box& block : blocks_)
      for (const Sweep& sweep : sweeps)
        if (blank_.point_in(sweep, block)) return true;
  }
  PartPoints points = points_;
  return meets(part, points, 0, until, 0);
}

std::optional<PartContact> PartSearch::run() {
  collect();
  if ((points_.empty() && blocks_.empty()) || !touches(1, 0)) return std::nullopt;
  double clear = 0, meets_at = 1;
  if (touches(0, 0)) meets_at = 0;
  for (int n = 0; n < kHalvings && meets_at > clear; ++n) {
    const double middle = 0.5 * (clear + meets_at);
    (touches(middle, 0) ? meets_at : clear) = middle;
  }
  return PartContact{first_part(move_, meets_at).to_mm, meets_at, depth_mm()};
}

/// It touches.
double PartSearch::depth_mm() {
  const double length = part_.to_z_mm - part_.from_z_mm;
  double deep = 0, too_deep = std::min(reach_mm_, length);
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (deep + too_deep);
    (touches(1, middle) ? deep : too_deep) = middle;
  }
  if (!std::isfinite(length) || too_deep < length - kAtOnce_mm) return too_deep + tolerance_mm_;
  // What is in its upper end would be in it still if it were as much higher: as if it had no end.
  PartSearch endless(field_, flutes_, {part_.radius_mm, part_.from_z_mm}, move_, tolerance_mm_);
  endless.collect();
  return endless.depth_mm();
}

}  // namespace

std::optional<PartContact> find_part_contact(const PartField& field,
                                             std::span<const ToolBody> flutes,
                                             const CarriedPart& part, const CutMove& move,
                                             double tolerance_mm) {
  return PartSearch(field, flutes, part, move, tolerance_mm).run();
}

double part_spare_mm(const PartField& field, const CarriedPart& part, const CutMove& move,
                     double enough_mm, double most_mm) {
  const Lattice& lattice = field.tree.lattice();
  const std::vector<ToolBody> body{part_body(part)};
  std::vector<Sweep> sweeps;
  const Box bounds{lattice.bounds_mm.min - Vec3(most_mm), lattice.bounds_mm.max + Vec3(most_mm)};
  append_sweeps(body, move, 0, {bounds, chord_mm(glm::length(lattice.cell_mm)), 0}, sweeps);
  const double cell_mm = glm::length(lattice.cell_mm);
  BrickFinder finder(field.tree, field.kernel);
  PartPoints points;
  std::vector<double> f;
  double spare = most_mm;
  for (const Sweep& sweep : sweeps) {
    finder.find(sweep, spare, [&](int bx, int by, int bz, const BrickRef& brick, double low_mm) {
      // The crossing that is nearest to a point of this brick may be one of its neighbour's.
      double least = low_mm - cell_mm;
      if (least < enough_mm && brick.get()) {
        points.clear();
        if (low_mm < 0)
          add_material(field.tree, bx, by, bz, points);
        else
          add_crossings(field.tree, bx, by, bz, points);
        field_of(field.kernel, {&sweep, 1}, points, f);
        const auto first = f.begin(), last = first + static_cast<std::ptrdiff_t>(points.size());
        if (first != last) least = std::max(least, *std::min_element(first, last) - cell_mm);
      }
      spare = std::min(spare, least);
    });
  }
  return spare;
}

namespace {

/// The nearest point of what a move leaves.
class GapSearch {
 public:
  GapSearch(const PartField& field, std::span<const ToolBody> cutter, const CarriedPart& part,
            const CutMove& move, double below_mm)
      : field_(field),
        body_{part_body(part)},
        move_(move),
        blank_(field.tree.lattice(), field.kernel, field.blank),
        below_mm_(below_mm),
        least_mm_(below_mm) {
    const Lattice& lattice = field.tree.lattice();
    const Box bounds{lattice.bounds_mm.min - Vec3(below_mm),
                     lattice.bounds_mm.max + Vec3(below_mm)};
    target_ = {bounds, chord_mm(glm::length(lattice.cell_mm)), 0};
    append_sweeps(body_, move, 0, target_, sweeps_);
    cutter_.assign(cutter.begin(), cutter.end());
    SweepTarget wider = target_;
    wider.shrink_mm = -kReachMargin_mm;
    append_sweeps(cutter_, move, 0, wider, cut_);
  }
  std::optional<PartGap> run();

 private:
  void look_at(const Sweep& sweep, int bx, int by, int bz);
  void take_nearest(const Sweep& sweep, const PartPoints& points);

  const PartField& field_;
  std::vector<ToolBody> body_, cutter_;
  const CutMove& move_;
  BlankContact blank_;
  SweepTarget target_;
  std::vector<Sweep> sweeps_, cut_;
  double below_mm_, least_mm_;
  Vec3 nearest_{0};
  PartPoints points_, near_;
  std::vector<double> f_, in_cut_;
};

void GapSearch::take_nearest(const Sweep& sweep, const PartPoints& points) {
  field_of(field_.kernel, {&sweep, 1}, points, f_);
  near_.clear();
  for (std::size_t n = 0; n < points.size(); ++n)
    if (f_[n] < least_mm_) near_.add(points.at(n));
  if (near_.empty()) return;
  field_of(field_.kernel, {&sweep, 1}, near_, f_);
  field_of(field_.kernel, cut_, near_, in_cut_);
  for (std::size_t n = 0; n < near_.size(); ++n) {
    if (in_cut_[n] < 0 || f_[n] >= least_mm_) continue;
    least_mm_ = f_[n];
    nearest_ = near_.at(n);
  }
}

void GapSearch::look_at(const Sweep& sweep, int bx, int by, int bz) {
  points_.clear();
  add_crossings(field_.tree, bx, by, bz, points_);
  take_nearest(sweep, points_);
  if (field_.blank.empty()) return;
  for (unsigned bits = field_.tree.untouched(bx, by, bz); bits != 0; bits &= bits - 1) {
    const Box block = blank_.block_of(bx, by, bz, std::countr_zero(bits));
    const auto found = blank_.nearest_in(sweep, block, least_mm_);
    if (!found) continue;
    points_.clear();
    points_.add(found->at_mm);
    take_nearest(sweep, points_);
  }
}

std::optional<PartGap> GapSearch::run() {
  BrickFinder finder(field_.tree, field_.kernel);
  for (const Sweep& sweep : sweeps_) {
    finder.find(sweep, least_mm_, [&](int bx, int by, int bz, const BrickRef& brick, double) {
      if (brick.get()) look_at(sweep, bx, by, bz);
    });
  }
  if (least_mm_ >= below_mm_) return std::nullopt;
  points_.clear();
  points_.add(nearest_);
  double clear = 0, meets_at = 1;
  const auto comes_by = [&](double t) {
    sweeps_.clear();
    append_sweeps(body_, first_part(move_, t), 0, target_, sweeps_);
    field_of(field_.kernel, sweeps_, points_, f_);
    return f_[0] <= least_mm_ + kAtOnce_mm;
  };
  if (comes_by(0)) meets_at = 0;
  for (int n = 0; n < kHalvings && meets_at > clear; ++n) {
    const double middle = 0.5 * (clear + meets_at);
    (comes_by(middle) ? meets_at : clear) = middle;
  }
  return PartGap{std::max(0.0, least_mm_), meets_at, first_part(move_, meets_at).to_mm};
}

}  // namespace

std::optional<PartGap> find_part_gap(const PartField& field, std::span<const ToolBody> cutter,
                                     const CarriedPart& part, const CutMove& move,
                                     double below_mm) {
  return GapSearch(field, cutter, part, move, below_mm).run();
}

}  // namespace kerf::octree
