#include "twin/playback/cut_query.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "base/golden_section.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"
#include "twin/process/process.h"

namespace kerf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// At the rim of the cutter a point counts as under it: there rounding decides; mm.
constexpr double kRim_mm = 1e-9;
/// Slopes of profile pieces that differ by less go on in one direction.
constexpr double kSameSlope = 1e-9;
/// Steps of a search along curved ways, in radii of the cutter.
constexpr double kSearchStep = 0.02;
constexpr int kMostSteps = 20'000;
/// Shrinks the interval by 1e-12.
constexpr int kGoldenSteps = 58;

bool is_cutting(const Motion& m) { return is_feed(m) || is_traverse(m); }

double slope_at(const ProfilePiece& piece, double r, double z) {
  if (piece.kind == ProfilePiece::Kind::kLine) {
    const double run = piece.r1 - piece.r0;
    return run > 0 ? (piece.z1 - piece.z0) / run : kInfinity;
  }
  const double fall = piece.center_z - z;
  return fall > 0 ? (r - piece.center_r) / fall : kInfinity;
}

/// The height over the tip is a convex function of the radius: flat, ball, bull, vee, drill.
bool is_convex(const Cutter& cutter) {
  double slope = -kInfinity;
  for (const ProfilePiece& piece : cutter.profile()) {
    if (piece.kind == ProfilePiece::Kind::kArc && !piece.convex) return false;
    if (slope_at(piece, piece.r0, piece.z0) < slope - kSameSlope) return false;
    slope = slope_at(piece, piece.r1, piece.z1);
  }
  return true;
}

/// Height over the middle of the point that the cutter, widened by the tolerance, leaves while its
/// tip is at `tip`; infinite beside it.
struct LeftHeight {
  const Cutter& cutter;
  Vec2 point_mm;
  double tolerance_mm;

  double at(const Vec3& tip) const {
    const double beside = glm::length(point_mm - Vec2(tip)) - tolerance_mm;
    const double r = std::max(0.0, beside);
    const double radius = cutter.radius_mm();
    if (r > radius + kRim_mm) return kInfinity;
    return tip.z + cutter.height_mm(std::min(r, radius));
  }
};

/// Least value of a function with one minimum on [a, b].
template <class F>
double least_between(const F& f, double a, double b) {
  const double least = golden_section(f, a, b, kGoldenSteps, std::less<>{}).least;
  return std::min({f(a), f(b), least});
}

/// The part of a straight way over which the cutter is, in fractions. False: none.
bool under_cutter(const Motion& m, const Vec2& point, double reach_mm, double& from, double& to) {
  const Vec2 way = Vec2(m.to_mm) - Vec2(m.from_mm);
  const Vec2 start = Vec2(m.from_mm) - point;
  const double square = glm::dot(way, way);
  const double inner = glm::dot(start, start) - reach_mm * reach_mm;
  from = 0;
  to = 1;
  if (square == 0) return inner <= 0;
  const double middle = -glm::dot(start, way) / square;
  const double root = middle * middle - inner / square;
  if (root < 0) return false;
  from = std::max(0.0, middle - std::sqrt(root));
  to = std::min(1.0, middle + std::sqrt(root));
  return from <= to;
}

/// Samples, and a search around those that are lower than their neighbours.
template <class F>
double searched_minimum(const F& f, int steps) {
  const auto t = [steps](int i) { return static_cast<double>(i) / steps; };
  double least = kInfinity;
  double before = kInfinity;
  double here = f(0.0);
  for (int i = 0; i <= steps; ++i) {
    const double next = i < steps ? f(t(i + 1)) : kInfinity;
    if (here < kInfinity && here <= before && here <= next) {
      least = std::min(least, least_between(f, t(std::max(0, i - 1)), t(std::min(steps, i + 1))));
    }
    before = here;
    here = next;
  }
  return least;
}

bool is_level(const Motion& m) {
  if (m.from_mm.z != m.to_mm.z) return false;
  return m.kind != MotionKind::kArc || (m.arc.axis.x == 0 && m.arc.axis.y == 0);
}

/// Least height that the motion leaves over the point.
double least_height(const Motion& m, const LeftHeight& left, bool convex) {
  const double radius = left.cutter.radius_mm();
  if (is_level(m)) {
    const Vec3 beside(left.point_mm, m.from_mm.z);
    return left.at(point_at(m, nearest_on(m, beside, 0).t));
  }
  const auto height = [&](double t) { return left.at(point_at(m, t)); };
  if (m.kind != MotionKind::kArc) {
    double from = 0, to = 1;
    if (!under_cutter(m, left.point_mm, radius + left.tolerance_mm, from, to)) return kInfinity;
    if (convex) return least_between(height, from, to);
  }
  const double steps = path_length_mm(m) / (kSearchStep * radius);
  return searched_minimum(height, static_cast<int>(std::clamp<double>(steps, 8, kMostSteps)));
}

}  // namespace

CutQuery::CutQuery(std::shared_ptr<const ProgramTrack> track, ToolSources tools,
                   ToolResolver::CutterCheck can_cut)
    : track_(std::move(track)), mounts_(1) {
  const std::unique_ptr<MotionTools> mounted = default_process()->tools(tools, can_cut);
  const ResolvedTool* last = nullptr;
  for (std::size_t i = 0; i < track_->size(); ++i) {
    if (i % kChunk == 0) chunks_.emplace_back();
    const Motion m = track_->motion(i);
    if (!is_cutting(m)) continue;
    const ResolvedTool* const tool = mounted->of(m, {}).tool;
    const bool known = tool && tool->cutter;
    // A tool that was not known may be so the next time it is mounted.
    if (tool != last || known != (mounts_.back().cutter != nullptr)) add_mount(i, tool);
    last = tool;
    if (!known || !m.start_known) continue;
    chunks_.back().tip_mm.extend(bounds_of(m));
    chunks_.back().radius_mm = std::max(chunks_.back().radius_mm, mounts_.back().radius_mm);
  }
}

void CutQuery::add_mount(std::size_t motion, const ResolvedTool* tool) {
  Mount mount{motion, nullptr, 0, false};
  if (tool && tool->cutter) {
    mount.cutter = std::make_shared<const Cutter>(*tool->cutter);
    mount.radius_mm = tool->cutter->radius_mm();
    mount.convex = is_convex(*tool->cutter);
  }
  mounts_.push_back(std::move(mount));
}

std::size_t CutQuery::mount_index(std::size_t motion) const {
  const auto after =
      std::upper_bound(mounts_.begin(), mounts_.end(), motion,
                       [](std::size_t place, const Mount& mount) { return place < mount.motion; });
  return static_cast<std::size_t>(after - mounts_.begin()) - 1;
}

const Cutter* CutQuery::cutter_at(std::size_t motion) const {
  return mounts_[mount_index(motion)].cutter.get();
}

bool CutQuery::may_touch(const Box& tip_mm, double radius_mm, const Probe& probe) {
  const double reach = radius_mm + probe.tolerance_mm + kRim_mm;
  const Vec3& p = probe.point_mm;
  return p.x >= tip_mm.min.x - reach && p.x <= tip_mm.max.x + reach &&
         p.y >= tip_mm.min.y - reach && p.y <= tip_mm.max.y + reach &&
         p.z + probe.tolerance_mm >= tip_mm.min.z;
}

bool CutQuery::touches(const Motion& m, const Mount& mount, const Probe& probe) {
  if (!m.start_known || !is_cutting(m)) return false;
  if (!may_touch(bounds_of(m), mount.radius_mm, probe)) return false;
  const LeftHeight left{*mount.cutter, Vec2(probe.point_mm), probe.tolerance_mm};
  return least_height(m, left, mount.convex) <= probe.point_mm.z + probe.tolerance_mm;
}

std::optional<std::size_t> CutQuery::last_cut_at(const Vec3& point_mm, double tolerance_mm,
                                                 const TrackPosition& until) const {
  const Probe probe{point_mm, tolerance_mm};
  const std::size_t end = std::min(until.motion, track_->size());
  if (end < track_->size() && until.fraction > 0) {
    const Mount& mount = mounts_[mount_index(end)];
    const Motion part = part_of(track_->motion(end), 0, until.fraction);
    if (mount.cutter && touches(part, mount, probe)) return end;
  }
  for (std::size_t chunk = (end + kChunk - 1) / kChunk; chunk-- > 0;) {
    const Chunk& box = chunks_[chunk];
    if (box.tip_mm.empty() || !may_touch(box.tip_mm, box.radius_mm, probe)) continue;
    std::size_t i = std::min(end, (chunk + 1) * kChunk);
    std::size_t mount = mount_index(i - 1);
    while (i-- > chunk * kChunk) {
      if (i < mounts_[mount].motion) --mount;
      if (mounts_[mount].cutter && touches(track_->motion(i), mounts_[mount], probe)) return i;
    }
  }
  return std::nullopt;
}

}  // namespace kerf
