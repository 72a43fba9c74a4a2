#include "twin/process/milling/lane_scan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "twin/process/milling/tool_side.h"

namespace kerf {
namespace {

/// Halvings of where the cutter begins on a lane, and narrowings of where it is deepest.
constexpr int kLaneHalvings = 14, kLaneNarrowings = 26;
constexpr double kGolden = 0.6180339887498949;
/// Halvings of where material begins between two lanes.
constexpr int kSideHalvings = 5;
/// Lanes above each other are closer together near the tip: so many cells.
constexpr double kFirstRow = 0.05;
/// Lanes in a row begin by so much of a step later.
constexpr double kLaneStagger = 0.618;
/// What is no deeper in the material than this part of a cell is its surface.
constexpr double kWithin = 1.0 / 40;
/// The outermost lanes are so much of the radius within it.
constexpr double kRim = 2e-5;
/// Directions this near are one.
constexpr double kSame = 1e-9;
/// A spindle this near to the way: it goes straight down or up.
constexpr double kPlunge = 1e-6;

}  // namespace

bool LaneScan::set(const Box& box, const Cutter& cutter, const CutMove& move) {
  cutter_ = &cutter;
  box_ = box;
  start_ = move.from_mm;
  radius_ = cutter.radius_mm();
  form_ = cutter.undercuts()               ? Form::kAny
          : is_ball_end(cutter)            ? Form::kBall
          : cutter.height_mm(radius_) <= 0 ? Form::kFlat
                                           : Form::kAny;
  length_ = glm::length(move.to_mm - move.from_mm);
  if (length_ < kSame) return false;
  along_ = (move.to_mm - move.from_mm) / length_;
  const Vec3 spindle = glm::normalize(move.axis_from + move.axis_to);
  lean_ = glm::dot(spindle, along_);
  Vec3 up = spindle - lean_ * along_;
  if (glm::length(up) < kSame) up = std::abs(along_.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  up -= glm::dot(up, along_) * along_;
  above_ = glm::normalize(up);
  beside_ = glm::cross(above_, along_);
  rise_ = glm::dot(spindle, above_);
  far_ = glm::length(box.size()) + length_ + 4 * radius_;
  for (const Vec3& corner : {box.min, box.max}) far_ += glm::length(corner - start_);
  return true;
}

bool LaneScan::solid(double x, double y, double along) const {
  looks_ += 1;
  return solid_->solid_at(start_ + x * beside_ + y * above_ + along * along_, within_);
}

/// A place as seen from the tip is in the cutter.
bool LaneScan::inside(double x, double y, double along) const {
  const double height = y * rise_ + along * lean_;
  if (height < 0) return false;
  const double across = y * lean_ - along * rise_;
  const double distance = std::sqrt(x * x + across * across);
  if (!(height >= cutter_->height_mm(distance))) return false;
  return !cutter_->undercuts() || height <= cutter_->upper_height_mm(distance) ||
         distance <= *cutter_->neck_radius_mm();
}

/// Of a cylinder about the spindle what is above the tip, or above a ball's centre, and that ball.
/// `half`: of the cylinder's chord.
bool LaneScan::reach_closed(double x, double y, double half, double& back, double& front) const {
  const double above = form_ == Form::kBall ? radius_ : 0;
  back = far_, front = -far_;
  double low = (y * lean_ - half) / rise_, high = (y * lean_ + half) / rise_;
  if (low > high) std::swap(low, high);
  if (std::abs(lean_) < kSame) {
    if (y * rise_ < above) high = low - 1;
  } else {
    const double end = (above - y * rise_) / lean_;
    lean_ > 0 ? low = std::max(low, end) : high = std::min(high, end);
  }
  if (low <= high) back = low, front = high;
  if (form_ == Form::kBall) {
    const double up = y - radius_ * rise_, half2 = radius_ * radius_ - x * x - up * up;
    if (half2 >= 0) {
      const double middle = radius_ * lean_, chord = std::sqrt(half2);
      back = std::min(back, middle - chord), front = std::max(front, middle + chord);
    }
  }
  return back <= front;
}

/// What of a lane the cutter fills, from its first place to its last.
bool LaneScan::reach(double x, double y, double& back, double& front) const {
  const double half2 = radius_ * radius_ - x * x;
  if (half2 <= 0) return false;
  double low = -far_, high = far_;
  if (std::abs(rise_) > kPlunge) {  // |y * lean - along * rise| <= half
    const double half = std::sqrt(half2), middle = y * lean_ / rise_;
    if (form_ != Form::kAny) return reach_closed(x, y, half, back, front);
    low = std::max(low, middle - half / std::abs(rise_));
    high = std::min(high, middle + half / std::abs(rise_));
  } else if (std::abs(y) >= std::sqrt(half2)) {
    return false;
  } else {  // straight down or up: all above the surface
    const double surface = cutter_->height_mm(std::sqrt(x * x + y * y)) / lean_;
    (lean_ < 0 ? high : low) = surface;
    back = low, front = high;
    return back < front;
  }
  const auto edge = [&](double in, double out) {
    for (int i = 0; i < kLaneHalvings; ++i) {
      const double middle = 0.5 * (in + out);
      (inside(x, y, middle) ? in : out) = middle;
    }
    return in;
  };
  const double in = std::abs(lean_) < kSame ? 0 : deepest(x, y, low, high);
  if (!inside(x, y, in)) return false;
  front = edge(in, high);
  back = std::abs(lean_) < kSame ? -front : edge(in, low);
  return true;
}

/// The place of a lane that is farthest within the cutter, whose surface is convex there.
double LaneScan::deepest(double x, double y, double low, double high) const {
  const auto above = [&](double along) {
    const double across = y * lean_ - along * rise_;
    return cutter_->height_mm(std::min(std::sqrt(x * x + across * across), radius_)) -
           along * lean_;
  };
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = above(a), at_b = above(b);
  for (int i = 0; i < kLaneNarrowings; ++i) {
    if (at_a <= at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low), at_a = above(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low), at_b = above(b);
    }
  }
  return 0.5 * (low + high);
}

/// The lowest lane that far beside the way that the cutter fills something of.
double LaneScan::lowest_y(double x) const {
  if (std::abs(rise_) <= kPlunge) return -std::sqrt(std::max(0.0, radius_ * radius_ - x * x));
  if (std::abs(lean_) < kSame) return cutter_->height_mm(std::abs(x)) / rise_;
  double out = -radius_ - cell_, in = 2 * radius_ + cutter_->height_mm(std::abs(x)) / rise_;
  double back = 0, front = 0;
  for (int i = 0; i < kLaneHalvings; ++i) {
    const double middle = 0.5 * (out + in);
    (reach(x, middle, back, front) ? in : out) = middle;
  }
  return in;
}

/// What of the cutter is wider is above all of the blank.
double LaneScan::engaged_radius() const {
  if (cutter_->undercuts()) return radius_;
  const Vec3 spindle = rise_ * above_ + lean_ * along_;
  double most = -far_;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at((corner & 1) != 0 ? box_.max.x : box_.min.x,
                  (corner & 2) != 0 ? box_.max.y : box_.min.y,
                  (corner & 4) != 0 ? box_.max.z : box_.min.z);
    most = std::max(most, glm::dot(at - start_, spindle));
  }
  most += std::max(0.0, -lean_ * length_);
  double low = 0, high = radius_;
  if (cutter_->height_mm(high) <= most) return high;
  for (int i = 0; i < kLaneHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (cutter_->height_mm(middle) <= most ? low : high) = middle;
  }
  return high;
}

void LaneScan::lay_lanes(const Grain& grain) {
  const int count = grain.lanes | 1;
  const double engaged = engaged_radius();
  lanes_.clear();
  double least = far_, most = -far_;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at((corner & 1) != 0 ? box_.max.x : box_.min.x,
                  (corner & 2) != 0 ? box_.max.y : box_.min.y,
                  (corner & 4) != 0 ? box_.max.z : box_.min.z);
    const double y = glm::dot(at - start_, above_);
    least = std::min(least, y), most = std::max(most, y);
  }
  for (int k = -1; k <= count; ++k) {
    const double angle = kPi * ((k + 0.5) / count - 0.5);
    const bool rim = k < 0 || k == count;
    const double x = rim ? (k < 0 ? -1 : 1) * engaged * (1 - kRim) : engaged * std::sin(angle);
    const double width = rim ? 0 : engaged * std::cos(angle) * kPi / count;
    const double bottom = lowest_y(x),
                 inner_angle = kPi * ((k + (x < 0 ? 1.5 : -0.5)) / count - 0.5);
    const double inner = rim ? x : engaged * std::sin(inner_angle);
    const double high = std::abs(rise_) <= kPlunge ? std::min(most, -bottom) : most;
    double low = std::max(bottom, least), row = kFirstRow * cell_;
    while (low < high) {
      const double top = low + 1.5 * row >= high ? high : low + row;
      Lane lane{x, 0.5 * (low + top), low, top, inner, width * (top - low)};
      if (reach(lane.x, lane.y, lane.back, lane.front)) {
        double back = 0;
        lane.front_low = lane.front_high = lane.front;
        reach(x, low + kSame, back, lane.front_low);
        reach(x, top, back, lane.front_high);
        lanes_.push_back(lane);
      }
      low = top;
      row = std::min(row * grain.row_grows, std::max(row, grain.row_of_diameter * 2 * radius_));
    }
  }
}

/// Between material and air.
double LaneScan::edge_between(const Lane& lane, double in, double out) const {
  while (std::abs(out - in) > within_) {
    const double middle = 0.5 * (in + out);
    (solid(lane.x, lane.y, middle) ? in : out) = middle;
  }
  return 0.5 * (in + out);
}

void LaneScan::add(double from, double to, double mm3) {
  const double bin = 1.0 / static_cast<double>(bins_.size());
  const auto last = static_cast<int>(bins_.size()) - 1;
  from = std::max(from, 0.0), to = std::min(to, 1.0);
  const int first = std::clamp(static_cast<int>(from / bin), 0, last);
  const int end = std::clamp(static_cast<int>(to / bin), 0, last);
  for (int b = first; b <= end; ++b) {
    const double in = std::min(to, (b + 1) * bin) - std::max(from, b * bin);
    bins_[static_cast<std::size_t>(b)] += to > from ? mm3 * std::max(0.0, in) / (to - from) : mm3;
    if (to <= from) return;
  }
}

/// The cutter's front where the material begins between the lane and the next one inward.
double LaneScan::front_at_side(const Lane& lane, double along) const {
  double in = lane.x, out = lane.inner, back = 0, front = lane.front;
  if (in == out || solid(out, lane.y, along)) return front;
  for (int i = 0; i < kSideHalvings; ++i) {
    const double middle = 0.5 * (in + out);
    (solid(middle, lane.y, along) ? in : out) = middle;
  }
  reach(0.5 * (in + out), lane.y, back, front);
  return front;
}

void LaneScan::walk(const Lane& lane, double phase, const Grain& grain) {
  double low = std::max(lane.back, -far_), high = length_ + lane.front;
  const Vec3 at_zero = start_ + lane.x * beside_ + lane.y * above_;
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = along_[axis];
    const double a = box_.min[axis] - at_zero[axis], b = box_.max[axis] - at_zero[axis];
    if (std::abs(slope) < kSame) {
      if (a > 0 || b < 0) return;
      continue;
    }
    low = std::max(low, std::min(a / slope, b / slope));
    high = std::min(high, std::max(a / slope, b / slope));
  }
  if (low >= high) return;
  const double step = std::min(std::max(grain.step_mm, cell_), high - low);
  bool was_solid = false;
  double before_at = low;
  WaySpan span;
  // The lane's highest or lowest counts, if that is material, too.
  const auto close = [&](double in, double out) {
    const double edge = edge_between(lane, in, out), inward = std::min(edge, in) - 2 * within_;
    const bool lower = solid(lane.x, std::min(lane.low + 2 * within_, lane.y), inward);
    const double front = lower ? std::min(lane.front, lane.front_low) : lane.front;
    span.to = (edge - front) / length_;
    spans_.push_back(span);
  };
  // At both ends of the lane, too: what is left there may be shorter than a step.
  const double rim = 2 * within_;
  const int count = static_cast<int>(std::ceil((high - low) / step)) + 1;
  for (int n = -1; n <= count && before_at < high - rim; ++n) {
    const double at = n < 0 ? low + rim : std::min(low + (phase + n) * step, high - rim);
    if (at <= before_at) continue;
    const bool is_solid = solid(lane.x, lane.y, at);
    if (is_solid && at > lane.front && n >= 0 && at < high - rim) {
      const double when = (at - lane.front) / length_, half = 0.5 * step / length_;
      add(when - half, when + half, lane.area_mm2 * step);
    }
    if (is_solid && !was_solid) {
      const double edge = edge_between(lane, at, before_at);
      const double inward = std::max(edge, low) + 2 * within_;
      const bool higher = solid(lane.x, std::max(lane.high - 2 * within_, lane.y), inward);
      const double front = higher ? std::max(lane.front, lane.front_high) : lane.front;
      span.from = (edge - std::max(front, front_at_side(lane, inward))) / length_;
    } else if (!is_solid && was_solid) {
      close(before_at, at);
    }
    was_solid = is_solid;
    before_at = at;
  }
  if (was_solid) close(before_at, high);
}

double LaneScan::run(const SolidPoints& solid, const Box& box, double cell_mm, const Cutter& cutter,
                     const CutMove& move, const Grain& grain) {
  solid_ = &solid;
  cell_ = cell_mm;
  within_ = kWithin * cell_mm;
  spans_.clear();
  looks_ = 0;
  bins_.assign(1, 0.0);
  if (!set(box, cutter, move)) return 0;
  const int bins = static_cast<int>(std::ceil(length_ / std::max(grain.bin_mm, 1e-6)));
  bins_.assign(static_cast<std::size_t>(std::clamp(bins, 1, kMostBins)), 0.0);
  lay_lanes(grain);
  double phase = 0.5;
  for (const Lane& lane : lanes_) {
    walk(lane, phase, grain);
    phase = std::fmod(phase + kLaneStagger, 1.0);
  }
  clip_spans(spans_, 0, 1);
  merge_spans(spans_, grain.gap_mm / length_);
  return looks_;
}

}  // namespace kerf
