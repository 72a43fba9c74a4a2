// twin/findings/finding.h - what a dry run found wrong: typed, placed, one for each event.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

enum class FindingId : std::uint8_t {
  kRapidContact,       ///< a traverse touches the workpiece
  kSpindleOffContact,  ///< a feed move touches the workpiece while the spindle stands
  kBelowStock,         ///< the tip goes below the floor of the blank, inside its outline
  kToolUndefined,      ///< feed moves with a tool nothing is known of, or with none
  kToolGuessed,        ///< only the diameter of the tool is known
  kToolAssumed,        ///< the program names no tool; the only one described is taken
  kStockGuessed,       ///< no blank is given or written in the program
  kNoProgramEnd,       ///< neither M2, M30 nor a closing %
  kRotaryIgnored,      ///< A, B or C motion, which this model does not have
  kFeedMissing,        ///< feed moves without a feed rate
  kInterpreterError,   ///< the interpreter refused a block
  kInterpreterWarning,
  kInterrupted,       ///< the run was stopped by the user
  kAxisLimit,         ///< a motion leaves the soft limits of the machine
  kOverFeed,          ///< feed moves ask for more than the axes can do
  kOutsideStock,      ///< no feed move comes near the blank: offset or blank is wrong
  kNotSimulated,      ///< user M-codes, M66: what a machine would do there is not known
  kSourceFault,       ///< the source itself is at fault: frames lost, clock stands, file damaged
  kSourceGap,         ///< positions were missing while the machine moved: that move is not cut
  kSourceRestarted,   ///< the controller has ended and begun again
  kOffPath,           ///< the machine's tip is not on the path of the program
  kNotThisProgram,    ///< the machine has never been on the path of the program, and cuts
  kToolMismatch,      ///< the machine has another tool in the spindle than the program
  kLengthUnknown,     ///< a tool whose length nothing tells; it counts as 0
  kLateStart,         ///< the machine was running its program when it was first seen
  kLineNotReached,    ///< no move of the line where the report was to begin
  kKinematics,        ///< what is taken for known of a machine that turns tool or workpiece
  kNoRotaryAxis,      ///< A, B or C of a machine that has none
  kSecondaryIgnored,  ///< U, V or W move, and what they slide is not known
  kSingularPose,      ///< an axis turns far while the spindle hardly does
  kToolTooLong,       ///< longer than the way to the pivot that the controller reckons with
  kTorchLeftOn,       ///< the program ends with the beam on
  kNoBeam,            ///< the program never turns the beam on
  kKerfZero,          ///< a kerf of no width
  kPierceInPart,      ///< pierces a part that has come free
  kCrossesPart,       ///< the head goes over a part that has come free, and may have tipped
  kBeamOff,           ///< feed moves over the sheet at cut height with the beam off
  kSmallPart,         ///< a part came free that may tilt or fall between the slats
  kStationEmpty,      ///< the punch strikes with a tool that has no station in the turret
  kNoPunch,           ///< it strikes with no tool
  kHitOnClamp,        ///< it comes down on a clamp
  kHitOffSheet,       ///< beside the sheet
  kHitOverEdge,       ///< partly beside the sheet
  kHitInAir,          ///< where all has been punched out already
  kHitOnPart,         ///< on a piece that has come free
  kWebLeft,           ///< nibbling leaves webs between strokes: the slug stays attached
  kPunchDown,         ///< the sheet moves while the punch is down
  kGripLost,          ///< a clamp holds nothing of the sheet
  kNoHit,             ///< the program never makes the punch strike
  kPositionUnknown,   ///< an axis stands where nothing has said: its moves are not cut
  kToolLength,        ///< the offset in force is not the length of the tool in the spindle
  kNotModelled,       ///< a machine of a kind that no model is for: turning
  kNothingCut,        ///< the program moves nothing, or misses its blank entirely
  kToolUnused,        ///< --tool describes a tool that the program never uses
  kToolNotChanged,    ///< a T word that no M6 follows, and the old tool cuts on
  kStopInPart,        ///< tool change, M0 or end of the program while the tool is inside the part
  kDrillSideways,     ///< a drill is fed sideways through material
  kBeamOnTraverse,    ///< the beam is on along traverses
  kCellCoarse,        ///< the cells of the grid are too large for a tool or a depth of the program
  kThinFilm,          ///< a wall or roof thinner than a cell was left, and the octree lost it
  kHolderContact,     ///< the holder touches the workpiece
  kShankContact,      ///< the shank, which is wider or slimmer than the cutter, touches it
  kFluteTooShort,     ///< material stands higher than the flutes reach, and the shank rubs
  kFixtureContact,    ///< cutter, shank, holder or spindle touches a fixture
  kSpindleContact,    ///< the spindle touches the workpiece
  kMachineCollision,  ///< what a machine carries touches what else it carries
  kNearMiss,          ///< two bodies come near each other, and do not touch
  kFeedLost,          ///< LinuxCNC does not run a feed that M61 comes right after
  kFlankContact,      ///< of a turning tool what does not cut touches the workpiece
  kThreadSpeed,       ///< a thread asks for more than the axes can do
  kWrongPlane,        ///< an arc of a lathe's program that does not lie in G18
  kPastCentre,        ///< a turning tool cuts beyond the axis
  kPipLeft,           ///< a face that has been turned has a pip in its middle
  kChuckContact,      ///< of a turning tool anything touches the chuck
  kJawContact,        ///< the same of its jaws
  kBarContact,        ///< the bar that holds an insert touches the workpiece
  kOverDepth,         ///< a cut is deeper than an insert's edge is long
  kOverSpeed,         ///< the spindle of a lathe is asked for more than it does
  kThreadShallow,     ///< a thread is less deep than its pitch asks for
  kUncompensated,     ///< a nose's contour is off the programmed one
  kGouge,             ///< the workpiece is cut into the design part
  kExcess,            ///< material is left over on the design part
  kPieceFree,         ///< a piece of what is milled comes free
  kChipLoadHigh,      ///< feed per tooth above what the tool's maker allows
  kChipThin,          ///< chips so thin that edges rub
  kFullSlot,          ///< a full slot, deeper than the tool is wide
  kPlunge,            ///< straight down into material, of a tool that does not cut at its centre
  kRampSteep,         ///< down into material on a steeper way than the tool's maker allows
  kCuttingSpeed,      ///< above what is known of the material
  kOverPower,         ///< cutting takes more power than the spindle has
  kOverTorque,        ///< the same of its torque
  kDeflection,        ///< forces bend the tool farther than is allowed
  kConventional,      ///< milling against the feed, where climb milling is wanted
  kAirCut,            ///< time at feed in no material
  kSpindleReversed,   ///< cuts while the spindle runs anticlockwise
  kEntryContact,      ///< a start in the middle of the program cuts what is in its way
  kLoadDiffers,       ///< of a watched machine: its spindle takes what its cuts should not
  kLongDwell,         ///< dwells for minutes
};

/// "rapid-contact", ...: the `id` of the report.
const char* to_string(FindingId id);

/// What a collision with the workpiece names as the other body.
inline constexpr const char* kWorkpieceBody = "workpiece";

/// One event. Position, time and depth are where it was first met and the greatest depth until it
/// stopped.
struct Finding {
  FindingId id = FindingId::kRapidContact;
  Severity severity = Severity::kError;
  SourceRef source;                 ///< line 0: the program as a whole
  std::optional<double> time_s;     ///< seconds after the start of the program
  std::optional<Vec3> position_mm;  ///< tool tip, workpiece frame
  std::optional<int> tool;
  std::optional<double> depth_mm;
  std::string text;     ///< without id, depth, place: "traverse touches the workpiece"
  std::string file;     ///< set where `source` cannot say it (interpreter's own messages)
  std::string excerpt;  ///< the source line, for people; may be empty
  std::string hint;     ///< what to do; may be empty
  /// Of a collision, or of what comes near one, as reports name them: what of the tool ("cutter",
  /// "shank", "holder", "spindle"), or of the machine a link's or a fixture's name; and a fixture's
  /// or a link's name or kWorkpieceBody. Else empty.
  std::array<std::string, 2> bodies{};
  bool has_bodies() const { return !bodies[0].empty(); }
  std::size_t times = 1;  ///< events that are told as this one (FindingLog::join_repeats)
};

/// "traverse touches the workpiece, 2.31 mm deep at X12.40 Y3.00 Z-1.20 (tool 3)". `depth_word` is
/// per id ("deep", "below").
std::string message_of(const Finding& finding);

/// The finding as a line for a person: file:line: error: rapid-contact: ...
Diagnostic diagnostic_of(const Finding& finding, const std::vector<std::string>& files);

/// Findings in the order in which they were met. Keeps the first kMaxKept and counts the rest, so
/// that an endless program of troubles cannot fill the memory.
class FindingLog {
 public:
  static constexpr std::size_t kMaxKept = 1000;
  using Handle = std::size_t;

  Handle add(Finding finding);
  /// From now on contacts of the same bodies (none of them the workpiece), tool and line are one
  /// finding, where it is deepest: a loop meets the same clamp each time it comes round.
  void join_repeats() { joins_repeats_ = true; }
  /// The event goes on, and is now better described so.
  void reword(Handle handle, std::string text) {
    if (handle < kept_.size()) kept_[handle].text = std::move(text);
  }
  void set_hint(Handle handle, std::string hint) {
    if (handle < kept_.size()) kept_[handle].hint = std::move(hint);
  }
  /// The event is more than it seemed.
  void raise(Handle handle, Severity severity);
  /// While muted nothing is kept or counted: for moves that are cut but not reported on.
  void set_muted(bool muted) { muted_ = muted; }
  /// What was added after the first `count` kept ones never happened.
  void forget_from(std::size_t count);
  /// All of another log behind what is here, as far as there is room; counted all the same.
  /// `files`: what its findings' sources mean, which they are given as their own.
  void join(const FindingLog& other, const std::vector<std::string>& files);
  /// The event goes on: its depth becomes the greater of the two.
  void deepen(Handle handle, double depth_mm);

  /// Names and texts of all that is kept: `renamed` gets each.
  template <typename Renamed>
  void rename_files(const Renamed& renamed) {
    for (Finding& finding : kept_) {
      finding.file = renamed(std::move(finding.file));
      finding.text = renamed(std::move(finding.text));
    }
  }

  const std::vector<Finding>& kept() const { return kept_; }
  std::uint64_t count(Severity severity) const {
    return counts_[static_cast<std::size_t>(severity)];
  }
  std::uint64_t total() const { return counts_[0] + counts_[1] + counts_[2]; }

 private:
  std::vector<Finding> kept_;
  /// The last event of a finding that is told once of several.
  struct Event {
    std::optional<double> time_s;
    std::optional<Vec3> position_mm;
  };
  std::optional<Handle> repeated(const Finding& finding) const;
  Handle repeat(Handle handle, const Finding& finding);

  std::map<Handle, Event> events_;
  bool joins_repeats_ = false;
  std::uint64_t counts_[3] = {0, 0, 0};
  bool muted_ = false;
};

}  // namespace kerf
