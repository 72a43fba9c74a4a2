// twin/live/live_cut_options.h - what is known and wished of a machine that is watched.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "interp_bridge/program.h"
#include "twin/live/live_frame.h"
#include "twin/live/path_follower.h"
#include "twin/live/sample_gate.h"
#include "twin/machine/timeline.h"
#include "twin/process/cut_stage.h"

namespace kerf {

/// What becomes of the way between two samples with a gap between them.
enum class GapPolicy : std::uint8_t {
  kMark,    ///< it is not cut, and is a finding
  kCut,     ///< it is cut, and is a finding
  kIgnore,  ///< it is not cut
};

/// What becomes of the program before the place where a machine that runs it already is first seen.
enum class JoinedLate : std::uint8_t {
  kCut,   ///< it is in the workpiece
  kKeep,  ///< the workpiece is as it was given
};

struct LiveCutOptions {
  LiveFrameOptions frame;
  bool work_known = false;  ///< frame.work is the user's word; else a program's, if there is one
  bool program_lengths = false;  ///< the tool lengths of the program's G43 are the machine's
  FollowOptions follow;
  GapPolicy gap = GapPolicy::kMark;
  double gap_s = 0.5;  ///< samples farther apart than this have a gap between them
  /// A machine cannot be faster: samples that say so have a gap between them. mm/s.
  double most_mm_per_s = std::numeric_limits<double>::infinity();
  PositionMost most;  ///< what no single reading can need (SampleGate)
  TimelineOptions timeline;
  double guard_s = 10;  ///< how far to look ahead; 0: not
  JoinedLate joined_late = JoinedLate::kCut;
  /// A machine that has cut for so long, and never been on the path of the program, runs another.
  double off_path_s = 2;
  /// Opens the program once more, to find out how far a machine has come that runs it already; may
  /// be empty.
  std::function<std::unique_ptr<Program>()> reopen;
  /// The machine has been watched since before the program began: what of it lies before the place
  /// where it is found has not been run, whatever joined_late says.
  bool seen_before = false;
  bool wait_for_program = false;  ///< a log waits for the interpreter, a machine does not
  /// That fits the workpiece. A beam: on the path of a program it is on where the program has it
  /// on. Elsewhere it is on while the spindle turns, as the source tells it: M3 of cutting tables.
  /// Where nothing tells it, it is off. A punch: on the path of a program the strokes are the
  /// program's, at its places; each counts as soon as the machine goes on from there, those of a
  /// nibbled move when it is done. Elsewhere they are as the source shows them (SeenStrokes), where
  /// the machine is.
  ProcessPointer process = default_process();
  CheckOptions checks;
};

}  // namespace kerf
