#include "twin/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/helper_thread.h"
#include "base/translate.h"
#include "interp_bridge/tool_lengths.h"
#include "stock/present_heights.h"
#include "twin/guess/guess_rows.h"
#include "twin/program/batch_queue.h"
#include "twin/program/probe_desk.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Session::Session(SessionOptions options, ProgramFront front, Clock::time_point start)
    : options_(std::move(options)),
      front_(std::move(front)),
      shown_program_(front_.program.get()),
      window_(options_.lines),
      tilt_(options_.timeline.kinematics),
      switched_(options_.timeline.kinematics),
      start_(start) {}

Session::~Session() = default;

std::unique_ptr<Session> Session::open(SessionOptions options, Diagnostics& diagnostics,
                                       Outcome& outcome) {
  const Clock::time_point start = Clock::now();
  std::optional<ProgramFront> front = open_front(options, diagnostics, outcome);
  if (!front) return nullptr;
  return std::unique_ptr<Session>(new Session(std::move(options), std::move(*front), start));
}

double Session::progress() const {
  const Program* program = shown_program_;
  const double read = program ? program->progress() : -1.0;
  const double to_cut = work_read_;
  // What has been read is not cut yet.
  return read <= 0 || to_cut <= 0 ? read : read * std::min(1.0, work_done_ / to_cut);
}

ProgramSummary Session::interpret(Program& program, const MotionSink& sink, std::stop_token stop) {
  interpreter_.clear();
  shown_program_ = &program;
  interpreting_ = true;
  ProgramSummary summary = program.run(sink, stop, interpreter_);
  interpreting_ = false;
  return summary;
}

/// In parts, where the observer asks for them. False: no more motions are wanted.
bool Session::cut_batch(CutStage& stage, std::span<const Motion> motions) {
  while (!motions.empty()) {
    const std::size_t most = observer_ ? observer_->most_motions() : motions.size();
    const std::span<const Motion> some = motions.first(std::min(most, motions.size()));
    if (!cut_some(stage, some)) return false;
    motions = motions.subspan(some.size());
  }
  return true;
}

bool Session::cut_some(CutStage& stage, std::span<const Motion> motions) {
  const Clock::time_point start = Clock::now();
  const WorkpieceFrame& frame = (second_pass_ ? *second_pass_ : *front_.program).workpiece_frame();
  motions = switched_.follow(motions, frame);
  tilt_.look_at(motions, frame);
  watch_tools(motions);
  if (must_begin_again()) return false;
  stage.set_frame(frame);
  if (materials_.take(taken_materials_)) stage.set_materials(taken_materials_);
  if ((observer_ || !recorders_.empty()) && files_.take(taken_files_)) {
    recorders_.name_files(taken_files_);
    if (observer_) observer_->on_files(taken_files_);
  }
  const bool silent = !window_.begun();
  if (silent) stage.hold_reports();
  const LineWindow::Split split = window_.split(motions);
  motions = motions.first(split.before + split.within);
  stage.take(motions.first(split.before));
  if (silent && window_.begun()) stage.release_reports();
  stage.take(motions.subspan(split.before));
  report_.timing.cut_s += seconds_since(start);
  if (observer_) observer_->on_cut(*stock(), motions, stage.timeline().clock_s());
  return !window_.over() && !stage.stopped();
}

/// A motion tilts the tool, and the model that was chosen without knowing of it is for upright
/// ones.
bool Session::is_tilted() const {
  return !tilt_.found().empty() && !options_.stock.kind && !front_.is_sheet() &&
         !front_.is_turned() && !stock()->takes_tilted_tools();
}

Session::Pass Session::stream(CutStage& stage, std::stop_token stop) {
  Program& program = second_pass_ ? *second_pass_ : *front_.program;
  BatchQueue queue;
  ProbeDesk desk(queue);
  // A sheet is cut by X and Y, whatever Z is probed.
  if (!front_.is_sheet()) {
    program.follow_probes([&desk](const ProbeQuestion& question) { return desk.ask(question); });
  }
  ProgramSummary summary;
  std::stop_source end;
  const std::stop_callback forward(stop, [&] { end.request_stop(); });
  const auto release = [&] {
    end.request_stop();
    queue.close();
  };
  const auto read = [&] {
    const MotionSink sink = [&](std::span<const Motion> motions) {
      materials_.put(program.materials());
      files_.put(program.files());
      double work = work_read_;
      for (const Motion& m : motions) work += CutStage::work_of(m);
      work_read_ = work;
      return queue.push(motions);
    };
    summary = interpret(program, sink, end.get_token());
    queue.close();
  };
  HelperThread reader(read, release);
  std::span<const Motion> batch;
  while (queue.pop(batch)) {
    if (batch.empty()) {
      desk.serve([&stage](const ProbeQuestion& question) { return stage.answer(question); });
      continue;
    }
    if (cut_batch(stage, batch)) continue;
    queue.close();
    desk.close();
    break;
  }
  reader.join();
  const double first_pass_s = report_.program.interpret_s;
  report_.program = std::move(summary);
  report_.program.interpret_s += first_pass_s;
  if (must_begin_again()) return Pass::kUnfit;
  const bool unread = stop.stop_requested() && report_.program.stopped_early;
  return unread || stage.stopped() ? Pass::kStopped : Pass::kWhole;
}

Session::Pass Session::cut_program(CutStage& stage, std::stop_token stop,
                                   Diagnostics& diagnostics) {
  if (!kept_whole_) {
    const bool second = !report_.program.interpreter.empty();
    if (second) second_pass_ = Program::open(options_.program, diagnostics);
    if (second_pass_) second_pass_->give_tools(known_tools(front_.tools));
    return second && !second_pass_ ? Pass::kWhole : stream(stage, stop);
  }
  files_.put(report_.program.files);
  const std::span<const Motion> all(kept_);
  double work = 0;
  for (const Motion& m : all) work += CutStage::work_of(m);
  work_read_ = work;
  for (std::size_t at = 0; at < all.size(); at += BatchQueue::kBatchMotions) {
    if (stop.stop_requested()) return Pass::kStopped;
    const std::size_t count = std::min(BatchQueue::kBatchMotions, all.size() - at);
    if (!cut_batch(stage, all.subspan(at, count))) break;
  }
  return stage.stopped() ? Pass::kStopped : Pass::kWhole;
}

/// Forgets what the pass has found, and makes the workpiece anew in a model that can hold it.
bool Session::begin_again(std::stop_token stop, Diagnostics& diagnostics, Outcome& outcome) {
  if (is_tilted() && options_.program.path == "-") {
    diagnostics.push_back(general_error(
        trf("{}, and standard input cannot be read a second time for another model", tilt_.found()),
        tr("--model octree is for tilted tools from the start")));
    outcome = Outcome::kUsageError;
    return false;
  }
  report_.findings = {};
  recorders_.restart();
  if (load_listener_) load_listener_->restart();
  if (labels_) labels_.emplace();
  window_ = LineWindow(options_.lines);
  switched_ = SwitchedMotions(options_.timeline.kinematics);
  if (std::exchange(lacks_tool_, false) && !survey_program(stop, diagnostics, outcome))
    return false;
  return make_room_for_tilt(options_, tilt_.found(), front_, diagnostics, outcome);
}

Outcome Session::run(std::stop_token stop, Diagnostics& diagnostics) {
  report_.version = KERF_VERSION;
  report_.program_path = options_.program.path;
  report_.lines = options_.lines;
  report_.material = options_.cutting.material;
  Outcome outcome = Outcome::kFinished;
  const bool look_first = !stock() || !options_.guess;
  if (look_first && !survey_program(stop, diagnostics, outcome)) return outcome;
  if (!stock()) return conclude(true);  // stopped while the blank was guessed
  // Of standard input there is no second reading, and of a given sheet the kerf must be given, too.
  if (!look_first && options_.program.path != "-" && !front_.is_sheet()) {
    open_tools_.emplace(front_.tools);
  }
  while (true) {
    if (const std::optional<Outcome> ended = cut_and_report(stop, diagnostics)) return *ended;
    if (!begin_again(stop, diagnostics, outcome)) return outcome;
  }
}

/// Nothing: the program needs another model, or a tool is to be guessed; nothing is reported.
std::optional<Outcome> Session::cut_and_report(std::stop_token stop, Diagnostics& diagnostics) {
  if (observer_) observer_->on_start(*stock());
  ToolResolver resolver(front_.tools, row_of(*stock()).can_cut);
  const ProcessPointer process = process_of(options_, front_);
  TimelineOptions timing = options_.timeline;
  timing.holds = process->holds();
  report_.findings.join_repeats();
  CutStage stage(*front_.stock.stock, resolver, report_.findings, timing, *process);
  stage.check_by(checks_of(options_, front_));
  stage.stop_by(stop);
  if (!recorders_.empty()) stage.record_by(recorders_);
  if (kept_moves_) stage.keep_moves(kept_moves_.emplace());
  if (engagement_) stage.log_engagement(*engagement_);
  if (load_listener_) stage.hear_loads(*load_listener_);
  // Heights know to a cell where a wall is; the moves that made it know it exactly.
  const bool by_moves =
      engagement_ && dynamic_cast<const PresentHeights*>(&front_.stock.stock->bare()) != nullptr;
  const bool by_labels = labels_ && !front_.is_sheet();
  if (by_moves || by_labels) front_.stock.stock->keep_cut_ids(true);
  if (by_labels) stage.label_by(*labels_);
  work_read_ = work_done_ = 0;
  stage.count_work(work_done_);
  const double cpu_before = thread_cpu_s();
  const Pass pass = cut_program(stage, stop, diagnostics);
  if (pass == Pass::kUnfit) return std::nullopt;
  const bool whole = pass == Pass::kWhole;
  const Clock::time_point finish_start = Clock::now();
  stage.judge_blank(judged_blank(options_, front_, report_.program, !has_error(interpreter_)));
  if (has_error(interpreter_) || window_.over()) stage.cut_short();
  // Where a sheet's program was stopped it may not have come to cut yet.
  stage.finish(whole && !(front_.is_sheet() && window_.over()));
  const bool cut_whole = whole && !stage.stopped();  // the last motions come with the end
  if (observer_) observer_->on_cut(*stock(), {}, stage.timeline().clock_s());
  report_.timing.cut_s += seconds_since(finish_start);
  report_.timing.cut_cpu_s = thread_cpu_s() - cpu_before;
  complete_report(stage);
  if (has_error(diagnostics)) return Outcome::kFailed;
  return conclude(!cut_whole);
}

std::vector<Finding> Session::try_moves(std::span<const Motion> moves) const {
  const std::unique_ptr<StockModel> tried = stock()->snapshot();
  ToolResolver resolver(front_.tools, row_of(*stock()).can_cut);
  const ProcessPointer process = process_of(options_, front_);
  FindingLog log;
  CutStage stage(*tried, resolver, log, options_.timeline, *process);
  stage.check_by(checks_of(options_, front_));
  stage.set_frame(front_.program->workpiece_frame());
  stage.take(moves);
  stage.finish(false);
  std::vector<Finding> told;
  for (const Finding& finding : log.kept()) {
    if (finding.severity != Severity::kNote) told.push_back(finding);
  }
  return told;
}

Outcome Session::conclude(bool stopped) {
  report_.timing.interpret_s = report_.program.interpret_s;
  complete_timing();
  const ProgramEnd end =
      conclude_program(report_.program, interpreter_, window_, stopped, report_.findings);
  report_.partial_reason = end.partial_reason;
  if (end.partial_reason.empty()) add_unused_tools(options_, report_.tools, report_.findings);
  return end.outcome;
}

void Session::complete_timing() {
  report_.timing.total_s = seconds_since(start_);
  report_.peak_rss_mb = peak_rss_mb();
}

void Session::complete_report(const CutStage& stage) {
  report_.motion = stage.timeline().totals();
  report_.time_model = stage.timeline().time_model();
  report_.tools = stage.tools();
  report_.collisions = stage.process().collisions();
  report_.pieces = stage.process().loose();
  if (engagement_) report_.engagement = engagement_->result();
  report_.guesses = guess_rows(options_, front_, report_.tools);
  const std::vector<ToolTableRow>& table = front_.tools.table;
  const auto axes = static_cast<unsigned>(options_.program.machine.length_axes);
  const std::map<int, ToolOffset> lengths = known_lengths(table, axes);
  report_.lengths_all_zero = !table.empty() && lengths.empty() && !front_.is_sheet();
  for (ToolUse& use : report_.tools) {
    const auto row = lengths.find(use.number);
    if (row != lengths.end() && !front_.is_sheet())
      use.offset_mm = {row->second[0], row->second[1], row->second[2]};
  }
  report_.stock = stock_report(*stock(), front_.stock.facts);
  if (const Sheet* const sheet = stock()->sheet()) {
    report_.sheet = sheet_report(*sheet, stage.process(), options_.beam.density_kg_per_m3);
  }
  if (stock()->turned()) {
    report_.turning = turning_report(*stock(), stage.process(), options_.beam.density_kg_per_m3);
  }
}

}  // namespace kerf
