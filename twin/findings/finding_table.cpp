#include "twin/findings/finding_table.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "base/translate.h"

namespace kerf {
namespace {

using Id = FindingId;
using Topic = FindingTopic;
constexpr Severity kNote = Severity::kNote;
constexpr Severity kWarning = Severity::kWarning;
constexpr Severity kError = Severity::kError;

constexpr std::array<FindingRow, kFindingIds> kRows{{
    {Id::kRapidContact, "rapid-contact", kError, Topic::kCutter,
     tr_noop("A rapid touches the workpiece."),
     tr_noop("A higher clearance or another order of the moves; or tool and blank are not as they "
             "were described.")},
    {Id::kSpindleOffContact, "spindle-off-contact", kError, Topic::kCutter,
     tr_noop("A feed move touches the workpiece while the spindle stands."),
     tr_noop("M3 and S behind the tool change, which stops the spindle.")},
    {Id::kBelowStock, "below-stock", kError, Topic::kCutter,
     tr_noop("The tip goes below the floor of the blank, inside its outline: into the table."),
     tr_noop("Over a spoilboard --below says how deep it may go; otherwise look at the blank and "
             "the zero in Z.")},
    {Id::kToolUndefined, "tool-undefined", kError, Topic::kTools,
     tr_noop("Nothing is known of the tool, or none is in the spindle; its moves do not cut."),
     tr_noop("--tool N=SHAPE, or a row in the tool table.")},
    {Id::kToolGuessed, "tool-guessed", kWarning, Topic::kTools,
     tr_noop("The shape of the tool is not known for sure: only its diameter, or no more than what "
             "fits its moves."),
     tr_noop("--tool N=SHAPE.")},
    {Id::kToolAssumed, "tool-assumed", kNote, Topic::kTools,
     tr_noop("The program cuts before any tool change; the only tool that is described is taken to "
             "be in the spindle."),
     tr_noop("T and M6 in the program.")},
    {Id::kStockGuessed, "stock-guessed", kWarning, Topic::kBlank,
     tr_noop("No blank is given or written in the program; one that fits its moves is taken."),
     tr_noop("--stock.")},
    {Id::kNoProgramEnd, "no-program-end", kWarning, Topic::kProgram,
     tr_noop("The program ends without M2, M30 or a closing %."), tr_noop("M2 or M30 at its end.")},
    {Id::kRotaryIgnored, "rotary-ignored", kError, Topic::kMachine,
     tr_noop("A, B or C move and the model is for upright tools, or a move turns so far that it is "
             "not cut."),
     tr_noop("--model octree; fewer turns in a block.")},
    {Id::kFeedMissing, "feed-missing", kWarning, Topic::kProgram,
     tr_noop("A feed move without a feed rate; it takes no time in the report."),
     tr_noop("F before the first feed move.")},
    {Id::kInterpreterError, "interpreter-error", kError, Topic::kProgram,
     tr_noop("The interpreter refused a block, and what comes behind it is not run."),
     tr_noop("Mend the block: the machine would stop there, too.")},
    {Id::kInterpreterWarning, "interpreter-warning", kWarning, Topic::kProgram,
     tr_noop("What the interpreter said beyond errors."), tr_noop("Read it.")},
    {Id::kInterrupted, "interrupted", kNote, Topic::kProgram,
     tr_noop("The run was stopped before its end: the report is partial."), ""},
    {Id::kAxisLimit, "axis-limit", kError, Topic::kMachine,
     tr_noop("A move leaves the soft limits of the machine."),
     tr_noop("Move the work zero, or the program; look at --work-offset and the parameter file.")},
    {Id::kOverFeed, "over-feed", kWarning, Topic::kMachine,
     tr_noop(
         "Feed moves ask for more than the axes can do; the times are those of the real speed."),
     tr_noop("A lower F; without an INI the limits are those of a small mill: --ini.")},
    {Id::kOutsideStock, "outside-stock", kWarning, Topic::kBlank,
     tr_noop("No feed move comes near the workpiece."),
     tr_noop("Is the blank given in the coordinates that the program writes?")},
    {Id::kNotSimulated, "not-simulated", kNote, Topic::kProgram,
     tr_noop("What a machine would do there is not known; the message says what was taken for true "
             "instead."),
     ""},
    {Id::kSourceFault, "source-fault", kWarning, Topic::kSource,
     tr_noop("The source of positions itself is at fault: frames lost, a clock that stands, a "
             "damaged recording."),
     tr_noop("Look at the bus, the device or the recording.")},
    {Id::kSourceGap, "source-gap", kWarning, Topic::kSource,
     tr_noop("Positions were missing, jumped, or were none of a machine."),
     tr_noop("--gap, and the limits of the machine.")},
    {Id::kSourceRestarted, "source-restarted", kNote, Topic::kSource,
     tr_noop("The controller has ended and begun again."), ""},
    {Id::kOffPath, "off-path", kWarning, Topic::kSource,
     tr_noop("The tip is farther from the program's path than --off-path."),
     tr_noop("Another offset, tool length or --path?")},
    {Id::kNotThisProgram, "not-this-program", kError, Topic::kSource,
     tr_noop("The machine works in the blank and has not once been on the path of the program."),
     tr_noop("Another --program, another work offset, or positions in another frame or unit.")},
    {Id::kToolMismatch, "tool-mismatch", kError, Topic::kSource,
     tr_noop("The machine has another tool in the spindle than the program where it is."),
     tr_noop("Look at the machine.")},
    {Id::kLengthUnknown, "length-unknown", kWarning, Topic::kTools,
     tr_noop("Nothing tells the length of the tool; its tip is taken to be where the machine's "
             "position is."),
     tr_noop("A tool table; or machine.tool_length: none says that this is so.")},
    {Id::kLateStart, "late-start", kNote, Topic::kSource,
     tr_noop("The machine ran its program already when it was first seen; what comes before is "
             "taken as cut."),
     tr_noop("--joined-late keep leaves the workpiece as it was given.")},
    {Id::kLineNotReached, "line-not-reached", kWarning, Topic::kProgram,
     tr_noop("The program runs no move of the line where the report was to begin, or beyond."),
     tr_noop("Another --from-line.")},
    {Id::kKinematics, "kinematics", kNote, Topic::kMachine,
     tr_noop("What is taken for known of a machine that turns tool or workpiece, and from where."),
     tr_noop("If it is wrong: machine.kinematics, machine.geometry and their neighbours in a "
             "configuration.")},
    {Id::kNoRotaryAxis, "no-rotary-axis", kError, Topic::kMachine,
     tr_noop("The program turns A, B or C, and the machine has no such axis."),
     tr_noop("Another INI, or a program for this machine.")},
    {Id::kSecondaryIgnored, "secondary-ignored", kError, Topic::kMachine,
     tr_noop("U, V or W move, and nothing says what they slide: it is cut as if they stood."),
     tr_noop("--ini or machine.joints with W as a quill; machine.kinematics: links says more.")},
    {Id::kSingularPose, "singular-pose", kWarning, Topic::kMachine,
     tr_noop("An axis has to turn far while the spindle's direction hardly changes."),
     tr_noop("Tilt the part a little, or go through the pole elsewhere.")},
    {Id::kToolTooLong, "tool-too-long", kError, Topic::kMachine,
     tr_noop("The tool is longer than the way to the pivot that the controller reckons with."),
     tr_noop("The pivot length of the HAL files, or machine.geometry.")},
    {Id::kTorchLeftOn, "torch-left-on", kWarning, Topic::kBeam,
     tr_noop("The program ends with the beam on."), tr_noop("M5.")},
    {Id::kNoBeam, "no-beam", kWarning, Topic::kBeam,
     tr_noop("The program never turns the beam on; nothing is cut."),
     tr_noop("--beam says what turns it on.")},
    {Id::kKerfZero, "kerf-zero", kError, Topic::kBeam,
     tr_noop("A kerf of no width; its moves do not cut."), tr_noop("--kerf, or --tool N=kerf:W.")},
    {Id::kPierceInPart, "pierce-in-part", kError, Topic::kBeam,
     tr_noop("Pierces a part that is free already and may have moved."),
     tr_noop("Cut holes before the outline.")},
    {Id::kCrossesPart, "crosses-part", kWarning, Topic::kBeam,
     tr_noop("The head goes over a part that is free and may have tipped."),
     tr_noop("Lift the torch for the way, or cut in another order.")},
    {Id::kBeamOff, "beam-off", kWarning, Topic::kBeam,
     tr_noop("Feed moves run over the sheet at cut height with the beam off."),
     tr_noop("Light the torch before them, or lift it; or --beam says what really turns it on.")},
    {Id::kSmallPart, "small-part", kWarning, Topic::kBeam,
     tr_noop("A part came free that is smaller than --slats, and may tilt or fall."),
     tr_noop("A tab that holds it.")},
    {Id::kStationEmpty, "station-empty", kError, Topic::kPunch,
     tr_noop("The punch strikes with a tool that has no station in the turret; nothing is cut."),
     tr_noop("The station in the turret's file, or another T.")},
    {Id::kNoPunch, "no-punch", kError, Topic::kPunch,
     tr_noop("The punch strikes with no tool; nothing is cut."), tr_noop("T and M6 before it.")},
    {Id::kHitOnClamp, "hit-on-clamp", kError, Topic::kPunch,
     tr_noop("The punch comes down on a clamp, or within its clearance."),
     tr_noop("Move the clamps, re-grip before, or keep away.")},
    {Id::kHitOffSheet, "hit-off-sheet", kError, Topic::kPunch,
     tr_noop("The punch comes down beside the sheet."),
     tr_noop("Look at the sheet's place and the zero.")},
    {Id::kHitOverEdge, "hit-over-edge", kNote, Topic::kPunch,
     tr_noop("A part of the punch hangs over the sheet's outer edge."),
     tr_noop("A larger sheet, or the punch farther in.")},
    {Id::kHitInAir, "hit-in-air", kWarning, Topic::kPunch,
     tr_noop("A move's strokes take nothing: all has been punched out there."),
     tr_noop("Leave the stroke out, or look at its place.")},
    {Id::kHitOnPart, "hit-on-part", kError, Topic::kPunch,
     tr_noop("The punch comes down on a piece that is free already."),
     tr_noop("Punch it before its outline is closed.")},
    {Id::kWebLeft, "web-left", kWarning, Topic::kPunch,
     tr_noop("Nibbling at too large a pitch leaves webs between strokes: the slug stays attached."),
     tr_noop("A smaller pitch.")},
    {Id::kPunchDown, "punch-down", kWarning, Topic::kPunch,
     tr_noop("The sheet moves while the punch is down."),
     tr_noop("End the stroke before the move, or make the move nibble.")},
    {Id::kGripLost, "grip-lost", kError, Topic::kPunch,
     tr_noop("A clamp of the punch press holds nothing of the sheet."),
     tr_noop("Another place for the clamps, or another order of strokes.")},
    {Id::kNoHit, "no-hit", kWarning, Topic::kPunch,
     tr_noop("The program never makes the punch strike."),
     tr_noop("punch.trigger in the turret's file.")},
    {Id::kPositionUnknown, "position-unknown", kNote, Topic::kProgram,
     tr_noop("A move that is not cut, since nothing has said where an axis stands or where the "
             "machine's zero is."),
     tr_noop("--ini, --work-offset, or a G0 before it that names the axis.")},
    {Id::kToolLength, "tool-length", kError, Topic::kTools,
     tr_noop("The offset in force is not the length of the tool in the spindle."),
     tr_noop("G43 behind M6, with the H of this tool.")},
    {Id::kNotModelled, "not-modelled", kError, Topic::kTurning,
     tr_noop("What the program does there no model is for: it is cut otherwise than the machine "
             "would, or not at all."),
     tr_noop(
         "live=z or live=x in the shape of a driven tool; --as-mill, if the program only mills.")},
    {Id::kNothingCut, "nothing-cut", kError, Topic::kBlank,
     tr_noop(
         "The program moves nothing, or its feed moves cut nothing of the blank that is given."),
     tr_noop("Is the blank given in the coordinates that the program writes?")},
    {Id::kToolUnused, "tool-unused", kNote, Topic::kTools,
     tr_noop("--tool describes a tool that the program never uses."), tr_noop("Another number?")},
    {Id::kToolNotChanged, "tool-not-changed", kWarning, Topic::kTools,
     tr_noop("A T word that no M6 follows, and the old tool cuts on."), tr_noop("M6.")},
    {Id::kStopInPart, "stop-in-part", kWarning, Topic::kCutter,
     tr_noop("Tool change, stop or the program's end while the tool is inside the part."),
     tr_noop("Go up before it.")},
    {Id::kDrillSideways, "drill-sideways", kError, Topic::kCutter,
     tr_noop("A drill is fed sideways through material."),
     tr_noop("Is it a drill? If not, --tool N=SHAPE.")},
    {Id::kBeamOnTraverse, "beam-on-traverse", kWarning, Topic::kBeam,
     tr_noop("Rapids cut the sheet, as the beam is on."),
     tr_noop("If the machine's beam is off there, another --beam.")},
    {Id::kCellCoarse, "cell-coarse", kWarning, Topic::kBlank,
     tr_noop("What a tool leaves at its deepest is narrower than two cells: volumes, pictures and "
             "meshes are not to be relied on there."),
     tr_noop("The --cell that the message names.")},
    {Id::kThinFilm, "thin-film", kWarning, Topic::kBlank,
     tr_noop("A move leaves a wall, roof or floor thinner than a cell, which the octree loses."),
     tr_noop("The --cell that the message names, if the wall matters.")},
    {Id::kHolderContact, "holder-contact", kError, Topic::kCollisions,
     tr_noop("The holder touches the workpiece as it then is."),
     tr_noop("The stick-out that the message names.")},
    {Id::kShankContact, "shank-contact", kError, Topic::kCollisions,
     tr_noop("The shank touches the workpiece."),
     tr_noop("Flutes as long as the message says, a slimmer shank, smaller steps.")},
    {Id::kFluteTooShort, "flute-too-short", kWarning, Topic::kCollisions,
     tr_noop("Material stands higher than the flutes reach where the cutter comes, and the shank "
             "rubs along it."),
     tr_noop("Smaller steps, or flutes as long as the message says.")},
    {Id::kFixtureContact, "fixture-contact", kError, Topic::kCollisions,
     tr_noop("Cutter, shank, holder or spindle touches a fixture."),
     tr_noop("Another way, a longer tool, a lower clamp.")},
    {Id::kSpindleContact, "spindle-contact", kError, Topic::kCollisions,
     tr_noop("The spindle touches the workpiece as it then is."),
     tr_noop("The length of tool that the message names.")},
    {Id::kMachineCollision, "machine-collision", kError, Topic::kCollisions,
     tr_noop("What the machine carries touches what else it carries."),
     tr_noop("Another way, another place of the part; machine.ignore names pairs that may touch.")},
    {Id::kNearMiss, "near-miss", kNote, Topic::kCollisions,
     tr_noop("Two bodies come nearer to each other than --clearance and do not touch."),
     tr_noop("--clearance, or clearance_mm of the fixture.")},
    {Id::kFeedLost, "feed-lost", kError, Topic::kProgram,
     tr_noop("LinuxCNC forgets a straight feed that M61 or G10 L0 comes right after."),
     tr_noop("Write G4 P0 between the feed and M61 or G10 L0.")},
    {Id::kFlankContact, "flank-contact", kError, Topic::kCollisions,
     tr_noop("What does not cut of an insert runs into the workpiece."),
     tr_noop("A slimmer insert, another orientation.")},
    {Id::kThreadSpeed, "thread-speed", kError, Topic::kTurning,
     tr_noop("A thread's lead times the spindle's speed is more than the axes do."),
     tr_noop("A lower S: the message has the greatest.")},
    {Id::kWrongPlane, "wrong-plane", kError, Topic::kTurning,
     tr_noop("On a lathe: an arc that does not lie in XZ."),
     tr_noop("G18: LinuxCNC begins with G17, on a lathe as well.")},
    {Id::kPastCentre, "past-centre", kWarning, Topic::kTurning,
     tr_noop("A turning tool cuts on beyond the axis."), tr_noop("An end nearer to the axis.")},
    {Id::kPipLeft, "pip-left", kNote, Topic::kTurning,
     tr_noop("In the middle of a face that has been turned a pip stands."),
     tr_noop("A round nose is driven by its radius beyond the axis.")},
    {Id::kChuckContact, "chuck-contact", kError, Topic::kCollisions,
     tr_noop("A turning tool, a drill or its holder touches the chuck."),
     tr_noop("Another way; at=Z of --chuck is where its face is.")},
    {Id::kJawContact, "jaw-contact", kError, Topic::kCollisions,
     tr_noop("A turning tool, a drill or its holder touches the jaws."),
     tr_noop("More of the blank out of the jaws.")},
    {Id::kBarContact, "bar-contact", kError, Topic::kCollisions,
     tr_noop("The bar that holds an insert touches the workpiece."),
     tr_noop("A slimmer bar, a wider bore first.")},
    {Id::kOverDepth, "over-depth", kWarning, Topic::kTurning,
     tr_noop("Material stands before the whole cutting edge of an insert: the cut is as deep as "
             "the edge is long, or deeper."),
     tr_noop("Less depth of cut; edge=L of the tool.")},
    {Id::kOverSpeed, "over-speed", kError, Topic::kTurning,
     tr_noop("S or G96 asks for more than the spindle does, or G96 without D feeds to the axis."),
     tr_noop("D behind G96, a lower S.")},
    {Id::kThreadShallow, "thread-shallow", kWarning, Topic::kTurning,
     tr_noop("A thread is less deep than its pitch and its form ask for."),
     tr_noop("Deeper passes; the diameter before the thread.")},
    {Id::kUncompensated, "uncompensated", kNote, Topic::kTurning,
     tr_noop("Without G41 or G42 the nose leaves a contour that is off the programmed one."),
     tr_noop("G42 or G41 before the contour.")},
    {Id::kGouge, "gouge", kError, Topic::kDesign,
     tr_noop("The workpiece is cut into the design part, deeper than the tolerance."),
     tr_noop("Look at that line; or at where the design lies (--compare-at).")},
    {Id::kExcess, "excess", kWarning, Topic::kDesign,
     tr_noop("On the design part material is left over, more than the tolerance."),
     tr_noop("Another pass; a larger --tolerance; or it is another setup's.")},
    {Id::kPieceFree, "piece-free", kWarning, Topic::kCutter,
     tr_noop("A piece of the workpiece is cut off and nothing holds it; an error where the tool "
             "goes on in it."),
     tr_noop("Tabs or a skin left below hold it; a pocket is cleared from its middle outward.")},
    {Id::kChipLoadHigh, "chip-load-high", kWarning, Topic::kCutter,
     tr_noop("The feed per tooth is above what the tool's maker allows (chip=)."),
     tr_noop("A lower F, or more S.")},
    {Id::kChipThin, "chip-thin", kWarning, Topic::kCutter,
     tr_noop("Chips are so thin that the edges rub instead of cutting: heat, wear, a hard skin; a "
             "note where only a blunt edge would."),
     tr_noop("More feed per tooth: a higher F, less S, fewer teeth.")},
    {Id::kFullSlot, "full-slot", kNote, Topic::kCutter,
     tr_noop("The tool is in a full slot deeper than it is wide."),
     tr_noop("Shallower passes, or a way that takes part of the width (trochoidal).")},
    {Id::kPlunge, "plunge", kError, Topic::kCutter,
     tr_noop("A tool that does not cut at its centre (centre=no) goes down into material with it: "
             "straight, or more steeply than its ramp= allows."),
     tr_noop("A hole drilled before; a ramp or a helix, as steep as ramp= of the tool says.")},
    {Id::kRampSteep, "ramp-steep", kWarning, Topic::kCutter,
     tr_noop("The way down into material is steeper than the tool's maker allows (ramp=)."),
     tr_noop("A longer ramp, a wider helix.")},
    {Id::kCuttingSpeed, "cutting-speed", kNote, Topic::kCutter,
     tr_noop("The cutting speed is above what is known of the material."), tr_noop("Less S.")},
    {Id::kOverPower, "over-power", kWarning, Topic::kMachine,
     tr_noop("Cutting takes more power than the spindle has; a note where it may."),
     tr_noop("Less depth, width or feed.")},
    {Id::kOverTorque, "over-torque", kWarning, Topic::kMachine,
     tr_noop("Cutting takes more torque than the spindle has; a note where it may."),
     tr_noop("Less depth or feed per tooth; a smaller tool.")},
    {Id::kDeflection, "deflection", kWarning, Topic::kCutter,
     tr_noop("Cutting bends the tool farther than --max-deflection; a note where it may."),
     tr_noop("Less stick-out, a thicker tool, less depth, width or feed.")},
    {Id::kConventional, "conventional", kWarning, Topic::kCutter,
     tr_noop("Conventional milling, where climb milling is wanted (--climb)."),
     tr_noop("The other way round the contour.")},
    {Id::kAirCut, "air-cut", kNote, Topic::kProgram,
     tr_noop("Time is lost at feed in no material."), tr_noop("A faster feed there, or rapids.")},
    {Id::kSpindleReversed, "spindle-reversed", kWarning, Topic::kCutter,
     tr_noop("The tool cuts while the spindle runs anticlockwise (M4): edges of right-hand tools "
             "then run backwards."),
     tr_noop("M3; or it is a left-hand tool.")},
    {Id::kEntryContact, "entry-contact", kError, Topic::kCutter,
     tr_noop("A start at this line (--enter) goes straight from where the machine stands, through "
             "the workpiece or what holds it."),
     tr_noop("Go to the place that the summary names first, or begin at an earlier line.")},
    {Id::kLoadDiffers, "load-differs", kWarning, Topic::kMachine,
     tr_noop("For some seconds the spindle of a watched machine has taken more or less than its "
             "cuts should (--material); a note where its load stands still."),
     tr_noop("More: is the tool blunt? Less: is it broken? Else material, depth or tool are other "
             "ones than kerf knows.")},
    {Id::kLongDwell, "long-dwell", kNote, Topic::kProgram,
     tr_noop("The program stands still for a hundred seconds or more."),
     tr_noop("P of G4, G82, G86, G88 and G89 is in seconds; many controls take milliseconds.")},
}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (static_cast<std::size_t>(kRows[i].id) != i) return false;
  }
  return true;
}
static_assert(in_order(), "a row for each FindingId, in the order of the enum");

constexpr std::array<FindingTopicRow, kFindingTopics> kTopics{{
    {Topic::kProgram, "program"},
    {Topic::kTools, "tools"},
    {Topic::kBlank, "blank"},
    {Topic::kCutter, "cutting"},
    {Topic::kCollisions, "collisions"},
    {Topic::kMachine, "machine"},
    {Topic::kTurning, "turning"},
    {Topic::kBeam, "beam"},
    {Topic::kPunch, "punch"},
    {Topic::kSource, "source"},
    {Topic::kDesign, "design"},
}};

constexpr bool topics_in_order() {
  for (std::size_t i = 0; i < kTopics.size(); ++i) {
    if (static_cast<std::size_t>(kTopics[i].topic) != i) return false;
  }
  return true;
}
static_assert(topics_in_order(), "a row for each FindingTopic, in the order of the enum");

}  // namespace

std::span<const FindingRow> finding_table() { return kRows; }

const FindingRow& row_of(FindingId id) {
  assert(static_cast<std::size_t>(id) < kRows.size());
  return kRows[static_cast<std::size_t>(id)];
}

std::span<const FindingTopicRow> finding_topics() { return kTopics; }

const char* to_string(FindingId id) { return row_of(id).name; }

}  // namespace kerf
