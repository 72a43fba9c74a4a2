// What the interpreter commands: every call becomes a record, and the world follows. The argument
// order of a record is that of the call's line in a listing of rs274; U, V, W come behind.
#include <array>
#include <canon.hh>
#include <cstdarg>
#include <cstdio>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/kerf_interp/recording.h"

using kerf::CanonicalName;
using kerf::interp::Pose;
using kerf::interp::recording;
using kerf::interp::World;

namespace {

World& world() { return recording().world; }

constexpr std::uint8_t code(CanonicalName name) { return static_cast<std::uint8_t>(name); }

void record(CanonicalName name, int move_line, std::initializer_list<double> values) {
  const int line = recording().line_of_move(move_line);
  recording().records->numbers(code(name), line, values);
}
void record(CanonicalName name, std::initializer_list<double> values = {}) {
  const int line = recording().line_now();
  recording().records->numbers(code(name), line, values);
}
void record_text(CanonicalName name, const char* text) {
  recording().records->text(code(name) | kerf::records::kText, recording().line_now(),
                            text != nullptr ? text : "");
}
void record_special(kerf::records::Code special, std::initializer_list<double> values) {
  recording().records->numbers(special, recording().line_now(), values);
}

Pose pose(const EmcPose& p) { return {p.tran.x, p.tran.y, p.tran.z, p.a, p.b, p.c, p.u, p.v, p.w}; }

/// Most moves have X, Y, Z alone; the reader puts zeros for what is left out.
void record_move(CanonicalName name, int line, const Pose& p) {
  std::size_t count = p.size();
  while (count > 3 && p[count - 1] == 0) --count;
  recording().records->numbers(code(name), recording().line_of_move(line), p.data(), count);
}

std::size_t spindle_index(int spindle) {
  return static_cast<std::size_t>(spindle) < World::kSpindles ? static_cast<std::size_t>(spindle)
                                                              : 0;
}

template <class Change>
void for_spindles(int spindle, Change change) {
  for (std::size_t i = 0; i < World::kSpindles; ++i) {
    if (spindle == -1 || i == spindle_index(spindle)) change(i);
  }
}

}  // namespace

// ---- Frames, units, planes
// --------------------------------------------------------------------------

void INIT_CANON() {}
void UPDATE_TAG(StateTag) {}

void USE_LENGTH_UNITS(CANON_UNITS u) {
  world().units = u;
  record(CanonicalName::kUseLengthUnits, {static_cast<double>(u - CANON_UNITS_INCHES)});
}
void SELECT_PLANE(CANON_PLANE plane) {
  world().plane = plane;
  const auto known = [&] {
    switch (plane) {
      case CANON_PLANE_XY:
        return kerf::CanonicalPlane::kXy;
      case CANON_PLANE_YZ:
        return kerf::CanonicalPlane::kYz;
      case CANON_PLANE_XZ:
        return kerf::CanonicalPlane::kXz;
      default:
        return kerf::CanonicalPlane::kUnknown;
    }
  };
  record(CanonicalName::kSelectPlane, {static_cast<double>(known())});
}
void SET_G5X_OFFSET(int origin, double x, double y, double z, double a, double b, double c,
                    double u, double v, double w) {
  world().set_g5x({x, y, z, a, b, c, u, v, w});
  record(CanonicalName::kSetG5xOffset, {static_cast<double>(origin), x, y, z, a, b, c, u, v, w});
}
void SET_G92_OFFSET(double x, double y, double z, double a, double b, double c, double u, double v,
                    double w) {
  world().set_g92({x, y, z, a, b, c, u, v, w});
  record(CanonicalName::kSetG92Offset, {x, y, z, a, b, c, u, v, w});
}
void SET_XY_ROTATION(double degrees) {
  world().set_rotation(degrees);
  record(CanonicalName::kSetXyRotation, {degrees});
}
void USE_TOOL_LENGTH_OFFSET(EmcPose offset) {
  const Pose p = pose(offset);
  const World::OffsetSource source = world().offset_source(p, recording().block_text());
  world().set_tool_offset(p);
  std::vector<double>& values = recording().length_offset;
  values.assign(p.begin(), p.end());
  values.insert(values.end(),
                {static_cast<double>(source.origin), static_cast<double>(source.tool)});
  recording().length_offset_line = recording().line_now();
  recording().records->numbers(code(CanonicalName::kUseToolLengthOffset),
                               recording().length_offset_line, values.data(), values.size());
}

// ---- Motion
// -------------------------------------------------------------------------------------------

void STRAIGHT_TRAVERSE(int line, double x, double y, double z, double a, double b, double c,
                       double u, double v, double w) {
  const Pose p = {x, y, z, a, b, c, u, v, w};
  record_move(CanonicalName::kStraightTraverse, line, p);
  world().move_to(p);
}
void STRAIGHT_FEED(int line, double x, double y, double z, double a, double b, double c, double u,
                   double v, double w) {
  const Pose p = {x, y, z, a, b, c, u, v, w};
  record_move(CanonicalName::kStraightFeed, line, p);
  world().move_to(p);
}
void ARC_FEED(int line, double first_end, double second_end, double first_axis, double second_axis,
              int rotation, double axis_end_point, double a, double b, double c, double u, double v,
              double w) {
  record(CanonicalName::kArcFeed, line,
         {first_end, second_end, first_axis, second_axis, static_cast<double>(rotation),
          axis_end_point, a, b, c, u, v, w});
  switch (world().plane) {
    case CANON_PLANE_YZ:
      world().move_to({axis_end_point, first_end, second_end, a, b, c, u, v, w});
      break;
    case CANON_PLANE_XZ:
      world().move_to({second_end, axis_end_point, first_end, a, b, c, u, v, w});
      break;
    case CANON_PLANE_UV:
      world().move_to({world().position(0), world().position(1), world().position(2), a, b, c,
                       first_end, second_end, axis_end_point});
      break;
    case CANON_PLANE_VW:
      world().move_to({world().position(0), world().position(1), world().position(2), a, b, c,
                       axis_end_point, first_end, second_end});
      break;
    case CANON_PLANE_UW:
      world().move_to({world().position(0), world().position(1), world().position(2), a, b, c,
                       second_end, axis_end_point, first_end});
      break;
    case CANON_PLANE_XY:
      world().move_to({first_end, second_end, axis_end_point, a, b, c, u, v, w});
      break;
  }
}
void NURBS_FEED(int line, std::vector<CONTROL_POINT> points, unsigned int order) {
  if (points.empty() || points.size() > kerf::records::kMaxSplinePoints) {
    record(CanonicalName::kNurbsFeed, line, {static_cast<double>(points.size())});
    return;
  }
  std::vector<double> values = {static_cast<double>(order)};
  for (const CONTROL_POINT& p : points) values.insert(values.end(), {p.X, p.Y, p.W});
  recording().records->numbers(kerf::records::kSpline, recording().line_of_move(line),
                               values.data(), values.size());
  Pose end{};
  for (std::size_t i = 0; i < end.size(); ++i) end[i] = world().position(i);
  end[0] = points.back().X;
  end[1] = points.back().Y;
  world().move_to(end);
}
void RIGID_TAP(int line, double x, double y, double z, double) {
  record(CanonicalName::kRigidTap, line, {x, y, z});  // and back to where it began
}
void STRAIGHT_PROBE(int line, double x, double y, double z, double a, double b, double c, double u,
                    double v, double w, unsigned char type) {
  using kerf::records::Answer;
  const Pose target = {x, y, z, a, b, c, u, v, w};
  const bool must = (type & 1) == 0;  // G38.2, .3, .4, .5 are 0, 1, 2, 3
  const bool away = (type & 2) != 0;
  Answer answer;
  if (recording().answers_fd >= 0) {
    if (must && !away && world().stands_tripped()) {
      answer.kind = Answer::kAlready;
    } else {
      answer = recording().ask_probe(line, target, type);
    }
  }
  // What it begins with is what it looks for: only G38.3 and G38.5 take that, where they stand.
  if (answer.kind == Answer::kAlready && must) {
    recording().refusal = away ? "Probe is already clear when starting G38.4 or G38.5 move"
                               : "Probe is already tripped when starting G38.2 or G38.3 move";
    return;
  }
  Pose end = target;
  if (answer.kind == Answer::kMet || answer.kind == Answer::kAlready) {
    const double share = answer.kind == Answer::kMet ? answer.share : 0;
    for (std::size_t i = 0; i < end.size(); ++i) {
      const double start = world().position(i);
      end[i] = start + share * (target[i] - start);
    }
  }
  record_move(CanonicalName::kStraightProbe, line, end);
  world().probe_to(end, answer.kind == Answer::kUnknown ? must : answer.kind != Answer::kMissed);
  world().note_tripped(answer.kind == Answer::kMet && !away);
  if (answer.kind == Answer::kMissed && must) {
    recording().refusal = away ? "G38.4 move finished without breaking contact."
                               : "G38.2 move finished without making contact.";
  }
}
void TURN_PROBE_ON() { record(CanonicalName::kTurnProbeOn); }
void TURN_PROBE_OFF() { record(CanonicalName::kTurnProbeOff); }
void DWELL(double seconds) { record(CanonicalName::kDwell, {seconds}); }
int UNLOCK_ROTARY(int, int joint) {
  record_special(kerf::records::kRotary, {static_cast<double>(joint), 0});
  return 0;
}
int LOCK_ROTARY(int, int joint) {
  record_special(kerf::records::kRotary, {static_cast<double>(joint), 1});
  return 0;
}

// ---- Feed and path
// ------------------------------------------------------------------------------------

void SET_FEED_MODE(int spindle, int mode) {
  record(CanonicalName::kSetFeedMode, {static_cast<double>(spindle), static_cast<double>(mode)});
}
void SET_FEED_RATE(double rate) {
  world().feed_mm_per_min = rate * world().unit_mm();
  record(CanonicalName::kSetFeedRate, {rate});
}
void SET_TRAVERSE_RATE(double rate) { record(CanonicalName::kSetTraverseRate, {rate}); }
void SET_FEED_REFERENCE(CANON_FEED_REFERENCE) { record(CanonicalName::kSetFeedReference); }
void SET_MOTION_CONTROL_MODE(CANON_MOTION_MODE mode, double tolerance) {
  world().motion_mode = mode;
  world().motion_tolerance_mm = tolerance * world().unit_mm();
  const double number = static_cast<double>(mode - CANON_EXACT_STOP);
  if (mode == CANON_CONTINUOUS) {
    record(CanonicalName::kSetMotionControlMode, {number, tolerance});
  } else {
    record(CanonicalName::kSetMotionControlMode, {number});
  }
}
void SET_NAIVECAM_TOLERANCE(double tolerance) {
  world().naivecam_tolerance_mm = tolerance * world().unit_mm();
  record(CanonicalName::kSetNaivecamTolerance, {tolerance});
}
void START_SPEED_FEED_SYNCH(int, double feed_per_revolution, bool velocity_mode) {
  record(CanonicalName::kStartSpeedFeedSync, {feed_per_revolution, velocity_mode ? 1.0 : 0.0});
}
void STOP_SPEED_FEED_SYNCH() { record(CanonicalName::kStopSpeedFeedSynch); }
void SET_CUTTER_RADIUS_COMPENSATION(double radius) {
  record(CanonicalName::kSetCutterRadiusCompensation, {radius});
}
void START_CUTTER_RADIUS_COMPENSATION(int) {
  record(CanonicalName::kStartCutterRadiusCompensation);
}
void STOP_CUTTER_RADIUS_COMPENSATION() { record(CanonicalName::kStopCutterRadiusCompensation); }

void ENABLE_FEED_OVERRIDE() {
  world().feed_override = true;
  record(CanonicalName::kEnableFeedOverride);
}
void DISABLE_FEED_OVERRIDE() {
  world().feed_override = false;
  record(CanonicalName::kDisableFeedOverride);
}
void ENABLE_ADAPTIVE_FEED() {
  world().adaptive_feed = true;
  record(CanonicalName::kEnableAdaptiveFeed);
}
void DISABLE_ADAPTIVE_FEED() {
  world().adaptive_feed = false;
  record(CanonicalName::kDisableAdaptiveFeed);
}
void ENABLE_FEED_HOLD() {
  world().feed_hold = true;
  record(CanonicalName::kEnableFeedHold);
}
void DISABLE_FEED_HOLD() {
  world().feed_hold = false;
  record(CanonicalName::kDisableFeedHold);
}
void ENABLE_SPEED_OVERRIDE(int spindle) {
  for_spindles(spindle, [](std::size_t i) { world().speed_override[i] = true; });
  record(CanonicalName::kEnableSpeedOverride, {static_cast<double>(spindle)});
}
void DISABLE_SPEED_OVERRIDE(int spindle) {
  for_spindles(spindle, [](std::size_t i) { world().speed_override[i] = false; });
  record(CanonicalName::kDisableSpeedOverride, {static_cast<double>(spindle)});
}

// ---- Spindle and coolant
// ------------------------------------------------------------------------------

void SET_SPINDLE_MODE(int spindle, double mode) {
  record(CanonicalName::kSetSpindleMode, {static_cast<double>(spindle), mode});
}
void SET_SPINDLE_SPEED(int spindle, double speed) {
  for_spindles(spindle, [&](std::size_t i) { world().spindle_speed[i] = speed; });
  record(CanonicalName::kSetSpindleSpeed, {static_cast<double>(spindle), speed});
}
void START_SPINDLE_CLOCKWISE(int spindle, int) {
  for_spindles(spindle, [](std::size_t i) { world().spindle_direction[i] = CANON_CLOCKWISE; });
  record(CanonicalName::kStartSpindleClockwise, {static_cast<double>(spindle)});
}
void START_SPINDLE_COUNTERCLOCKWISE(int spindle, int) {
  for_spindles(spindle,
               [](std::size_t i) { world().spindle_direction[i] = CANON_COUNTERCLOCKWISE; });
  record(CanonicalName::kStartSpindleCounterclockwise, {static_cast<double>(spindle)});
}
void STOP_SPINDLE_TURNING(int spindle) {
  for_spindles(spindle, [](std::size_t i) { world().spindle_direction[i] = CANON_STOPPED; });
  record(CanonicalName::kStopSpindleTurning, {static_cast<double>(spindle)});
}
void ORIENT_SPINDLE(int spindle, double orientation, int mode) {
  record(CanonicalName::kOrientSpindle,
         {static_cast<double>(spindle), orientation, static_cast<double>(mode)});
}
void WAIT_SPINDLE_ORIENT_COMPLETE(int, double timeout) {
  record(CanonicalName::kWaitOrientComplete, {timeout});
}
void SPINDLE_RETRACT() { record(CanonicalName::kSpindleRetract); }
void SPINDLE_RETRACT_TRAVERSE() { record(CanonicalName::kSpindleRetractTraverse); }
void USE_NO_SPINDLE_FORCE() { record(CanonicalName::kUseNoSpindleForce); }

void FLOOD_ON() {
  world().flood = true;
  record(CanonicalName::kFloodOn);
}
void FLOOD_OFF() {
  world().flood = false;
  record(CanonicalName::kFloodOff);
}
void MIST_ON() {
  world().mist = true;
  record(CanonicalName::kMistOn);
}
void MIST_OFF() {
  world().mist = false;
  record(CanonicalName::kMistOff);
}
void CLAMP_AXIS(CANON_AXIS) { record(CanonicalName::kClampAxis); }
void UNCLAMP_AXIS(CANON_AXIS) { record(CanonicalName::kUnclampAxis); }

// ---- Tools
// ----------------------------------------------------------------------------------------------

void SELECT_TOOL(int tool) {
  world().forget_lookup();
  record(CanonicalName::kSelectTool, {static_cast<double>(tool)});
}
void START_CHANGE() { record(CanonicalName::kStartChange); }
void CHANGE_TOOL(int row) {
  world().forget_lookup();
  // LinuxCNC's task moves the machine by itself: all axes at once, whatever is in the way.
  if (world().tool_change_axes > 0) {
    const Pose p = world().tool_change_position();
    record(CanonicalName::kStraightTraverse,
           {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]});
    world().move_to(p);
  }
  const int tool = world().load(row);
  record(CanonicalName::kChangeTool, {static_cast<double>(row), static_cast<double>(tool)});
}
void CHANGE_TOOL_NUMBER(int row) {
  const int tool = world().load(row);
  record(CanonicalName::kChangeToolNumber, {static_cast<double>(row), static_cast<double>(tool)});
}
void RELOAD_TOOLDATA() { record(CanonicalName::kReloadTooldata); }
void SET_TOOL_TABLE_ENTRY(int index, int number, EmcPose offset, double diameter,
                          double front_angle, double back_angle, int orientation) {
  CANON_TOOL_TABLE row = world().row(index);
  row.toolno = number;
  row.offset = offset;
  row.diameter = diameter;
  row.frontangle = front_angle;
  row.backangle = back_angle;
  row.orientation = orientation;
  world().set_row(index, row);
  const Pose p = pose(offset);
  record(CanonicalName::kSetToolTableEntry,
         {static_cast<double>(index), static_cast<double>(number), p[0], p[1], p[2], p[3], p[4],
          p[5], p[6], p[7], p[8], front_angle, back_angle, static_cast<double>(orientation)});
}

// ---- Inputs, outputs, messages
// --------------------------------------------------------------------------

void SET_MOTION_OUTPUT_BIT(int index) {
  record(CanonicalName::kSetMotionOutputBit, {static_cast<double>(index)});
}
void CLEAR_MOTION_OUTPUT_BIT(int index) {
  record(CanonicalName::kClearMotionOutputBit, {static_cast<double>(index)});
}
void SET_AUX_OUTPUT_BIT(int index) {
  record(CanonicalName::kSetAuxOutputBit, {static_cast<double>(index)});
}
void CLEAR_AUX_OUTPUT_BIT(int index) {
  record(CanonicalName::kClearAuxOutputBit, {static_cast<double>(index)});
}
void SET_MOTION_OUTPUT_VALUE(int index, double value) {
  world().set_analog_output(index, value);
  record(CanonicalName::kSetMotionOutputValue, {static_cast<double>(index), value});
}
void SET_AUX_OUTPUT_VALUE(int index, double value) {
  world().set_analog_output(index, value);
  record(CanonicalName::kSetAuxOutputValue, {static_cast<double>(index), value});
}
int WAIT(int index, int input_type, int wait_type, double timeout) {
  record_special(
      kerf::records::kWait,
      {static_cast<double>(index), input_type == DIGITAL_INPUT ? kerf::records::kDigitalInput : 0.0,
       static_cast<double>(wait_type), timeout});
  return 0;
}
void COMMENT(const char* text) {
  record_text(CanonicalName::kComment, text);
  if (world().qtplasmac && text != nullptr) world().materials.edit(text, world().unit_mm());
}
void MESSAGE(char* text) { record_text(CanonicalName::kMessage, text); }
void LOG(char* text) { record_text(CanonicalName::kLog, text); }
void LOGOPEN(char* text) { record_text(CanonicalName::kLogOpen, text); }
void LOGAPPEND(char* text) { record_text(CanonicalName::kLogAppend, text); }
void LOGCLOSE() { record(CanonicalName::kLogClose); }
void CANON_ERROR(const char* format, ...) {
  std::array<char, 1024> text{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  record_text(CanonicalName::kCanonError, text.data());
}
void PLUGIN_CALL(int, const char*) {}
void IO_PLUGIN_CALL(int, const char*) {}

// ---- The program's course
// ---------------------------------------------------------------------------------

void PROGRAM_STOP() { record(CanonicalName::kProgramStop); }
void OPTIONAL_PROGRAM_STOP() { record(CanonicalName::kOptionalProgramStop); }
void PALLET_SHUTTLE() { record(CanonicalName::kPalletShuttle); }
void PROGRAM_END() { record(CanonicalName::kProgramEnd); }
void FINISH() { record(CanonicalName::kFinish); }
void ON_RESET() { record(CanonicalName::kOnReset); }
