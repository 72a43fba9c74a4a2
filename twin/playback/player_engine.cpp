#include "twin/playback/player_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

using Kind = PlayerCommand::Kind;

/// While a seek goes on and while the checks run ahead a state that often tells how far they are.
constexpr std::chrono::milliseconds kProgressPeriod{100};
/// A run shows what it passes: it does not jump farther than this to a keyframe.
constexpr std::size_t kRunStep = 1024;
/// Times of findings that differ by less are the same place.
constexpr double kSameTime_s = 1e-9;

std::vector<Finding> by_time(const std::vector<Finding>& kept,
                             const std::vector<Finding>& remarks) {
  std::vector<Finding> sorted = kept;
  sorted.insert(sorted.end(), remarks.begin(), remarks.end());
  const auto time_of = [](const Finding& f) {
    return f.time_s.value_or(std::numeric_limits<double>::infinity());
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Finding& a, const Finding& b) { return time_of(a) < time_of(b); });
  return sorted;
}

}  // namespace

PlayerEngine::PlayerEngine(PlayerProgram program, const PlayerOptions& options)
    : track_(std::move(program.track)),
      options_(options),
      remarks_(std::move(program.remarks)),
      store_(options.keyframe_bytes),
      frontier_(*track_, std::move(program.blank), std::move(program.tools), program.timeline,
                store_, {program.report_from, program.whole, program.blank_kind}, *program.process,
                program.materials, program.checks),
      cursor_(*track_, frontier_.moves(), frontier_.record(), store_),
      place_(track_->place_before(0)),
      findings_(std::make_shared<const std::vector<Finding>>(by_time({}, remarks_))) {
  frontier_.judge(std::move(program.programmed));
  if (program.measures_loads) frontier_.measure_loads(track_);
}

void PlayerEngine::command(const PlayerCommand& c) {
  ticket_ = c.ticket;
  message_.clear();
  changed_ = urgent_ = true;
  switch (c.kind) {
    case Kind::kPlay:
      return set_playing(c.number);
    case Kind::kPause:
      return stand(PlayerStop::kAsked);
    case Kind::kStop:
      stand(PlayerStop::kAsked);
      return go_to(track_->place_before(0));
    case Kind::kStepBlock:
      return step_blocks(c.count);
    case Kind::kSeekTime:
      return go_to(track_->place_at(c.number));
    case Kind::kSeekMotion:
      return go_to(track_->place_before(std::min(c.motion, track_->size())));
    case Kind::kSeekLine:
    case Kind::kRunToLine:
      return seek_line(c);
    case Kind::kSeekToolChange:
      return seek_tool_change(c.count);
    case Kind::kSeekFinding:
      return find_finding(c.count);
    case Kind::kSeekFindingNumber:
      return seek_finding_number(c.motion);
    case Kind::kRunToMotion:
      return run_to(std::min(c.motion, track_->size()));
    case Kind::kSetBreakpoints:
      breakpoints_ = c.lines;
      return find_breakpoint();
  }
}

void PlayerEngine::set_playing(double speed) {
  if (!(speed > 0)) return refuse(trf("speed {} is not allowed; must be above 0", speed));
  if (std::isinf(speed)) return run_to(track_->size());
  speed_ = speed;
  if (mode_ == PlayerMode::kSeeking) {
    play_on_ = true;
    return;
  }
  mode_ = PlayerMode::kPlaying;
  stop_ = PlayerStop::kNone;
  anchor_ = Clock::now();
  anchor_s_ = place_.time_s;
  find_breakpoint();
}

/// Stands where it is. Of a seek that has not arrived nothing remains.
void PlayerEngine::stand(PlayerStop why) {
  mode_ = PlayerMode::kPaused;
  stop_ = why;
  play_on_ = behind_ = false;
  finding_count_.reset();
  changed_ = urgent_ = true;
}

void PlayerEngine::refuse(std::string message) { message_ = std::move(message); }

void PlayerEngine::go_to(const TrackPosition& goal) {
  if (mode_ == PlayerMode::kPlaying) play_on_ = true;
  mode_ = PlayerMode::kSeeking;
  stop_ = PlayerStop::kNone;
  finding_count_.reset();
  goal_ = goal;
  // The workpiece of a place that has been passed unseen is lost as soon as the cursor moves.
  place_ = shown_place_;
  seek_from_ = place_.motion;
}

void PlayerEngine::run_to(std::size_t motion) {
  if (motion < place_.motion) {
    stand(PlayerStop::kAsked);
    return go_to(track_->place_before(motion));
  }
  stand(PlayerStop::kNone);
  mode_ = PlayerMode::kRunning;
  goal_ = track_->place_before(motion);
  find_breakpoint();
}

void PlayerEngine::step_blocks(int blocks) {
  TrackPosition from = destination();
  stand(PlayerStop::kAsked);
  std::size_t motion = from.motion;
  if (blocks < 0 && motion < track_->size() &&
      (from.fraction > 0 || !track_->starts_block(motion))) {
    motion = track_->previous_block(motion + 1);
    ++blocks;
  }
  for (; blocks < 0; ++blocks) motion = track_->previous_block(motion);
  for (; blocks > 0 && motion < track_->size(); --blocks) motion = track_->next_block(motion);
  go_to(track_->place_before(motion));
}

void PlayerEngine::seek_line(const PlayerCommand& c) {
  std::optional<std::size_t> motion = track_->first_of_line(c.line, c.motion);
  if (!motion) {
    // Behind the last time that the line runs, and for lines without motions.
    const std::optional<SourceRef> line = track_->line_with_motions(c.line);
    if (line) motion = track_->first_of_line(*line, line == c.line ? 0 : c.motion);
    if (line && !motion) motion = track_->first_of_line(*line);
  }
  if (!motion) {
    return refuse(trf("the program makes no move in line {} or behind it", c.line.line));
  }
  if (c.kind == Kind::kRunToLine) return run_to(*motion);
  go_to(track_->place_before(*motion));
}

void PlayerEngine::seek_tool_change(int count) {
  std::size_t motion = destination().motion;
  for (; count != 0; count += count > 0 ? -1 : 1) {
    const std::optional<std::size_t> change =
        count > 0 ? track_->next_tool_change(motion) : track_->previous_tool_change(motion);
    if (!change) {
      return refuse(
          trf("there is no tool change {} this place", count > 0 ? tr("behind") : tr("before")));
    }
    motion = *change;
  }
  go_to(track_->place_before(motion));
}

void PlayerEngine::find_finding(int count) {
  if (count == 0) return;
  const double from_s = destination().time_s;
  go_to(destination());
  finding_count_ = count;
  finding_from_s_ = from_s;
}

/// Its time, else the first motion of its line or behind it: what the interpreter said of a block
/// has no time.
void PlayerEngine::seek_finding_number(std::size_t index) {
  const Finding* const finding = index < findings_->size() ? &(*findings_)[index] : nullptr;
  if (finding && finding->time_s) return go_to(track_->place_at(*finding->time_s));
  const std::optional<SourceRef> line = finding ? line_of(*finding) : std::nullopt;
  if (!line) return refuse(trf("finding {} has no place in the program", index + 1));
  const std::optional<SourceRef> moving = track_->line_with_motions(*line);
  const std::optional<std::size_t> motion = moving ? track_->first_of_line(*moving) : std::nullopt;
  go_to(track_->place_before(motion.value_or(track_->size())));
}

/// Nothing: it is of the program as a whole, or of a file in which nothing moves.
std::optional<SourceRef> PlayerEngine::line_of(const Finding& finding) const {
  if (finding.source.line == 0) return std::nullopt;
  if (finding.file.empty()) return finding.source;
  const std::vector<std::string>& files = track_->files();
  const auto file = std::find(files.begin(), files.end(), finding.file);
  if (file == files.end()) return std::nullopt;
  return SourceRef{static_cast<std::uint32_t>(file - files.begin()), finding.source.line};
}

/// False: not known before more of the program has been checked.
bool PlayerEngine::search_finding() {
  refresh_findings();
  std::vector<double> times;
  for (const Finding& finding : *findings_) {
    if (finding.time_s) times.push_back(*finding.time_s);
  }
  const int count = *finding_count_;
  const auto after = std::upper_bound(times.begin(), times.end(), finding_from_s_ + kSameTime_s);
  const auto before = std::lower_bound(times.begin(), times.end(), finding_from_s_ - kSameTime_s);
  const std::ptrdiff_t room = count > 0 ? times.end() - after : before - times.begin();
  if (room >= std::abs(count)) {
    goal_ = track_->place_at(count > 0 ? *(after + (count - 1)) : *(before + count));
    finding_count_.reset();
    return true;
  }
  const bool known = frontier_.complete() || (count < 0 && frontier_.reached() > goal_.motion);
  if (!known) return false;
  finding_count_.reset();
  refuse(trf("there is no finding {} this place", count > 0 ? tr("behind") : tr("before")));
  return true;
}

/// The first one ahead.
void PlayerEngine::find_breakpoint() {
  next_breakpoint_ = track_->size();
  for (const SourceRef& line : breakpoints_) {
    std::optional<std::size_t> motion = track_->first_of_line(line, place_.motion + 1);
    if (motion && !track_->starts_block(*motion)) {
      motion = track_->first_of_line(line, track_->next_block(*motion));
    }
    if (motion) next_breakpoint_ = std::min(next_breakpoint_, *motion);
  }
}

void PlayerEngine::move_to(const TrackPosition& place) {
  if (place_ == place) return;
  place_ = place;
  changed_ = true;
}

/// Brings the workpiece to a place. False: the time was not enough.
bool PlayerEngine::reach(const TrackPosition& goal, Clock::time_point until) {
  const std::size_t needed = goal.motion + (goal.fraction > 0 ? 1 : 0);
  do {
    if (frontier_.reached() < needed) {
      frontier_.advance(needed);
    } else if (cursor_.approach(goal.motion)) {
      return true;
    }
  } while (Clock::now() < until);
  return false;
}

void PlayerEngine::work_seek(Clock::time_point until) {
  if (finding_count_ && !search_finding()) {
    frontier_.advance(track_->size());
    return;
  }
  if (!reach(goal_, until)) return;
  move_to(goal_);
  const bool play_on = play_on_;
  stand(goal_.motion == track_->size() ? PlayerStop::kProgramEnd : PlayerStop::kArrived);
  if (play_on) set_playing(speed_);
}

void PlayerEngine::work_run(Clock::time_point until) {
  const std::size_t goal = std::min(goal_.motion, next_breakpoint_);
  while (Clock::now() < until) {
    const TrackPosition next = track_->place_before(std::min(goal, place_.motion + kRunStep));
    if (!reach(next, until)) break;
    move_to(next);
    if (next.motion < goal) continue;
    const bool met = goal == next_breakpoint_ && goal < track_->size();
    return stand(met                      ? PlayerStop::kBreakpoint
                 : goal == track_->size() ? PlayerStop::kProgramEnd
                                          : PlayerStop::kArrived);
  }
}

void PlayerEngine::work_play(Clock::time_point now, Clock::time_point until) {
  const double time_s = anchor_s_ + speed_ * std::chrono::duration<double>(now - anchor_).count();
  TrackPosition target = track_->place_at(time_s);
  const bool halts = next_breakpoint_ < track_->size() && target.motion >= next_breakpoint_;
  if (halts) target = track_->place_before(next_breakpoint_);
  if (reach(target, until)) {
    behind_ = false;
    move_to(target);
    if (halts) return stand(PlayerStop::kBreakpoint);
    if (target.motion == track_->size()) stand(PlayerStop::kProgramEnd);
    return;
  }
  // Cutting takes longer than that: the clock waits for it.
  behind_ = true;
  if (cursor_.motion() > place_.motion && cursor_.motion() <= target.motion) {
    move_to(track_->place_before(cursor_.motion()));
  }
  anchor_ = Clock::now();
  anchor_s_ = place_.time_s;
}

PlayerEngine::Clock::time_point PlayerEngine::work() {
  const Clock::time_point now = Clock::now();
  const Clock::time_point until = now + kSlice;
  switch (mode_) {
    case PlayerMode::kSeeking:
      work_seek(until);
      return Clock::time_point::min();
    case PlayerMode::kRunning:
      work_run(until);
      return Clock::time_point::min();
    case PlayerMode::kPlaying:
      work_play(now, until);
      if (mode_ != PlayerMode::kPlaying || behind_) return Clock::time_point::min();
      break;
    case PlayerMode::kPaused:
      break;
  }
  if (options_.check_ahead && !frontier_.complete()) {
    while (!frontier_.complete() && Clock::now() < until) frontier_.advance(track_->size());
    refresh_findings();
    changed_ = true;
    return Clock::time_point::min();
  }
  return mode_ == PlayerMode::kPlaying ? now + options_.publish_period : Clock::time_point::max();
}

PlayerEngine::Clock::time_point PlayerEngine::state_due_at() const {
  const bool seeks = mode_ == PlayerMode::kSeeking;
  if (urgent_ && !seeks) return Clock::time_point::min();
  if (!changed_ && !seeks) return Clock::time_point::max();
  const bool moves = mode_ == PlayerMode::kPlaying || mode_ == PlayerMode::kRunning;
  return shown_ + (moves ? Clock::duration(options_.publish_period) : kProgressPeriod);
}

/// A copy of the list whenever it has grown; at the end once more, with the last depths.
void PlayerEngine::refresh_findings() {
  const std::vector<Finding>& kept = frontier_.findings().kept();
  if (kept.size() == findings_seen_ && findings_whole_ == frontier_.complete()) return;
  findings_seen_ = kept.size();
  findings_whole_ = frontier_.complete();
  findings_ = std::make_shared<const std::vector<Finding>>(by_time(kept, remarks_));
}

double PlayerEngine::seek_progress() const {
  if (mode_ != PlayerMode::kSeeking) return 1;
  const std::size_t goal = finding_count_ ? track_->size() : goal_.motion;
  const std::size_t at = std::min(goal, frontier_.reached());
  if (at <= seek_from_ || goal <= seek_from_) return 0;
  return static_cast<double>(at - seek_from_) / static_cast<double>(goal - seek_from_);
}

void PlayerEngine::describe_place(PlayerState& state) const {
  state.place = place_;
  state.elapsed_s = place_.time_s;
  state.remaining_s = track_->duration_s() - place_.time_s;
  if (track_->empty()) return;
  const bool at_end = place_.motion >= track_->size();
  state.motion = track_->motion(at_end ? track_->size() - 1 : place_.motion);
  const Motion& m = state.motion;
  const double t = at_end ? 1 : place_.fraction;
  state.tip_mm = at_end ? m.to_mm : t > 0 ? point_at(m, t) : m.from_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    state.abc_deg[i] = m.from_abc_deg[i] + t * (m.to_abc_deg[i] - m.from_abc_deg[i]);
  }
  state.uvw_mm = m.from_uvw_mm + t * (m.to_uvw_mm - m.from_uvw_mm);
  state.cutter = frontier_.record().cutter_of_tool(m.tool, place_.motion);
}

std::shared_ptr<const PlayerState> PlayerEngine::take_state() {
  refresh_findings();
  auto state = std::make_shared<PlayerState>();
  state->number = ++states_;
  const bool on_the_way = mode_ == PlayerMode::kSeeking || mode_ == PlayerMode::kRunning;
  state->commands_done = on_the_way && ticket_ > 0 ? ticket_ - 1 : ticket_;
  state->mode = mode_;
  state->stop = stop_;
  state->speed = speed_;
  state->behind = behind_;
  state->seek_progress = seek_progress();
  state->message = message_;
  shown_place_ = place_;
  describe_place(*state);
  // While a seek is on its way the cursor is elsewhere; the old picture stands for the old place.
  const bool cuts = place_.fraction > 0 && frontier_.record().cuts(place_.motion);
  const TrackPosition shown{place_.motion, cuts ? place_.fraction : 0, 0};
  if (!picture_ || (!(shown == picture_place_) && cursor_.motion() == place_.motion)) {
    picture_ = cursor_.picture(shown.fraction);
    picture_place_ = shown;
    ++pictures_;
  }
  state->stock = picture_;
  state->stock_number = pictures_;
  state->findings = findings_;
  state->motions_checked = frontier_.reached();
  state->keyframes = store_.count();
  state->keyframe_bytes = store_.bytes();
  state->worst_seek_s = store_.worst_s();
  shown_ = Clock::now();
  changed_ = urgent_ = false;
  return state;
}

}  // namespace kerf
