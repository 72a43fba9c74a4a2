#include "twin/scene/frame_moves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"
#include "twin/scene/tool_shape.h"

namespace kerf {
namespace {

/// Chords of the motion's way; 1 for straight ones.
int chord_count(const Motion& m) {
  if (m.kind != MotionKind::kArc) return 1;
  const auto radius = [&m](const Vec3& p) {
    const Vec3 arm = p - m.arc.center_mm;
    return glm::length(arm - glm::dot(arm, m.arc.axis) * m.arc.axis);
  };
  const double greatest_mm = std::max(radius(m.from_mm), radius(m.to_mm));
  // At least eight a turn, however small the circle.
  double step_rad = kPi / 4;
  if (greatest_mm > FrameMoves::kChordTolerance_mm) {
    step_rad =
        std::min(step_rad, 2.0 * std::acos(1.0 - FrameMoves::kChordTolerance_mm / greatest_mm));
  }
  return std::max(1, static_cast<int>(std::ceil(std::abs(m.arc.sweep_rad) / step_rad)));
}

void add_chords(const Motion& m, std::uint32_t tool, std::vector<SweptMove>& moves) {
  const int count = chord_count(m);
  Vec3 from = m.from_mm;
  for (int i = 1; i <= count; ++i) {
    const Vec3 to = i == count ? m.to_mm : point_at(m, static_cast<double>(i) / count);
    moves.push_back({from, to, tool});
    from = to;
  }
}

bool reaches(const Box& tip_mm, double radius_mm, const Box& blank_mm) {
  return tip_mm.min.z < blank_mm.max.z && tip_mm.min.x - radius_mm < blank_mm.max.x &&
         tip_mm.max.x + radius_mm > blank_mm.min.x && tip_mm.min.y - radius_mm < blank_mm.max.y &&
         tip_mm.max.y + radius_mm > blank_mm.min.y;
}

}  // namespace

std::size_t low_cells(const HeightGrid& grid) {
  const float top = static_cast<float>(grid.bounds_mm().max.z);
  std::size_t low = 0;
  for (int j = 0; j < grid.ny(); ++j) {
    for (int i = 0; i < grid.nx(); ++i) low += grid.height(i, j) < top ? 1 : 0;
  }
  return low;
}

FrameMoves::FrameMoves(std::shared_ptr<const ProgramTrack> track,
                       std::shared_ptr<const CutQuery> cuts, const Box& blank_mm)
    : track_(std::move(track)), cuts_(std::move(cuts)), blank_mm_(blank_mm) {
  std::unordered_map<std::string, std::uint32_t> tool_of_shape;
  const Cutter* last = nullptr;
  for (std::size_t i = 0; cuts_ && i < track_->size(); ++i) {
    const Cutter* const cutter = cuts_->cutter_at(i);
    if (!cutter || cutter == last) continue;
    last = cutter;
    const auto [shape, is_new] =
        tool_of_shape.emplace(cutter->spec(), static_cast<std::uint32_t>(tools_.size()));
    if (is_new) {
      CsgTool tool;
      tool.shape = *tool_shape_of(*cutter);
      tools_.push_back(std::move(tool));
    }
    tool_of_.emplace(cutter, shape->second);
  }
}

const Cutter* FrameMoves::cutter_of(const Motion& m, std::size_t number) const {
  if (!m.start_known || (!is_feed(m) && !is_traverse(m))) return nullptr;
  const Cutter* const cutter = cuts_ ? cuts_->cutter_at(number) : nullptr;
  return cutter && reaches(bounds_of(m), cutter->radius_mm(), blank_mm_) ? cutter : nullptr;
}

std::vector<SweptMove> FrameMoves::between(const TrackPosition& from,
                                           const TrackPosition& to) const {
  std::vector<SweptMove> moves;
  for (std::size_t i = from.motion; i <= to.motion && i < track_->size(); ++i) {
    const double begin = i == from.motion ? from.fraction : 0;
    const double end = i == to.motion ? to.fraction : 1;
    if (end <= begin) continue;
    const Motion motion = track_->motion(i);
    if (const Cutter* const cutter = cutter_of(motion, i)) {
      add_chords(part_of(motion, begin, end), tool_of_.at(cutter), moves);
    }
  }
  return moves;
}

std::size_t FrameMoves::count_until(const TrackPosition& to) const {
  std::size_t count = 0;
  const std::size_t end = std::min(track_->size(), to.motion + (to.fraction > 0 ? 1 : 0));
  for (std::size_t i = 0; i < end; ++i) {
    const Motion motion = track_->motion(i);
    if (cutter_of(motion, i)) count += static_cast<std::size_t>(chord_count(motion));
  }
  return count;
}

}  // namespace kerf
