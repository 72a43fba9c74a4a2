#include "twin/live/live_shift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "twin/job/stock_choice.h"

namespace kerf {
namespace {

/// A tip that leaves the path for less than this has not left it: sensors tremble. s.
constexpr double kLeft_s = 0.1;
/// Where no lines are named, a program that is not at its end is only taken to be over when the
/// machine has not been on its path for so long.
constexpr double kLeftWithoutLines_s = 1.0;
/// Scouts that have been wrong are not sent again before. s.
constexpr double kScoutsAgain_s = 2.0;
/// Where two may be right for so long, the first of them is taken: the programs are alike.
constexpr double kAlike_mm = 50.0;
/// The run that seemed to be over is found again so much farther on: it has not come there.
constexpr double kSkipped_s = 1.0;
/// A machine that is nearer to where it was stands. mm, degrees.
constexpr double kElsewhere_mm = 0.01;

/// Adds what tools have done to what they had done.
void add_uses(const std::vector<ToolUse>& uses, std::vector<ToolUse>& all) {
  for (const ToolUse& use : uses) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const ToolUse& one) {
      return one.number == use.number && one.shape == use.shape;
    });
    if (same == all.end()) {
      all.push_back(use);
      continue;
    }
    same->cut_s += use.cut_s;
    same->feed_mm += use.feed_mm;
    same->removed_mm3 += use.removed_mm3;
    same->max_depth_mm = std::max(same->max_depth_mm, use.max_depth_mm);
    same->peak_mm3_per_s = std::max(same->peak_mm3_per_s, use.peak_mm3_per_s);
  }
}

}  // namespace

LiveShift::LiveShift(std::unique_ptr<StockModel> stock, const ToolSources& tools, FindingLog& log,
                     ShiftOptions options, std::unique_ptr<Program> first)
    : tools_(tools), log_(log), options_(std::move(options)), stock_(std::move(stock)) {
  run_.log = std::make_unique<FindingLog>();
  run_.cutter =
      std::make_unique<LiveCutter>(*stock_, tools_, *run_.log, options_.cutting, std::move(first));
  for (const Finding& finding : log_.kept()) told_.push_back({finding, {}});
}

LiveShift::~LiveShift() = default;

void LiveShift::label_by(CutLabels& labels) {
  labels_ = &labels;
  current().label_by(labels);
}

/// A further run may be recognised.
bool LiveShift::can_begin() const {
  return std::any_of(options_.programs.begin(), options_.programs.end(),
                     [](const ShiftProgram& program) { return program.open != nullptr; });
}

LiveShift::Run LiveShift::make_run(std::size_t program, StockModel& stock,
                                   std::unique_ptr<Program> opened) {
  Run run;
  run.program = program;
  run.opened = start_;
  run.log = std::make_unique<FindingLog>();
  run.begin_s = t_s_;
  LiveCutOptions cutting = options_.cutting;
  cutting.seen_before = true;
  cutting.reopen = reopen(program);
  run.cutter = std::make_unique<LiveCutter>(stock, tools_, *run.log, cutting, std::move(opened));
  if (labels_) run.cutter->label_by(*labels_);
  return run;
}

/// From where the machine stood last; null: it cannot be.
std::unique_ptr<Program> LiveShift::open(std::size_t program) const {
  const bool is = program < options_.programs.size() && options_.programs[program].open;
  return is ? options_.programs[program].open(start_) : nullptr;
}

/// While the machine runs no program, by what it says of itself, or as it stands.
void LiveShift::see_start(const AxisSample& sample) {
  const bool told = sample.program != ProgramState::kUnknown;
  const bool idle =
      told ? sample.program == ProgramState::kIdle
           : sample.line == 0 || (sample.line == AxisSample::kUnknown && stands(sample));
  const bool begins = std::exchange(was_idle_, idle) && !idle;
  if (idle) {
    if (const ProgramStart start = run_.cutter->start_at(sample)) start_ = start;
  }
  if (!begins) return;
  const bool alone = options_.programs.size() == 1 && past_.empty();
  if (alone && !run_.end_s) read_from_start(run_);
  for (Run& scout : scouts_) read_from_start(scout);
}

bool LiveShift::stands(const AxisSample& sample) const {
  const auto same = [](double a, double b) { return std::abs(a - b) < kElsewhere_mm; };
  return !before_ || std::equal(sample.position.begin(), sample.position.end(),
                                before_->first.position.begin(), same);
}

/// Anew, of a run that has not been seen on its program yet.
void LiveShift::read_from_start(Run& run) {
  const auto same = [](double a, double b) { return std::abs(a - b) < kElsewhere_mm; };
  const std::array<double, 9> was = run.opened.value_or(std::array<double, 9>{});
  if (!start_ || run.cutter->found()) return;
  if (std::equal(was.begin(), was.end(), start_->begin(), same)) return;
  std::unique_ptr<Program> opened = open(run.program);
  if (!opened) return;
  run.opened = start_;
  run.cutter->read_again(std::move(opened), reopen(run.program));
}

/// As LiveCutOptions has it.
std::function<std::unique_ptr<Program>()> LiveShift::reopen(std::size_t program) const {
  return [open = options_.programs[program].open, start = start_] { return open(start); };
}

void LiveShift::take(const AxisSample& sample, double t_s, bool lost) {
  see_start(sample);
  if (options_.on_end == OnProgramEnd::kNewBlank && !blank_ && can_begin()) {
    blank_ = stock_->snapshot();
  }
  t_s_ = t_s;
  // Several programs: which of them it is, is to be found out.
  if (!before_ && options_.programs.size() > 1) {
    run_.cutter->set_running(false);
    begin_scouts();
  }
  const bool begins = sample.program == ProgramState::kRunning && state_ == ProgramState::kIdle &&
                      run_.end_s.has_value();
  if (begins && scouts_.empty() && can_begin()) begin_next();
  const bool goes_back = sample.line > 0 && static_cast<std::uint32_t>(sample.line) < last_line_;
  const bool may_be_over = goes_back || sample.line == 0;
  if (may_be_over && sample.program == ProgramState::kUnknown && can_begin() && !scouts_wrong_) {
    // Whether it is off its path is to be told when it is known to be its path.
    current().set_doubtful(true);
  }
  current().take(sample, t_s, lost);
  for (Run& scout : scouts_) scout.cutter->take(sample, t_s, lost);
  if (before_scouts_ && current().place().followed && !regained_s_) {
    regained_s_ = current().place().program_s;
  }
  decide();
  if (sample.program != ProgramState::kUnknown) {
    see_state(sample, t_s);
  } else {
    see_line(sample, t_s);
  }
  before_.emplace(sample, t_s);
}

/// The machine says itself whether its program runs.
void LiveShift::see_state(const AxisSample& sample, double t_s) {
  const ProgramState before = std::exchange(state_, sample.program);
  if (sample.program != ProgramState::kIdle || run_.end_s) return;
  const bool has_run = before == ProgramState::kRunning || before == ProgramState::kPaused;
  if (!has_run) return;
  drop_scouts();
  end_run(t_s);
}

/// It says at most its line.
void LiveShift::see_line(const AxisSample& sample, double t_s) {
  state_ = ProgramState::kUnknown;
  if (!can_begin() || !current().found()) return;
  if (sample.line == 0) rested_ = true;
  const ToolState& place = current().place();
  if (place.followed) {
    if (scouts_.empty()) last_line_ = place.source.line;
    off_since_s_.reset();
    scouts_wrong_ = false;
    if (sample.line != 0) rested_ = false;
    if (!rested_ && scouts_.empty()) current().set_doubtful(false);
    // A machine on its way to a program's beginning may come by its end.
    if (!run_.end_s && scouts_.empty() && current().finished()) {
      run_.end_s = t_s;
      run_.finished = true;
    }
    return;
  }
  if (!off_since_s_) off_since_s_ = t_s;
  const double off_s = t_s - *off_since_s_;
  const bool named = sample.line > 0;
  const bool elsewhere = named && static_cast<std::uint32_t>(sample.line) < last_line_;
  const bool doubt = sample.line < 0 ? run_.finished || off_s >= kLeftWithoutLines_s
                                     : named && (run_.finished || rested_ || elsewhere);
  if (!scouts_.empty() || !doubt || off_s < kLeft_s || t_s < scouts_from_s_) return;
  begin_scouts();
}

/// Of its program: what the machine does until the next one begins is still counted with it.
void LiveShift::end_run(double t_s) {
  run_.end_s = t_s;
  run_.finished = current().finished();
  current().set_running(false);
}

/// One is known to have begun.
void LiveShift::begin_next() {
  if (options_.programs.size() > 1) return begin_scouts();
  std::unique_ptr<Program> opened = open(0);
  if (!opened) return;
  const bool new_part = blank_ && run_.finished;
  current().settle();
  std::unique_ptr<StockModel> stock = new_part ? blank_->snapshot() : nullptr;
  Run next = make_run(0, stock ? *stock : *stock_, std::move(opened));
  next.part = run_.part + (new_part ? 1 : 0);
  if (!new_part) next.cutter->go_on_from(current());
  next.cutter->know_loads_of(current());
  if (before_) next.cutter->begin_at(before_->first, before_->second);
  next.stock = std::move(stock);
  scouts_.push_back(std::move(next));
  promote(0);
}

void LiveShift::begin_scouts() {
  current().settle();
  // Its end may come while nobody looks: the last way home is as good.
  const bool new_part = blank_ && (run_.finished || current().has_cut_all());
  for (std::size_t i = 0; i < options_.programs.size(); ++i) {
    std::unique_ptr<Program> opened = open(i);
    if (!opened) continue;
    std::unique_ptr<StockModel> stock = new_part ? blank_->snapshot() : stock_->snapshot();
    Run scout = make_run(i, *stock, std::move(opened));
    scout.stock = std::move(stock);
    scout.part = run_.part + (new_part ? 1 : 0);
    scout.cutter->set_looks_ahead(false);
    if (!new_part) scout.cutter->go_on_from(current());
    scout.cutter->know_loads_of(current());
    if (before_) scout.cutter->begin_at(before_->first, before_->second);
    scouts_.push_back(std::move(scout));
  }
  scouts_from_s_ = t_s_ + kScoutsAgain_s;
  if (scouts_.empty()) return;
  before_scouts_ = now();
  before_scouts_->sheet = sheet_now();
  stock_before_ = stock_->snapshot();
  regained_s_.reset();
  current().set_doubtful(true);
}

/// They have been wrong.
void LiveShift::drop_scouts() {
  if (scouts_.empty()) return;
  scouts_.clear();
  before_scouts_.reset();
  stock_before_.reset();
  rested_ = false;
  scouts_wrong_ = true;
  current().set_doubtful(false);
}

/// The one that has come farthest along its path; none may be right yet.
std::optional<std::size_t> LiveShift::best_scout() const {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < scouts_.size(); ++i) {
    if (!scouts_[i].cutter->place().followed || way_of(scouts_[i]) < kSure_mm) continue;
    if (!best || way_of(scouts_[i]) > way_of(scouts_[*best])) best = i;
  }
  return best;
}

void LiveShift::decide() {
  if (scouts_.empty()) return;
  const LiveCutter& cutter = current();
  const bool over = run_.end_s.has_value() || !cutter.found();
  const double own_mm = cutter.facts().path_mm - before_scouts_->facts.path_mm;
  const bool skipped = regained_s_ && *regained_s_ > before_scouts_->program_s + kSkipped_s;
  const bool goes_on = !over && cutter.place().followed && !skipped && own_mm >= kSure_mm;
  const std::optional<std::size_t> best = best_scout();
  if (!best) {
    const bool lost = std::all_of(scouts_.begin(), scouts_.end(), [&](const Run& scout) {
      const bool astray = !over && !scout.cutter->found() && scout.cutter->is_astray();
      return scout.cutter->is_foreign() || astray;
    });
    if (goes_on || (lost && !over)) {
      drop_scouts();
    } else if (lost) {
      promote(0);
    }
    return;
  }
  const double way_mm = way_of(scouts_[*best]);
  if (goes_on && own_mm >= kAlike_mm) return drop_scouts();
  const bool rivals = goes_on || std::any_of(scouts_.begin(), scouts_.end(), [&](const Run& scout) {
                        return &scout != &scouts_[*best] && scout.cutter->place().followed &&
                               way_of(scout) > 0.5 * way_mm;
                      });
  if (!rivals || (!goes_on && way_mm >= kAlike_mm)) promote(*best);
}

/// It is the run from here on.
void LiveShift::promote(std::size_t scout) {
  Run next = std::move(scouts_[scout]);
  scouts_.clear();
  const bool never = past_.empty() && !current().found() && !run_.end_s;
  if (never) {
    // There was no run before this one.
    next.begin_s = run_.begin_s;
    next.part = run_.part;
  } else {
    if (!run_.end_s) run_.end_s = next.begin_s;
    close_run();
  }
  run_.cutter.reset();
  if (next.stock) stock_ = std::move(next.stock);
  run_ = std::move(next);
  before_scouts_.reset();
  told_count_ = 0;
  current().set_looks_ahead(true);
  rested_ = scouts_wrong_ = false;
  last_line_ = 0;
  off_since_s_.reset();
  regained_s_.reset();
}

LiveShift::Before LiveShift::now() const {
  const LiveCutter& cutter = *run_.cutter;
  return {run_.log->kept().size(),  cutter.facts(),
          cutter.stage().tools(),   {},
          cutter.place().program_s, cutter.place().source.line,
          cutter.has_cut_all()};
}

/// The workpiece as it is, if it is a sheet.
std::optional<SheetReport> LiveShift::sheet_now() const {
  const Sheet* const sheet = stock_->sheet();
  if (!sheet) return std::nullopt;
  return sheet_report(*sheet, run_.cutter->stage().process(), options_.density_kg_per_m3);
}

/// The present one becomes a past one.
void LiveShift::close_run() {
  // What it has seen since there were scouts has been the next one's.
  const std::optional<Before> before = before_scouts_;
  current().finish();
  if (before) run_.log->forget_from(before->findings);
  past_.push_back(present());
  LiveRun& past = past_.back();
  past.sheet = before ? before->sheet : sheet_now();
  past.files = files();
  const StockModel& part = stock_before_ ? *stock_before_ : *stock_;
  past.digest = part.digest();
  past.part_removed_mm3 = part.blank_mm3() - part.remaining_mm3();
  before_scouts_.reset();
  stock_before_.reset();
  std::vector<Told> told = take_findings();
  told_.insert(told_.end(), std::make_move_iterator(told.begin()),
               std::make_move_iterator(told.end()));
  log_.join(*run_.log, files());
  add_uses(before ? before->tools : current().stage().tools(), past_tools_);
}

void LiveShift::finish() {
  drop_scouts();
  close_run();
  over_ = true;
}

LiveRun LiveShift::present() const {
  const Before run = before_scouts_ ? *before_scouts_ : now();
  const LiveCutter& cutter = *run_.cutter;
  LiveRun out;
  out.number = static_cast<std::uint32_t>(past_.size()) + (over_ ? 0 : 1);
  out.part = run_.part;
  if (run_.program < options_.programs.size()) out.program = options_.programs[run_.program].path;
  if (!out.program.empty() && !cutter.found()) {
    out.end = RunEnd::kUnseen;
  } else if (run_.finished || run.finished) {
    out.end = RunEnd::kFinished;
  } else if (run_.end_s) {
    out.end = RunEnd::kAborted;
  }
  out.from_line = cutter.first_line();
  out.to_line = run.line;
  out.begin_s = run_.begin_s;
  out.end_s = run_.end_s.value_or(t_s_);
  out.facts = run.facts;
  out.errors = run_.log->count(Severity::kError);
  out.warnings = run_.log->count(Severity::kWarning);
  out.notes = run_.log->count(Severity::kNote);
  for (const ToolUse& use : run.tools) out.removed_mm3 += use.removed_mm3;
  return out;
}

std::vector<std::string> LiveShift::files() const {
  const ProgramAhead* const program = run_.cutter->program();
  return program ? program->files() : std::vector<std::string>{};
}

std::vector<LiveShift::Told> LiveShift::take_findings() {
  std::vector<Told> out = std::exchange(told_, {});
  const std::vector<Finding>& kept = run_.log->kept();
  const std::size_t sure = before_scouts_ ? before_scouts_->findings : kept.size();
  if (told_count_ >= sure) return out;
  const std::vector<std::string> of = files();
  for (; told_count_ < sure; ++told_count_) out.push_back({kept[told_count_], of});
  return out;
}

LiveFacts LiveShift::facts() const {
  LiveFacts all;
  for (const LiveRun& run : past_) all += run.facts;
  return over_ ? all : all += present().facts;
}

std::vector<ToolUse> LiveShift::tools() const {
  std::vector<ToolUse> all = past_tools_;
  if (!over_) add_uses(now().tools, all);
  return all;
}

}  // namespace kerf
