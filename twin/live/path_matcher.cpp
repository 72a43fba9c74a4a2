#include "twin/live/path_matcher.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interp_bridge/tool_lengths.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
PathMatcher::PathMatcher(const LiveCutOptions& options)
    : options_(options), frame_(options.frame), follower_(options.follow) {}

void PathMatcher::take_up(std::unique_ptr<Program> program) {
  if (ahead_) {
    ahead_->stop();
    follower_ = PathFollower(options_.follow);
  }
  ahead_ = std::make_unique<ProgramAhead>(std::move(program), options_.timeline, follower_);
  const std::optional<WorkpieceFrame> frame = ahead_->wait_for_frame();
  if (frame && !options_.work_known) frame_.set_work(*frame);
}

void PathMatcher::stop() {
  if (ahead_) ahead_->stop();
}

double PathMatcher::driven_mm() const {
  double driven_mm = 0;
  for (const PathFollower::DrivenPart& part : driven_) driven_mm += path_length_mm(part.motion);
  return driven_mm;
}

bool PathMatcher::finished() const {
  return ahead_ && ahead_->complete() && follower_.found() && follower_.left_s() <= kProgramEnd_s;
}

/// With the program's tool lengths the tip is that of a tool of no length, until follow() has found
/// where in the program the machine is.
std::optional<double> PathMatcher::assumed_length_mm() const {
  return ahead_ && options_.program_lengths ? std::optional<double>(0.0) : std::nullopt;
}

const MachineKinematics* PathMatcher::switched_machine() const {
  const MachineKinematics* const machine = options_.timeline.kinematics.get();
  return machine && (machine->is_switchable() || machine->is_arm()) ? machine : nullptr;
}

std::optional<SamplePose> PathMatcher::pose_of(const AxisSample& sample, int type) const {
  return frame_.pose_of(sample, assumed_length_mm(), type);
}

Reading PathMatcher::reading_of(const AxisSample& sample, const SamplePose& pose,
                                double t_s) const {
  Reading now;
  now.place = {pose.tip_mm, pose.abc_deg, pose.along_tool, pose.uvw_mm};
  now.abc_known = pose.abc_known;
  now.uvw_known = pose.uvw_known;
  now.t_s = t_s;
  now.tool_length_mm = pose.tool_length_mm;
  now.length_is_applied = pose.length_is_applied;
  now.real_shift_mm = pose.real_shift_mm;
  now.length_checked = pose.length_checked;
  now.sample = sample;
  // A program that is followed knows better than a configuration that says one tool for all.
  const bool by_configuration = !ahead_ || program_tool_ < 0;
  now.tool = by_configuration ? frame_.tool_of(sample) : sample.tool;
  return now;
}

void PathMatcher::begin() { driven_.clear(); }

void PathMatcher::read_ahead() {
  ahead_->read_until(follower_.program_s() + options_.guard_s + kPlannedAhead_s,
                     options_.wait_for_program);
}

MatchQuery PathMatcher::query_of(const Reading& now, double elapsed_s) const {
  MatchQuery query;
  query.here = now.place;
  query.abc_known = now.abc_known;
  query.uvw_known = now.uvw_known;
  const AxisSample& sample = now.sample;
  query.machine = switched_machine();
  if (query.machine) {
    for (std::size_t i = 0; i < query.machine->types.size(); ++i) {
      const auto pose = frame_.pose_of(sample, assumed_length_mm(), static_cast<int>(i));
      query.by_type[i] = {pose->tip_mm, pose->abc_deg, pose->along_tool, pose->uvw_mm};
    }
  }
  const ToolLengthFrom from = options_.frame.tool_length;
  query.without_length = options_.program_lengths && !options_.frame.workpiece_frame &&
                         (from == ToolLengthFrom::kProgram ||
                          (from == ToolLengthFrom::kAuto && std::isnan(sample.tool_offset_z_mm)));
  query.applied_length = now.length_is_applied;
  query.elapsed_s = elapsed_s;
  query.line = sample.line;
  query.tool = sample.tool;
  return query;
}

PathFollower::Drive PathMatcher::drive() {
  return [this](const PathFollower::DrivenPart& part) { driven_.push_back(part); };
}

PathMatch PathMatcher::follow(const MatchQuery& query) { return follower_.follow(query, drive()); }

void PathMatcher::follow_by_length_before(const MatchQuery& query, const Reading& before,
                                          Reading& now, PathMatch& point) {
  if (!now.length_is_applied || !before.length_is_applied) return;
  const double before_mm = before.tool_length_mm + before.real_shift_mm.z;
  if (before_mm == now.tool_length_mm) return;
  MatchQuery as_before = query;
  as_before.elapsed_s = 0;
  const double change_mm = now.tool_length_mm - before_mm;
  as_before.here.tip_mm += change_mm * query.here.along_tool;
  for (ProgramPose& one : as_before.by_type) one.tip_mm += change_mm * one.along_tool;
  const PathMatch then = follow(as_before);
  if (!then.on_path) return;
  point = then;
  now.by_length_before = true;
}

void PathMatcher::take_kinematics(int type, bool without_length, Reading& now, Reading* before) {
  kinematics_type_ = type;
  const auto again = [&](Reading& at) {
    const auto pose = frame_.pose_of(at.sample, assumed_length_mm(), type);
    at.place = {pose->tip_mm, pose->abc_deg, pose->along_tool, pose->uvw_mm};
  };
  again(now);
  if (!before) return;
  again(*before);
  if (without_length) before->place.tip_mm -= before->tool_length_mm * before->place.along_tool;
}

void PathMatcher::place_real_tip(Reading& now, const PathMatch& point) {
  if (!now.length_is_applied) return;
  const bool stated = point.stated_length_mm &&
                      std::abs(*point.stated_length_mm - now.tool_length_mm) <= kMostWear_mm;
  const bool checked = now.length_checked && now.sample.tool >= 0 && !stated;
  const double off_mm = now.real_shift_mm.z - point.tip_shift_mm.z;
  const bool other = now.by_length_before || (checked && std::abs(off_mm) > kMostWear_mm);
  if (point.on_path && !other) {
    now.real_shift_mm = point.tip_shift_mm;
  }
  now.place.tip_mm += now.real_shift_mm;
  now.tool_length_mm -= now.real_shift_mm.z;
}

bool PathMatcher::note_real_tip(const Reading& now, const PathMatch& point) {
  if (!point.on_path || now.by_length_before) return false;
  RealTip tip;
  tip.program_tool = point.tool;
  if (now.length_is_applied) {
    tip.program = point.length;
    tip.shift_mm = now.real_shift_mm - point.tip_shift_mm;
    tip.length_mm = now.tool_length_mm;
    const auto& lengths = options_.frame.table_length_mm;
    const auto programmed = lengths.find(point.tool), real = lengths.find(now.sample.tool);
    if (now.length_checked && programmed != lengths.end() && real != lengths.end()) {
      const double longer_mm = programmed->second - real->second;
      if (std::abs(longer_mm) > kMostWear_mm) tip.tool_shift_mm = {0, 0, longer_mm};
    }
  }
  const bool is_other = !tip.is_like(real_tip_);
  real_tip_ = tip;
  return is_other;
}

void PathMatcher::note_program_tool(const PathMatch& point) {
  if (point.on_path) program_tool_ = point.tool;
}

ProgramPose PathMatcher::place_on_path(const Reading& now, const PathMatch& point) {
  ProgramPose place = point.place;
  if (now.length_is_applied && !now.by_length_before) {
    place.tip_mm += now.real_shift_mm - point.tip_shift_mm;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!point.turned[i] && now.abc_known[i]) place.abc_deg[i] = now.place.abc_deg[i];
    const auto axis = static_cast<int>(i);
    if (!point.slid[i] && now.uvw_known[i]) place.uvw_mm[axis] = now.place.uvw_mm[axis];
  }
  return place;
}

}  // namespace kerf
