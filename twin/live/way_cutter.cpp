#include "twin/live/way_cutter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "twin/job/stock_choice.h"
#include "twin/live/real_tip.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Sensors tremble: a machine that moved less has not moved. mm.
constexpr double kWayStands_mm = 1e-6;
/// An axis that has turned by less stands. Degrees.
constexpr double kTurned_deg = 0.01;

/// The motion is under this type of the machine's kinematics.
void set_type(const MachineKinematics& machine, int type, Motion& motion) {
  if (!machine.is_switchable() || machine.switch_output >= TorchState::kAnalogs) return;
  motion.torch.analog[machine.switch_output] = static_cast<float>(type);
}

ToolLengthState real_length_of(const Reading& now) {
  ToolLengthState length;
  length.verdict = ToolLengthState::Verdict::kWrong;
  length.real_mm = {0, 0, now.tool_length_mm};
  length.applied_mm = length.real_mm + now.real_shift_mm;
  length.tip_shift_mm = now.real_shift_mm;
  length.displaces = true;
  return length;
}

/// A motion of the program, by the tool and the offset that the machine really has.
void take_real_length(const Reading& now, Motion& motion) {
  const Vec3 more_mm = now.real_shift_mm - motion.length.tip_shift_mm;
  if (!now.length_is_applied || now.by_length_before || more_mm == Vec3{0}) return;
  move_real_tip(more_mm, now.tool_length_mm, motion);
}

}  // namespace

bool is_near_blank(const StockModel& stock, bool has_beam, const Vec3& from_mm, const Vec3& to_mm,
                   double radius_mm) {
  const Box blank = stock.bounds_mm();
  Box way;
  way.extend(from_mm);
  way.extend(to_mm);
  return (has_beam || way.min.z < blank.max.z) && way.min.x - radius_mm < blank.max.x &&
         way.max.x + radius_mm > blank.min.x && way.min.y - radius_mm < blank.max.y &&
         way.max.y + radius_mm > blank.min.y;
}

WayCutter::WayCutter(StockModel& stock, const ToolSources& tools, FindingLog& log,
                     const LiveCutOptions& options, LiveFacts& facts)
    : stock_(stock),
      is_beam_(options.process->traits().is_beam),
      facts_(facts),
      resolver_(tools, row_of(stock).can_cut),
      stage_(stock, resolver_, log, options.timeline, *options.process),
      run_(ToolPathTolerance::of_cell(stock.cell_mm()).tip_mm, options.follow.lever_mm) {
  stage_.watch_machine();
  stage_.check_by(options.checks);
  if (options.checks.cutting.material) stage_.log_engagement(engagement_);
}

std::span<const TorchMaterial> WayCutter::update_materials() {
  if (program_->take_materials(materials_)) stage_.set_materials(materials_);
  return materials_;
}

Pose WayCutter::pose_in_workpiece(const Reading& at, int type) const {
  const ToolPath* const path = stage_.model_path();
  if (!path) return shift(at.place.tip_mm);
  Motion here;
  here.start_known = false;
  here.to_mm = at.place.tip_mm;
  here.to_abc_deg = here.from_abc_deg = at.place.abc_deg;
  here.to_uvw_mm = here.from_uvw_mm = at.place.uvw_mm;
  here.tool_offset_mm = {0, 0, at.tool_length_mm};
  set_type(path->machine(), type, here);
  return path->pose_at(here, 1);
}

/// When a run is cut depends on the samples alone, or a workpiece would depend on who looks at it
/// when.
void WayCutter::cut(const Motion& motion, DrivenRun::Way way, double duration_s, double t_s) {
  if (!stock_.takes_tilted_tools()) return cut_now(motion, duration_s, t_s);
  const double begin_s = t_s - duration_s;
  if (!run_.add(motion, way, duration_s, begin_s)) {
    cut_run();
    run_.add(motion, way, duration_s, begin_s);
  }
  cut_long_run(t_s);
}

void WayCutter::cut_run() {
  if (const auto run = run_.take()) cut_now(run->motion, run->duration_s, run->t_s);
}

void WayCutter::cut_now(const Motion& motion, double duration_s, double t_s) {
  TimedStep step;
  step.start_s = t_s;
  step.duration_s = duration_s;
  step.length_mm = path_length_mm(motion);
  // Readings in a burst may have one stamp. A machine that moves has a feed.
  step.programmed_mm_per_min =
      duration_s > 0 ? 60 * step.length_mm / duration_s : std::numeric_limits<double>::infinity();
  step.allowed_mm_per_min = step.programmed_mm_per_min;
  if (is_beam_ && program_) update_materials();
  stage_.take_timed(motion, step);
}

std::optional<Motion> WayCutter::chord_to(const Reading& to, double duration_s,
                                          const WayState& state) {
  const ProgramPose& from = place_;
  const double length_mm = std::max(glm::length(to.place.tip_mm - from.tip_mm),
                                    glm::length(to.place.uvw_mm - from.uvw_mm));
  const bool turns = stock_.takes_tilted_tools() && from.abc_deg != to.place.abc_deg;
  if (length_mm < kWayStands_mm && !turns) return std::nullopt;
  Motion motion;
  motion.spindle = state.spindle.state;
  // Without its beam a head is on its way.
  const bool travels = is_beam_ && motion.spindle == SpindleState::kStopped;
  motion.kind = travels ? MotionKind::kTraverse : MotionKind::kFeed;
  motion.torch.spindles_on = motion.spindle != SpindleState::kStopped ? 1 : 0;
  motion.speed_said = state.spindle.said;
  motion.spindle_rpm = state.spindle.rpm;
  motion.tool = std::max(0, to.tool >= 0 ? to.tool : state.program_tool);
  const int line = to.sample.line;
  motion.source = {0, line > 0 ? static_cast<std::uint32_t>(line) : 0};
  motion.from_mm = from.tip_mm;
  motion.to_mm = to.place.tip_mm;
  // A model of upright tools is not asked about turns: MachineWatch has told.
  motion.from_abc_deg = turns ? from.abc_deg : to.place.abc_deg;
  motion.to_abc_deg = to.place.abc_deg;
  motion.from_uvw_mm = from.uvw_mm;
  motion.to_uvw_mm = to.place.uvw_mm;
  if (const ToolPath* const path = stage_.machine_path()) {
    set_type(path->machine(), state.kinematics_type, motion);
  }
  motion.tool_offset_mm = {0, 0, to.tool_length_mm};
  if (to.real_shift_mm != Vec3{0}) motion.length = real_length_of(to);
  motion.feed_mm_per_min = duration_s > 0 ? 60 * length_mm / duration_s : 0;
  facts_.chord_mm += length_mm;
  double radius_mm = 0;
  if (motion.tool > 0 || resolver_.has_arguments()) {
    const ResolvedTool& tool = resolver_.mount(motion.tool, 0);
    if (tool.cutter) radius_mm = tool.cutter->radius_mm();
  }
  // Jogging in the air needs no tool that is known.
  const bool near = is_near_blank(stock_, is_beam_, from.tip_mm, to.place.tip_mm, radius_mm);
  if (stage_.is_upright(motion) && !near) return std::nullopt;
  return motion;
}

/// What the program has not turned or moved is where the machine has it.
void WayCutter::place_idle_axes(const Reading& now, const PathMatch& point, Motion& motion) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const double stands_deg = now.place.abc_deg[i];
    const bool elsewhere = std::abs(stands_deg - motion.to_abc_deg[i]) > kTurned_deg;
    if (point.turned[i] || !now.abc_known[i] || !elsewhere) continue;
    motion.from_abc_deg[i] = motion.to_abc_deg[i] = stands_deg;
  }
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (point.slid[axis] || !now.uvw_known[axis]) continue;
    motion.from_uvw_mm[i] = motion.to_uvw_mm[i] = now.place.uvw_mm[i];
  }
}

void WayCutter::cut_path(std::span<PathFollower::DrivenPart> driven, const Reading& before,
                         const Reading& now, const PathMatch& point, double duration_s,
                         const SpindleNow& spindle) {
  if (driven.empty()) return;
  double planned_s = 0;
  for (const PathFollower::DrivenPart& part : driven) planned_s += part.duration_s;
  // Where the tool was changed out of sight, what comes before the change is the old one's. Without
  // a change on that way the machine stood for it: at the way's end, if it had the program's tool
  // before, else at its beginning.
  const int program_from = driven.front().motion.tool, program_to = driven.back().motion.tool;
  const bool changed = before.tool >= 0 && now.tool >= 0 && before.tool != now.tool &&
                       (program_from != program_to || before.tool == program_from);
  for (auto& [motion, share_s, of_same_piece] : driven) {
    const bool is_before = changed && motion.tool == program_from;
    const bool is_between = changed && !is_before && motion.tool != program_to;
    if (is_before) {
      motion.tool = before.tool;
    } else if (now.sample.tool >= 0 && !is_between) {
      motion.tool = now.sample.tool;
    }
    if (spindle.said && !is_beam_) {
      motion.spindle = spindle.state;
      motion.spindle_rpm = spindle.rpm;
    }
    place_idle_axes(now, point, motion);
    if (!is_between) take_real_length(is_before ? before : now, motion);
    facts_.path_mm += path_length_mm(motion);
    cut(motion, of_same_piece ? DrivenRun::Way::kNextPart : DrivenRun::Way::kPart,
        planned_s > 0 ? duration_s * share_s / planned_s : 0, now.t_s);
  }
}

}  // namespace kerf
