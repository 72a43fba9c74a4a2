#include "twin/playback/cut_query.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "twin/motion/least_height.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"
#include "twin/process/process.h"

namespace kerf {
namespace {

bool is_cutting(const Motion& m) { return is_feed(m) || is_traverse(m); }

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
  const double reach = radius_mm + probe.tolerance_mm + kCutterRim_mm;
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
