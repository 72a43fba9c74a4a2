// twin/playback/load_program.h - from an NC program to something that can be played.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/findings/outcome.h"
#include "twin/playback/cut_query.h"
#include "twin/playback/player.h"
#include "twin/program/program_front.h"
#include "twin/report/guess_row.h"
#include "twin/report/report.h"

namespace kerf {

/// A tool that the program moves with, in the order of their first moves.
struct ProgramTool {
  int number = 0;
  std::string shape;     ///< SHAPE text; empty: nothing is known, it does not cut
  std::string origin;    ///< where the shape comes from, as in the report
  std::string remark;    ///< of the tool table; mostly its name. May be empty
  std::string trouble;   ///< why it does not cut, as far as more is to be said than "not known"
  bool guessed = false;  ///< only its diameter is known
};

/// A work offset of the machine.
struct NamedOffset {
  std::string name;  ///< "G54" .. "G59.3"
  WorkpieceFrame frame;
};

/// A program that has been read, with what a view tells about it.
struct LoadedProgram {
  /// Ready for Player. Its findings, with `remarks`, are those of Session for the same options.
  PlayerProgram player;
  /// kFinished and kLossy; kFailed: the interpreter refused a block (a remark says which), and the
  /// program is what lies before it; kInterrupted: likewise up to where the reading was stopped.
  Outcome outcome = Outcome::kFinished;
  std::string partial_reason;  ///< empty: read to the end
  StockReport blank;           ///< where the blank comes from, and what it is
  ProgramSummary summary;
  std::string time_model;  ///< one sentence, as in the report
  /// Absolute; SourceRef::file indexes them (ProgramTrack::files() has them as the user gave them).
  /// "-" for stdin.
  std::vector<std::string> files;
  std::vector<ProgramTool> tools;
  std::vector<GuessRow> guesses;  ///< taken for want of better
  /// Which line and tool made a point of the surface; null for sheets.
  std::shared_ptr<const CutQuery> cuts;
  /// As the machine's parameter file has them; empty: no INI, or it names none. What the program
  /// itself sets (G10) is not in them. Places of a track are those of the first offset that the
  /// program uses, ProgramTrack::frame(), also while another one is in force; which one that is at
  /// a motion the motions do not tell.
  std::vector<NamedOffset> work_offsets;
};

/// How far the reading is.
struct LoadProgress {
  double fraction = -1;     ///< of the source, 0..1; < 0: not known
  std::size_t motions = 0;  ///< so far
};

/// For windows. Both may be empty.
struct LoadControl {
  std::stop_token stop;
  /// After every batch of motions (some hundreds), from the thread that loads.
  std::function<void(const LoadProgress&)> on_progress;
};

/// Reads a program as Session does (with PlannerOptions::with_path the track is of the path that
/// the machine runs, piece by piece, and PlayerProgram::programmed is kept for the findings, with
/// about as much memory again): the same files, tools, blank, lines (those before --from-line
/// are cut and not reported on: PlayerProgram::report_from), findings about the program as a whole.
/// It is read once, whether or not blank and tools have to be guessed (twice where a sheet is).
/// Blocks until it is read, so it wants a thread of its own beside a window. Nothing on errors that
/// leave nothing to play; they are in `diagnostics`, and `outcome` says of which kind.
/// `diagnostics` also gets warnings about files.
///
/// A million motions of a CAM program take 3 to 4 s, nearly all of it the interpreter's, and 22 MB
/// (ProgramTrack::bytes()).
std::unique_ptr<LoadedProgram> load_program(const SessionOptions& options,
                                            const LoadControl& control, Diagnostics& diagnostics,
                                            Outcome& outcome);

}  // namespace kerf
