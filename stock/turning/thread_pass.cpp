#include "stock/turning/thread_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/mesh_patch.h"
#include "base/portable_math.h"

namespace kerf::turning {
namespace {

/// Beyond the material, so that no cut edge lies on it.
constexpr double kClipMargin_mm = 0.05;
/// How much farther a pass may go than the one that covers it.
constexpr double kWayFilm_mm = 1e-3;

double cross_of(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

double area2(const ConvexChain& chain) {
  double sum = 0;
  for (std::size_t i = 2; i < chain.size(); ++i)
    sum += cross_of(chain[i - 1] - chain[0], chain[i] - chain[0]);
  return sum;
}

/// What lies on the side of a line on which `height` is not negative.
template <class Height>
ConvexChain clipped(const ConvexChain& chain, Height&& height) {
  ConvexChain kept;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2 &a = chain[i == 0 ? chain.size() - 1 : i - 1], &b = chain[i];
    const double from = height(a), to = height(b);
    if ((from < 0) != (to < 0)) kept.push_back(a + from / (from - to) * (b - a));
    if (to >= 0) kept.push_back(b);
  }
  return kept;
}

/// How far a point lies outside of a convex chain, by its lines.
double outside_by(const ConvexChain& chain, const Vec2& p) {
  double most = -1e300;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Vec2 &a = chain[i == 0 ? chain.size() - 1 : i - 1], &b = chain[i];
    const double length = glm::distance(a, b);
    if (length > 0) most = std::max(most, -cross_of(b - a, p - a) / length);
  }
  return most;
}

/// What a convex chain sweeps from one place to another, on the grid.
void hull_of(const ConvexChain& chain, const Vec2& from, const Vec2& to, ConvexRegion& region) {
  // Corners on the right of the way go along it, those on the left come back: in the chain's order
  // each is where it is last seen, and once in both places where the two meet.
  const Vec2 way = to - from;
  const std::size_t n = chain.size();
  std::size_t right = 0, left = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (cross_of(way, chain[i] - chain[right]) < 0) right = i;
    if (cross_of(way, chain[i] - chain[left]) > 0) left = i;
  }
  std::vector<Point> corners;
  for (std::size_t i = right; i != left; i = i + 1 == n ? 0 : i + 1)
    corners.push_back(to_units(chain[i] + to));
  corners.push_back(to_units(chain[left] + to));
  for (std::size_t i = left; i != right; i = i + 1 == n ? 0 : i + 1)
    corners.push_back(to_units(chain[i] + from));
  corners.push_back(to_units(chain[right] + from));
  region.assign(corners);
}

}  // namespace

ConvexChain between_heights(const ConvexChain& chain, double low_r_mm, double high_r_mm) {
  ConvexChain kept = clipped(chain, [&](const Vec2& p) { return high_r_mm - p.y; });
  kept = clipped(kept, [&](const Vec2& p) { return p.y - low_r_mm; });
  if (kept.size() < 3 || !(area2(kept) > 0)) kept.clear();
  return kept;
}

std::optional<ThreadPass> ThreadPass::create(const GridPart& part, const Vec2& from_mm,
                                             const Vec2& to_mm, double lead_mm, double from_turns,
                                             double low_r_mm, double high_r_mm, std::uint64_t id) {
  ThreadPass pass;
  pass.set_way(from_mm, to_mm);
  if (!(pass.length_mm_ > 0)) return std::nullopt;
  ConvexChain chain;
  for (const Point& p : part.corners()) chain.push_back(turning::to_mm(p));
  pass.low_r_mm_ = low_r_mm - kClipMargin_mm;
  pass.high_r_mm_ = high_r_mm + kClipMargin_mm;
  pass.corners_ = between_heights(chain, pass.low_r_mm_ - std::max(from_mm.y, to_mm.y),
                                  pass.high_r_mm_ - std::min(from_mm.y, to_mm.y));
  if (pass.corners_.empty()) return std::nullopt;
  pass.lead_mm_ = lead_mm;
  pass.from_turns_ = from_turns - std::floor(from_turns);
  pass.id_ = id;
  pass.find_extent();
  return pass;
}

void ThreadPass::set_way(const Vec2& from_mm, const Vec2& to_mm) {
  from_ = from_mm;
  to_ = to_mm;
  length_mm_ = glm::distance(from_mm, to_mm);
  if (length_mm_ > 0) direction_ = (to_mm - from_mm) / length_mm_;
}

void ThreadPass::find_extent() {
  low_ = high_ = corners_[0];
  for (const Vec2& p : corners_) {
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
  }
}

std::optional<ThreadPass> ThreadPass::restored(ConvexChain corners, const Vec2& from_mm,
                                               const Vec2& to_mm, double lead_mm, double from_turns,
                                               double low_r_mm, double high_r_mm,
                                               std::uint64_t id) {
  const auto is_place = [](const Vec2& p) {
    return std::abs(p.x) <= kMaxCoordinate_mm && std::abs(p.y) <= kMaxCoordinate_mm;
  };
  const bool is_sound = is_place(from_mm) && is_place(to_mm) && std::isfinite(lead_mm) &&
                        std::abs(lead_mm) >= kLeastLead_mm && from_turns >= 0 && from_turns < 1 &&
                        is_place({low_r_mm, high_r_mm}) && corners.size() >= 3;
  if (!is_sound) return std::nullopt;
  const std::size_t n = corners.size();
  double around = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    if (!(glm::length(a) <= 2 * kMaxInsertReach_mm)) return std::nullopt;
    const double turn = portable::atan2(cross_of(b - a, c - b), glm::dot(b - a, c - b));
    // Where outlines are clipped, corners may come to lie on a line, but for rounding.
    if (!(turn > -1e-6 && glm::distance(a, b) > 0)) return std::nullopt;
    around += turn;
  }
  if (!(around < 3 * kPi) || !(area2(corners) > 0)) return std::nullopt;
  ThreadPass pass;
  pass.set_way(from_mm, to_mm);
  if (!(pass.length_mm_ > 0)) return std::nullopt;
  pass.corners_ = std::move(corners);
  pass.lead_mm_ = lead_mm;
  pass.from_turns_ = from_turns;
  pass.low_r_mm_ = low_r_mm;
  pass.high_r_mm_ = high_r_mm;
  pass.id_ = id;
  pass.find_extent();
  return pass;
}

/// Half a turn about an axis across z: what was at an angle is at its opposite, and the hand stays.
ThreadPass ThreadPass::turned_about(double at_z_mm) const {
  ThreadPass pass = *this;
  pass.set_way({at_z_mm - from_.x, from_.y}, {at_z_mm - to_.x, to_.y});
  std::reverse(pass.corners_.begin(), pass.corners_.end());
  for (Vec2& p : pass.corners_) p.x = -p.x;
  pass.lead_mm_ = -lead_mm_;
  pass.from_turns_ = -from_turns_ - std::floor(-from_turns_);
  pass.find_extent();
  return pass;
}

ThreadPass ThreadPass::moved(double at_z_mm) const {
  ThreadPass pass = *this;
  pass.set_way({at_z_mm + from_.x, from_.y}, {at_z_mm + to_.x, to_.y});
  pass.find_extent();
  return pass;
}

std::uint32_t ThreadPass::mark() const {
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(id_, MeshPatch::kNotCut - std::uint64_t{1}));
}

ThreadPass::Turns ThreadPass::turns_seen(double low_turns, double high_turns, double low_way_mm,
                                         double high_way_mm) const {
  const double low_way = std::max(low_way_mm, 0.0), high_way = std::min(high_way_mm, length_mm_);
  if (!(low_way <= high_way)) return {};
  double low = low_way / lead_mm_, high = high_way / lead_mm_;
  if (lead_mm_ < 0) std::swap(low, high);
  return {static_cast<std::int64_t>(std::ceil(low - from_turns_ + low_turns)),
          static_cast<std::int64_t>(std::floor(high - from_turns_ + high_turns))};
}

Vec2 ThreadPass::swept_low_mm() const { return low_ + glm::min(from_, to_); }
Vec2 ThreadPass::swept_high_mm() const { return high_ + glm::max(from_, to_); }

Rect ThreadPass::swept_box() const {
  Rect box;
  box.extend(to_units(swept_low_mm()));
  box.extend(to_units(swept_high_mm()));
  return box;
}

void ThreadPass::swept(ConvexRegion& region) const { hull_of(corners_, from_, to_, region); }

void ThreadPass::swept_all_round(double gap_mm, ConvexRegion& region) const {
  std::vector<Point> none;
  region.assign(none);
  if (!(length_mm_ >= gap_mm)) return;
  ConvexChain common = corners_;
  const Vec2 by = gap_mm * direction_;
  for (std::size_t i = 0; i < corners_.size() && common.size() >= 3; ++i) {
    const Vec2 a = corners_[i == 0 ? corners_.size() - 1 : i - 1] + by, b = corners_[i] + by;
    common = clipped(common, [&](const Vec2& p) { return cross_of(b - a, p - a); });
  }
  if (common.size() >= 3) hull_of(common, from_, to_ - by, region);
}

bool ThreadPass::covers(const ThreadPass& other) const {
  // The same turn of both: there they are nearest.
  const Vec2 place = other.from_;
  const double near = glm::dot(place - from_, direction_);
  const double n = std::round(near / lead_mm_ - from_turns_ + other.from_turns_);
  const auto own_way = [&](double way) { return way_at(other.turns_at(way), n); };
  for (const double way : {0.0, other.length_mm_}) {
    const double own = own_way(way);
    if (own < -kWayFilm_mm || own > length_mm_ + kWayFilm_mm) return false;
  }
  // Both move evenly, and what lies outside is convex in place and way: it is most at the ends, or
  // where a corner comes to a border of the material.
  std::vector<double> ways{0, other.length_mm_};
  for (const Vec2& p : other.corners_) {
    for (const double border : {low_r_mm_, high_r_mm_}) {
      const double way = (border - p.y - other.from_.y) / other.direction_.y;
      if (way > 0 && way < other.length_mm_) ways.push_back(way);
    }
  }
  for (const double way : ways) {
    const Vec2 there = other.at(way), here = at(std::clamp(own_way(way), 0.0, length_mm_));
    const ConvexChain seen =
        between_heights(other.corners_, low_r_mm_ - there.y, high_r_mm_ - there.y);
    for (const Vec2& p : seen) {
      if (outside_by(corners_, p + there - here) > kThreadFilm_mm) return false;
    }
  }
  return true;
}

}  // namespace kerf::turning
