#include "interp_bridge/motion_fold.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/units.h"

namespace kerf {
namespace {

/// rs274 prints four decimals of the program's unit.
constexpr double kPrintResolution = 1e-4;

/// Ends closer than this are a full turn, as in LinuxCNC's own arc code (CIRCLE_FUZZ).
constexpr double kFullTurnFuzz_rad = 1e-6;

/// What a command does to the queue of moves in LinuxCNC 2.9: its task sends some only when all
/// moves before them are done (emcTaskCheckPreconditions: WAITING_FOR_MOTION), and some more end
/// the chain of feeds that may be merged (flush_segments of emccanon).
enum class QueueEffect : std::uint8_t { kNone, kEndsChain, kOutputs, kHalts, kHaltsForIo };

/// Not those that are steps of their own: a dwell, a tool change, a stop.
QueueEffect queue_effect(CanonicalName name) {
  switch (name) {
    case CanonicalName::kSetG5xOffset:
    case CanonicalName::kSetG92Offset:
    case CanonicalName::kSetXyRotation:
    case CanonicalName::kUseToolLengthOffset:
    case CanonicalName::kStartSpindleClockwise:
    case CanonicalName::kStartSpindleCounterclockwise:
    case CanonicalName::kStopSpindleTurning:
    case CanonicalName::kSetSpindleSpeed:
    case CanonicalName::kOrientSpindle:
    case CanonicalName::kWaitOrientComplete:
    case CanonicalName::kSetAuxOutputBit:
    case CanonicalName::kClearAuxOutputBit:
    case CanonicalName::kSetAuxOutputValue:
    case CanonicalName::kEnableAdaptiveFeed:
    case CanonicalName::kDisableAdaptiveFeed:
    case CanonicalName::kMessage:
      return QueueEffect::kHalts;
    case CanonicalName::kFloodOn:
    case CanonicalName::kFloodOff:
    case CanonicalName::kMistOn:
    case CanonicalName::kMistOff:
    case CanonicalName::kSetToolTableEntry:
    case CanonicalName::kReloadTooldata:
      return QueueEffect::kHaltsForIo;
    case CanonicalName::kSetFeedMode:
    case CanonicalName::kSetMotionControlMode:
    case CanonicalName::kStartSpeedFeedSync:
    case CanonicalName::kStopSpeedFeedSynch:
    case CanonicalName::kEnableFeedOverride:
    case CanonicalName::kDisableFeedOverride:
    case CanonicalName::kEnableSpeedOverride:
    case CanonicalName::kDisableSpeedOverride:
    case CanonicalName::kEnableFeedHold:
    case CanonicalName::kDisableFeedHold:
    case CanonicalName::kLog:
      return QueueEffect::kEndsChain;
    case CanonicalName::kSetMotionOutputBit:
    case CanonicalName::kClearMotionOutputBit:
    case CanonicalName::kSetMotionOutputValue:
      return QueueEffect::kOutputs;
    default:
      return QueueEffect::kNone;
  }
}

void count_up(std::uint8_t& count) { count += count < 255 ? 1 : 0; }

/// Degrees to (cos, sin), exact for multiples of 90 so that a part turned by R90 keeps its digits.
std::pair<double, double> cos_sin(double degrees) {
  const double quarter = degrees / 90.0;
  if (quarter == std::floor(quarter) && std::abs(quarter) < 1e9) {
    constexpr std::array<std::pair<double, double>, 4> kQuarters = {
        {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    return kQuarters[static_cast<std::size_t>(static_cast<std::int64_t>(quarter) & 3)];
  }
  const double radians = degrees * kRadPerDeg;
  return {std::cos(radians), std::sin(radians)};
}

Vec3 turned(const Vec3& p, double cosine, double sine) {
  return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z};
}

/// Where the numbers of ARC_FEED go: x, y, z index of the first, second and normal axis. In this
/// order the three are right-handed in every plane, so that a positive rotation is
/// counter-clockwise about +normal.
struct PlaneAxes {
  int first;
  int second;
  int normal;
};

PlaneAxes axes_of(CanonicalPlane plane) {
  switch (plane) {
    case CanonicalPlane::kYz:
      return {1, 2, 0};
    case CanonicalPlane::kXz:
      return {2, 0, 1};
    case CanonicalPlane::kXy:
    case CanonicalPlane::kUnknown:
      break;
  }
  return {0, 1, 2};
}

/// 0.0 for -0.0, which rs274 prints, and which would reach reports.
double without_sign_of_zero(double value) { return value + 0.0; }

}  // namespace

double arc_sweep_rad(const Vec2& start, const Vec2& end, int turns, double resolution,
                     bool as_printed) {
  const double direction = turns < 0 ? -1.0 : 1.0;
  const double start_radius = glm::length(start);
  const double end_radius = glm::length(end);
  const double cross = start.x * end.y - start.y * end.x;
  double sweep = direction * std::atan2(cross, glm::dot(start, end));
  // Rounding to four decimals turns the ends about the centre by up to one digit, so a full turn
  // may show as a sliver. It is one if nothing but rounding separates the ends, or if they lie on
  // one ray at different radii (a spiral).
  const double sliver = std::abs(sweep) * std::max(start_radius, end_radius);
  const double radial = std::abs(end_radius - start_radius);
  const bool ends_meet = as_printed ? start == end : sliver + radial <= 3 * resolution;
  const bool on_one_ray = sliver <= 1.5 * resolution && radial >= 5 * resolution;
  if (ends_meet || on_one_ray || std::abs(sweep) <= kFullTurnFuzz_rad) {
    sweep = 2 * kPi;
  } else if (sweep < 0) {
    sweep += 2 * kPi;
  }
  const double full_turns = std::max(0.0, std::abs(static_cast<double>(turns)) - 1.0);
  return direction * (sweep + full_turns * 2 * kPi);
}

MotionFold::MotionFold(std::vector<int> tool_by_index) : tool_by_index_(std::move(tool_by_index)) {}

Vec3 MotionFold::work_from_program(const Vec3& p_mm) const {
  if (same_frame_) return p_mm;
  return turned(p_mm, turn_cos_, turn_sin_) + shift_mm_;
}

Vec3 MotionFold::program_from_work(const Vec3& w_mm) const {
  if (same_frame_) return w_mm;
  return turned(w_mm - shift_mm_, turn_cos_, -turn_sin_);
}

std::array<double, 3> MotionFold::work_abc(const double* program_abc_deg) const {
  std::array<double, 3> abc{};
  for (std::size_t i = 0; i < 3; ++i) {
    abc[i] = without_sign_of_zero(program_abc_deg[i]);
    if (same_frame_) continue;
    abc[i] += frame_.g5x_abc_deg[i] + frame_.g92_abc_deg[i];
    abc[i] -= work_.g5x_abc_deg[i] + work_.g92_abc_deg[i];
  }
  return abc;
}

Vec3 MotionFold::work_uvw(const CanonicalCommand& command, std::size_t first) const {
  const Vec3 uvw_mm = scaled_if_there(command, first);
  if (same_frame_) return uvw_mm;
  return uvw_mm + frame_.g5x_uvw_mm + frame_.g92_uvw_mm - work_.g5x_uvw_mm - work_.g92_uvw_mm;
}

/// U, V, W follow the other numbers, where the interpreter gives them.
Vec3 MotionFold::scaled_if_there(const CanonicalCommand& command, std::size_t first) const {
  return command.argument_count < first + 3 ? Vec3{0} : scaled(command, first);
}

Vec3 MotionFold::scaled(const CanonicalCommand& command, std::size_t first) const {
  return {without_sign_of_zero(command.number(first) * unit_mm_),
          without_sign_of_zero(command.number(first + 1) * unit_mm_),
          without_sign_of_zero(command.number(first + 2) * unit_mm_)};
}

void MotionFold::frame_changed() {
  if (!work_fixed_) return;
  if (follows_places_) adopt_frame();
  const bool same = frame_ == work_;
  if (same && same_frame_) return;
  position_as_printed_ = false;
  same_frame_ = same;
  if (same) return;
  std::tie(turn_cos_, turn_sin_) = cos_sin(frame_.rotation_deg - work_.rotation_deg);
  const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
  shift_mm_ = turned(frame_.g92_mm, turn_cos_, turn_sin_) +
              turned(frame_.g5x_mm - work_.g5x_mm, work_cos, -work_sin) - work_.g92_mm;
}

void MotionFold::fix_workpiece_frame() {
  work_ = frame_;
  work_fixed_ = true;
  same_frame_ = true;
  if (!stands_at_) return;
  height_said_ = true;
  const std::array<double, 9>& at = *stands_at_;
  const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
  const Vec3 tip_mm = Vec3{at[0], at[1], at[2]} - tool_offset_mm_ - work_.g5x_mm;
  position_mm_ = turned(tip_mm, work_cos, -work_sin) - work_.g92_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    abc_deg_[i] = at[3 + i] - tool_offset_abc_deg_[i] - work_.g5x_abc_deg[i] - work_.g92_abc_deg[i];
  }
  if (!follows_places_) has_rotary_motion_ |= abc_deg_ != std::array<double, 3>{};
  uvw_mm_ = Vec3{at[6], at[7], at[8]} - tool_offset_uvw_mm_ - work_.g5x_uvw_mm - work_.g92_uvw_mm;
  position_known_ = true;
  position_as_printed_ = false;
}

WorkpieceFrame MotionFold::workpiece_frame() const {
  WorkpieceFrame frame;
  frame.g5x_mm = work_.g5x_mm;
  frame.g92_mm = work_.g92_mm;
  frame.rotation_deg = work_.rotation_deg;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.offset_abc_deg[i] = work_.g5x_abc_deg[i] + work_.g92_abc_deg[i];
  }
  frame.offset_uvw_mm = work_.g5x_uvw_mm + work_.g92_uvw_mm;
  return frame;
}

Motion& MotionFold::append(MotionKind kind, SourceRef source, std::vector<Motion>& out) {
  Motion& motion = out.emplace_back();
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

void MotionFold::halt() {
  count_up(halts_);
  chain_end_ = std::max(chain_end_, ChainEnd::kEnds);
}

void MotionFold::note_waits(const CanonicalCommand& command) {
  if (command.name == CanonicalName::kStartChange) change_begun_ = true;
  if (command.name == CanonicalName::kReloadTooldata) {
    const bool joined = halts_ == 0 && chain_end_ == ChainEnd::kNone;
    table_reloaded_ = table_reloaded_ || joined;
    if (joined) lose_held_feed(held_axes_);
  }
  switch (queue_effect(command.name)) {
    case QueueEffect::kHaltsForIo:
      count_up(io_halts_);
      [[fallthrough]];
    case QueueEffect::kHalts:
      halt();
      break;
    case QueueEffect::kOutputs:
      chain_end_ = ChainEnd::kOutputs;
      break;
    case QueueEffect::kEndsChain:
      chain_end_ = std::max(chain_end_, ChainEnd::kEnds);
      break;
    case QueueEffect::kNone:
      break;
  }
}

/// G96 turns about X0 of the program.
SurfaceSpeed MotionFold::surface_speed() const {
  const Spindle& spindle = spindles_[spindle_];
  if (spindle.surface_max_rpm <= 0) return {};
  return {spindle.speed * spindle.surface_unit_mm, spindle.surface_max_rpm,
          work_from_program(Vec3{0}).x};
}

void MotionFold::update_rpm() {
  const SurfaceSpeed surface = surface_speed();
  rpm_ = surface.on() ? surface.rpm_at(position_mm_.x) : spindles_[spindle_].speed;
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

FoldRemark MotionFold::fold_arc(const CanonicalCommand& command, SourceRef source,
                                std::vector<Motion>& out) {
  if (!work_fixed_) fix_workpiece_frame();
  if (plane_ == CanonicalPlane::kUnknown) {
    position_known_ = false;
    return FoldRemark::kArcPlaneUnknown;
  }
  take_synchronised_outputs();
  if (only_pierces(source, out)) return FoldRemark::kNone;
  return_from_overburn(source, out);
  const PlaneAxes axes = axes_of(plane_);
  const auto number = [&](std::size_t i) {
    return without_sign_of_zero(command.number(i) * unit_mm_);
  };
  const int turns = command.integer(4);
  Vec3 end_mm{0};
  end_mm[axes.first] = number(0);
  end_mm[axes.second] = number(1);
  end_mm[axes.normal] = number(5);
  const Vec3 start_mm = position_known_ ? program_from_work(position_mm_) : end_mm;
  if (held_z_mm_ && end_mm.z == *held_z_mm_) {
    end_mm.z = start_mm.z;
  } else {
    held_z_mm_.reset();
  }
  Vec3 center_mm{0};
  center_mm[axes.first] = number(2);
  center_mm[axes.second] = number(3);
  center_mm[axes.normal] = start_mm[axes.normal];
  Vec3 normal{0};
  normal[axes.normal] = 1;

  const Vec2 start{start_mm[axes.first] - center_mm[axes.first],
                   start_mm[axes.second] - center_mm[axes.second]};
  const Vec2 end{end_mm[axes.first] - center_mm[axes.first],
                 end_mm[axes.second] - center_mm[axes.second]};
  const bool start_known = position_known_ && unknown_ == 0;
  const bool as_printed = position_as_printed_;
  // No rotation, or no radius: LinuxCNC moves straight.
  const double resolution_mm = kPrintResolution * unit_mm_;
  const bool straight = turns == 0 || (glm::length(start) < resolution_mm / 2 &&
                                       glm::length(end) < resolution_mm / 2);
  const double sweep_rad =
      straight || !start_known ? 0.0 : arc_sweep_rad(start, end, turns, resolution_mm, as_printed);
  const bool full_circle = std::abs(sweep_rad) > 2 * kPi - kFullTurnFuzz_rad &&
                           glm::length(end - start) <= 3 * resolution_mm;
  begin_arc(straight ? 0.0 : 2 * glm::length(start), full_circle);
  const std::uint8_t held_before = held_axes_;
  Motion& motion = append(straight ? MotionKind::kFeed : MotionKind::kArc, source, out);
  move_to(motion, work_from_program(end_mm), work_abc(&command.arguments[6]), work_uvw(command, 9));
  set_feed(motion);
  if (straight) {
    hold_back(motion, held_before);
    return FoldRemark::kNone;
  }
  motion.arc.center_mm = work_from_program(center_mm);
  motion.arc.axis = same_frame_ ? normal : turned(normal, turn_cos_, turn_sin_);
  motion.arc.sweep_rad = motion.start_known ? sweep_rad : 0.0;
  hold_back(motion, held_before);
  if (full_circle && hole_active_ && modes_.overburn) append_overburn(Motion(motion), out);
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

void MotionFold::change_tool_length(const CanonicalCommand& command) {
  const Vec3 offset_mm = scaled(command, 0);
  const std::array<double, 3> abc_deg = {command.number(3), command.number(4), command.number(5)};
  const Vec3 uvw_mm = coded_lengths_ ? Vec3{0} : scaled_if_there(command, 6);
  if (offset_mm == tool_offset_mm_ && abc_deg == tool_offset_abc_deg_ &&
      uvw_mm == tool_offset_uvw_mm_) {
    return;
  }
  if (position_known_) {
    const auto [work_cos, work_sin] = cos_sin(work_.rotation_deg);
    position_mm_ += turned(tool_offset_mm_ - offset_mm, work_cos, -work_sin);
    for (std::size_t i = 0; i < 3; ++i) abc_deg_[i] += tool_offset_abc_deg_[i] - abc_deg[i];
    uvw_mm_ += tool_offset_uvw_mm_ - uvw_mm;
    position_as_printed_ = false;
  }
  tool_offset_mm_ = offset_mm;
  tool_offset_abc_deg_ = abc_deg;
  tool_offset_uvw_mm_ = uvw_mm;
}

bool MotionFold::fold_frame(const CanonicalCommand& command) {
  switch (command.name) {
    case CanonicalName::kUseLengthUnits: {
      constexpr std::array<double, 3> kUnits_mm = {kMmPerInch, 1.0, 10.0};
      const double unit_mm = kUnits_mm[static_cast<std::size_t>(command.integer(0))];
      if (unit_mm != unit_mm_) position_as_printed_ = false;
      unit_mm_ = unit_mm;
      return true;
    }
    case CanonicalName::kSetG5xOffset:
      frame_.g5x_mm = scaled(command, 1);
      for (std::size_t i = 0; i < 3; ++i) frame_.g5x_abc_deg[i] = command.number(4 + i);
      frame_.g5x_uvw_mm = scaled_if_there(command, 7);
      follow_offset(command.name, command.integer(0));
      frame_changed();
      return true;
    case CanonicalName::kSetG92Offset:
      frame_.g92_mm = scaled(command, 0);
      for (std::size_t i = 0; i < 3; ++i) frame_.g92_abc_deg[i] = command.number(3 + i);
      frame_.g92_uvw_mm = scaled_if_there(command, 6);
      follow_offset(command.name, 0);
      frame_changed();
      return true;
    case CanonicalName::kSetXyRotation:
      frame_.rotation_deg = without_sign_of_zero(command.number(0));
      frame_changed();
      return true;
    case CanonicalName::kSelectPlane:
      plane_ = static_cast<CanonicalPlane>(command.integer(0));
      return true;
    case CanonicalName::kUseToolLengthOffset:
      for (std::size_t i = 0; i < length_call_.size(); ++i) {
        length_call_[i] = i < command.argument_count ? command.number(i) : 0;
      }
      change_tool_length(command);
      // By how much only the probe knows.
      lose_place(probed_);
      return true;
    default:
      return false;
  }
}

/// The first that turns.
void MotionFold::choose_spindle() {
  const auto turning = std::find_if(spindles_.begin(), spindles_.end(), [](const Spindle& one) {
    return one.state != SpindleState::kStopped;
  });
  spindle_ = turning == spindles_.end()
                 ? 0
                 : static_cast<std::size_t>(std::distance(spindles_.begin(), turning));
  update_rpm();
  note_spindles();
}

/// M2 stops all spindles before it ends the program, which is seen by the mode that it sets with
/// each: those that it found turning are told with the end, so that it can be seen whether the
/// program has stopped them itself.
void MotionFold::append_program_end(SourceRef source, std::vector<Motion>& out) {
  const auto stopped = spindles_;
  for (Spindle& spindle : spindles_) {
    if (spindle.ended_from != SpindleState::kStopped) spindle.state = spindle.ended_from;
  }
  choose_spindle();
  append(MotionKind::kProgramEnd, source, out);
  spindles_ = stopped;
  choose_spindle();
}

bool MotionFold::fold_spindle(const CanonicalCommand& command) {
  const auto for_each = [&](auto change) {
    // -1 is all of them (M5 $-1); numbers beyond the last spindle are not on any machine.
    const int number = command.integer(0);
    for (std::size_t i = 0; i < kMaxSpindles; ++i) {
      if (number == -1 || number == static_cast<int>(i)) change(spindles_[i]);
    }
    choose_spindle();
    return true;
  };
  switch (command.name) {
    case CanonicalName::kStartSpindleClockwise:
      return for_each([](Spindle& spindle) { spindle.start(SpindleState::kClockwise); });
    case CanonicalName::kStartSpindleCounterclockwise:
      return for_each([](Spindle& spindle) { spindle.start(SpindleState::kCounterclockwise); });
    case CanonicalName::kStopSpindleTurning:
      return for_each([](Spindle& spindle) { spindle.stop(); });
    case CanonicalName::kSetSpindleSpeed:
      speed_said_ = true;
      return for_each([&](Spindle& spindle) { spindle.speed = command.number(1); });
    case CanonicalName::kSetSpindleMode:
      // Surface speed is m/min in G21 and ft/min in G20.
      return for_each([&](Spindle& spindle) {
        if (stop_before_) spindle.ended_from = spindle.stopped_from;
        spindle.surface_max_rpm = command.number(1);
        spindle.surface_unit_mm = unit_mm_ == kMmPerInch ? 304.8 : 1000.0;
      });
    default:
      return false;
  }
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
