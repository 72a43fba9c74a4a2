#include "twin/live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/helper_thread.h"
#include "base/translate.h"
#include "twin/job/blank_choice.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/process_table.h"
#include "twin/program/program_front.h"
#include "twin/program/turning.h"

namespace kerf {
namespace {

/// How long the source is given, and how long the cutter waits, before they look round.
constexpr std::chrono::milliseconds kPatience{50};
/// The program ahead is looked at this often, in seconds of the samples' clock.
constexpr double kLook_s = 0.05;
constexpr std::size_t kAges = 1 << 16;
/// A device's stamps that leave the arrival by more are not believed.
constexpr double kPlausible_s = 1.0;
/// The status is copied this seldom while a log rushes by.
constexpr std::uint64_t kStatusEvery = 256;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

std::int64_t steady_ns(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(t.time_since_epoch()).count();
}

}  // namespace

const char* to_string(LiveState state) {
  switch (state) {
    case LiveState::kWaiting:
      return tr_noop("waiting");
    case LiveState::kLive:
      return tr_noop("live");
    case LiveState::kStale:
      return tr_noop("stale");
    case LiveState::kLost:
      return tr_noop("lost");
    case LiveState::kEnded:
      return tr_noop("ended");
  }
  return "";
}

LiveSession::LiveSession(LiveOptions options, std::unique_ptr<PositionSource> source)
    : options_(std::move(options)),
      source_(std::move(source)),
      clock_watch_(options_.clock_ns ? options_.clock_ns : real_time_ns),
      start_(Clock::now()) {
  ages_ms_.reserve(kAges);
  pace_.set_speed(options_.speed);
}

LiveSession::~LiveSession() = default;

std::unique_ptr<LiveSession> LiveSession::open(LiveOptions options,
                                               std::unique_ptr<PositionSource> source,
                                               Diagnostics& diagnostics, Outcome& outcome) {
  std::unique_ptr<LiveSession> session(new LiveSession(std::move(options), std::move(source)));
  outcome = Outcome::kFailed;
  if (!session->set_up(diagnostics, outcome)) return nullptr;
  outcome = Outcome::kFinished;
  return session;
}

struct LiveSession::Survey {
  bool guesses = false;  ///< the blank is to be guessed
  std::optional<Blank> blank;
  std::string tilt;  ///< TiltWatch::found()
};

bool LiveSession::set_up(Diagnostics& diagnostics, Outcome& outcome) {
  ProgramOptions program;
  program.tool_table_path = options_.tool_table_path;
  program.machine.inch_machine = options_.inch_table;
  if (options_.program) {
    program = *options_.program;
    if (!programs_.open(program, diagnostics)) return false;
  }
  const Program* const first = programs_.first();
  ToolSources& tools = tool_sources_;
  if (!gather_tool_sources(options_.tools, options_.libraries, first, program, tools,
                           diagnostics)) {
    return false;
  }
  program.lathe = options_.lathe;
  program.as_mill = options_.as_mill;
  if (!note_turning(program, first, options_.stock.kind, options_.blank, tools, diagnostics)) {
    outcome = Outcome::kUsageError;
    return false;
  }
  options_.cutting.frame.y_stands = tools.turning;
  if (first && !programs_.start(known_tools(tools), options_.more_programs, diagnostics)) {
    return false;
  }
  for (const ToolTableRow& row : tools.table) {
    options_.cutting.frame.table_length_mm[row.tool] = row.offset_mm.z;
  }
  CommentBlank found;
  if (options_.blank) {
    found = {options_.blank, "--stock"};
  } else if (first && !find_comment_blank(*first, program.path, found, diagnostics)) {
    return false;
  }
  if (options_.turret && !can_be_punched(found.blank, diagnostics, outcome)) return false;
  Survey survey;
  survey.guesses = !found.blank;
  if (!survey_program(tools, survey, diagnostics)) return false;
  StockNeeds needs = stock_needs(tools);
  needs.tilt = need_of_tilt(survey);
  choice_ = choose_stock(options_.stock, needs);
  if (!found.blank && !guess_blank(survey, diagnostics, outcome)) return false;
  options_.cutting.checks.blank_guessed = !found.blank;
  if (found.blank) options_.cutting.checks.blank = *found.blank;
  const FixtureList& fixtures = options_.cutting.checks.collisions.fixtures;
  const bool turns = choice_.kind == StockKind::kTurning;
  if (found.blank && fixtures && !turns &&
      !check_fixtures_beside(*fixtures, *found.blank, diagnostics)) {
    outcome = Outcome::kUsageError;
    return false;
  }
  if (found.blank) {
    StockSetup setup =
        make_stock(*found.blank, choice_, options_.stock, found.origin, diagnostics, outcome);
    stock_ = std::move(setup.stock);
    stock_facts_ = std::move(setup.facts);
  }
  if (!stock_) return false;
  CollisionWishes& wishes = options_.cutting.checks.collisions;
  if (!hold_workpiece(wishes.holding, wishes.fixtures, *stock_, found.blank.has_value(),
                      wishes.held_by, diagnostics)) {
    outcome = Outcome::kUsageError;
    return false;
  }
  prepare_process(diagnostics);
  options_.cutting.wait_for_program = options_.log();
  options_.cutting.gap_s = options_.stale_after_s;
  ShiftOptions shift{options_.cutting, programs_.all(), options_.on_end,
                     options_.beam.density_kg_per_m3};
  if (!shift.programs.empty() && shift.programs[0].open) {
    shift.cutting.reopen = [open = shift.programs[0].open] { return open({}); };
  }
  shift_ = std::make_unique<LiveShift>(std::move(stock_), tools, report_.findings, std::move(shift),
                                       programs_.take_followed());
  return true;
}

/// The one that workpiece and options need.
void LiveSession::prepare_process(Diagnostics& diagnostics) {
  ProcessWish wish;
  wish.is_sheet = stock_->sheet() != nullptr;
  wish.is_turned = stock_->turned() != nullptr;
  wish.beam = options_.beam;
  wish.turret = options_.turret;
  const Program* const program = programs_.first();
  wish.is_qtplasmac = program && program->is_qtplasmac();
  wish.has_program = program != nullptr;
  LiveCutOptions& cutting = options_.cutting;
  cutting.process = choose_process(wish);
  cutting.timeline.holds = cutting.process->holds();
  if (std::string warning = cutting.process->warning(); !warning.empty()) {
    Diagnostic note = general_error(std::move(warning));
    note.severity = Severity::kWarning;
    diagnostics.push_back(std::move(note));
  }
}

void LiveSession::keep_cut_ids() {
  shift_->stock().keep_cut_ids(true);
  shift_->label_by(labels_);
}

/// One reading of the program beforehand, if anything is to be learnt from it: where it works, and
/// whether it turns anything on a machine that can.
bool LiveSession::survey_program(const ToolSources& tools, Survey& survey,
                                 Diagnostics& diagnostics) {
  const TimelineOptions& timeline = options_.cutting.timeline;
  const bool may_turn = !options_.stock.kind && timeline.kinematics && timeline.kinematics->turns();
  if (!programs_.can_read_again() || !(survey.guesses || may_turn)) return true;
  // What is interpreted for it, and perhaps beyond it, who follows need not interpret again.
  const auto first_pass = programs_.read(diagnostics);
  if (!first_pass) return false;
  TiltWatch tilt(timeline.kinematics);
  BlankSurvey blank(options_.margin_mm, tools);
  Diagnostics said;
  first_pass->run(
      [&](std::span<const Motion> motions) {
        tilt.look_at(motions, first_pass->workpiece_frame());
        if (survey.guesses) blank.add(motions, tilt.moves());
        return survey.guesses || tilt.found().empty();
      },
      {}, said);
  survey.tilt = tilt.found();
  if (survey.guesses) survey.blank = blank.blank();
  return true;
}

/// As in a dry run where there is a program. A machine without one may turn whenever it likes.
std::string LiveSession::need_of_tilt(const Survey& survey) const {
  const TimelineOptions& timeline = options_.cutting.timeline;
  if (programs_.can_read_again()) return survey.tilt;
  if (!timeline.kinematics_known || !timeline.kinematics || !timeline.kinematics->turns()) {
    return {};
  }
  const MachineKinematics& machine = *timeline.kinematics;
  std::string axes;
  for (std::size_t i = 3; i < 6; ++i) {
    if (machine.is_arm() || !machine.chain.is_driven_by(i)) continue;
    axes.append(axes.empty() ? "" : tr(" and ")).append(1, kAxisLetters[i]);
  }
  return trf("the machine turns the tool or the workpiece ({}{}{})", machine.module,
             axes.empty() ? "" : ": ", axes);
}

/// From the motions of the program.
bool LiveSession::guess_blank(const Survey& survey, Diagnostics& diagnostics, Outcome& outcome) {
  outcome = Outcome::kUsageError;
  if (!survey.blank) {
    diagnostics.push_back(general_error(
        tr("no blank is given: without a program there is nothing to guess it from"),
        tr("--stock box:x0,y0,z0:x1,y1,z1 gives it, in the coordinates of the work offset")));
    return false;
  }
  StockSetup setup =
      make_stock(*survey.blank, choice_, options_.stock, tr("guessed"), diagnostics, outcome);
  stock_ = std::move(setup.stock);
  stock_facts_ = std::move(setup.facts);
  if (!stock_) return false;
  Finding finding;
  finding.id = FindingId::kStockGuessed;
  finding.severity = Severity::kWarning;
  finding.text =
      trf("no blank is given or written in the program; assumed: {} (the feed moves plus {:g} mm; "
          "--stock SPEC says better)",
          stock_facts_.description, options_.margin_mm);
  report_.findings.add(std::move(finding));
  return true;
}

void LiveSession::read_source(std::stop_token stop) {
  AxisSample sample;
  std::uint64_t handed = 0;
  const auto copy_status = [&] {
    const std::lock_guard lock(status_mutex_);
    source_status_ = source_->status();
  };
  while (!stop.stop_requested()) {
    const PositionSource::Next next = source_->next(sample, kPatience);
    if (next != PositionSource::Next::kSample) {
      copy_status();
      if (next == PositionSource::Next::kEnd) break;
      continue;
    }
    if (options_.log()) pace_.wait_for(sample, stop);
    ArrivedSample arrived{sample, Clock::now() - std::chrono::nanoseconds(sample.age_ns),
                          source_->status().lost};
    if (!options_.log() && sample.host_ns != AxisSample::kNoTime) {
      arrived.clock_set_ns = clock_watch_.set_by(sample.host_ns, steady_ns(arrived.arrival));
    }
    if (tap_) tap_(tapped(arrived));
    if (!options_.log() || handed % kStatusEvery == 0) copy_status();
    ++handed;
    if (!options_.log()) {
      queue_.push_or_drop(arrived);
    } else if (!queue_.push_waiting(arrived)) {
      break;
    }
  }
  copy_status();
  queue_.close();
}

/// What the recorder has to know beside the sample itself.
TappedSample LiveSession::tapped(const ArrivedSample& arrived) {
  TappedSample out{arrived.sample};
  out.lost = arrived.lost - std::exchange(tapped_lost_, arrived.lost);
  out.clock_set_ns = arrived.clock_set_ns;
  return out;
}

/// Seconds since the first sample. By the stamps as long as they go along with the arrivals.
double LiveSession::time_of(const ArrivedSample& arrived) {
  const std::int64_t stamp = stamp_of(arrived.sample);
  if (!first_) {
    first_ = newest_ = arrived;
    stamp_before_ns_ = stamp;
    return 0;
  }
  const double by_arrival_s = seconds(arrived.arrival - newest_.arrival);
  double elapsed_s = by_arrival_s;
  if (stamp != AxisSample::kNoTime && stamp_before_ns_ != AxisSample::kNoTime) {
    const double by_stamp_s = seconds(stamp - stamp_before_ns_);
    // Without a clock of its own the stamp is ours, of when it was read: so a recording of this
    // run, which has no other times, is cut as the run was.
    const bool own_clock = arrived.sample.device_ns != AxisSample::kNoTime;
    const double allowed_s = own_clock ? kPlausible_s : ClockWatch::kStep_s;
    const bool plausible = by_stamp_s >= 0 && std::abs(by_stamp_s - by_arrival_s) < allowed_s;
    if (options_.log() || plausible) elapsed_s = std::max(0.0, by_stamp_s);
  }
  stamp_before_ns_ = stamp;
  return t_s_ + elapsed_s;
}

void LiveSession::note_clocks(const ArrivedSample& arrived, double t_s) {
  if (options_.log()) return;
  if (arrived.clock_set_ns != 0) ++live_.clock_steps;
  if (arrived.sample.device_ns != AxisSample::kNoTime) {
    const double late_s = seconds(arrived.arrival - first_->arrival) - t_s;
    live_.jitter_ms = std::max(live_.jitter_ms, std::abs(late_s) * 1e3);
  }
}

void LiveSession::take(const ArrivedSample& arrived) {
  const double t_s = time_of(arrived);
  note_clocks(arrived, t_s);
  const std::uint64_t dropped = options_.log() ? 0 : queue_.dropped();
  const bool lost = arrived.lost > lost_before_ || dropped > dropped_before_;
  lost_before_ = arrived.lost;
  dropped_before_ = dropped;
  t_s_ = t_s;
  newest_ = arrived;
  ++samples_;
  shift_->take(arrived.sample, t_s, lost);
  measure_feed();
  if (options_.log()) return;
  const auto age_ms = static_cast<float>(seconds(Clock::now() - arrived.arrival) * 1e3);
  if (ages_ms_.size() < kAges) {
    ages_ms_.push_back(age_ms);
  } else {
    ages_ms_[next_age_++ % kAges] = age_ms;
  }
  live_.age_max_ms = std::max(live_.age_max_ms, static_cast<double>(age_ms));
}

/// Without what turns, where the axes are: the tip changes places with a tool's length, too.
void LiveSession::measure_feed() {
  const ToolState& place = shift_->cutter().place();
  if (!place.known) return feed_meter_.forget();
  feed_meter_.take(t_s_, place.turns ? place.tip_mm : place.machine_mm);
}

LiveState LiveSession::state_now(double age_s) const {
  if (!first_) return LiveState::kWaiting;
  if (options_.log() || age_s <= options_.stale_after_s) return LiveState::kLive;
  return age_s <= options_.lost_after_s ? LiveState::kStale : LiveState::kLost;
}

/// What is new goes to the observer at once, the rest from time to time.
void LiveSession::tell(bool ended) {
  const auto now = Clock::now();
  const std::vector<AheadWarning> warnings = shift_->take_warnings();
  live_.warnings_ahead += warnings.size();
  const bool other_run = told_runs_ < shift_->past().size();
  if (other_run) ahead_.clear();
  ahead_.insert(ahead_.end(), warnings.begin(), warnings.end());
  std::erase_if(ahead_, [&](const AheadWarning& w) {
    return w.finding.time_s.value_or(0) < shift_->cutter().place().program_s;
  });
  // A log is read ahead: what is wrong with it is told at its end.
  if (!options_.log() || ended) {
    const std::vector<Finding>& kept = report_.findings.kept();
    const std::size_t before = kept.size();
    const std::lock_guard lock(status_mutex_);
    source_faults_.look_at(source_status_, report_.findings);
    for (std::size_t i = before; i < kept.size(); ++i) fresh_.push_back({kept[i], {}});
  }
  const double age_s = first_ ? seconds(now - newest_.arrival) : seconds(now - start_);
  const LiveState state = ended ? LiveState::kEnded : state_now(age_s);
  if (observer_) {
    // In the order of what they are about: a run's findings before its end.
    for (const LiveShift::Told& told : shift_->take_findings()) fresh_.push_back(told);
  }
  const bool news = state != told_state_ || !warnings.empty() || !fresh_.empty() || other_run;
  if (!observer_ || (!news && now - told_at_ < kStatusPeriod)) return;
  told_at_ = now;
  told_state_ = state;
  const LiveStatus status = status_now(state, age_s);
  for (const LiveShift::Told& told : std::exchange(fresh_, {})) {
    observer_->on_finding(told.finding, told.files);
  }
  for (; told_runs_ < shift_->past().size(); ++told_runs_) {
    // One that is the whole watch is told of by its end.
    if (!ended || shift_->past().size() > 1) observer_->on_run(shift_->past()[told_runs_]);
  }
  const ProgramAhead* const program = shift_->cutter().program();
  const std::vector<std::string> files = program ? program->files() : std::vector<std::string>{};
  for (const AheadWarning& warning : warnings) observer_->on_warning(warning, files);
  observer_->on_status(status);
}

LiveStatus LiveSession::status_now(LiveState state, double age_s) {
  LiveStatus status;
  status.state = state;
  status.age_s = age_s;
  status.t_s = t_s_;
  const LiveCutter& cutter = shift_->cutter();
  status.place = cutter.place();
  status.work = cutter.work();
  const LiveRun run = shift_->present();
  status.run = run.number;
  status.part = run.part;
  if (const ProgramAhead* program = cutter.program()) {
    const std::vector<std::string>& files = program->files();
    if (status.place.source.file < files.size()) status.file = files[status.place.source.file];
  }
  const double total_s = programs_.total_s(shift_->program());
  if (total_s >= 0) status.remaining_s = std::max(0.0, total_s - status.place.program_s);
  for (const AheadWarning& warning : ahead_) {
    const double in_s = warning.finding.time_s.value_or(0) - status.place.program_s;
    if (status.collision_in_s >= 0 && in_s >= status.collision_in_s) continue;
    status.collision_in_s = in_s;
    status.collision_line = warning.finding.source.line;
  }
  {
    const std::lock_guard lock(status_mutex_);
    status.source = source_status_;
  }
  status.dropped = queue_.dropped();
  status.samples = samples_;
  if (state == LiveState::kLive) status.feed_mm_per_min = feed_meter_.mm_per_min();
  status.load = cutter.loads().now();
  if (status.place.off_path) status.off_path_mm = status.place.distance_mm;
  status.removed_mm3 = run.removed_mm3;
  for (const LiveRun& past : shift_->past()) {
    if (past.part == run.part && past.number != run.number) status.removed_mm3 += past.removed_mm3;
  }
  return status;
}

void LiveSession::extend_trail() {
  const ToolState& place = shift_->cutter().place();
  if (!shows_frames_ || !place.known) return;
  const bool far =
      !trail_end_ || glm::distance(*trail_end_, place.tip_mm) > LiveObserver::kTrail_mm;
  if (!far) return;
  trail_.push_back(place.tip_mm);
  trail_end_ = place.tip_mm;
}

void LiveSession::show_frame() {
  if (!shows_frames_ || samples_ == frame_samples_) return;
  const auto now = Clock::now();
  if (now - frame_at_ < frame_period_) return;
  frame_at_ = now;
  frame_samples_ = samples_;
  shift_->hand_over();
  const double age_s = seconds(now - newest_.arrival);
  observer_->on_frame(shift_->stock(), shift_->cutter().stage().cutter(),
                      status_now(state_now(age_s), age_s), trail_, labels_.all());
  trail_.clear();
}

/// Until the source ends or stop is requested; then the source's thread is over.
void LiveSession::cut_samples(const std::stop_token& stop) {
  std::stop_source end;
  const std::stop_callback forward(stop, [&] { end.request_stop(); });
  const auto release = [&] {
    end.request_stop();
    queue_.close();
  };
  HelperThread reader([&] { read_source(end.get_token()); }, release);
  std::optional<HelperThread> measure;
  if (programs_.can_read_again() && (!options_.log() || std::isfinite(options_.speed))) {
    const auto take_time = [&] { programs_.measure(options_.cutting.timeline, end.get_token()); };
    measure.emplace(take_time, release);
  }
  std::vector<ArrivedSample> batch;
  // The newest sample of a batch that came too soon after a frame is shown when the wait is over.
  constexpr std::chrono::milliseconds kCalm{20};
  const auto patience = shows_frames_ ? std::min(frame_period_, kCalm) : kCalm;
  while (queue_.pop_all(batch, patience)) {
    for (const ArrivedSample& arrived : batch) {
      take(arrived);
      extend_trail();
      if (t_s_ < look_at_s_) continue;
      shift_->look();
      look_at_s_ = t_s_ + kLook_s;
      tell(false);
      show_frame();
    }
    tell(false);
    show_frame();
    if (rest_) std::this_thread::sleep_for(rest_());
    const double run_s = options_.log() ? t_s_ : seconds(Clock::now() - start_);
    if (options_.for_s > 0 && run_s >= options_.for_s) break;
  }
  stopped_ = stop.stop_requested();
  release();
  reader.join();
  if (measure) measure->join();
  // What was recorded is cut. (A log was read ahead: what lies beyond the time asked for is not.)
  while (!options_.log() && queue_.pop_all(batch, std::chrono::milliseconds(0))) {
    for (const ArrivedSample& arrived : batch) take(arrived);
  }
}

Outcome LiveSession::run(std::stop_token stop, Diagnostics& diagnostics) {
  report_.version = KERF_VERSION;
  report_.program_path = options_.program ? options_.program->path : std::string();
  live_.source = source_->describe();
  shows_frames_ = observer_ && observer_->wants_frames();
  if (shows_frames_) frame_period_ = observer_->frame_period();
  const double cpu_before = thread_cpu_s();
  cut_samples(stop);
  last_state_ = state_now(first_ ? seconds(Clock::now() - newest_.arrival) : 0);
  shift_->look();
  shift_->finish();
  tell(true);
  report_.timing.cut_cpu_s = thread_cpu_s() - cpu_before;
  conclude();
  const SourceStatus& status = live_.status;
  if (status.state == SourceState::kFailed || (!first_ && !stopped_)) {
    diagnostics.push_back(general_error(
        fmt::format("{}: {}", live_.source,
                    status.trouble.empty() ? tr("no position has come") : status.trouble)));
    return Outcome::kFailed;
  }
  return outcome();
}

}  // namespace kerf
