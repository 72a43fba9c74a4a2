#include "twin/program/program_front.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/process_table.h"
#include "twin/program/turning.h"

namespace kerf {
namespace {

/// Of a tool whose way is only to be bounded: its tip counts.
constexpr double kGuessReach_mm = 1;

void add_program_finding(FindingId id, Severity severity, std::string text, FindingLog& log) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.text = std::move(text);
  log.add(std::move(finding));
}

/// "o<name> sub", "O100 SUB".
bool defines_subroutine(const std::string& line) {
  static const std::regex kSub(R"(^\s*o\s*(<[^>]*>|\d+)\s*sub\b)", std::regex::icase);
  return std::regex_search(line, kSub);
}

/// It moves nothing, since it only defines what other programs call.
bool is_library(const std::string& path, const ProgramSummary& summary) {
  for (const char* const name : {"STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"}) {
    if (summary.canonical_commands.contains(name)) return false;
  }
  std::ifstream text(path);
  for (std::string line; std::getline(text, line);) {
    if (defines_subroutine(line)) return true;
  }
  return false;
}

void add_what_is_not_simulated(const ProgramSummary& summary, FindingLog& log) {
  for (const ProgramNote& note : summary.notes) {
    Finding finding;
    finding.id = FindingId::kNotSimulated;
    finding.severity = Severity::kNote;
    finding.source = note.source;
    finding.text = note.is_sentence ? note.text
                                    : trf("{} is passed over{}", note.text,
                                          note.count > 1 ? trf(" ({} times)", note.count) : "");
    log.add(std::move(finding));
  }
}

bool choose_known_blank(const SessionOptions& options, ProgramFront& front,
                        Diagnostics& diagnostics, Outcome& outcome) {
  CommentBlank found;
  if (options.blank) {
    const bool is_entered = options.program.machine.first_line > 0;
    const char* const origin = options.blank_words.empty() ? "--stock"
                               : is_entered                ? "--enter"
                                                           : tr("the job");
    found = {options.blank, options.blank_is_guess ? tr("guessed") : origin};
  } else if (!find_comment_blank(*front.program, options.program.path, found, diagnostics)) {
    return false;
  }
  if (!found.blank && options.stock.kind == StockKind::kSheet) {
    diagnostics.push_back(general_error(tr("--model sheet: there is no sheet"),
                                        tr("--stock sheet:x0,y0:x1,y1:THICKNESS gives one")));
    outcome = Outcome::kUsageError;
    return false;
  }
  if (options.turret && !can_be_punched(found.blank, diagnostics, outcome)) return false;
  if (!found.blank) return true;
  front.blank = std::move(found.blank);
  front.blank_origin = std::move(found.origin);
  front.blank_guessed = options.blank && options.blank_is_guess;
  front.guess_reason = options.guess_reason;
  if (is_sheet(*front.blank)) front.choice = {StockKind::kSheet, {}, 0};
  const FixtureList& fixtures = options.collisions.fixtures;
  if (fixtures && !front.blank_guessed && !front.is_turned() &&
      !check_fixtures_beside(*fixtures, *front.blank, diagnostics)) {
    outcome = Outcome::kUsageError;
    return false;
  }
  return fill_front(options, front, diagnostics, outcome);
}

}  // namespace

bool can_be_punched(const std::optional<Blank>& blank, Diagnostics& diagnostics, Outcome& outcome) {
  if (blank && is_sheet(*blank)) return true;
  diagnostics.push_back(general_error(trf("--turret: only a sheet can be punched; the blank is {}",
                                          blank ? describe(*blank) : tr("not given")),
                                      tr("--stock sheet:x0,y0:x1,y1:THICKNESS gives a sheet")));
  outcome = Outcome::kUsageError;
  return false;
}

CheckOptions checks_of(const SessionOptions& options, const ProgramFront& front) {
  CheckOptions checks{front.blank_guessed, options.below_mm, front.is_drawn, options.collisions};
  checks.collisions.held_by = front.held_by;
  checks.spindle_max_rpm = options.spindle_max_rpm;
  checks.cutting = options.cutting;
  if (front.blank) checks.blank = *front.blank;
  return checks;
}

bool fill_front(const SessionOptions& options, ProgramFront& front, Diagnostics& diagnostics,
                Outcome& outcome) {
  front.stock = {};  // the memory of the one before is free again
  front.stock = make_stock(*front.blank, front.choice, options.stock, front.blank_origin,
                           diagnostics, outcome);
  if (!front.stock.stock) return false;
  if (!options.blank_words.empty()) front.stock.facts.description = options.blank_words;
  const CollisionWishes& wishes = options.collisions;
  if (hold_workpiece(wishes.holding, wishes.fixtures, *front.stock.stock, !front.blank_guessed,
                     front.held_by, diagnostics)) {
    return true;
  }
  outcome = Outcome::kUsageError;
  return false;
}

bool make_room_for_tilt(const SessionOptions& options, const std::string& tilt, ProgramFront& front,
                        Diagnostics& diagnostics, Outcome& outcome) {
  if (tilt.empty() || options.stock.kind || front.is_sheet() || front.is_turned() ||
      stock_model(front.choice.kind).takes_tilted_tools) {
    return true;
  }
  StockNeeds needs;
  needs.tilt = tilt;
  front.choice = choose_stock(options.stock, needs);
  return !front.stock.stock || fill_front(options, front, diagnostics, outcome);
}

std::optional<ProgramFront> open_front(const SessionOptions& options, Diagnostics& diagnostics,
                                       Outcome& outcome) {
  ProgramFront front;
  outcome = Outcome::kFailed;
  front.program = Program::open(options.program, diagnostics);
  if (!front.program) return std::nullopt;
  if (!gather_tool_sources(options.tools, options.libraries, front.program.get(), options.program,
                           front.tools, diagnostics)) {
    return std::nullopt;
  }
  front.tools.guesses = options.tool_guesses;
  if (!note_turning(options.program, front.program.get(), options.stock.kind, options.blank,
                    front.tools, diagnostics)) {
    outcome = Outcome::kUsageError;
    return std::nullopt;
  }
  front.program->give_tools(known_tools(front.tools));
  front.choice = choose_stock(options.stock, stock_needs(front.tools));
  if (!choose_known_blank(options, front, diagnostics, outcome)) return std::nullopt;
  outcome = Outcome::kFinished;
  return front;
}

void BlankSurvey::add(std::span<const Motion> motions, const MotionMoves& moves) {
  for (const Motion& m : motions) {
    if (turning_) {
      bar_.add(m.length.displaces ? as_programmed(m) : m);
      continue;
    }
    if (is_feed(m) && stands_still(m)) continue;
    if (is_feed(m) && m.tool != tool_) {
      tool_ = m.tool;
      const ResolvedTool& mounted = resolver_.mount(tool_, m.source.line);
      radius_mm_ = mounted.cutter ? mounted.cutter->radius_mm() : 0;
    }
    if (m.length.displaces) {
      // The blank is where the program works, not where a tool of another length does.
      guess_.add(as_programmed(m), radius_mm_);
      round_.add(as_programmed(m), {}, radius_mm_);
    } else if (moves.is_upright(m)) {
      guess_.add(m, radius_mm_);
      round_.add(m, {}, radius_mm_);
    } else {
      divided_.clear();
      moves.path()->moves_of(m, kGuessReach_mm, 0, divided_);
      guess_.add(m, divided_, radius_mm_);
      round_.add(m, divided_, radius_mm_);
    }
  }
}

Blank BlankSurvey::blank() const {
  if (turning_) return bar_.blank();
  return round_.blank().value_or(guess_.blank());
}

ProcessPointer process_of(const SessionOptions& options, const ProgramFront& front) {
  ProcessWish wish;
  wish.is_sheet = front.is_sheet();
  wish.is_turned = front.is_turned();
  wish.guessed = front.blank_guessed;
  wish.beam = options.beam;
  wish.turret = options.turret;
  wish.is_qtplasmac = front.program->is_qtplasmac();
  return choose_process(wish);
}

BlankKind judged_blank(const SessionOptions& options, const ProgramFront& front,
                       const ProgramSummary& summary, bool sound) {
  if (!sound || options.stock.additive) return BlankKind::kUnjudged;
  if (options.lines.from > 0 || options.lines.until > 0) return BlankKind::kUnjudged;
  if (summary.stopped_early || is_library(options.program.path, summary)) {
    return BlankKind::kUnjudged;
  }
  if (front.blank_guessed) return BlankKind::kGuessed;
  return front.blank && !front.blank->state_file.empty() ? BlankKind::kSaved : BlankKind::kGiven;
}

void add_unused_tools(const SessionOptions& options, std::span<const ToolUse> used,
                      FindingLog& log) {
  if (!options.tools_named || options.turret || options.lines != LineRange{}) return;
  if (used.empty()) return;  // it moves nothing, or lights no torch: that is told
  std::string names;
  for (const ToolUse& use : used) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", use.number);
  }
  for (const ToolShapeArgument& given : options.tools) {
    const bool is_used = std::any_of(used.begin(), used.end(),
                                     [&](const ToolUse& use) { return use.number == given.tool; });
    if (is_used) continue;
    add_program_finding(
        FindingId::kToolUnused, Severity::kNote,
        trf("--tool {}={}: the program never uses tool {}{}", given.tool, given.cutter.spec(),
            given.tool, names.empty() ? std::string() : trf("; it uses {}", names)),
        log);
  }
}

ProgramEnd conclude_program(const ProgramSummary& summary, Diagnostics said,
                            const LineWindow& window, bool stopped, FindingLog& log) {
  if (!window.begun() && !stopped) {
    add_program_finding(
        FindingId::kLineNotReached, Severity::kWarning,
        trf("--from-line: the program runs no move of line {} or beyond; nothing is reported",
            window.range().from),
        log);
  }
  add_what_is_not_simulated(summary, log);
  if (stopped) {
    // What the interpreter says when it is stopped is of no use to anybody.
    const std::string reason = tr("interrupted before the end of the program");
    add_program_finding(FindingId::kInterrupted, Severity::kNote, reason, log);
    return {Outcome::kInterrupted, reason};
  }
  if (window.over()) {
    // The interpreter is ahead of the cutter: what it says of lines that were not to be run is of
    // no interest.
    const auto until = static_cast<int>(window.range().until);
    std::erase_if(said, [until](const Diagnostic& d) { return d.line <= 0 || d.line > until; });
  }
  const bool end_remarked = summary.end_remarked && !summary.stopped_early && !window.over();
  add_interpreter_findings(said, end_remarked, log);
  if (has_error(said)) return {Outcome::kFailed, tr("the interpreter stopped at an error")};
  if (!summary.has_program_end && !end_remarked && !window.over()) {
    add_program_finding(FindingId::kNoProgramEnd, Severity::kWarning,
                        tr("the program ends without M2, M30 or a closing %"), log);
  }
  return {summary.lost_splines > 0 ? Outcome::kLossy : Outcome::kFinished, {}};
}

}  // namespace kerf
