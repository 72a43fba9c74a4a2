// twin/program/program_front.h - the way from what the user asked for to motions and a blank; the
// same for a dry run and for a program that is to be played.
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "stock/blank.h"
#include "stock/cutter/shape_spec.h"
#include "twin/findings/finding.h"
#include "twin/findings/outcome.h"
#include "twin/job/blank_choice.h"
#include "twin/job/round_blank_guess.h"
#include "twin/job/tool_use.h"
#include "twin/job/tools.h"
#include "twin/job/turned_blank_guess.h"
#include "twin/machine/beam_settings.h"
#include "twin/machine/timeline.h"
#include "twin/machine/turret.h"
#include "twin/process/process.h"
#include "twin/program/session_parts.h"
#include "twin/report/line_window.h"

namespace kerf {

struct SessionOptions {
  ProgramOptions program;
  std::vector<ToolShapeArgument> tools;  ///< of --tool
  std::vector<ToolLibrary> libraries;    ///< of --tools
  std::optional<Blank> blank;            ///< of --stock; absent: from comments, else guessed
  StockSettings stock;
  BeamOptions beam;            ///< for a sheet
  TurretPointer turret;        ///< for a sheet: it is punched; null: it is cut by the beam
  double margin_mm = 5;        ///< around a guessed blank
  double below_mm = 0;         ///< CheckOptions::below_mm
  double spindle_max_rpm = 0;  ///< CheckOptions::spindle_max_rpm
  CollisionWishes collisions{};
  CuttingWish cutting{};
  TimelineOptions timeline;
  bool tools_named = false;  ///< `tools` are those of --tool itself: each is meant for the program
  bool guess = true;         ///< what nobody has said; false: that is an error
  /// What a blank is called that no option has given; empty: by its shape or its file.
  std::string blank_words;
  /// What has been guessed of the program already: `blank` is such a one, and why.
  bool blank_is_guess = false;
  std::string guess_reason;
  std::vector<ToolGuess> tool_guesses;
  std::string beam_text;  ///< of beam.trigger, where that is a guess
  LineRange lines;        ///< cut silently up to there, reported from there, stopped there
};

/// A program that can be interpreted, and what is known before it is.
struct ProgramFront {
  std::unique_ptr<Program> program;
  ToolSources tools;
  /// Without a stock: nobody gave a blank and no comment describes one. Then it is guessed from the
  /// motions (BlankSurvey).
  StockSetup stock;
  StockChoice choice;          ///< of its model, by what is known of the tools
  std::optional<Blank> blank;  ///< what `stock` was made of
  std::string blank_origin;
  HoldingList held_by;  ///< of a workpiece that turns; null: nothing holds it

  bool blank_guessed = false;
  std::string guess_reason;  ///< of that; empty: the program moves nothing
  bool is_drawn = false;     ///< ProgramSurvey::is_drawn(), of a blank that was guessed

  bool is_turned() const { return choice.kind == StockKind::kTurning; }
  bool is_sheet() const { return blank && choice.kind == StockKind::kSheet; }
};

/// False with a diagnostic: it is no sheet.
bool can_be_punched(const std::optional<Blank>& blank, Diagnostics& diagnostics, Outcome& outcome);

/// Checks everything that can be checked before the program is interpreted: files, comments, tool
/// table, blank, cell size, memory. Nothing on error, with diagnostics, and `outcome` says of which
/// kind.
std::optional<ProgramFront> open_front(const SessionOptions& options, Diagnostics& diagnostics,
                                       Outcome& outcome);

/// Makes front.stock of front.blank, by front.choice. False as make_stock().
bool fill_front(const SessionOptions& options, ProgramFront& front, Diagnostics& diagnostics,
                Outcome& outcome);

/// A motion of the program needs a model for tilted tools (TiltWatch::found()): makes the workpiece
/// anew, uncut, unless its model was asked for or holds them. False as make_stock().
bool make_room_for_tilt(const SessionOptions& options, const std::string& tilt, ProgramFront& front,
                        Diagnostics& diagnostics, Outcome& outcome);

/// Guesses the blank from all motions of a program, those beyond --until-line included: where a
/// program works does not depend on how much of it is run. One thread.
class BlankSurvey {
 public:
  BlankSurvey(double margin_mm, ToolSources tools)
      : turning_(tools.turning),
        guess_(margin_mm),
        bar_(margin_mm),
        round_(margin_mm),
        resolver_(std::move(tools), nullptr) {}

  /// `moves`: how the machine moves.
  void add(std::span<const Motion> motions, const MotionMoves& moves);
  Blank blank() const;
  /// blank() is a bar about X: it goes round and round under the tool.
  bool is_round() const { return !turning_ && round_.blank(); }
  const BlankGuess& guess() const { return guess_; }

 private:
  bool turning_;
  BlankGuess guess_;
  TurnedBlankGuess bar_;
  RoundBlankGuess round_;
  ToolResolver resolver_;
  int tool_ = -1;
  double radius_mm_ = 0;  ///< of that tool
  std::vector<CutMove> divided_;
};

/// The process that its workpiece and these options need: choose_process().
ProcessPointer process_of(const SessionOptions& options, const ProgramFront& front);

/// What findings of a run of it are judged by.
CheckOptions checks_of(const SessionOptions& options, const ProgramFront& front);

/// For nothing-cut: what it means that nothing of this blank is cut (CutStage::judge_blank).
/// Nothing is said of a part of a program, of one that was refused (`sound` = false) or only
/// defines subroutines, nor where material is added. May read the program's text once more.
BlankKind judged_blank(const SessionOptions& options, const ProgramFront& front,
                       const ProgramSummary& summary, bool sound);

/// How the reading of a program ended.
struct ProgramEnd {
  Outcome outcome = Outcome::kFinished;
  std::string partial_reason;  ///< empty: everything was read
};

/// tool-unused, of a whole program that uses these tools.
void add_unused_tools(const SessionOptions& options, std::span<const ToolUse> used,
                      FindingLog& log);

/// Adds the findings about the program as a whole: what it does and kerf does not, what the
/// interpreter said (`said`; not of lines beyond the window), a missing end. `stopped`: from
/// outside, before its end.
ProgramEnd conclude_program(const ProgramSummary& summary, Diagnostics said,
                            const LineWindow& window, bool stopped, FindingLog& log);

}  // namespace kerf
