// What Session takes for want of better: a reading of the program beforehand.
#include <fmt/format.h>

#include <utility>

#include "base/translate.h"
#include "twin/guess/guess_rows.h"
#include "twin/session/session.h"

namespace kerf {

/// One batch of the first pass: what is to be learnt of it, and the motions themselves while they
/// fit. False: a stdin too long to keep.
bool Session::gather(std::span<const Motion> motions, ProgramSurvey& survey) {
  kept_whole_ = kept_whole_ && kept_.size() + motions.size() <= kMaxKeptMotions;
  if (!kept_whole_ && options_.program.path == "-") return false;
  if (kept_whole_) {
    kept_.insert(kept_.end(), motions.begin(), motions.end());
  } else {
    kept_ = {};
  }
  tilt_.look_at(motions, (second_pass_ ? *second_pass_ : *front_.program).workpiece_frame());
  survey.add(motions, tilt_.moves());
  return true;
}

/// Motions are kept for cutting where nothing waits for the workpiece: probes do, once the blank is
/// known.
bool Session::survey_program(std::stop_token stop, Diagnostics& diagnostics, Outcome& outcome) {
  if (!report_.program.interpreter.empty()) {
    second_pass_ = Program::open(options_.program, diagnostics);
    if (!second_pass_) return false;
    second_pass_->give_tools(known_tools(front_.tools));
  }
  Program& program = second_pass_ ? *second_pass_ : *front_.program;
  ProgramSurvey survey(SurveyWishes::of(options_, front_), front_.tools);
  bool too_long = false;
  kept_whole_ = !stock() || options_.program.path == "-";
  program.follow_probes(nullptr);
  const MotionSink sink = [&](std::span<const Motion> motions) {
    too_long = !gather(motions, survey);
    return !too_long;
  };
  report_.program = interpret(program, sink, stop);
  if (too_long) {
    diagnostics.push_back(
        general_error(trf("standard input has more than {} motions, too many to keep while "
                          "the blank is guessed from them",
                          kMaxKeptMotions),
                      tr("--stock SPEC gives the blank, and then any length will do")));
    outcome = Outcome::kUsageError;
    return false;
  }
  if (stop.stop_requested() && report_.program.stopped_early) return true;
  if (!options_.guess) {
    Diagnostics missing = survey.missing();
    outcome = Outcome::kUsageError;
    diagnostics.insert(diagnostics.end(), missing.begin(), missing.end());
    if (!missing.empty()) return false;
    outcome = Outcome::kFinished;
    return true;
  }
  return take_guesses(survey, diagnostics, outcome);
}

bool Session::take_guesses(const ProgramSurvey& survey, Diagnostics& diagnostics,
                           Outcome& outcome) {
  if (const auto sheet =
          survey.sheet(front_.program->is_qtplasmac(), front_.program->materials())) {
    return take_sheet(*sheet, survey, diagnostics, outcome);
  }
  if (!front_.blank) {
    front_.blank = survey.blank();
    front_.blank_origin = tr("guessed");
    front_.blank_guessed = true;
    front_.is_drawn = survey.is_drawn();
    if (survey.has_moves()) front_.guess_reason = survey.blank_reason();
    if (auto warning = survey.warning(*front_.blank, front_.guess_reason)) {
      report_.findings.add(std::move(*warning));
    }
  }
  const Box bounds = front_.stock.stock ? stock()->bounds_mm() : front_.blank->bounds_mm();
  front_.tools.guesses = survey.tools(bounds.max.z);
  front_.choice = choose_stock(options_.stock, stock_needs(front_.tools));
  open_tools_.reset();
  known_tool_.reset();
  return make_room_for_tilt(options_, tilt_.found(), front_, diagnostics, outcome) &&
         fill_front(options_, front_, diagnostics, outcome);
}

/// Of a sheet Z does not matter, to the interpreter neither: it is read again.
bool Session::take_sheet(const ProgramSurvey::SheetGuess& guess, const ProgramSurvey& survey,
                         Diagnostics& diagnostics, Outcome& outcome) {
  options_ = with_sheet(options_, guess, survey.kerfs(guess.beam));
  if (auto warning = survey.warning(*options_.blank, guess.reason)) {
    report_.findings.add(std::move(*warning));
  }
  Diagnostics said;  // of the files, once more
  std::optional<ProgramFront> front = open_front(options_, said, outcome);
  if (!front) {
    diagnostics.insert(diagnostics.end(), said.begin(), said.end());
    return false;
  }
  front_ = std::move(*front);
  shown_program_ = front_.program.get();
  report_.program = {};
  kept_ = {};
  kept_whole_ = false;
  return true;
}

/// A feed move of a tool of which nothing is known, or its diameter alone: it is guessed from all
/// moves, and everything begins again.
void Session::watch_tools(std::span<const Motion> motions) {
  if (!open_tools_ || lacks_tool_) return;
  const bool described = front_.tools.describes();
  for (const Motion& m : motions) {
    if (m.kind == MotionKind::kToolChange || known_tool_ != m.tool) known_tool_.reset();
    if (known_tool_) continue;
    const ResolvedTool* const tool = open_tools_->feeding(m);
    if (!tool) continue;
    const bool is_open = !tool->cutter && !(described && m.tool != 0);
    if (!is_open && !tool->is_size_alone()) {
      known_tool_ = m.tool;
      continue;
    }
    lacks_tool_ = true;
    return;
  }
}

}  // namespace kerf
