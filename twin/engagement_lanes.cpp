// EngagementScan by lanes: the same questions, asked of some places only.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/engagement_scan.h"

namespace kerf {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// What is thinner is not there: heights are floats.
constexpr double kLeast_mm = 1e-4;
/// Places along which the lowest one of a cutter on a slope is looked for.
constexpr int kSlopePlaces = 32;
/// Lanes in a row begin by so much of a step later.
constexpr double kStagger = 0.618;
/// Narrowings of where a cutter on a slope was lowest.
constexpr int kHeldSteps = 10;
constexpr double kHeldSlack_mm = 0.002, kGolden = 0.6180339887498949;

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
  double best = kNever, behind = 0;
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

/// Closer together towards the cutter's sides, where a small part of it does much.
void EngagementScan::lay_lanes(int count) {
  lanes_.clear();
  const int most = static_cast<int>(std::ceil(kPi * radius_ / cell_)) + 2;
  const int n = std::clamp(count, 3, std::max(3, most)) | 1;
  const bool in_rows = !arc_ && (direction_.x == 0 || direction_.y == 0);
  const double origin = direction_.x == 0 ? start_.x : start_.y;
  const double least =
      direction_.x == 0 ? heights_->bounds_mm().min.x : heights_->bounds_mm().min.y;
  const double row_mm = direction_.x == 0 ? heights_->cell_x_mm() : heights_->cell_y_mm();
  const double sign = direction_.x == 0 ? -direction_.y : direction_.x;
  double last_row = kNever;
  for (int k = 0; k < n; ++k) {
    const double angle = kPi * ((k + 0.5) / n - 0.5);
    Lane lane{radius_ * std::sin(angle), radius_ * std::cos(angle) * kPi / n, 0};
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
        (arc_radius_ * arc_radius_ + p * p - radius_ * radius_) / (2 * arc_radius_ * p);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
    low = from_ * sweep_ - half, high = to_ * sweep_ + half;
    if (high - low >= 2 * kPi) low = 0, high = 2 * kPi;
    return true;
  }
  const double half = std::sqrt(std::max(0.0, radius_ * radius_ - lane.beside * lane.beside));
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

/// How high the material is there when the move that is held back is cut, too.
double EngagementScan::behind_held(const Vec2& point, double height) const {
  const Held& held = held_;
  if (held.length <= 0 || height <= std::min(held.z, held.z + held.rise)) return height;
  const Vec2 arm = point - held.start;
  const double beside = held.direction.x * arm.y - held.direction.y * arm.x;
  const double along = glm::dot(arm, held.direction);
  const double half2 = radius_ * radius_ - beside * beside;
  if (half2 <= 0) return height;
  const double half = std::sqrt(half2);
  double low = std::max(0.0, along - half), high = std::min(held.length, along + half);
  if (low >= high) return height;
  const auto surface_at = [&](double at) {
    const double distance = std::sqrt((along - at) * (along - at) + beside * beside);
    const auto k = static_cast<std::size_t>(std::min(distance * lift_scale_, double{kLifts}));
    return held.z + held.rise * at / held.length + lift_[k];
  };
  if (held.rise == 0) return std::min(height, surface_at(std::clamp(along, low, high)));
  if (is_flat())
    return std::min(height, held.z + held.rise * (held.rise < 0 ? high : low) / held.length);
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = surface_at(a), at_b = surface_at(b);
  for (int i = 0; i < kHeldSteps; ++i) {
    if (at_a <= at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = surface_at(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = surface_at(b);
    }
  }
  return std::min(height, std::min(at_a, at_b) - kHeldSlack_mm);
}

/// Of the cell that is there: as the model does, its middle counts.
EngagementScan::Look EngagementScan::look(const Lane& lane, double along) {
  cost_.looks += 1;
  Look found;
  const Vec2 point = point_of({along, (arc_ ? arc_radius_ : 0) + lane.beside});
  const Box& box = heights_->bounds_mm();
  const double cell_x = heights_->cell_x_mm(), cell_y = heights_->cell_y_mm();
  const double i = std::floor((point.x - box.min.x) / cell_x);
  const double j = std::floor((point.y - box.min.y) / cell_y);
  if (i < 0 || j < 0 || i >= heights_->nx() || j >= heights_->ny()) return found;
  found.height = static_cast<double>(heights_->height(static_cast<int>(i), static_cast<int>(j)));
  if (found.height <= low_z_ + kLeast_mm) return found;
  const Vec2 middle(box.min.x + (i + 0.5) * cell_x, box.min.y + (j + 0.5) * cell_y);
  found.height = behind_held(middle, found.height);
  if (found.height <= low_z_ + kLeast_mm) return found;
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
    found.removed = found.depth > kLeast_mm;
    found.when = is_flat() && is_level() ? pass.first : lowest;
    if (length_ == 0 && rise_ < 0) {
      found.when = std::clamp((found.height - surface(found.place, 0)) / rise_, from_, to_);
    }
  }
  return found;
}

/// Between a place that is removed and one that is not: the last that is, to half a cell.
void EngagementScan::find_edge(const Lane& lane, double removed, double free, Look& last) {
  const double unit = arc_ ? std::max(arc_radius_ + lane.beside, cell_) : 1;
  while (std::abs(free - removed) * unit > cell_ / 2) {
    const double middle = 0.5 * (removed + free);
    const Look found = look(lane, middle);
    (found.removed ? removed : free) = middle;
    if (found.removed) last = found;
  }
}

void EngagementScan::walk(const Lane& lane, double phase, double step) {
  double low = 0, high = 0;
  if (!lane_within(lane, low, high)) return;
  const double unit = arc_ ? std::max(arc_radius_ + lane.beside, cell_) : 1;
  const double each = std::min(step / unit, high - low);
  const double each_mm = each * unit, ahead = length_ > 0 ? each_mm / length_ : 1;
  const auto begin_at = [&](const Look& edge) {
    const double begin = begin_of(edge.place, edge.height, from_, to_, kNever);
    return std::min(begin, edge.when);
  };
  const auto end_at = [&](const Look& edge) {
    return std::max(end_of(edge.place, edge.height, from_, to_, -kNever), edge.when);
  };
  Look before;
  double before_at = low;
  Span span;
  const auto close = [&](double free) {
    find_edge(lane, before_at, free, before);
    span.to = std::max(span.to, end_at(before));
    spans_.push_back(span);
  };
  // At both ends of the lane, too: what is left there may be shorter than a step.
  const double rim = std::min(cell_ / 4, each_mm / 4) / unit;
  const int count = static_cast<int>(std::ceil((high - low) / each)) + 1;
  for (int n = -1; n <= count && before_at < high - rim; ++n) {
    const double at = n < 0 ? low + rim : std::min(low + (phase + n) * each, high - rim);
    if (at <= before_at) continue;
    const bool counts = n >= 0 && at < high - rim;
    Look found = look(lane, at);
    if (found.removed) {
      const double half = length_ > 0 ? 0.5 * ahead : 0;
      add(found.when - half, length_ > 0 ? found.when + half : to_,
          counts ? found.depth * lane.width_mm * each_mm : 0);
      if (!before.removed) {
        Look edge = found;
        find_edge(lane, at, before_at, edge);
        span.from = begin_at(edge);
        span.to = found.when;
      } else if (std::abs(found.when - before.when) > 3 * ahead) {  // the other end of a turn
        close(before_at);
        span = {begin_at(found), found.when};
      }
      span.from = std::min(span.from, found.when);
      span.to = std::max(span.to, found.when);
    } else if (before.removed) {
      close(at);
    }
    before = found;
    before_at = at;
  }
  if (before.removed) close(high);
}

void EngagementScan::merge_spans(double gap) {
  std::sort(spans_.begin(), spans_.end(),
            [](const Span& a, const Span& b) { return a.from < b.from; });
  std::size_t kept = 0;
  for (const Span& span : spans_) {
    if (kept > 0 && span.from - spans_[kept - 1].to < gap) {
      spans_[kept - 1].to = std::max(spans_[kept - 1].to, span.to);
    } else {
      spans_[kept++] = span;
    }
  }
  spans_.resize(kept);
  for (Span& span : spans_) {
    span.from = std::clamp(span.from, from_, to_);
    span.to = std::clamp(span.to, from_, to_);
  }
  std::erase_if(spans_, [](const Span& span) { return span.to <= span.from; });
}

EngagementScan::Cost EngagementScan::run_lanes(const HeightGrid& heights, const Cutter& cutter,
                                               const CutMove& move, double from, double to,
                                               const Lanes& lanes) {
  set(heights, cutter, move);
  held_ = {};
  if (lanes.held != nullptr) {
    const Vec2 way = Vec2(lanes.held->to_mm - lanes.held->from_mm);
    held_ = {Vec2(lanes.held->from_mm),
             {1, 0},
             glm::length(way),
             lanes.held->from_mm.z,
             lanes.held->to_mm.z - lanes.held->from_mm.z};
    if (held_.length > 0) held_.direction = way / held_.length;
  }
  cost_ = {};
  from_ = from, to_ = to;
  set_bins(lanes.bin_mm);
  spans_.clear();
  lay_lanes(lanes.count);
  double phase = 0.5;
  for (const Lane& lane : lanes_) {
    walk(lane, phase, std::max(lanes.step_mm, cell_));
    phase = std::fmod(phase + kStagger, 1.0);
  }
  merge_spans(lanes.gap_mm / std::hypot(length_, rise_));
  return cost_;
}

}  // namespace kerf
