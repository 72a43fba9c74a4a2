#include "twin/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "twin/batch_queue.h"
#include "twin/motion_geometry.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Session::Session(SessionOptions options)
    : options_(std::move(options)), window_(options_.lines), start_(Clock::now()) {}

Session::~Session() = default;

std::unique_ptr<Session> Session::open(SessionOptions options, Diagnostics& diagnostics,
                                       Outcome& outcome) {
  std::unique_ptr<Session> session(new Session(std::move(options)));
  outcome = Outcome::kFailed;
  const bool files_good = session->open_program(diagnostics) && session->read_tools(diagnostics);
  if (!files_good || !session->choose_known_blank(diagnostics, outcome)) return nullptr;
  outcome = Outcome::kFinished;
  return session;
}

bool Session::open_program(Diagnostics& diagnostics) {
  program_ = Program::open(options_.program, diagnostics);
  shown_program_ = program_.get();
  return program_ != nullptr;
}

bool Session::read_tools(Diagnostics& diagnostics) {
  return gather_tool_sources(options_.tools, program_.get(), options_.program, tool_sources_,
                             diagnostics);
}

bool Session::choose_known_blank(Diagnostics& diagnostics, Outcome& outcome) {
  if (options_.blank) return create_stock(*options_.blank, "--stock", diagnostics, outcome);
  CommentBlank found;
  if (!find_comment_blank(*program_, options_.program.path, found, diagnostics)) return false;
  // Without one it is guessed from the motions, later.
  return !found.blank || create_stock(*found.blank, found.origin, diagnostics, outcome);
}

bool Session::create_stock(const Blank& blank, const std::string& origin, Diagnostics& diagnostics,
                           Outcome& outcome) {
  StockSetup setup = make_stock(blank, options_.stock, origin, diagnostics, outcome);
  stock_ = std::move(setup.stock);
  stock_facts_ = std::move(setup.facts);
  return stock_ != nullptr;
}

double Session::progress() const {
  const Program* program = shown_program_;
  return program ? program->progress() : -1.0;
}

ProgramSummary Session::interpret(Program& program, const MotionSink& sink, std::stop_token stop) {
  interpreter_.clear();
  shown_program_ = &program;
  interpreting_ = true;
  ProgramSummary summary = program.run(sink, stop, interpreter_);
  interpreting_ = false;
  return summary;
}

/// One batch of the first pass: bounds, and the motions themselves while they fit. False: a stdin
/// too long to keep.
bool Session::gather(std::span<const Motion> motions, BlankGuess& guess, ToolBook& book) {
  kept_whole_ = kept_whole_ && kept_.size() + motions.size() <= kMaxKeptMotions;
  if (!kept_whole_ && options_.program.path == "-") return false;
  if (kept_whole_) {
    kept_.insert(kept_.end(), motions.begin(), motions.end());
  } else {
    kept_ = {};
  }
  int tool = -1;
  double radius_mm = 0;
  for (const Motion& m : motions) {
    if (is_feed(m) && m.tool != tool) {
      tool = m.tool;
      const ResolvedTool& mounted = book.mount(tool, m.source.line);
      radius_mm = mounted.cutter ? mounted.cutter->radius_mm() : 0;
    }
    guess.add(m, radius_mm);
  }
  return true;
}

bool Session::guess_blank(std::stop_token stop, Diagnostics& diagnostics, Outcome& outcome) {
  BlankGuess guess(options_.margin_mm);
  ToolBook book(tool_sources_, true);
  bool too_long = false;
  kept_whole_ = true;
  const MotionSink sink = [&](std::span<const Motion> motions) {
    too_long = !gather(motions, guess, book);
    return !too_long;
  };
  report_.program = interpret(*program_, sink, stop);
  if (too_long) {
    diagnostics.push_back(
        general_error(fmt::format("standard input has more than {} motions, too many to keep while "
                                  "the blank is guessed from them",
                                  kMaxKeptMotions),
                      "--stock SPEC gives the blank, and then any length will do"));
    outcome = Outcome::kUsageError;
    return false;
  }
  if (stop.stop_requested() && report_.program.stopped_early) return true;
  const Blank blank = guess.blank();
  if (!create_stock(blank, "guessed", diagnostics, outcome)) return false;
  if (!guess.has_moves()) return true;  // nothing will be cut: nothing to warn of
  Finding finding;
  finding.id = FindingId::kStockGuessed;
  finding.severity = Severity::kWarning;
  finding.text = fmt::format(
      "no blank is given or written in the program; assumed: {} (the feed moves plus {:g} mm; "
      "--stock SPEC says better)",
      describe(blank), options_.margin_mm);
  report_.findings.add(std::move(finding));
  return true;
}

/// False: no more motions are wanted.
bool Session::cut_batch(CutStage& stage, std::span<const Motion> motions) {
  const Clock::time_point start = Clock::now();
  stage.set_frame((second_pass_ ? *second_pass_ : *program_).workpiece_frame());
  const bool silent = !window_.begun();
  if (silent) stage.hold_reports();
  const LineWindow::Split split = window_.split(motions);
  motions = motions.first(split.before + split.within);
  stage.take(motions.first(split.before));
  if (silent && window_.begun()) stage.release_reports();
  stage.take(motions.subspan(split.before));
  report_.timing.cut_s += seconds_since(start);
  if (observer_) observer_->on_cut(*stock_, motions, stage.timeline().clock_s());
  return !window_.over();
}

/// The program may be over before the part to be reported on began.
void Session::close_window() {
  if (window_.begun()) return;
  add_program_finding(
      FindingId::kLineNotReached, Severity::kWarning,
      fmt::format("--from-line: the program runs no move of line {} or beyond; nothing is reported",
                  options_.lines.from));
}

/// False: stopped before the end.
bool Session::stream(CutStage& stage, std::stop_token stop) {
  Program& program = second_pass_ ? *second_pass_ : *program_;
  BatchQueue queue;
  ProgramSummary summary;
  std::thread reader([&] {
    const MotionSink sink = [&](std::span<const Motion> motions) { return queue.push(motions); };
    summary = interpret(program, sink, stop);
    queue.close();
  });
  std::vector<Motion> batch;
  while (queue.pop(batch)) {
    if (cut_batch(stage, batch)) continue;
    queue.close();
    break;
  }
  reader.join();
  const double first_pass_s = report_.program.interpret_s;
  report_.program = std::move(summary);
  report_.program.interpret_s += first_pass_s;
  return !(stop.stop_requested() && report_.program.stopped_early);
}

bool Session::cut_program(CutStage& stage, std::stop_token stop, Diagnostics& diagnostics) {
  if (!kept_whole_) {
    const bool second = !report_.program.interpreter.empty();
    if (second) second_pass_ = Program::open(options_.program, diagnostics);
    return second && !second_pass_ ? true : stream(stage, stop);
  }
  const std::span<const Motion> all(kept_);
  for (std::size_t at = 0; at < all.size(); at += BatchQueue::kBatchMotions) {
    if (stop.stop_requested()) return false;
    const std::size_t count = std::min(BatchQueue::kBatchMotions, all.size() - at);
    if (!cut_batch(stage, all.subspan(at, count))) break;
  }
  return true;
}

Outcome Session::run(std::stop_token stop, Diagnostics& diagnostics) {
  report_.version = KERF_VERSION;
  report_.program_path = options_.program.path;
  report_.lines = options_.lines;
  Outcome outcome = Outcome::kFinished;
  if (!stock_ && !guess_blank(stop, diagnostics, outcome)) return outcome;
  if (!stock_) return conclude(true);  // stopped while the blank was guessed
  if (observer_) observer_->on_start(*stock_);
  ToolBook book(tool_sources_, false);
  CutStage stage(*stock_, book, report_.findings, options_.timeline);
  const double cpu_before = thread_cpu_s();
  const bool whole = cut_program(stage, stop, diagnostics);
  const Clock::time_point finish_start = Clock::now();
  stage.finish(whole);
  if (observer_) observer_->on_cut(*stock_, {}, stage.timeline().clock_s());
  close_window();
  report_.timing.cut_s += seconds_since(finish_start);
  report_.timing.cut_cpu_s = thread_cpu_s() - cpu_before;
  complete_report(stage);
  if (has_error(diagnostics)) return Outcome::kFailed;
  return conclude(!whole);
}

void Session::add_program_finding(FindingId id, Severity severity, std::string text) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.text = std::move(text);
  report_.findings.add(std::move(finding));
}

/// The interpreter is ahead of the cutter: what it says of lines that were not to be run is of no
/// interest.
void Session::drop_remarks_beyond_window() {
  if (!window_.over()) return;
  const auto until = static_cast<int>(options_.lines.until);
  std::erase_if(interpreter_,
                [until](const Diagnostic& d) { return d.line <= 0 || d.line > until; });
}

/// Findings about the program as a whole, and how the run ended.
Outcome Session::conclude(bool stopped) {
  const ProgramSummary& program = report_.program;
  if (program.has_rotary_motion) {
    add_program_finding(
        FindingId::kRotaryIgnored, Severity::kWarning,
        "the program moves A, B or C; the Z-map has no rotary axes and cuts as if they stood");
  }
  for (const ProgramNote& note : program.notes) {
    Finding finding;
    finding.id = FindingId::kNotSimulated;
    finding.severity = Severity::kNote;
    finding.source = note.source;
    finding.text = fmt::format("{} is passed over{}", note.text,
                               note.count > 1 ? fmt::format(" ({} times)", note.count) : "");
    report_.findings.add(std::move(finding));
  }
  report_.timing.interpret_s = program.interpret_s;
  complete_timing();
  if (stopped) {
    // What the interpreter says when it is stopped is of no use to anybody.
    report_.partial_reason = "interrupted before the end of the program";
    add_program_finding(FindingId::kInterrupted, Severity::kNote, report_.partial_reason);
    return Outcome::kInterrupted;
  }
  drop_remarks_beyond_window();
  const bool open_ended = !program.has_program_end && !program.stopped_early;
  const bool end_remarked = add_interpreter_findings(interpreter_, open_ended, report_.findings);
  if (has_error(interpreter_)) {
    report_.partial_reason = "the interpreter stopped at an error";
    return Outcome::kFailed;
  }
  if (!program.has_program_end && !end_remarked && !window_.over()) {
    add_program_finding(FindingId::kNoProgramEnd, Severity::kWarning,
                        "the program ends without M2, M30 or a closing %");
  }
  return program.lost_splines > 0 ? Outcome::kLossy : Outcome::kFinished;
}

void Session::complete_timing() {
  report_.timing.total_s = seconds_since(start_);
  report_.peak_rss_mb = peak_rss_mb();
}

void Session::complete_report(const CutStage& stage) {
  report_.motion = stage.timeline().totals();
  report_.time_model = stage.timeline().time_model();
  report_.tools = stage.tools();
  report_.stock = stock_report(*stock_, stock_facts_);
}

}  // namespace kerf
