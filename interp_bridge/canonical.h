// interp_bridge/canonical.h - one line of LinuxCNC's canonical listing (the text that rs274 prints)
// as a typed value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// Every call that the listings of LinuxCNC 2.9 and 2.10 hold. The printed spelling is
/// canonical_spelling().
enum class CanonicalName : std::uint8_t {
  kStraightFeed,
  kStraightTraverse,
  kArcFeed,
  kSetFeedRate,
  kStraightProbe,
  kRigidTap,
  kNurbsFeed,
  kUseLengthUnits,
  kSetG5xOffset,
  kSetG92Offset,
  kSetXyRotation,
  kSetFeedReference,
  kSelectPlane,
  kSetFeedMode,
  kStartSpeedFeedSync,
  kStopSpeedFeedSynch,
  kSetMotionControlMode,
  kSetNaivecamTolerance,
  kSetPlannerMode,
  kDwell,
  kSetSpindleMode,
  kSetSpindleSpeed,
  kStartSpindleClockwise,
  kStartSpindleCounterclockwise,
  kStopSpindleTurning,
  kOrientSpindle,
  kWaitOrientComplete,
  kSpindleRetract,
  kSpindleRetractTraverse,
  kUseNoSpindleForce,
  kSelectTool,
  kStartChange,
  kChangeTool,
  kChangeToolNumber,
  kSetToolTableEntry,
  kReloadTooldata,
  kUseToolLengthOffset,
  kSetCutterRadiusCompensation,
  kStartCutterRadiusCompensation,
  kStopCutterRadiusCompensation,
  kSetTraverseRate,
  kComment,
  kMessage,
  kLog,
  kLogOpen,
  kLogAppend,
  kLogClose,
  kMistOn,
  kMistOff,
  kFloodOn,
  kFloodOff,
  kEnableFeedOverride,
  kDisableFeedOverride,
  kEnableAdaptiveFeed,
  kDisableAdaptiveFeed,
  kEnableFeedHold,
  kDisableFeedHold,
  kEnableSpeedOverride,
  kDisableSpeedOverride,
  kSetMotionOutputBit,
  kClearMotionOutputBit,
  kSetAuxOutputBit,
  kClearAuxOutputBit,
  kSetMotionOutputValue,
  kSetAuxOutputValue,
  kTurnProbeOn,
  kTurnProbeOff,
  kClampAxis,
  kUnclampAxis,
  kProgramStop,
  kOptionalProgramStop,
  kPalletShuttle,
  kProgramEnd,
  kFinish,
  kOnReset,
  kCanonError,
};
inline constexpr std::size_t kCanonicalNameCount =
    static_cast<std::size_t>(CanonicalName::kCanonError) + 1;

/// Argument of USE_LENGTH_UNITS, of SELECT_PLANE and of SET_MOTION_CONTROL_MODE, in `arguments[0]`;
/// the last has a tolerance in `arguments[1]` (program units) where the mode is kContinuous.
enum class CanonicalUnits : std::uint8_t { kInches, kMm, kCm };
enum class CanonicalPlane : std::uint8_t { kXy, kYz, kXz, kUnknown };
enum class CanonicalControlMode : std::uint8_t { kExactStop, kExactPath, kContinuous };

/// One call. Cheap: no allocation; the views point into the parsed line and live as long as it
/// does.
struct CanonicalCommand {
  static constexpr std::size_t kMaxArguments = 14;

  CanonicalName name = CanonicalName::kOnReset;
  std::uint8_t argument_count = 0;
  bool has_n = false;          ///< the N column holds a number
  std::uint64_t sequence = 0;  ///< line counter of the listing; 0 = not printed (2.10's G6)
  std::uint64_t n = 0;         ///< the program's N word, if has_n
  /// Numbers in printed order, in the program's units; integers exact. Missing optional ones:
  /// argument_count is lower. Units, planes and control modes as the value of their enum.
  std::array<double, kMaxArguments> arguments{};
  std::string_view spelling;  ///< the name as printed (SPINDLE.1.WAIT_ORIENT_COMPLETE)
  std::string_view
      text;  ///< COMMENT and the like: between the outer quotes, raw; CANON_ERROR: all of it

  double number(std::size_t index) const { return arguments[index]; }
  int integer(std::size_t index) const { return static_cast<int>(arguments[index]); }
};

enum class CanonicalLineKind : std::uint8_t {
  kCommand,    ///< `command` is complete
  kUnknown,    ///< looks canonical, the name is none of ours; `command.spelling` holds it
  kForeign,    ///< other text: (PRINT,..), messages of remaps, blank lines
  kMalformed,  ///< a known command whose arguments do not fit; `column` and `message` say where and
               ///< why
};

struct CanonicalLine {
  CanonicalLineKind kind = CanonicalLineKind::kForeign;
  CanonicalCommand command;
  int column = 0;            ///< kMalformed: 1-based, in bytes
  const char* message = "";  ///< kMalformed: static text
};

/// Parses one line (without its newline; a trailing CR is dropped) into `out`, which may be reused:
/// only the fields that `kind` names are valid. Grammar of a line, as printed by rs274:
///
///     blanks sequence blank N(digits | "....." | blanks) blanks NAME "(" arguments ")"
///     N..... saicanon NAME "(" arguments ")"               (2.10's G6 splines)
///
/// NAME ends at the FIRST "(", the arguments at the LAST ")": strings are printed raw and may hold
/// quotes, parentheses and commas. Six digits and more of N are glued to NAME. Any bytes are
/// accepted; nothing is read outside `line`. About 0.15 us a line.
void parse_canonical_line(std::string_view line, CanonicalLine& out);

/// "STRAIGHT_FEED" ...; for kWaitOrientComplete the form of spindle 0.
std::string_view canonical_spelling(CanonicalName name);

/// True if the numbers are what the call's line could hold: enough of them, whole where they must
/// be, none beyond reason. For commands that come as numbers (record_reader.h); a few more numbers
/// than the line has (U, V, W) are allowed.
bool canonical_arguments_fit(const CanonicalCommand& command);

/// True for a line that only rs274 prints: sequence, N column and a call (of any name). What tells
/// a listing from NC text.
bool looks_canonical(std::string_view line);

}  // namespace kerf
