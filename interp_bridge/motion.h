// interp_bridge/motion.h - what the machine is told to do, after the modal fold: mm, mm/min, tip in
// the workpiece frame.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/geometry.h"

namespace kerf {

/// Where a motion comes from. `file` indexes ProgramSource::files (0 = the program itself, others
/// are called O-word subroutine files); `line` is 1-based, 0 = not known.
struct SourceRef {
  std::uint32_t file = 0;
  std::uint32_t line = 0;
  bool operator==(const SourceRef&) const = default;
};

enum class MotionKind : std::uint8_t {
  kTraverse,  ///< G0 and the rapid parts of cycles
  kFeed,      ///< straight, at feed
  kArc,       ///< circular or helical, at feed
  kThread,    ///< straight, synchronised with the spindle (G33, G76), or the in-and-out of a rigid
              ///< tap
  kProbe,     ///< straight probing move; the tip does not cut
  kDwell,     ///< no motion, `duration_s`
  kToolChange,  ///< `tool` is the new tool; no motion
  kStop,        ///< M0, M1, M60: the program waits for the operator
  kProgramEnd,  ///< M2, M30 or closing %; with the spindles that the program leaves to M2 to stop
  /// Where it is asked for (ProgramOptions::signals): spindle, coolant or an output has been
  /// switched at once, or a user M-code come. No motion; the step has what is on from here.
  kSignal,
};

/// Circular part of a motion: the tip turns about an axis through `center_mm` along `axis` (unit
/// vector) by `sweep_rad` (right-hand rule about `axis`, |sweep| > 2 pi for several turns) while it
/// moves along the axis linearly in angle. If the distances of start and end from the axis differ
/// (spiral), the radius changes linearly in angle too.
struct ArcGeometry {
  Vec3 center_mm{0};
  Vec3 axis{0, 0, 1};
  double sweep_rad = 0;
};

enum class SpindleState : std::uint8_t { kStopped, kClockwise, kCounterclockwise };

/// Constant surface speed (G96): the spindle turns the faster the nearer the tip is to its axis.
/// That is X0 of the program, axis_x_mm of the workpiece frame.
struct SurfaceSpeed {
  /// Nearer to the axis than this counts as this: without a cap the speed there has no bound.
  static constexpr double kSmallestRadius_mm = 0.5;

  double mm_per_min = 0;  ///< S; 0: none is in force (G97)
  double max_rpm = 0;     ///< D; 1e30 without
  double axis_x_mm = 0;

  bool on() const { return mm_per_min > 0; }
  /// What is commanded while the tip is at this X of the workpiece frame.
  double rpm_at(double x_mm) const {
    const double radius_mm = std::max(std::abs(x_mm - axis_x_mm), kSmallestRadius_mm);
    return std::min(mm_per_min / (2 * kPi * radius_mm), max_rpm);
  }
  bool operator==(const SurfaceSpeed&) const = default;
};

/// What has come since the step before that ends the chain of feeds which G64 Q merges, if nothing
/// more. A feed or a path mode that is another one ends it too.
enum class ChainEnd : std::uint8_t {
  kNone,
  kEnds,     ///< an override (M48 to M51, M53), (LOG,..), what makes the machine halt
  kOutputs,  ///< M62, M63, M67: switched where this step begins
};

/// A T word that has come since the step before. LinuxCNC's I/O task prepares the tool then, and
/// the moves behind it are not sent before that is done. The last one's, if there are more.
enum class ToolPrepare : std::uint8_t {
  kNone,
  kAheadOfLast,  ///< nothing was between that ends the chain of feeds: if the step before is a
                 ///< straight feed, LinuxCNC holds it back and sends the T word ahead of it
  kBehindLast,
  kStanding,  ///< behind what made the machine halt (Motion::halts)
};

/// How the machine runs through the corner between two moves: G61.1, G61, G64.
enum class PathMode : std::uint8_t { kExactStop, kExactPath, kContinuous };

/// Where the workpiece frame lies in the machine: a point w of it is, in machine coordinates of the
/// tip, R(rotation) * (w + g92) + g5x. R turns about Z.
struct WorkpieceFrame {
  Vec3 g5x_mm{0};
  Vec3 g92_mm{0};
  double rotation_deg = 0;
  std::array<double, 3> offset_abc_deg{};  ///< added to A, B, C
  Vec3 offset_uvw_mm{0};                   ///< added to U, V, W; these do not turn
  bool operator==(const WorkpieceFrame&) const = default;
};

/// What a step tells a torch, a laser or a jet. Which of it means "the beam is on" differs between
/// machines: BeamTrigger (beam_trigger.h). M62, M63 and M67 take effect with the next step that
/// moves, M64, M65 and M68 at once, as in LinuxCNC. 32 bytes.
struct TorchState {
  static constexpr unsigned kOutputs = 64;   ///< EMCMOT_MAX_DIO: M62 P0 to P63
  static constexpr unsigned kAnalogs = 4;    ///< E0 to E3; programs use no others
  static constexpr unsigned kThcOff = 2;     ///< QtPlasmaC: output that holds the torch's height
  static constexpr unsigned kTorchOff = 3;   ///< QtPlasmaC: output that puts the torch out
  static constexpr unsigned kReduction = 3;  ///< QtPlasmaC: analog output, percent of the feed

  std::uint64_t outputs = 0;             ///< bit n: digital output n is set
  std::array<float, kAnalogs> analog{};  ///< M67 E Q, M68 E Q
  std::uint8_t spindles_on = 0;          ///< bit n: M3 $n or M4 $n; QtPlasmaC: see TorchTool
  bool adaptive_feed = false;            ///< M52 P1: without it velocity_percent() has no effect
  /// QtPlasmaC's hole sensing has added this step: 4 mm more of the hole, with the torch out.
  bool overburn = false;
  std::uint16_t material = 0;  ///< index into Program::materials(); [0] is the default

  constexpr bool output(unsigned n) const { return n < kOutputs && (outputs >> n & 1) != 0; }
  constexpr bool thc_enabled() const { return !output(kThcOff); }
  constexpr bool torch_enabled() const { return !output(kTorchOff); }
  /// Of the programmed feed, as QtPlasmaC has it: what is outside 10 to 100 counts as 100.
  double velocity_percent() const {
    const double percent = double{analog[kReduction]};
    return percent >= 10 && percent < 100 ? percent : 100;
  }
  bool operator==(const TorchState&) const = default;
};

/// The tools of a QtPlasmaC machine, by the spindle that M3 $n names.
enum class TorchTool : std::uint8_t { kNone, kPlasma, kScribe, kSpotting };

/// The first that is on: M3 $0, $1, $2. A torch that output 3 puts out is not on.
constexpr TorchTool torch_tool(const TorchState& torch) {
  if ((torch.spindles_on & 1) != 0 && torch.torch_enabled()) return TorchTool::kPlasma;
  if ((torch.spindles_on & 2) != 0) return TorchTool::kScribe;
  return (torch.spindles_on & 4) != 0 ? TorchTool::kSpotting : TorchTool::kNone;
}

/// The tool length offset in force, where it is not the length of the tool in the spindle. 144
/// bytes.
struct ToolLengthState {
  enum class Verdict : std::uint8_t {
    kSound,   ///< it is, or nothing tells; the rest is empty
    kStated,  ///< the program itself has said another length for this tool (G43.1): positions are
              ///< as programmed
    kWrong,   ///< the tip is not where the program has it, but at tip_shift_mm from there
  };
  Vec3 applied_mm{0};    ///< X Y Z of the offset in force, along the machine's axes
  Vec3 real_mm{0};       ///< of the tool in the spindle, by the tool table
  Vec3 tip_shift_mm{0};  ///< workpiece frame; in from_mm, to_mm and the arc's centre already
  Vec3 uvw_off_mm{0};    ///< U V W: applied less real; in from_uvw_mm, to_uvw_mm if `displaces`
  Vec3 abc_off_deg{0};   ///< A B C: the same. Where that leaves the tip is not reckoned with
  SourceRef set_at;      ///< G43 that set it after the tool change; line 0: none has
  std::int32_t offset_tool = -1;  ///< whose row is applied (H); -1: none's (G49), or not known
  Verdict verdict = Verdict::kSound;
  bool displaces = false;  ///< the motion is that of the real tip, off by tip_shift_mm, uvw_off_mm
  bool operator==(const ToolLengthState&) const = default;
};

/// One step of the program. Positions are the tool tip in the workpiece frame: the coordinates that
/// the program writes under its first work offset, in mm (ABC in degrees). from_mm of a step is
/// to_mm of the one before, except where a tool length offset changes under a standing machine, or
/// a tool of another length known comes into the spindle: the tip (of the new tool) is then
/// elsewhere, and both ends are true workpiece positions.
struct Motion {
  MotionKind kind = MotionKind::kTraverse;
  SpindleState spindle = SpindleState::kStopped;
  bool flood = false;
  bool mist = false;
  PathMode path_mode = PathMode::kContinuous;
  bool feed_per_rev = false;  ///< G95: feed is mm per revolution
  bool compensated = false;   ///< G41, G42: the tip runs beside the programmed contour
  /// False where the way is not known: in the first motion (rs274 starts at 0,0,0 and the real
  /// machine does not) and all steps before it, after a spline, whose points the listing does not
  /// hold, and where an axis is unknown (unknown_from, unknown_to). kerf must not cut along such a
  /// move; `to_mm` is right but for the axes of unknown_to, from_mm equals it, and an arc has a
  /// sweep of 0.
  bool start_known = true;
  /// Axes, bit 0 is X, 1 Y, 2 Z, of which nothing has said where they stand when the step begins,
  /// and when it ends: no block has placed them yet, or they went where only the machine's zero
  /// would tell. Only of programs that are followed so (InterpreterSetup::unknown_places).
  std::uint8_t unknown_from = 0;
  std::uint8_t unknown_to = 0;
  /// The step goes to a place of the machine (G53, G28, G30, a tool change), and where the work
  /// lies in the machine is not known.
  bool to_machine_place = false;
  /// An S word has come in the program (or before it, in the startup code), S0 included.
  bool speed_said = false;
  std::uint8_t user_m = 0;  ///< kSignal of M100 to M199: the number; else 0
  /// kArc only: the rounded corner of a traverse, where the planned path is taken for the
  /// program's; as rapid as that.
  bool rapid = false;
  /// Since the step before, so many commands have come that LinuxCNC sends out only when all moves
  /// before them are done, so that the machine has stopped: offsets, spindle, coolant, M64, M65,
  /// M68, M52, M66, messages. Not what is a step of its own. 255: that, or more.
  std::uint8_t halts = 0;
  std::uint8_t io_halts = 0;  ///< of those, the ones that wait for LinuxCNC's I/O task: coolant
  ChainEnd chain_end = ChainEnd::kNone;
  ToolPrepare tool_prepare = ToolPrepare::kNone;
  /// kToolChange by M61: the program only says which tool is in the spindle. LinuxCNC 2.9 loses a
  /// straight feed (or a chain that G64 Q merges) that comes right before it.
  bool by_number = false;
  /// G10 L0 has come since the step before, and nothing ahead of it that ends the chain of feeds:
  /// LinuxCNC loses what it loses before M61.
  bool table_reloaded = false;
  int tool = 0;  ///< tool number in the spindle, 0 = none
  /// The last T word, while no tool change has followed it; line 0: there is none that waits.
  int selected_tool = 0;
  SourceRef selected_at;
  SourceRef source;
  Vec3 from_mm{0};
  Vec3 to_mm{0};
  std::array<double, 3> from_abc_deg{};
  std::array<double, 3> to_abc_deg{};
  /// U, V, W, as the program has them under its first work offset. What they slide is the machine's
  /// business (MachineKinematics): from_mm and to_mm are X Y Z alone. rs274 knows no U, V, W.
  Vec3 from_uvw_mm{0};
  Vec3 to_uvw_mm{0};
  ArcGeometry arc;  ///< kArc only
  /// The machine's own coordinates are those of the tip plus this, along its axes: the offset in
  /// force (G43), or where that is wrong and the tip displaced, the tool's length.
  Vec3 tool_offset_mm{0};
  Vec3 tool_offset_uvw_mm{0};  ///< the same of U, V, W
  /// Programmed; 0 for traverses. Of X Y Z, or of U V W where those stand. mm per revolution if
  /// feed_per_rev (of a thread: its pitch), and degrees/min where only A, B or C move.
  double feed_mm_per_min = 0;
  double spindle_rpm = 0;  ///< programmed S; under G96, that at the end of the step
  SurfaceSpeed surface;    ///< G96; spindle_rpm_at() has the speed along the step
  double duration_s = 0;   ///< kDwell only
  /// G64 P: how far a corner may be cut; 0 = as far as the speed wants. kContinuous only.
  float blend_tolerance_mm = 0;
  /// G64 Q (without Q: P): straight feeds may be merged into one within this; 0 = they are not.
  float merge_tolerance_mm = 0;
  TorchState torch;
  ToolLengthState length;
};

}  // namespace kerf
