#include "twin/scene/sheet_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "twin/job/stock_choice.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"
#include "twin/process/process.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

/// Walls that are off by no more than this from one another are the same: arcs are polygons.
constexpr double kSameWall_mm = 0.01;
/// Of the way of an arc that is not level, seen from above.
constexpr int kSteps = 64;

double distance_mm(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 way = to - from;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(point - from, way) / square, 0.0, 1.0) : 0.0;
  return glm::length(from + t * way - point);
}

/// From the motion's way, seen from above.
double distance_mm(const Motion& motion, const Vec2& point) {
  Motion flat = motion;
  flat.from_mm.z = flat.to_mm.z = 0;
  if (motion.kind != MotionKind::kArc) return distance_mm(point, flat.from_mm, flat.to_mm);
  if (motion.arc.axis.x == 0 && motion.arc.axis.y == 0) {
    flat.arc.center_mm.z = 0;
    return nearest_on(flat, Vec3(point, 0), 0).distance_mm;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    least = std::min(least, distance_mm(point, point_at(motion, static_cast<double>(i) / kSteps),
                                        point_at(motion, (i + 1.0) / kSteps)));
  }
  return least;
}

/// From the outline of a stroke.
double distance_mm(const Cutter::Footprint& outline, const PunchHit& hit, const Vec2& point) {
  const double c = std::cos(hit.turn_rad), s = std::sin(hit.turn_rad);
  // Into the frame of the punch, instead of the punch into that of the sheet.
  const Vec2 at = point - Vec2(hit.place_mm);
  const Vec2 local(c * at.x + s * at.y, -s * at.x + c * at.y);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& ring : outline) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      least = std::min(least, distance_mm(local, ring[i], ring[(i + 1) % ring.size()]));
    }
  }
  return least;
}

}  // namespace

bool SheetQuery::Nearest::accepts(double candidate_mm) const {
  return wall ? candidate_mm < off_mm - kSameWall_mm : candidate_mm <= off_mm;
}

std::shared_ptr<const SheetQuery> SheetQuery::of(const PlayerProgram& program) {
  const TurretPointer turret = program.process->turret();
  const bool burns = program.process->beam() != nullptr;
  if (!program.track || !program.blank || (!burns && !turret)) return nullptr;
  std::shared_ptr<SheetQuery> query(new SheetQuery(program.track));
  if (turret) {
    query->punch_.emplace(turret);
  } else {
    query->find_burns(program);
  }
  return query;
}

void SheetQuery::find_burns(const PlayerProgram& program) {
  const BeamSettings& beam = *program.process->beam();
  const TorchMoves torch(beam.trigger, beam.pierce_mm);
  const std::unique_ptr<MotionTools> kerfs =
      program.process->tools(program.tools, row_of(*program.blank).can_cut);
  const auto motion_at = [&](std::size_t i) { return track_->motion(i); };
  const ResolvedTool* last = nullptr;
  for (std::size_t i = 0; i < track_->size(); ++i) {
    const Motion motion = track_->motion(i);
    const ResolvedTool* const burning = kerfs->of(motion, program.materials).tool;
    if (!burning || !burning->cutter) continue;
    const ResolvedTool& tool = *burning;
    if (&tool != last) {
      last = &tool;
      names_.push_back(tool_name_of(*tool.cutter));
      if (!tool.origin.empty()) names_.back() += fmt::format(" ({})", tool.origin);
    }
    Burn burn{i, static_cast<float>(tool.cutter->radius_mm()), 0,
              static_cast<std::uint32_t>(names_.size() - 1)};
    const auto half_hole_mm = static_cast<float>(0.5 * beam.pierce_mm);
    if (half_hole_mm > burn.half_kerf_mm && torch.pierces(i, motion_at)) {
      burn.half_hole_mm = half_hole_mm;
    }
    burns_.push_back(burn);
  }
}

void SheetQuery::look_at_burns(const Vec2& point_mm, const TrackPosition& until,
                               Nearest* nearest) const {
  for (const Burn& burn : burns_) {
    if (burn.motion > until.motion || (burn.motion == until.motion && !(until.fraction > 0))) {
      return;
    }
    Motion motion = track_->motion(burn.motion);
    if (burn.motion == until.motion) motion = part_of(motion, 0, until.fraction);
    double off_mm = std::abs(distance_mm(motion, point_mm) - burn.half_kerf_mm);
    if (burn.half_hole_mm > 0) {
      const double from_mm = glm::length(point_mm - Vec2(motion.from_mm));
      off_mm = std::min(off_mm, std::abs(from_mm - burn.half_hole_mm));
    }
    if (!nearest->accepts(off_mm)) continue;
    nearest->off_mm = off_mm;
    nearest->wall = Wall{burn.motion, names_[burn.name]};
  }
}

void SheetQuery::look_at_strokes(const Vec2& point_mm, const TrackPosition& until,
                                 Nearest* nearest) const {
  const auto motion_at = [&](std::size_t i) { return track_->motion(i); };
  std::vector<PunchHit> hits;
  for (std::size_t i = 0; i < track_->size() && i <= until.motion; ++i) {
    const TurretStation* const station = punch_->turret().station(track_->tool(i));
    const Cutter::Footprint* const outline = station ? station->punch.footprint() : nullptr;
    if (!outline) continue;
    hits.clear();
    punch_->hits(i, motion_at, hits);
    for (const PunchHit& hit : hits) {
      if (i == until.motion && (hit.share > until.fraction || !(until.fraction > 0))) break;
      const double apart_mm = glm::length(point_mm - Vec2(hit.place_mm));
      if (apart_mm > station->punch.radius_mm() + kReach_mm) continue;
      const double off_mm = distance_mm(*outline, hit, point_mm);
      if (!nearest->accepts(off_mm)) continue;
      nearest->off_mm = off_mm;
      nearest->wall = Wall{i, station->name.empty() ? station->shape : station->name};
    }
  }
}

std::optional<SheetQuery::Wall> SheetQuery::wall_at(const Vec3& point_mm,
                                                    const TrackPosition& until) const {
  Nearest nearest;
  if (punch_) {
    look_at_strokes(Vec2(point_mm), until, &nearest);
  } else {
    look_at_burns(Vec2(point_mm), until, &nearest);
  }
  return nearest.wall;
}

}  // namespace kerf
