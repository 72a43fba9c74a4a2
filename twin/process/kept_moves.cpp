#include "twin/process/kept_moves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "twin/motion/least_height.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Heights of the models are float: what is this little below an envelope has been cut by it.
constexpr double kReached_mm = 1e-4;

Motion motion_from(const Vec3& from_mm, const Vec3& to_mm, const CutArc* arc) {
  Motion m;
  m.kind = arc != nullptr ? MotionKind::kArc : MotionKind::kFeed;
  m.from_mm = from_mm;
  m.to_mm = to_mm;
  if (arc != nullptr) {
    m.arc.center_mm = arc->center_mm;
    m.arc.axis = arc->axis;
    m.arc.sweep_rad = arc->sweep_rad;
  }
  return m;
}

}  // namespace

void KeptMoves::Reach::extend(const Reach& other) {
  min = glm::min(min, other.min);
  max = glm::max(max, other.max);
  low = std::min(low, other.low);
}

void KeptMoves::add(const Cutter& cutter, std::span<const CutMove> moves) {
  if (moves.empty() || !is_exact_) return;
  const bool fits = moves_.size() + moves.size() <= kMost;
  const bool is_plain =
      !cutter.undercuts() && cutter.insert() == nullptr && cutter.footprint() == nullptr &&
      std::ranges::all_of(moves,
                          [](const CutMove& m) { return m.is_vertical() && m.lead_mm == 0; });
  if (!fits || !is_plain) {
    *this = KeptMoves();
    is_exact_ = false;
    return;
  }
  if (&cutter != last_cutter_ || mounts_.back().cutter.spec() != cutter.spec()) {
    mounts_.push_back({cutter, is_convex(cutter)});
    last_cutter_ = &cutter;
  }
  for (const CutMove& move : moves) {
    const auto label = static_cast<std::uint32_t>(std::min<std::uint64_t>(move.id, kStraight - 1));
    Move kept{move.from_mm, move.to_mm, label, kStraight,
              static_cast<std::uint32_t>(mounts_.size() - 1)};
    if (move.arc) {
      kept.arc = static_cast<std::uint32_t>(arcs_.size());
      arcs_.push_back(*move.arc);
    }
    const Box box =
        bounds_of(motion_from(move.from_mm, move.to_mm, move.arc ? &arcs_[kept.arc] : nullptr));
    const Vec2 radius(cutter.radius_mm() + kCutterRim_mm);
    Reach reach;
    reach.min = Vec2(box.min) - radius;
    reach.max = Vec2(box.max) + radius;
    reach.low = box.min.z - kReached_mm;
    const std::size_t number = moves_.size();
    moves_.push_back(kept);
    reach_.push_back(reach);
    if (number % kChunk == 0) chunks_.emplace_back();
    if (number % (kChunk * kChunk) == 0) groups_.emplace_back();
    chunks_.back().extend(reach);
    groups_.back().extend(reach);
  }
}

template <class Take>
void KeptMoves::each_meeting(const Vec3& low, const Vec3& high, const Take& take) const {
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    if (!groups_[group].meets(low, high)) continue;
    const std::size_t last_chunk = std::min(chunks_.size(), (group + 1) * kChunk);
    for (std::size_t chunk = group * kChunk; chunk < last_chunk; ++chunk) {
      if (!chunks_[chunk].meets(low, high)) continue;
      const std::size_t last = std::min(moves_.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < last; ++i) {
        if (reach_[i].meets(low, high) && !take(static_cast<std::uint32_t>(i))) return;
      }
    }
  }
}

double KeptMoves::least_over(std::uint32_t move, const Vec2& xy_mm) const {
  const Move& m = moves_[move];
  const Mount& mount = mounts_[m.mount];
  const LeftHeight left{mount.cutter, xy_mm, 0};
  if (m.arc == kStraight && m.from_mm.z == m.to_mm.z) {  // most moves, and fast
    const Vec2 from(m.from_mm), way = Vec2(m.to_mm) - from;
    const double square = glm::dot(way, way);
    const double t = square > 0 ? std::clamp(glm::dot(xy_mm - from, way) / square, 0.0, 1.0) : 0.0;
    return left.at(m.from_mm + t * (m.to_mm - m.from_mm));
  }
  thread_local Motion motion;
  const CutArc* const arc = m.arc == kStraight ? nullptr : &arcs_[m.arc];
  motion.kind = arc != nullptr ? MotionKind::kArc : MotionKind::kFeed;
  motion.from_mm = m.from_mm;
  motion.to_mm = m.to_mm;
  if (arc != nullptr) {
    motion.arc.center_mm = arc->center_mm;
    motion.arc.axis = arc->axis;
    motion.arc.sweep_rad = arc->sweep_rad;
  }
  return least_height(motion, left, mount.is_convex);
}

/// What lies lower than the whole move, or under the cutter's rim where it is higher, is not looked
/// at closely.
bool KeptMoves::cuts(std::uint32_t move, const Vec3& point_mm) const {
  if (!reach_[move].meets(point_mm, point_mm)) return false;
  const Move& m = moves_[move];
  const double z = point_mm.z + kReached_mm;
  if (m.arc == kStraight && m.from_mm.z != m.to_mm.z) {
    const Vec2 from(m.from_mm), way = Vec2(m.to_mm) - from, p(point_mm);
    const double square = glm::dot(way, way);
    const double t = square > 0 ? std::clamp(glm::dot(p - from, way) / square, 0.0, 1.0) : 0.0;
    const LeftHeight left{mounts_[m.mount].cutter, p, 0};
    const Vec3 nearest(from + t * way, std::min(m.from_mm.z, m.to_mm.z));
    if (left.at(nearest) > z) return false;
  }
  return least_over(move, Vec2(point_mm)) <= z;
}

KeptMoves::Lowest KeptMoves::lowest(const Vec2& xy_mm) const {
  return Near(*this, Box{Vec3(xy_mm, 0), Vec3(xy_mm, std::numeric_limits<double>::infinity())})
      .lowest(xy_mm);
}

std::optional<std::uint32_t> KeptMoves::cut_by(const Vec3& point_mm) const {
  std::optional<std::uint32_t> found;
  each_meeting(point_mm, point_mm, [&](std::uint32_t move) {
    if (cuts(move, point_mm)) found = moves_[move].label;
    return !found;
  });
  return found;
}

KeptMoves::Near::Near(const KeptMoves& kept, const Box& box_mm) : kept_(kept) {
  kept.each_meeting(box_mm.min, box_mm.max, [&](std::uint32_t move) {
    moves_.push_back(move);
    return true;
  });
}

std::optional<std::uint32_t> KeptMoves::Near::cut_by(const Vec3& point_mm) const {
  const std::size_t count = moves_.size();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t at = (last_ + n) % count;
    const std::uint32_t move = moves_[at];
    if (!kept_.cuts(move, point_mm)) continue;
    last_ = at;
    return kept_.moves_[move].label;
  }
  return std::nullopt;
}

KeptMoves::Lowest KeptMoves::Near::lowest(const Vec2& xy_mm) const {
  Lowest lowest{std::numeric_limits<double>::infinity()};
  for (const std::uint32_t move : moves_) {
    // What stays above the lowest one cannot be lower.
    const Vec3 at(xy_mm, lowest.z_mm);
    if (!kept_.reach_[move].meets(at, at)) continue;
    const double z = kept_.least_over(move, xy_mm);
    if (z < lowest.z_mm) lowest = {z, kept_.moves_[move].label};
  }
  return lowest;
}

KeptMoves::Far KeptMoves::Near::farthest(const Vec2& from_mm, const Vec2& to_mm, double z_mm,
                                         double fine) const {
  const Vec3 low(glm::min(from_mm, to_mm), z_mm), high(glm::max(from_mm, to_mm), z_mm);
  const auto at = [&](double share) { return Vec3(from_mm + share * (to_mm - from_mm), z_mm); };
  tried_.clear();
  for (const std::uint32_t move : moves_)
    if (kept_.reach_[move].meets(low, high)) tried_.push_back(move);
  Far far;
  far.tried = tried_.size();
  // Again as long as something has been cut: what begins farther on counts once that is reached.
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const std::uint32_t move : tried_) {
      const double next = far.is_cut ? far.share + fine : 0;
      if (next > 1) return far;
      if (!kept_.cuts(move, at(next))) continue;
      double cut = next, left = 1;
      if (kept_.cuts(move, at(1))) cut = 1;
      while (left - cut > fine) {
        const double middle = 0.5 * (cut + left);
        (kept_.cuts(move, at(middle)) ? cut : left) = middle;
      }
      goes_on = true;
      far.is_cut = true;
      far.share = cut;
      far.label = kept_.moves_[move].label;
    }
  }
  return far;
}

void KeptMoves::tips_of(std::size_t move, double step_mm, std::vector<Vec3>& tips) const {
  const Move& m = moves_[move];
  const Motion motion =
      motion_from(m.from_mm, m.to_mm, m.arc == kStraight ? nullptr : &arcs_[m.arc]);
  const double steps = std::max(1.0, std::ceil(path_length_mm(motion) / step_mm));
  tips.clear();
  for (double n = 0; n <= steps; ++n) tips.push_back(point_at(motion, n / steps));
}

std::optional<KeptMoves::Pass> KeptMoves::nearest_pass(const Vec3& point_mm) const {
  std::optional<Pass> best;
  std::vector<Vec3> tips;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    const Reach& r = reach_[i];
    const double dx = std::max({r.min.x - point_mm.x, 0.0, point_mm.x - r.max.x});
    const double dy = std::max({r.min.y - point_mm.y, 0.0, point_mm.y - r.max.y});
    const double dz = std::max(r.low - point_mm.z, 0.0);
    const double box2 = dx * dx + dy * dy + dz * dz;
    if (best && box2 >= best->distance_mm * best->distance_mm) continue;
    const Move& m = moves_[i];
    const double radius = mounts_[m.mount].cutter.radius_mm();
    // The middle of the cutter's end, along the move in steps of a fifth of its radius.
    tips_of(i, 0.2 * radius, tips);
    for (const Vec3& tip : tips) {
      const double beside = std::max(0.0, glm::length(Vec2(point_mm) - Vec2(tip)) - radius);
      const double below = std::max(0.0, tip.z - point_mm.z);
      const double distance = std::hypot(beside, below);
      if (!best || distance < best->distance_mm) best = Pass{m.label, distance};
    }
  }
  return best;
}

}  // namespace kerf
