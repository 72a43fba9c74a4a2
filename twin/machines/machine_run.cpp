#include "twin/machines/machine_run.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/units.h"
#include "twin/machine/kinematics/arc_bounds.h"
#include "twin/machine/kinematics/work_frame.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

using Kind = ToolChain::Kind;
constexpr std::size_t kFirstTurn = 3;
constexpr std::size_t kFirstSlide = 6;
/// Slides whose directions span less than this are taken for parallel.
constexpr double kLeastSlides = 1e-9;

bool is_xyz(const ToolChain::Step& step) { return step.kind == Kind::kSlide && step.input < 3; }

AxisValues mapped(const KinematicsType& type, const AxisValues& program) {
  AxisValues axes{};
  for (std::size_t i = 0; i < kAxisCount; ++i) axes[i] = type.sign[i] * program[type.source[i]];
  return axes;
}

/// Of an arc's radius: where it grows, it turns round a little beside where a circle does.
double growth_of(const Motion& m) {
  const auto radius = [&](const Vec3& place) {
    const Vec3 arm = place - m.arc.center_mm;
    return glm::length(arm - glm::dot(arm, m.arc.axis) * m.arc.axis);
  };
  return std::abs(radius(m.to_mm) - radius(m.from_mm));
}

}  // namespace

Result<MachineRuns> MachineRuns::create(MachineKinematics machine, const WorkpieceFrame& frame) {
  Result<ToolPath> path = ToolPath::create(std::move(machine), frame, {});
  if (!path) return Error{path.error()};
  MachineRuns runs(std::move(path.value()));
  runs.frame_ = frame;
  runs.machine_from_workpiece_ = machine_from_workpiece(frame);
  runs.take_apart();
  return runs;
}

/// The steps from the workpiece to the tool: what lies before X, Y and Z, these, and what follows.
void MachineRuns::take_apart() {
  const ToolChain whole(machine().chain, machine().joint_letters);
  const auto& steps = whole.steps();
  const auto first = std::ranges::find_if(steps, is_xyz);
  auto last = steps.end();
  while (last != first && !is_xyz(*std::prev(last))) --last;
  const auto turns = [](const ToolChain::Step& step) { return step.kind == Kind::kTurn; };
  glm::dmat3 slides(0.0);
  std::vector<ToolChain::Step> after;
  for (auto step = first; step != steps.end(); ++step) {
    if (is_xyz(*step)) {
      slides[step->input] += step->vector;
    } else {
      after.push_back(*step);
    }
  }
  slides_are_together_ =
      std::none_of(first, last, turns) && std::abs(glm::determinant(slides)) > kLeastSlides;
  if (!slides_are_together_) return;
  axes_from_slides_ = glm::inverse(slides);
  std::vector<ToolChain::Step> before;
  for (auto step = first; step != steps.begin();) {
    --step;
    before.push_back({step->kind, step->input, -step->vector});
  }
  for (std::uint8_t i = 0; i < 3; ++i) {
    Vec3 along(0.0);
    along[i] = 1.0;
    before.push_back({Kind::kSlide, i, along});
  }
  to_slides_ = ToolChain(std::move(before));
  from_slides_ = ToolChain(std::move(after));
}

bool MachineRuns::knows(const Motion& motion) const {
  switch (machine().type(machine().type_of(motion)).mode) {
    case KinematicsMode::kAxes:
      return true;
    case KinematicsMode::kTip:
      return slides_are_together_;
    case KinematicsMode::kArm:
      break;
  }
  return false;
}

Vec3 MachineRuns::tip_from_nose(const Motion& motion, double tool_mm) const {
  const Vec3& nose = machine().nose_from_tip;
  if (motion.tool_offset_mm == Vec3(0.0)) return -tool_mm * nose;
  const KinematicsType& type = machine().type(machine().type_of(motion));
  if (type.mode != KinematicsMode::kAxes) return -motion.tool_offset_mm;
  Vec3 offset(0.0);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    offset[i] = type.sign[axis] * motion.tool_offset_mm[type.source[axis]];
  }
  return -offset;
}

void MachineRuns::follow(const Motion& motion, double tool_mm, MachineRun& run) const {
  assert(knows(motion) && motion.start_known);
  const Vec3& nose = machine().nose_from_tip;
  const bool has_offset = motion.tool_offset_mm != Vec3(0.0);
  run.runs_ = this;
  run.motion_ = &motion;
  run.type_ = &machine().type(machine().type_of(motion));
  run.offset_mm_ = has_offset ? motion.tool_offset_mm : tool_mm * nose;
  run.told_tool_mm_ = (has_offset ? machine().told_tool(motion.tool_offset_mm.z) : tool_mm) * nose;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    run.from_[kFirstTurn + i] = motion.from_abc_deg[i] + frame_.offset_abc_deg[i];
    run.to_[kFirstTurn + i] = motion.to_abc_deg[i] + frame_.offset_abc_deg[i];
    const double offset = frame_.offset_uvw_mm[axis] + motion.tool_offset_uvw_mm[axis];
    run.from_[kFirstSlide + i] = motion.from_uvw_mm[axis] + offset;
    run.to_[kFirstSlide + i] = motion.to_uvw_mm[axis] + offset;
  }
  run.bound_program();
  run.type_->mode == KinematicsMode::kAxes ? run.bound_axes() : run.bound_slides();
}

AxisValues MachineRun::program_at(double t) const {
  const Motion& m = *motion_;
  const Vec3 tip = t <= 0 ? m.from_mm : t >= 1 ? m.to_mm : point_at(m, t);
  const Vec3 xyz = runs_->machine_from_workpiece_.point(tip) + offset_mm_;
  AxisValues program{xyz.x, xyz.y, xyz.z};
  for (std::size_t i = kFirstTurn; i < kAxisCount; ++i)
    program[i] = t >= 1 ? to_[i] : from_[i] + t * (to_[i] - from_[i]);
  return program;
}

Vec3 MachineRun::slides_at(const AxisValues& program) const {
  AxisValues nose = program;
  for (int i = 0; i < 3; ++i) nose[static_cast<std::size_t>(i)] -= told_tool_mm_[i];
  const Vec3 point = runs_->to_slides_.pose(nose).origin_mm;
  const Vec3 tip = runs_->from_slides_.pose(program).point(-told_tool_mm_);
  return runs_->axes_from_slides_ * (point - tip);
}

AxisValues MachineRun::axes_at(double t) const {
  AxisValues axes = program_at(t);
  if (type_->mode == KinematicsMode::kAxes) return mapped(*type_, axes);
  const Vec3 slides = slides_at(axes);
  for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)] = slides[i];
  return axes;
}

/// Of X Y Z A B C U V W as the program has them, with offsets.
void MachineRun::bound_program() {
  const Motion& m = *motion_;
  program_ = {};
  for (std::size_t i = kFirstTurn; i < kAxisCount; ++i)
    program_.rate[i] = std::abs(to_[i] - from_[i]);
  if (is_arc(m)) {
    const ArcBounds arc = arc_bounds(m);
    for (std::size_t i = 0; i < 3; ++i) {
      program_.rate[i] = arc.speed;
      program_.acceleration[i] = arc.acceleration;
      program_.jerk[i] = arc.jerk;
    }
    return;
  }
  const Vec3 way = runs_->machine_from_workpiece_.direction(m.to_mm - m.from_mm);
  for (int i = 0; i < 3; ++i) program_.rate[static_cast<std::size_t>(i)] = std::abs(way[i]);
}

/// Each axis goes by itself.
void MachineRun::bound_axes() {
  bounds_ = {};
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const std::size_t source = type_->source[i];
    bounds_.rate[i] = program_.rate[source];
    bounds_.acceleration[i] = program_.acceleration[source];
    bounds_.jerk[i] = program_.jerk[source];
  }
  AxisValues low = program_at(0), high = program_at(1);
  if (is_arc(*motion_)) {
    const Box tips = box_around(runs_->machine_from_workpiece_, kerf::bounds_of(*motion_));
    const double growth = growth_of(*motion_);
    for (int i = 0; i < 3; ++i) {
      low[static_cast<std::size_t>(i)] = tips.min[i] + offset_mm_[i] - growth;
      high[static_cast<std::size_t>(i)] = tips.max[i] + offset_mm_[i] + growth;
    }
  }
  span_ = {mapped(*type_, low), mapped(*type_, high)};
  for (std::size_t i = 0; i < kAxisCount; ++i)
    if (span_.low[i] > span_.high[i]) std::swap(span_.low[i], span_.high[i]);
}

/// The slides are the difference of two points that chains carry (MachineRuns): each bends no more
/// than its chain says.
void MachineRun::bound_slides() {
  const AxisValues middle = program_at(0.5);
  AxisValues nose = middle;
  for (int i = 0; i < 3; ++i) nose[static_cast<std::size_t>(i)] -= told_tool_mm_[i];
  const PathBounds there = runs_->to_slides_.bounds(nose, program_, 1, Vec3(0.0));
  const PathBounds back = runs_->from_slides_.bounds(middle, program_, 1, -told_tool_mm_);
  bounds_ = program_;
  const AxisValues begin = axes_at(0), end = axes_at(1), between = axes_at(0.5);
  const glm::dmat3& axes_from_slides = runs_->axes_from_slides_;
  const bool is_straight = there.acceleration_mm + back.acceleration_mm == 0;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double share =
        glm::length(Vec3(axes_from_slides[0][i], axes_from_slides[1][i], axes_from_slides[2][i]));
    bounds_.rate[axis] = share * (there.speed_mm + back.speed_mm);
    bounds_.acceleration[axis] = share * (there.acceleration_mm + back.acceleration_mm);
    bounds_.jerk[axis] = share * (there.jerk_mm + back.jerk_mm);
  }
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const bool ends = i >= kFirstTurn || is_straight;
    span_.low[i] = ends ? std::min(begin[i], end[i]) : between[i] - bounds_.rate[i] / 2;
    span_.high[i] = ends ? std::max(begin[i], end[i]) : between[i] + bounds_.rate[i] / 2;
  }
}

Pose LinkWay::pose(double t) const {
  return still_from_ * (chain_.pose(run_.axes_at(t)) * link_from_body_);
}

PathBounds LinkWay::bounds(double from, double to, double reach_mm) const {
  return chain_.bounds(run_.axes_at((from + to) / 2), run_.bounds(), to - from,
                       link_from_body_.origin_mm, reach_mm);
}

double LinkWay::slack_mm(double from, double to, double reach_mm) const {
  // A point's chord is off by no more than an eighth of its second derivative.
  const double part = to - from;
  return bounds(from, to, reach_mm).acceleration_mm * part * part / 8;
}

double LinkWay::turning_mm(double from, double to, double reach_mm) const {
  return bounds(from, to, reach_mm).turning_rad * (to - from) * reach_mm;
}

double LinkWay::travel_mm(double from, double to, double reach_mm) const {
  return bounds(from, to, reach_mm).speed_mm * (to - from);
}

double most_way_mm(const ToolChain& chain, const AxisValues& from, const AxisSpan& span,
                   const Vec3& end_mm, double reach_mm) {
  // Of the points as seen from the frame reached so far, from the last one back: how far they are
  // from its origin where the axes stand at `from`, and how far they go.
  double away = reach_mm, way = 0;
  Vec3 level = end_mm, slid(0.0);
  const auto close_level = [&] {
    way += glm::length(slid);
    away += glm::length(level);
    level = slid = Vec3(0.0);
  };
  for (auto step = chain.steps().rbegin(); step != chain.steps().rend(); ++step) {
    const std::size_t i = step->input;
    switch (step->kind) {
      case Kind::kShift:
        level += step->vector;
        break;
      case Kind::kSlide: {
        level += step->vector * from[i];
        const double most = std::max({span.high[i] - from[i], from[i] - span.low[i], 0.0});
        slid += glm::abs(step->vector) * most;
        break;
      }
      case Kind::kTurn: {
        close_level();
        const double most = std::max({span.high[i] - from[i], from[i] - span.low[i], 0.0});
        way += std::min(most * kRadPerDeg, 2.0) * (away + way);
        break;
      }
    }
  }
  close_level();
  return way;
}

}  // namespace kerf
