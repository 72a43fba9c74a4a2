#include "interp_bridge/timing/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "base/block_copy.h"
#include "base/portable_math.h"
#include "base/translate.h"
#include "base/triple.h"
#include "interp_bridge/timing/lookahead.h"
#include "interp_bridge/timing/merge.h"
#include "interp_bridge/timing/schedule.h"

namespace kerf {
namespace {

bool is_move(MotionKind kind) { return kind <= MotionKind::kProbe; }

bool per_revolution(const Motion& m) { return m.feed_per_rev || m.kind == MotionKind::kThread; }

double programmed_per_minute(const Motion& m) {
  if (m.kind == MotionKind::kTraverse) return 0;
  if (!per_revolution(m)) return m.feed_mm_per_min;
  return m.feed_mm_per_min * peak_spindle_rpm(m).rpm;
}

SegmentEnd end_of(PathMode mode) {
  switch (mode) {
    case PathMode::kExactStop:
      return SegmentEnd::kStop;
    case PathMode::kExactPath:
      return SegmentEnd::kExact;
    case PathMode::kContinuous:
      break;
  }
  return SegmentEnd::kParabolic;
}

/// An arc so flat that LinuxCNC takes two lines for it; `middle` is where they meet.
bool flat_arc(const Motion& m, Vec3& middle) {
  if (m.path_mode != PathMode::kContinuous || m.merge_tolerance_mm <= 0) return false;
  if (std::abs(m.arc.axis.z) < 0.9999 || std::abs(m.arc.sweep_rad) >= 2 * kPi) return false;
  const Vec3 out = m.from_mm - m.arc.center_mm;
  const double radius = portable::hypot(out.x, out.y);
  const double half = m.arc.sweep_rad / 2 * (m.arc.axis.z < 0 ? -1.0 : 1.0);
  if (radius * (1.0 - portable::cos(half)) >= static_cast<double>(m.merge_tolerance_mm))
    return false;
  const double c = portable::cos(half);
  const double s = portable::sin(half);
  middle = {m.arc.center_mm.x + c * out.x - s * out.y, m.arc.center_mm.y + s * out.x + c * out.y,
            (m.from_mm.z + m.to_mm.z) / 2};
  return true;
}

/// Goes back where `m` came from: the way out of a rigid tap.
template <class Step>
bool returns(const Step& m, const Motion& next) {
  return next.from_mm == m.to_mm && next.to_mm == m.from_mm;
}

/// Servo periods from the end of a rigid tap's way on until the spindle turns the other way, and
/// back to there. Measured, as is the next one, with a spindle that turns round at once.
constexpr double kSpindleTurnPeriods = 4;
/// Servo periods from the spindle's index to the first that moves.
constexpr double kIndexSeenPeriods = 1.5;

constexpr std::size_t kFirstSpindleSteps = 64;

}  // namespace

struct TrajectoryPlanner::Impl final : MotionPlanSink {
  Impl(const MachineLimits& machine, const PlannerOptions& wanted, MotionPlanSink& receiver)
      : limits(machine),
        options(wanted),
        rates(machine),
        sink(receiver),
        schedule(*this, wanted.with_path),
        lookahead(rates, schedule),
        spindle(wanted.spindle),
        spindle_steps(kFirstSpindleSteps) {}

  void timed(const MotionTiming& timing) override;
  void path(const PathPiece& piece) override { sink.path(piece); }

  void push(const Motion& m);
  void move(const Motion& m);
  void straight(const Motion& m, const StraightRates& way, double allowed);
  void thread(const Motion& m, const MotionTiming& timing, const StraightRates& way, double speed);
  void run_thread(const Motion* next);
  void add_to_chain(const Vec3& from, const Vec3& to, const Motion& m);
  void flush_chain();
  void halt();
  void command_waits(const Motion& m);
  double halt_s() const;
  double io_done_s(double from_s, int looks);
  double io_wait_s(int looks);
  double sent_s() const;
  void prepare_tool(const Motion& m);
  std::uint32_t held_pieces() const;
  void take_tool_number(const Motion& m);
  std::uint64_t add_piece(double length_mm);
  double index_wait_s(const Motion& m);
  void wait_for_spindle(const Motion& m);
  SpindleFeed feed_speed(const Motion& m, double length_mm, double most_mm_per_s,
                         std::uint64_t step);
  void change_tool(const Motion& m);
  void stand(const Motion& m, double seconds);

  MachineLimits limits;
  PlannerOptions options;
  AxisRates rates;
  MotionPlanSink& sink;
  Schedule schedule;
  Lookahead lookahead;
  MergeChain chain;
  /// A straight feed that nothing is merged with. LinuxCNC holds it back too, until what comes next
  /// shows that it cannot be.
  std::optional<Segment> feed_waits;
  Motion chain_motion;  ///< its first
  bool chain_keeps_start = false;
  /// Where the machine stands and what is switched on.
  struct Stand {
    MotionKind kind = MotionKind::kTraverse;
    SpindleState spindle = SpindleState::kStopped;
    bool flood = false, mist = false;
    SourceRef source;
    Vec3 from_mm{0}, to_mm{0};
    std::array<double, 3> to_abc_deg{};
    Vec3 to_uvw_mm{0};
    double spindle_rpm = 0;
    SurfaceSpeed surface;

    void take(const Motion& m) {
      kind = m.kind;
      spindle = m.spindle;
      flood = m.flood;
      mist = m.mist;
      source = m.source;
      from_mm = m.from_mm;
      to_mm = m.to_mm;
      to_abc_deg = m.to_abc_deg;
      to_uvw_mm = m.to_uvw_mm;
      spindle_rpm = m.spindle_rpm;
      surface = m.surface;
    }
  };
  Stand last;
  bool begun = false;
  std::uint32_t queued = 0;  ///< pieces since the machine stood
  double stood_s = 0;        ///< when the first of them was queued
  double index_s = -1;       ///< a moment of the spindle's index pulse; -1: none known
  /// The last motion, if it is a thread: how it ends depends on the one after it.
  struct Thread {
    Motion motion;
    MotionTiming timing;
    double length = 0;
    double speed = 0;
    double accel = 0;
    double fastest = 0;     ///< that the axes do
    bool retracts = false;  ///< the way out of a rigid tap
    bool goes_on = false;   ///< of a thread before it: it is in step with the spindle already
  };
  std::optional<Thread> thread_waits;
  double turning_round_s(const Thread& thread) const;
  double io_phase_s = -1;  ///< a moment at which the I/O task looked; -1: none known
  double io_free_s = 0;    ///< it has done all it was told
  std::uint64_t stops = 0;
  /// Where its acceleration is known: the spindle as it is at spindle_s of the clock, and the
  /// motions that have not been timed yet.
  SpindleSpeed spindle;
  double spindle_s = 0;
  struct SpindleStep {
    Motion motion;
    double end_rpm = -1;  ///< of a feed under G96; negative: to be followed
  };
  Ring<SpindleStep> spindle_steps;
  std::uint64_t chain_step = 0;  ///< the last motion of the chain
  bool awaits_speed = false;     ///< the next feed waits until the spindle is at speed
  double feed_rpm = -1;          ///< at the end of the last feed under G96; negative: as commanded
};

void TrajectoryPlanner::Impl::timed(const MotionTiming& timing) {
  if (options.spindle.known()) {
    const auto& [m, end_rpm] = spindle_steps.front();
    spindle.stand(commanded_rpm(m, 0), timing.start_s - spindle_s);
    spindle.follow(m, timing.duration_s, timing.way, end_rpm);
    spindle_s = timing.start_s + timing.duration_s;
    spindle_steps.pop_front();
  }
  sink.timed(timing);
}

/// Ends the path here: the machine stands when everything queued is done.
void TrajectoryPlanner::Impl::halt() {
  run_thread(nullptr);
  flush_chain();
  lookahead.drain();
  queued = 0;
}

std::uint64_t TrajectoryPlanner::Impl::add_piece(double length_mm) {
  if (queued++ == 0) stood_s = schedule.clock_s();
  return schedule.add_piece(length_mm);
}

void TrajectoryPlanner::Impl::flush_chain() {
  if (feed_waits) lookahead.add(*feed_waits);
  feed_waits.reset();
  if (chain.empty()) return;
  const Vec3 to = chain.last();
  const StraightRates way = straight_rates(rates, to - chain.start(), {});
  if (way.length > 0) {
    chain_motion.to_mm = to;
    const double most = std::min(way.speed, rates.linear_cap);
    const SpindleFeed feed = feed_speed(chain_motion, way.length, most, chain_step);
    Segment segment = make_line(chain.start(), to, way, feed.mean);
    segment.end = SegmentEnd::kParabolic;
    if (chain_motion.feed_per_rev) follow_spindle(segment, feed);
    segment.keeps_start = chain_keeps_start;
    segment.tolerance_mm = chain.tolerance_mm();
    segment.first_piece = chain.first_piece();
    segment.piece_count = chain.piece_count();
    lookahead.add(segment);
  } else {
    // The merged moves return to where they began: LinuxCNC drops them.
    lookahead.drain();
    schedule.drop_pieces(chain.piece_count());
  }
  chain.clear();
}

/// When a command that is sent at `from_s` is done. The I/O task looks once in its period; a
/// command waits for that many looks, behind those that were sent before. Where in its period it
/// was when the program began is not known: half a period then.
double TrajectoryPlanner::Impl::io_done_s(double from_s, int looks) {
  const double period = limits.io_period_s;
  const double begin_s = std::max(from_s, io_free_s);
  if (looks <= 0 || period <= 0) return begin_s;
  double wait = period / 2;
  if (io_phase_s >= 0) {
    const double since = begin_s - io_phase_s;
    wait = period * (std::floor(since / period) + 1.0) - since;
  }
  wait += (looks - 1) * period;
  io_phase_s = begin_s + wait;
  io_free_s = io_phase_s;
  return io_free_s;
}

/// From now on.
double TrajectoryPlanner::Impl::io_wait_s(int looks) {
  const double now = schedule.clock_s();
  return io_done_s(now, looks) - now;
}

/// When the task comes to what is sent while moves are under way: it has run ahead of them.
double TrajectoryPlanner::Impl::sent_s() const {
  return queued == 0 ? schedule.clock_s() : stood_s;
}

/// The T word is sent behind what is in the look-ahead, and what comes after it when the tool is
/// prepared. The machine stops if it has nothing to do until then.
void TrajectoryPlanner::Impl::prepare_tool(const Motion& m) {
  if (m.tool_prepare != ToolPrepare::kAheadOfLast) flush_chain();
  run_thread(nullptr);
  const double done_s = io_done_s(sent_s(), kToolPrepareLooks);
  if (lookahead.end_s() > done_s) {
    lookahead.next_comes_at(done_s);
    return;
  }
  lookahead.drain();
  schedule.pause(std::max(done_s - schedule.clock_s(), 0.0) + halt_s());
  stood_s = schedule.clock_s();
  queued = held_pieces();
}

std::uint32_t TrajectoryPlanner::Impl::held_pieces() const {
  return feed_waits ? feed_waits->piece_count : chain.piece_count();
}

void TrajectoryPlanner::Impl::change_tool(const Motion& m) {
  halt();
  // Where the machine goes to a place first, the I/O task has begun before (Motion::io_halts).
  const bool goes_there = begun && is_move(last.kind) && last.source == m.source;
  const int looks = goes_there ? kToolChangeLooks - 1 : kToolChangeLooks;
  stand(m, io_wait_s(looks) + options.tool_change_s + kReadOn_s);
}

/// M61 has been sent to the I/O task; the program is read on when all is done.
void TrajectoryPlanner::Impl::take_tool_number(const Motion& m) {
  halt();
  stand(m, halt_s() + io_wait_s(0) + kReadOn_s);
}

/// What the program switched between the last motion and this one. What M2 switches off comes
/// behind the last move.
void TrajectoryPlanner::Impl::command_waits(const Motion& m) {
  const bool ends = m.kind == MotionKind::kProgramEnd;
  const bool halts = !ends && m.halts > 0;
  const bool turns = m.spindle != SpindleState::kStopped;
  const bool as_before = m.surface.on() ? m.surface == last.surface
                                        : !last.surface.on() && m.spindle_rpm == last.spindle_rpm;
  const bool switched = m.spindle != last.spindle || (turns && !as_before);
  // The tip of another tool is elsewhere, which is no command.
  const bool offset =
      m.kind != MotionKind::kToolChange &&
      !(is_equal(m.from_mm, last.to_mm) && is_equal(m.from_abc_deg, last.to_abc_deg) &&
        is_equal(m.from_uvw_mm, last.to_uvw_mm));
  int coolant = (m.flood != last.flood ? 1 : 0) + (m.mist != last.mist ? 1 : 0);
  // Switching coolant off is two commands, one for each kind.
  if ((last.flood && !m.flood) || (last.mist && !m.mist)) coolant = 2;
  if (!ends) coolant = std::max<int>(coolant, m.io_halts);
  if (switched) {
    index_s = -1;
    awaits_speed = turns;
  }
  if (!halts && !switched && !offset && coolant == 0) return;
  halt();
  schedule.pause(halt_s());
  if (switched && turns) schedule.pause(options.spindle_start_s);
  if (coolant > 0) schedule.pause(io_wait_s(coolant) + halt_s());
}

/// From standstill, or from the I/O task's look, to the next move. The task sees it half of its
/// period later.
double TrajectoryPlanner::Impl::halt_s() const { return options.halt_s + limits.task_period_s / 2; }

/// The machine stands until the spindle is at speed: before the first feed after it has been sent
/// to another one, and under G96 before the first after each traverse.
void TrajectoryPlanner::Impl::wait_for_spindle(const Motion& m) {
  if (m.kind == MotionKind::kTraverse) {
    if (m.surface.on()) awaits_speed = true;
    return;
  }
  const bool threads = m.kind == MotionKind::kThread && last.kind != MotionKind::kThread;
  if (!options.spindle.known() || m.spindle == SpindleState::kStopped) return;
  if (!awaits_speed && !threads) return;
  awaits_speed = false;
  flush_chain();
  lookahead.stop_last();
  halt();
  const double commanded = commanded_rpm(m, 0);
  spindle.stand(commanded, schedule.clock_s() - spindle_s);
  schedule.pause(spindle.wait_until_near(commanded));
  spindle_s = schedule.clock_s();
  feed_rpm = std::abs(spindle.rpm());
}

/// What the program makes of a motion's speed, mm/s. `step`: its place among spindle_steps.
SpindleFeed TrajectoryPlanner::Impl::feed_speed(const Motion& m, double length_mm,
                                                double most_mm_per_s, std::uint64_t step) {
  if (!per_revolution(m)) {
    feed_rpm = -1;
    return {.mean = m.feed_mm_per_min / 60.0};
  }
  const SpindleFeed feed =
      spindle_feed(m, m.feed_mm_per_min, length_mm, options.spindle, feed_rpm, most_mm_per_s);
  feed_rpm = feed.end_rpm;
  if (options.spindle.known() && m.surface.on()) spindle_steps[step].end_rpm = feed.end_rpm;
  return feed;
}

void TrajectoryPlanner::Impl::push(const Motion& m) {
  run_thread(&m);
  const bool standing = m.tool_prepare == ToolPrepare::kStanding;
  if (m.tool_prepare != ToolPrepare::kNone && !standing) prepare_tool(m);
  if (m.by_number && m.halts == 0) io_done_s(sent_s(), kToolNumberLooks);
  if (begun) command_waits(m);
  if (m.by_number && m.halts > 0) io_done_s(sent_s(), kToolNumberLooks);
  if (standing) prepare_tool(m);
  if (options.spindle.known()) spindle_steps.push() = {m, -1};
  switch (m.kind) {
    case MotionKind::kDwell:
      halt();
      schedule.pause(halt_s());
      stand(m, m.duration_s);
      break;
    case MotionKind::kToolChange:
      m.by_number ? take_tool_number(m) : change_tool(m);
      break;
    case MotionKind::kStop:
      ++stops;
      stand(m, 0);
      break;
    case MotionKind::kProgramEnd:
    case MotionKind::kSignal:
      stand(m, 0);
      break;
    default:
      move(m);
      break;
  }
  last.take(m);
  begun = true;
}

void TrajectoryPlanner::Impl::stand(const Motion& m, double seconds) {
  halt();
  schedule.alone(m, {}, seconds, 0);
}

void TrajectoryPlanner::Impl::move(const Motion& m) {
  if (m.chain_end != ChainEnd::kNone) flush_chain();
  MotionTiming timing;
  timing.programmed_mm_per_min = programmed_per_minute(m);
  const StraightRates way = straight_rates(rates, m.to_mm - m.from_mm, extra_way(m));
  const bool arc = m.kind == MotionKind::kArc && has_radius(m);
  const bool traverse = m.kind == MotionKind::kTraverse;
  const bool moves = arc ? m.arc.sweep_rad != 0 : way.length > 0;
  const bool fed = traverse || timing.programmed_mm_per_min > 0;
  if (!m.start_known || !moves || !fed) {
    // The machine is simply there afterwards; a move of no length does not even stop it.
    if (moves || !m.start_known) halt();
    schedule.open_motion(timing.programmed_mm_per_min, timing.allowed_mm_per_min, 0);
    return;
  }
  wait_for_spindle(m);
  const double cap = way.linear ? rates.linear_cap : rates.angular_cap;
  if (!arc) {
    const double allowed = std::min(way.speed, cap);
    timing.allowed_mm_per_min = allowed * 60.0;
    if (m.kind == MotionKind::kThread) {
      flush_chain();
      lookahead.stop_last();
      halt();
      thread(m, timing, way, timing.programmed_mm_per_min / 60.0);
      return;
    }
    schedule.open_motion(timing.programmed_mm_per_min, timing.allowed_mm_per_min, 1);
    straight(m, way, allowed);
    return;
  }
  const double programmed = timing.programmed_mm_per_min / 60.0;
  Segment segment = make_arc(rates, m, programmed);
  timing.allowed_mm_per_min = std::min(segment.max_speed, rates.linear_cap) * 60.0;
  Vec3 middle;
  if (!segment.extra && flat_arc(m, middle)) {
    schedule.open_motion(timing.programmed_mm_per_min, timing.allowed_mm_per_min, 2);
    add_to_chain(m.from_mm, middle, m);
    add_to_chain(middle, m.to_mm, m);
    return;
  }
  flush_chain();
  if (m.feed_per_rev) {
    follow_spindle(segment,
                   feed_speed(m, segment.length_mm, segment.max_speed, spindle_steps.end() - 1));
  } else {
    feed_rpm = -1;
  }
  schedule.open_motion(timing.programmed_mm_per_min, timing.allowed_mm_per_min, 1);
  segment.end = end_of(m.path_mode);
  segment.tolerance_mm = static_cast<double>(m.blend_tolerance_mm);
  segment.piece_count = 1;
  segment.first_piece = add_piece(segment.length_mm);
  lookahead.add(segment);
}

void TrajectoryPlanner::Impl::straight(const Motion& m, const StraightRates& way, double allowed) {
  const bool mergeable = m.kind == MotionKind::kFeed && !way.extra &&
                         m.path_mode == PathMode::kContinuous && m.merge_tolerance_mm > 0;
  if (mergeable) {
    add_to_chain(m.from_mm, m.to_mm, m);
    return;
  }
  flush_chain();
  if (m.kind == MotionKind::kProbe) halt();
  const bool traverse = m.kind == MotionKind::kTraverse;
  SpindleFeed feed{.mean = std::numeric_limits<double>::infinity()};
  if (!traverse) feed = feed_speed(m, way.length, allowed, spindle_steps.end() - 1);
  if (traverse) feed_rpm = -1;
  Segment segment = make_line(m.from_mm, m.to_mm, way, feed.mean);
  if (m.feed_per_rev && m.kind == MotionKind::kFeed) follow_spindle(segment, feed);
  segment.keeps_start = m.chain_end == ChainEnd::kOutputs;
  segment.traverse = traverse;
  segment.end = end_of(m.path_mode);
  segment.tolerance_mm = static_cast<double>(m.blend_tolerance_mm);
  segment.piece_count = 1;
  segment.first_piece = add_piece(segment.length_mm);
  if (m.kind == MotionKind::kFeed) {
    feed_waits = segment;
    return;
  }
  lookahead.add(segment);
  if (m.kind == MotionKind::kProbe) halt();
}

/// Seconds until the spindle's next index pulse. Where it is when it has started is not known: half
/// a revolution then; but threads that follow each other wait for pulses whole revolutions apart.
double TrajectoryPlanner::Impl::index_wait_s(const Motion& m) {
  const double turn_s = 60.0 / m.spindle_rpm;
  const double now = schedule.clock_s();
  double wait = turn_s / 2;
  if (index_s >= 0) {
    const double since = now - index_s;
    wait = turn_s * std::ceil(since / turn_s) - since;
  }
  index_s = now + wait;
  return wait;
}

void TrajectoryPlanner::Impl::thread(const Motion& m, const MotionTiming& timing,
                                     const StraightRates& way, double speed) {
  const bool behind = begun && last.kind == MotionKind::kThread;
  const bool retracts = behind && returns(last, m);
  thread_waits = {m,           timing,    way.length, std::min(speed, way.speed),
                  way.accel(), way.speed, retracts,   behind && m.halts == 0};
}

/// Follows the spindle from its index pulse on: half of v / a late, as it has to speed up, and
/// where it stops as much later. Threads right behind each other stay in step with the spindle, and
/// do not stop. A rigid tap does not stop: LinuxCNC turns the spindle round at the
/// bottom and again at the top, and the axis goes back with it. The spindle has then turned back as
/// far as it had turned, but for what the axis was late.
/// What a spindle takes that turns round no faster than it can: at the bottom it runs on and comes
/// back to there, at the top it runs on until it stands, and the axis comes back by itself.
double TrajectoryPlanner::Impl::turning_round_s(const Thread& t) const {
  if (!options.spindle.known()) return 0;
  const double stopping_s = t.motion.spindle_rpm / options.spindle.accel_rpm_per_s;
  const double past_mm = t.speed * stopping_s / 2;
  return 3 * stopping_s +
         speed_profile(past_mm, t.accel / 2, 0, std::min(t.fastest, rates.linear_cap), 0)
             .duration_s;
}

void TrajectoryPlanner::Impl::run_thread(const Motion* next) {
  if (!thread_waits) return;
  const Thread t = *thread_waits;
  thread_waits.reset();
  const double late_s = t.speed / t.accel / 2;
  const double seen_s = kIndexSeenPeriods * rates.cycle_s;
  double seconds = t.length / t.speed;
  MotionTiming timing = t.timing;
  if (t.retracts) {
    seconds += 2 * kSpindleTurnPeriods * rates.cycle_s + turning_round_s(t);
  } else {
    const bool stands = next == nullptr || next->kind != MotionKind::kThread ||
                        (next->halts > 0 && !returns(t.motion, *next));
    const double waits_s = t.goes_on ? 0 : index_wait_s(t.motion) + seen_s;
    if (!t.goes_on) seconds += waits_s + late_s;
    if (stands) seconds += late_s;
    timing.way.set_ramps(t.length, t.accel, t.goes_on ? t.speed : 0, t.speed, stands ? 0 : t.speed);
    timing.way.in_time = static_cast<float>(waits_s / seconds);
  }
  schedule.alone(t.motion, timing, seconds, t.speed);
  if (t.retracts) index_s = schedule.clock_s() - late_s - seen_s;
}

/// Merged is what has one feed: under G96 of one per revolution, whatever becomes of it.
void TrajectoryPlanner::Impl::add_to_chain(const Vec3& from, const Vec3& to, const Motion& m) {
  const double tolerance = static_cast<double>(m.merge_tolerance_mm);
  const double blend = static_cast<double>(m.blend_tolerance_mm);
  const bool steady = !m.surface.on() || !m.feed_per_rev;
  const double speed = steady ? programmed_per_minute(m) / 60.0 : m.feed_mm_per_min;
  if (feed_waits) flush_chain();
  if (!chain.empty() &&
      !(chain.speed() == speed && chain.tolerance_mm() == blend && chain.links(to, tolerance))) {
    flush_chain();
  }
  const std::uint64_t piece = add_piece(glm::length(to - from));
  if (chain.empty()) {
    chain.begin(from, speed, blend, piece);
    copy_block(chain_motion, m);
    chain_motion.kind = MotionKind::kFeed;
    chain_motion.from_mm = from;
    chain_keeps_start = m.chain_end == ChainEnd::kOutputs;
  }
  chain.append(to);
  chain_step = spindle_steps.end() - 1;
}

TrajectoryPlanner::TrajectoryPlanner(const MachineLimits& limits, const PlannerOptions& options,
                                     MotionPlanSink& sink)
    : impl_(std::make_unique<Impl>(limits, options, sink)) {}

TrajectoryPlanner::~TrajectoryPlanner() = default;

void TrajectoryPlanner::push(const Motion& motion) {
  const double most = impl_->options.spindle.max_rpm;
  const double wanted = motion.surface.on() ? motion.surface.max_rpm : motion.spindle_rpm;
  if (most <= 0 || wanted <= most) return impl_->push(motion);
  Motion capped = motion;
  cap_speed(capped, most);
  impl_->push(capped);
}

void TrajectoryPlanner::hold(double seconds) {
  impl_->halt();
  impl_->schedule.pause(seconds);
}

void TrajectoryPlanner::finish() { impl_->halt(); }

double TrajectoryPlanner::clock_s() const { return impl_->schedule.clock_s(); }

std::uint64_t TrajectoryPlanner::stops() const { return impl_->stops; }

std::string TrajectoryPlanner::time_model() const {
  std::string axes;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    const AxisLimits& axis = impl_->limits.axes[i];
    if (!axis.present) continue;
    const char* const unit = is_rotary_axis(i) ? "deg" : "mm";
    axes += fmt::format("{}{} {:g} {}/s {:g} {}/s2", axes.empty() ? "" : ", ", kAxisLetters[i],
                        axis.max_velocity, unit, axis.max_acceleration, unit);
  }
  std::string cap = tr("no cap on the path's speed");
  if (std::isfinite(impl_->rates.linear_cap)) {
    cap = trf("at most {:g} mm/s along the path", impl_->rates.linear_cap);
  }
  // What stands before the first ": " is its short form, in every language.
  const std::string what = trf("LinuxCNC 2.9 trajectory planner, limits of {}",
                               tr(impl_->options.limits_origin.c_str()));
  std::string figures =
      trf("{}, {}, servo period {:g} ms; tool change {} I/O periods of {:g} s and {:g} s, spindle "
          "start {:g} s, M0 and M1 no time",
          axes, cap, impl_->rates.cycle_s * 1000.0, kToolChangeLooks, impl_->limits.io_period_s,
          impl_->options.tool_change_s, impl_->options.spindle_start_s);
  if (impl_->options.spindle.known()) {
    figures += trf(", spindle {:g} rpm/s", impl_->options.spindle.accel_rpm_per_s);
  }
  return fmt::format("{}: {}", what, figures);
}

}  // namespace kerf
