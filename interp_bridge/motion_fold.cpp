#include "interp_bridge/motion_fold.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/block_copy.h"
#include "interp_bridge/motion_fold_math.h"

namespace kerf {

MotionFold::MotionFold(std::vector<int> tool_by_index) : tool_by_index_(std::move(tool_by_index)) {}

Motion& MotionFold::append(MotionKind kind, SourceRef source, std::vector<Motion>& out) {
  static const Motion kFresh;
  Motion& motion = append_block(out, kFresh);
  motion.kind = kind;
  motion.source = source;
  motion.tool = tool_;
  motion.selected_tool = selected_tool_;
  motion.selected_at = selected_at_;
  motion.speed_said = speed_said_;
  motion.flood = flood_;
  motion.mist = mist_;
  motion.compensated = compensation_;
  on_workpiece_ = false;
  held_axes_ = 0;
  motion.start_known = position_known_ && unknown_ == 0;
  motion.unknown_from = motion.unknown_to = unknown_;
  motion.from_mm = position_mm_;
  motion.to_mm = position_mm_;
  motion.from_abc_deg = abc_deg_;
  motion.to_abc_deg = abc_deg_;
  motion.from_uvw_mm = uvw_mm_;
  motion.to_uvw_mm = uvw_mm_;
  motion.spindle = spindles_[spindle_].state;
  motion.spindle_rpm = rpm_;
  motion.surface = surface_speed();
  motion.tool_offset_mm = tool_offset_mm_;
  motion.tool_offset_uvw_mm = tool_offset_uvw_mm_;
  motion.path_mode = path_mode_;
  motion.blend_tolerance_mm = blend_tolerance_mm_;
  motion.merge_tolerance_mm = merge_tolerance_mm_;
  motion.torch = torch_;
  // M6 has begun, and the machine goes to a place where tools are changed: the I/O task was told
  // before. Else that is in the tool change's own time.
  if (std::exchange(change_begun_, false) && kind <= MotionKind::kProbe) {
    count_up(io_halts_);
    halt();
  }
  motion.halts = std::exchange(halts_, std::uint8_t{0});
  motion.io_halts = std::exchange(io_halts_, std::uint8_t{0});
  motion.chain_end = std::exchange(chain_end_, ChainEnd::kNone);
  motion.tool_prepare = std::exchange(tool_prepare_, ToolPrepare::kNone);
  motion.table_reloaded = std::exchange(table_reloaded_, false);
  return motion;
}

void MotionFold::move_to(Motion& motion, Vec3 to_mm, const std::array<double, 3>& to_abc_deg,
                         const Vec3& to_uvw_mm) {
  if (follows_places_) {
    motion.unknown_to = unknown_ = unknown_after(motion, to_mm);
    motion.start_known = motion.start_known && unknown_ == 0;
  }
  motion.to_mm = to_mm;
  motion.to_abc_deg = to_abc_deg;
  motion.to_uvw_mm = to_uvw_mm;
  if (!motion.start_known) {
    motion.from_mm = to_mm;
    motion.from_abc_deg = to_abc_deg;
    motion.from_uvw_mm = to_uvw_mm;
    has_rotary_motion_ |= to_abc_deg != std::array<double, 3>{};
  }
  has_rotary_motion_ |= motion.from_abc_deg != motion.to_abc_deg;
  position_mm_ = to_mm;
  abc_deg_ = to_abc_deg;
  uvw_mm_ = to_uvw_mm;
  position_known_ = true;
  position_as_printed_ = true;
  if (spindles_[spindle_].surface_max_rpm > 0) {
    update_rpm();
    motion.spindle_rpm = rpm_;
  }
}

void MotionFold::set_feed(Motion& motion) const {
  if (synchronised_) {
    motion.feed_per_rev = true;
    motion.feed_mm_per_min = pitch_mm_;
    return;
  }
  motion.feed_per_rev = feed_per_rev_;
  const bool only_turns = motion.from_mm == motion.to_mm &&
                          motion.from_uvw_mm == motion.to_uvw_mm &&
                          motion.from_abc_deg != motion.to_abc_deg;
  motion.feed_mm_per_min = only_turns ? feed_ : feed_mm_;
}

FoldRemark MotionFold::fold_straight(MotionKind kind, const CanonicalCommand& command,
                                     SourceRef source, std::vector<Motion>& out) {
  if (!work_fixed_) fix_workpiece_frame();
  end_hole();
  take_synchronised_outputs();
  if (kind == MotionKind::kFeed && only_pierces(source, out)) return FoldRemark::kNone;
  overburn_from_mm_.reset();
  const std::uint8_t held_before = held_axes_;
  Motion& motion = append(kind, source, out);
  const Vec3 from_mm = position_mm_, from_uvw_mm = uvw_mm_;
  const std::array<double, 3> from_abc_deg = abc_deg_;
  Vec3 to_mm = scaled(command, 0);
  if (held_z_mm_) hold_height(command, source, to_mm);
  move_to(motion, work_from_program(to_mm), work_abc(&command.arguments[3]), work_uvw(command, 6));
  if (kind != MotionKind::kTraverse) set_feed(motion);
  const bool stands = motion.unknown_to != 0 && motion.unknown_to == motion.unknown_from &&
                      motion.to_mm == from_mm && motion.to_abc_deg == from_abc_deg &&
                      motion.to_uvw_mm == from_uvw_mm;
  if (kind == MotionKind::kFeed && stands) {
    // "G1 F300" comes as a feed to where the tool stands. Where nobody knows that, it would count
    // as one from nowhere.
    halts_ = motion.halts;
    io_halts_ = motion.io_halts;
    chain_end_ = motion.chain_end;
    tool_prepare_ = motion.tool_prepare;
    table_reloaded_ = motion.table_reloaded;
    out.pop_back();
  } else if (kind == MotionKind::kFeed) {
    hold_back(motion, held_before);
  }
  return FoldRemark::kNone;
}

void MotionFold::fold_rigid_tap(const CanonicalCommand& command, SourceRef source,
                                std::vector<Motion>& out) {
  if (!work_fixed_) fix_workpiece_frame();
  take_synchronised_outputs();
  overburn_from_mm_.reset();
  halt();
  const Vec3 bottom_mm = work_from_program(scaled(command, 0));
  const bool top_known = position_known_ && unknown_ == 0;
  const Unknowns place_at_top = place_;
  const Vec3 top_mm = position_mm_;
  const auto abc_deg = abc_deg_;
  Motion& down = append(MotionKind::kThread, source, out);
  move_to(down, bottom_mm, abc_deg, uvw_mm_);
  set_feed(down);
  if (!top_known) {
    // Back to where it came from, which nobody has said.
    position_known_ = follows_places_;
    if (follows_places_) {
      position_mm_ = top_mm;
      place_ = place_at_top;
      settle();
    }
    return;
  }
  Motion& up = append(MotionKind::kThread, source, out);
  move_to(up, top_mm, abc_deg, uvw_mm_);
  set_feed(up);
}

bool MotionFold::fold_feed(const CanonicalCommand& command) {
  switch (command.name) {
    case CanonicalName::kSetFeedRate:
      // Another feed ends the chain; under G95 the same one does.
      if (feed_per_rev_ || command.number(0) * unit_mm_ != feed_mm_) {
        chain_end_ = std::max(chain_end_, ChainEnd::kEnds);
      }
      feed_ = command.number(0);
      feed_mm_ = feed_ * unit_mm_;
      return true;
    case CanonicalName::kSetFeedMode:
      feed_per_rev_ = command.integer(1) != 0;
      return true;
    case CanonicalName::kSetMotionControlMode:
      path_mode_ = static_cast<PathMode>(command.integer(0));
      blend_tolerance_mm_ =
          command.argument_count == 2 ? static_cast<float>(command.number(1) * unit_mm_) : 0.0F;
      return true;
    case CanonicalName::kSetNaivecamTolerance:
      merge_tolerance_mm_ = static_cast<float>(command.number(0) * unit_mm_);
      return true;
    case CanonicalName::kStartSpeedFeedSync:
      synchronised_ = true;
      if (command.argument_count == 2) {
        pitch_mm_ = command.number(0) * unit_mm_;
        synchronised_by_speed_ = command.integer(1) != 0;
      }
      return true;
    case CanonicalName::kStopSpeedFeedSynch:
      synchronised_ = false;
      return true;
    case CanonicalName::kFloodOn:
      return flood_ = true;
    case CanonicalName::kMistOn:
      return mist_ = true;
    case CanonicalName::kFloodOff:
      flood_ = false;
      return true;
    case CanonicalName::kMistOff:
      mist_ = false;
      return true;
    default:
      return false;
  }
}

bool MotionFold::fold_event(const CanonicalCommand& command, SourceRef source,
                            std::vector<Motion>& out) {
  switch (command.name) {
    case CanonicalName::kDwell:
      append(MotionKind::kDwell, source, out).duration_s = command.number(0);
      return true;
    case CanonicalName::kSelectTool:
      selected_tool_ = command.integer(0);
      selected_at_ = source;
      tool_prepare_ = halts_ > 0                      ? ToolPrepare::kStanding
                      : chain_end_ != ChainEnd::kNone ? ToolPrepare::kBehindLast
                                                      : ToolPrepare::kAheadOfLast;
      return true;
    case CanonicalName::kChangeTool:
      // The printed number is a row of the table, not a tool; kerf-interp adds the tool's.
      tool_ = command.argument_count > 1 ? command.integer(1) : selected_tool_;
      append(MotionKind::kToolChange, source, out);
      selected_at_ = {};
      return true;
    case CanonicalName::kChangeToolNumber: {
      const auto row = static_cast<std::size_t>(std::max(0, command.integer(0)));
      tool_ = row < tool_by_index_.size() ? tool_by_index_[row] : command.integer(0);
      if (command.argument_count > 1) tool_ = command.integer(1);
      if (halts_ == 0 && chain_end_ == ChainEnd::kNone) lose_held_feed(held_axes_);
      numbered_at_ = source;
      append(MotionKind::kToolChange, source, out).by_number = true;
      selected_at_ = {};
      return true;
    }
    case CanonicalName::kProgramStop:
    case CanonicalName::kOptionalProgramStop:
      append(MotionKind::kStop, source, out);
      return true;
    case CanonicalName::kProgramEnd:
    case CanonicalName::kFinish:
      has_program_end_ = true;
      append_program_end(source, out);
      return true;
    default:
      return false;
  }
}

FoldRemark MotionFold::fold(const CanonicalCommand& command, SourceRef source,
                            std::vector<Motion>& out) {
  if (!lengths_.checks()) return fold_command(command, source, out);
  const std::size_t first = out.size();
  const bool known = position_known_;
  const double z_mm = position_mm_.z;
  const FoldRemark remark = fold_command(command, source, out);
  follow_lengths(command, source);
  if (!height_said_ && out.size() > first) note_height(command, known, z_mm);
  place_tips(first, out);
  return remark;
}

FoldRemark MotionFold::fold_command(const CanonicalCommand& command, SourceRef source,
                                    std::vector<Motion>& out) {
  stop_before_ = std::exchange(stop_came_, command.name == CanonicalName::kStopSpindleTurning);
  switch (command.name) {
    case CanonicalName::kStraightFeed: {
      const bool thread = synchronised_ && !synchronised_by_speed_;
      return fold_straight(thread ? MotionKind::kThread : MotionKind::kFeed, command, source, out);
    }
    case CanonicalName::kStraightTraverse:
      return fold_straight(MotionKind::kTraverse, command, source, out);
    case CanonicalName::kStraightProbe:
      return fold_straight(MotionKind::kProbe, command, source, out);
    case CanonicalName::kArcFeed:
      return fold_arc(command, source, out);
    case CanonicalName::kRigidTap:
      fold_rigid_tap(command, source, out);
      return FoldRemark::kNone;
    case CanonicalName::kNurbsFeed:
      position_known_ = false;
      return FoldRemark::kSplineLost;
    default:
      if (command.name == CanonicalName::kSetMotionControlMode && source.line != 0) {
        path_mode_said_ = true;
      }
      note_waits(command);
      fold_switch(command, source, out);
      return FoldRemark::kNone;
  }
}

void MotionFold::signal(std::uint8_t user_m, SourceRef source, std::vector<Motion>& out) {
  append(MotionKind::kSignal, source, out).user_m = user_m;
  place_tips(out.size() - 1, out);
}

/// What does not move the machine. A signal for what it has switched.
void MotionFold::fold_switch(const CanonicalCommand& command, SourceRef source,
                             std::vector<Motion>& out) {
  const auto take = [&] {
    const bool switched =
        fold_frame(command) || fold_spindle(command) || fold_feed(command) || fold_torch(command);
    if (!switched) fold_event(command, source, out);
    return switched;
  };
  if (!signals_) {
    take();
    return;
  }
  const auto state = [this] {
    return std::tuple(spindles_[spindle_].state, rpm_, flood_, mist_, torch_.spindles_on,
                      torch_.outputs, torch_.analog);
  };
  const auto before = state();
  if (take() && state() != before) append(MotionKind::kSignal, source, out);
}

}  // namespace kerf
