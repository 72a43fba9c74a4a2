// EngagementScan by lanes: the same questions, asked of some places only.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/golden_section.h"
#include "twin/process/milling/engagement_scan.h"

namespace kerf {
namespace {

constexpr double kNeverLeft = std::numeric_limits<double>::infinity();
/// What is thinner is not there: heights are floats.
constexpr double kThinnest_mm = 1e-4;
/// Places along which the lowest one of a cutter on a slope is looked for.
constexpr int kSlopePlaces = 32;
/// Lanes in a row begin by so much of a step later.
constexpr double kStagger = 0.618;
/// Narrowings of where a cutter on a slope was lowest.
constexpr int kHeldSteps = 10;
constexpr double kHeldSlack_mm = 0.0005;
/// Lanes at the cutter's sides are so many cells within it.
constexpr double kRimCells = 0.5;

}  // namespace

/// How much behind the place where it is nearest a cutter on a slope is lowest: part of the way.
double EngagementScan::lowest_behind(double beside) const {
  if (rise_ == 0 || length_ == 0) return 0;
  const double r = arc_radius_, p = arc_radius_ + beside;
  double half = std::sqrt(std::max(0.0, radius_ * radius_ - beside * beside)) / length_;
  if (arc_) {
    const double cosine = (r * r + p * p - radius_ * radius_) / std::max(2 * r * p, 1e-9);
    half = std::acos(std::clamp(cosine, -1.0, 1.0)) / sweep_;
  }
  const double side = rise_ < 0 ? half : -half;
  double best = kNeverLeft, behind = 0;
  for (int k = 0; k <= kSlopePlaces; ++k) {
    const double t = side * k / kSlopePlaces;
    const double distance2 = arc_ ? r * r + p * p - 2 * r * p * std::cos(t * sweep_)
                                  : beside * beside + t * t * length_ * length_;
    const double scaled = std::sqrt(std::max(0.0, distance2)) * lift_scale_ * (1 - 1e-9);
    const auto i =
        static_cast<std::size_t>(std::min(scaled, static_cast<double>(lift_.size() - 1)));
    const double height = lift_[i] + rise_ * t;
    if (height < best) best = height, behind = t;
  }
  return behind;
}

/// What of the cutter is wider is above all of the blank.
double EngagementScan::engaged_radius() const {
  const double most = heights_->bounds_mm().max.z - low_z_;
  const auto above = std::upper_bound(lift_.begin(), lift_.begin() + kLifts, most);
  return std::min(radius_, static_cast<double>(above - lift_.begin()) / lift_scale_);
}

/// Closer together towards the cutter's sides, where a small part of it does much; and one at each
/// side, which counts for nothing but is met first or left last by what is cut there alone.
void EngagementScan::lay_lanes(int count) {
  lanes_.clear();
  engaged_ = engaged_radius();
  const double rim = engaged_ - kRimCells * cell_;
  const int most = static_cast<int>(std::ceil(kPi * engaged_ / cell_)) + 2;
  const int n = std::clamp(count, 3, std::max(3, most)) | 1;
  const bool in_rows = !arc_ && (direction_.x == 0 || direction_.y == 0);
  const double origin = direction_.x == 0 ? start_.x : start_.y;
  const double least =
      direction_.x == 0 ? heights_->bounds_mm().min.x : heights_->bounds_mm().min.y;
  const double row_mm = direction_.x == 0 ? heights_->cell_x_mm() : heights_->cell_y_mm();
  const double sign = direction_.x == 0 ? -direction_.y : direction_.x;
  double last_row = kNeverLeft;
  const bool rims = rim > engaged_ * std::cos(kPi / 2 / n);
  for (int k = rims ? -1 : 0; k < (rims ? n + 1 : n); ++k) {
    const double angle = kPi * ((k + 0.5) / n - 0.5);
    Lane lane{engaged_ * std::sin(angle), engaged_ * std::cos(angle) * kPi / n, 0};
    if (k < 0 || k == n) lane = {k < 0 ? -rim : rim, 0, 0};
    if (arc_ && arc_radius_ + lane.beside <= 0) continue;
    const double row = std::floor((origin + sign * lane.beside - least) / row_mm);
    if (in_rows && row == last_row) {
      lanes_.back().width_mm += lane.width_mm;
      continue;
    }
    last_row = row;
    lane.lowest = lowest_behind(lane.beside);
    lanes_.push_back(lane);
  }
}

/// The part of a lane that the cutter comes over, and where the blank is: mm, or angles.
bool EngagementScan::lane_within(const Lane& lane, double& low, double& high) const {
  if (arc_) {
    const double p = arc_radius_ + lane.beside;
    const double cosine =
        (arc_radius_ * arc_radius_ + p * p - engaged_ * engaged_) / (2 * arc_radius_ * p);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
    low = from_ * sweep_ - half, high = to_ * sweep_ + half;
    if (high - low >= 2 * kPi) low = 0, high = 2 * kPi;
    return true;
  }
  const double half = std::sqrt(std::max(0.0, engaged_ * engaged_ - lane.beside * lane.beside));
  low = from_ * length_ - half, high = to_ * length_ + half;
  const Vec2 at = point_of({0, lane.beside});
  const Box& box = heights_->bounds_mm();
  for (int axis = 0; axis < 2; ++axis) {
    const double slope = direction_[axis];
    const double a = box.min[axis] - at[axis], b = box.max[axis] - at[axis];
    if (std::abs(slope) < 1e-12) {
      if (a > 0 || b < 0) return false;
      continue;
    }
    low = std::max(low, std::min(a / slope, b / slope));
    high = std::min(high, std::max(a / slope, b / slope));
  }
  return low < high;
}

/// Where on a lane the cutter ends before it goes.
double EngagementScan::front_at_start(const Lane& lane) const {
  if (!arc_) {
    return from_ * length_ +
           std::sqrt(std::max(0.0, engaged_ * engaged_ - lane.beside * lane.beside));
  }
  const double r = arc_radius_, p = r + lane.beside;
  const double cosine = (r * r + p * p - engaged_ * engaged_) / (2 * r * p);
  return from_ * sweep_ + std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// How high the material is there when the move that is held back is cut, too.
double EngagementScan::behind_way(const Vec2& point, double height) const {
  const Held& held = held_;
  const Vec2 arm = point - held.start;
  const double beside = held.direction.x * arm.y - held.direction.y * arm.x;
  const double along = glm::dot(arm, held.direction);
  const double nearest = std::clamp(along, 0.0, held.length);
  const double half2 = radius_ * radius_ - beside * beside;
  if ((along - nearest) * (along - nearest) >= half2) return height;
  const auto surface_at = [&](double at) {
    const double distance = std::sqrt((along - at) * (along - at) + beside * beside);
    const double scaled = std::min(distance * lift_scale_, double{kLifts});
    const auto k = static_cast<std::size_t>(scaled);
    const double step = lift_[k + 1] - lift_[k];
    const double part = step * lift_scale_ > kWallSlope ? 0 : scaled - static_cast<double>(k);
    return held.z + held.slope * at + lift_[k] + part * step;
  };
  if (held.slope == 0) return std::min(height, surface_at(nearest));
  const double half = std::sqrt(half2);
  const double low = std::max(0.0, along - half), high = std::min(held.length, along + half);
  if (is_flat()) return std::min(height, held.z + held.slope * (held.slope < 0 ? high : low));
  if (const std::optional<double> lowest = side_.lowest_mm(held.slope, std::abs(beside), half, 0))
    return std::min(height, surface_at(std::clamp(along + *lowest, low, high)));
  const double least = golden_section(surface_at, low, high, kHeldSteps).least;
  return std::min(height, least - kHeldSlack_mm);
}

/// How far from the blank a place is, seen from above.
double EngagementScan::outside_mm(const Vec2& point) const {
  const Box& box = heights_->bounds_mm();
  return glm::length(glm::max(glm::max(Vec2(box.min) - point, point - Vec2(box.max)), Vec2(0)));
}

Vec2 EngagementScan::point_on(const Lane& lane, double along) const {
  return point_of({along, (arc_ ? arc_radius_ : 0) + lane.beside});
}

EngagementScan::LaneLook EngagementScan::look(const Lane& lane, double along) {
  return look_at(lane, point_on(lane, along));
}

/// Of the cell that is there: as the model does, its middle counts.
EngagementScan::LaneLook EngagementScan::look_at(const Lane& lane, const Vec2& point) {
  cost_.looks += 1;
  LaneLook found;
  const Box& box = heights_->bounds_mm();
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const double i = std::floor((point.x - box.min.x) / cell_x);
  const double j = std::floor((point.y - box.min.y) / cell_y);
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return found;
  found.height = static_cast<double>(heights_->height(static_cast<int>(i), static_cast<int>(j)));
  if (found.height <= low_z_ + kThinnest_mm) return found;
  const Vec2 middle(box.min.x + (i + 0.5) * cell_x, box.min.y + (j + 0.5) * cell_y);
  found.height = behind_held(middle, found.height);
  if (found.height <= low_z_ + kThinnest_mm) return found;
  found.place = place_of(middle);
  Pass passes_found[3];
  const int count = passes(found.place, from_, to_, passes_found);
  for (int k = 0; k < count && !found.removed; ++k) {
    const Pass& pass = passes_found[k];
    double lowest = pass.nearest;
    if (length_ == 0) {
      lowest = rise_ < 0 ? to_ : from_;
    } else if (rise_ != 0) {
      lowest = is_flat() ? lowest_at(found.place, pass)
                         : std::clamp(pass.middle + lane.lowest, pass.first, pass.last);
    }
    const double tip = surface(found.place, lowest);
    found.depth = found.height - std::max(tip, box.min.z);
    found.removed = found.depth > kThinnest_mm;
    found.when = is_flat() && is_level() ? pass.first : lowest;
    if (length_ == 0 && rise_ < 0) {
      found.when = std::clamp((found.height - surface(found.place, 0)) / rise_, from_, to_);
    }
  }
  return found;
}

/// Between a place that is removed and one that is not: the last that is, to half a cell.
void EngagementScan::find_edge(const Lane& lane, double removed, double free, LaneLook& last) {
  const double unit = arc_ ? std::max(arc_radius_ + lane.beside, cell_) : 1;
  while (std::abs(free - removed) * unit > cell_ / 2) {
    const double middle = 0.5 * (removed + free);
    const LaneLook found = look(lane, middle);
    (found.removed ? removed : free) = middle;
    if (found.removed) last = found;
  }
}

void EngagementScan::note_edge(const Lane& lane, const LaneLook& look, double removed_at,
                               double free_at, bool begins) {
  Edge edge{lane, removed_at, free_at, look, 0, 0, spans_.size() - 1, 0, begins};
  edge.time = begins
                  ? std::min(begin_of(look.place, look.height, from_, to_, kNeverLeft), look.when)
                  : std::max(end_of(look.place, look.height, from_, to_, -kNeverLeft), look.when);
  WaySpan& span = spans_.back();
  (begins ? span.from : span.to) =
      begins ? std::min(span.from, edge.time) : std::max(span.to, edge.time);
  // A cell on either side; and beside the cutter's widest a wall, that this has to pass.
  const double unit = arc_ ? sweep_ : length_;
  const bool widest = !begins && beside_mm(look.place) + half_along_ > radius_ - cell_;
  const double about = (2 * cell_ + (widest ? radius_ : 0)) / std::max(length_, cell_);
  edge.most = unit > 0 ? std::abs(removed_at - free_at) / unit + about : kNeverLeft;
  edges_.push_back(edge);
}

/// The stretch begins or ends no later or earlier than that lane does between the edge's places.
void EngagementScan::take_edge(const Lane& lane, const Edge& edge, LaneLook look,
                               WaySpan& stretch) {
  find_edge(lane, edge.removed_at, edge.free_at, look);
  WaySpan found{look.when, look.when};
  if (edge.begins) {
    found.from = std::min(begin_of(look.place, look.height, from_, to_, kNeverLeft), look.when);
    stretch.from = std::min(stretch.from, found.from);
  } else {
    found.to = std::max(end_of(look.place, look.height, from_, to_, -kNeverLeft), look.when);
    stretch.to = std::max(stretch.to, found.to);
  }
  spans_.push_back(found);
  WaySpan& span = spans_[edge.span];
  (edge.begins ? span.from : span.to) =
      edge.begins ? std::min(span.from, found.from) : std::max(span.to, found.to);
}

/// Of the lanes that lie side by side in one stretch only those edges are looked for that can be
/// its begin or its end.
void EngagementScan::find_edges(bool missed) {
  std::vector<WaySpan> stretches = spans_;
  merge_spans(stretches, 0);
  const auto stretch_of = [&](const Edge& edge) -> WaySpan& {
    const auto behind =
        std::upper_bound(stretches.begin(), stretches.end(), spans_[edge.span].from,
                         [](double from, const WaySpan& stretch) { return from < stretch.from; });
    return *std::max(stretches.begin(), behind - 1);
  };
  for (Edge& edge : edges_)
    edge.stretch = static_cast<std::size_t>(&stretch_of(edge) - stretches.data());
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
    return (a.begins ? a.time : -a.time) - a.most < (b.begins ? b.time : -b.time) - b.most;
  });
  const auto matters = [](const Edge& edge, const WaySpan& stretch) {
    return edge.begins ? edge.time - edge.most < stretch.from : edge.time + edge.most > stretch.to;
  };
  const std::size_t last = lanes_.size() - 1;
  for (const Edge& edge : edges_) {
    WaySpan& stretch = stretches[edge.stretch];
    if (!matters(edge, stretch)) continue;
    // What is shorter than a step some lanes have missed: the one in the middle comes to it first,
    // those at the sides leave it last.
    for (const std::size_t n : {edge.begins ? last / 2 : 0, last}) {
      if (!missed || (edge.begins && n == last)) continue;
      const LaneLook other = look(lanes_[n], edge.removed_at);
      if (other.removed) take_edge(lanes_[n], edge, other, stretch);
    }
    if (matters(edge, stretch)) take_edge(edge.lane, edge, edge.look, stretch);
  }
}

void EngagementScan::walk(const Lane& lane, double phase, double step) {
  double low = 0, high = 0;
  if (!lane_within(lane, low, high)) return;
  const double unit = arc_ ? std::max(arc_radius_ + lane.beside, cell_) : 1;
  const double each = std::min(step / unit, high - low);
  const double each_mm = each * unit, ahead = length_ > 0 ? each_mm / length_ : 1;
  LaneLook before;
  double before_at = low;
  const auto begin = [&](const LaneLook& look, double at, double free) {
    spans_.push_back({look.when, look.when});
    note_edge(lane, look, at, free, true);
  };
  const auto close = [&](double free) { note_edge(lane, before, before_at, free, false); };
  // At both ends of the lane, too: what is left there may be shorter than a step. The cutter stands
  // in no material when it sets out; what the move before has left is right ahead of it.
  const double rim = std::min(cell_ / 4, each_mm / 4) / unit;
  const double ahead_of =
      length_ > 0 && rise_ >= 0 ? std::max(low, front_at_start(lane) + cell_ / unit) : low;
  const int count = static_cast<int>(std::ceil((high - low) / each)) + 1;
  // Along an arc the arm is turned on by a step at a time: four multiplications for a sine and a
  // cosine, which are worked out anew before 64 of their roundings have come together.
  const double turn = turn_ * each;
  const Vec2 turned(std::cos(turn), std::sin(turn));
  Vec2 arm(0);
  int arm_of = -2, exact = 0;
  const auto point_at = [&](int n, double at) {
    if (!arc_ || n < 0 || at != low + (phase + n) * each) return point_on(lane, at);
    if (n == arm_of + 1 && n < exact + 64) {
      arm = {arm.x * turned.x - arm.y * turned.y, arm.x * turned.y + arm.y * turned.x};
    } else {
      arm = point_on(lane, at) - center_;
      exact = n;
    }
    arm_of = n;
    return center_ + arm;
  };
  for (int n = -1; n <= count && before_at < high - rim; ++n) {
    const double at = n < 0 ? std::min(ahead_of, high - 2 * rim) + rim
                            : std::min(low + (phase + n) * each, high - rim);
    if (at <= before_at) continue;
    const bool counts = n >= 0 && at < high - rim;
    const Vec2 point = point_at(n, at);
    LaneLook found = look_at(lane, point);
    if (found.removed) {
      const double half = length_ > 0 ? 0.5 * ahead : 0;
      add(found.when - half, length_ > 0 ? found.when + half : to_,
          counts ? found.depth * lane.width_mm * each_mm : 0);
      if (!before.removed) {
        begin(found, at, before_at);
      } else if (std::abs(found.when - before.when) > 3 * ahead) {  // the other end of a turn
        close(before_at);
        begin(found, at, at);
      }
      spans_.back().from = std::min(spans_.back().from, found.when);
      spans_.back().to = std::max(spans_.back().to, found.when);
    } else if (before.removed) {
      close(at);
    }
    before = found;
    before_at = at;
    // Long arcs are mostly beside the blank; those of 100 m are walked in no time.
    if (arc_ && n >= 0 && !found.removed) {
      const int missed = static_cast<int>(outside_mm(point) / each_mm) - 1;
      if (missed > 0) {
        n = std::min(n + missed, count);
        before_at = std::min(low + (phase + n) * each, high - rim);
      }
    }
  }
  if (before.removed) close(high);
}

void EngagementScan::set_held(const CutMove* held) {
  held_ = {};
  if (held == nullptr) return;
  const Vec3 way = held->to_mm - held->from_mm;
  const double length = glm::length(Vec2(way));
  if (length <= 0) return;
  const double slope = way.z / length;
  held_ = {Vec2(held->from_mm),
           Vec2(way) / length,
           length,
           held->from_mm.z,
           slope,
           slope / std::hypot(1, slope),
           0};
  held_.lowest = held_.z + std::min(0.0, slope * length);
}

EngagementScan::Cost EngagementScan::run_lanes(const HeightGrid& heights, const Cutter& cutter,
                                               const CutMove& move, double from, double to,
                                               const Lanes& lanes) {
  set(heights, cutter, move);
  set_held(lanes.held);
  cost_ = {};
  from_ = from, to_ = to;
  set_bins(lanes.bin_mm);
  spans_.clear();
  edges_.clear();
  lay_lanes(lanes.count);
  double phase = 0.5;
  for (const Lane& lane : lanes_) {
    walk(lane, phase, std::max(lanes.step_mm, cell_));
    phase = std::fmod(phase + kStagger, 1.0);
  }
  find_edges(lanes.step_mm > lanes.gap_mm);
  merge_spans(spans_, lanes.gap_mm / std::hypot(length_, rise_));
  clip_spans(spans_, from_, to_);
  return cost_;
}

}  // namespace kerf
