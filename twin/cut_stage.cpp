#include "twin/cut_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "twin/blank_choice.h"
#include "twin/motion_geometry.h"
#include "twin/planned_pieces.h"
#include "twin/probe_contact.h"

namespace kerf {
namespace {

/// Moves handed to the model at once: many enough that the call costs nothing, few enough to stay
/// in the cache.
constexpr std::size_t kMovesPerCut = 4096;
/// Motion::unknown_to: X, Y and Z.
constexpr std::uint8_t kAllUnknown = 7;
/// Of moves that cost much (tilted tools, long ways on fine cells) fewer, so that a stop is seen in
/// time: as many as take about so long.
constexpr double kCut_s = 0.05;
constexpr std::size_t kLeastMovesPerCut = 1;
constexpr double kSearchShare = 0.5;
/// To begin with, while nobody knows: of upright tools.
constexpr std::size_t kFirstMovesPerCut = 64;
/// Of tilted ones at most: moves in the air say nothing of those in the material behind them. An
/// octree takes no more at once.
constexpr std::size_t kMostTiltedMovesPerCut = 512;
/// From one cut to the next at most so many times as many.
constexpr double kGrowth = 4;
/// Rounded limits of an INI are no finding.
constexpr double kOverFeed = 1.01;

/// Of the moves of one motion, to share its time: as far as they go, and as they turn.
double way_of(const CutMove& move) {
  return glm::length(move.to_mm - move.from_mm) + glm::length(move.axis_to - move.axis_from);
}

/// Beams and punches go through whatever the length of the tool: they are taken as programmed.
bool displaced(const Motion& motion) { return motion.length.displaces; }

}  // namespace

CutStage::CutStage(StockModel& stock, ToolBook& tools, FindingLog& log,
                   const TimelineOptions& options)
    : stock_(stock),
      book_(tools),
      log_(log),
      limits_known_(options.limits_known),
      limits_origin_(options.planner.limits_origin),
      kinematics_(options.kinematics),
      joint_limits_(options.joint_limits),
      timeline_(options, *this),
      checks_(stock, log),
      program_(stock, log),
      load_meter_(stock),
      lengths_(stock.bounds_mm(), log),
      films_(stock, log),
      axis_limits_(options.limits, log),
      moves_per_cut_(stock.takes_tilted_tools() ? kLeastMovesPerCut : kFirstMovesPerCut) {
  moves_.reserve(kMovesPerCut);
  in_flight_.reserve(2 * kMovesPerCut);
  reports_.reserve(2 * kMovesPerCut);
}

void CutStage::set_frame(const WorkpieceFrame& frame) {
  axis_limits_.set_frame(frame);
  if (!kinematics_) return;
  const ToolPath* const before = machine_moves_.path();
  const Result<bool> follows = machine_moves_.follow(kinematics_, frame, stock_.cell_mm());
  assert(follows);  // who made the machine has tried it
  if (before != nullptr && !follows.value()) return;
  motion_moves_ =
      stock_.takes_tilted_tools() ? machine_moves_ : MotionMoves::of(stock_, kinematics_, frame);
  if (!rotary_check_) rotary_check_.emplace(*machine_moves_.path(), joint_limits_);
}

void CutStage::set_materials(std::span<const TorchMaterial> materials) {
  timeline_.set_materials(materials);
  if (torch_) torch_->set_materials(materials);
}

void CutStage::go_on_from(const CutStage& other) {
  if (torch_) torch_->go_on_from(*other.torch_);
  if (punch_) punch_->go_on_from(*other.punch_);
}

void CutStage::take(std::span<const Motion> motions) {
  for (const Motion& motion : motions) {
    ++taken_;
    timeline_.push(motion);
  }
  flush();
}

void CutStage::take_timed(const Motion& motion, const TimedStep& timed,
                          std::span<const PathPiece> path) {
  timed_ = true;
  ++taken_;
  step(motion, timed, path);
}

void CutStage::hold_reports() {
  holding_ = true;
  report_from_ = kNever;
}

void CutStage::step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) {
  if (holding_) {
    log_.set_muted(true);
    if (stepped_ == report_from_) begin_reporting();
  }
  ++stepped_;
  path_ = path;
  work_searched_ = 0;
  work_of_step_ = work_of(motion);
  if (!stop_now()) cut(motion, timed);
  work_before_ += work_of_step_;
  if (work_done_) *work_done_ = work_before_;
  log_.set_muted(false);
}

/// Of a motion whose contacts are looked for that is half of what is to be done.
void CutStage::note_search(double share) {
  if (!work_done_ || !path_.empty()) return;
  work_searched_ = kSearchShare * share * work_of_step_;
  *work_done_ = work_before_ + work_searched_;
}

bool CutStage::stop_now() {
  stopped_ = stopped_ || stop_.stop_requested();
  return stopped_;
}

double CutStage::work_of(const Motion& m) {
  double turned_deg = 0;
  for (std::size_t i = 0; i < 3; ++i) turned_deg += std::abs(m.to_abc_deg[i] - m.from_abc_deg[i]);
  return path_length_mm(m) + turned_deg;
}

void CutStage::begin_reporting() {
  flush_whole();
  checks_.forget_events();
  lengths_.forget();
  films_.forget();
  program_.forget_events();
  speed_unsaid_.reset();
  axis_limits_.forget_events();
  timeline_.begin_totals();
  uses_.clear();
  deepest_.clear();
  if (torch_) torch_->begin_reporting();
  if (punch_) punch_->begin_reporting();
  mounted_ = nullptr;
  feed_missing_reported_ = drawn_told_ = false;
  machine_place_told_ = unknown_feed_told_ = false;
  over_feed_ = {};
  invented_limits_told_ = false;
  holding_ = false;
  log_.set_muted(false);
}

void CutStage::finish(bool whole) {
  timeline_.finish();
  flush_whole();
  if (holding_) begin_reporting();  // with nothing
  report_over_feed();
  if (torch_) {
    torch_->finish(whole);
    return;
  }
  if (punch_) {
    punch_->finish(whole);
    return;
  }
  program_.finish(whole);
  if (whole && !stopped_) report_nothing_cut();
  report_coarse_cells();
  for (ToolUse& use : uses_) {
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

void CutStage::cut(const Motion& m, const TimedStep& step) {
  axis_limits_.check(m, step);
  if (!watched_) program_.watch_lost_feed(m, step);
  // Of strokes that nobody knows the place of the punch tells.
  if (!punch_ && (m.unknown_from | m.unknown_to) != 0) report_unknown_place(m, step);
  if (m.from_uvw_mm != m.to_uvw_mm) check_slides(m, step);
  if (punch_) {
    if (is_feed(m) && m.start_known) note_speed(m, step);
    punch_->take(displaced(m) ? as_programmed(m) : m, step);
    return;
  }
  check_turns(m, step);
  if (torch_) {
    if (is_feed(m) && m.start_known) note_speed(m, step);
    torch_->take(displaced(m) ? as_programmed(m) : m, step, path_);
    return;
  }
  watch_program(m, step);
  if (m.kind == MotionKind::kToolChange || m.tool != spindle_tool_) {
    flush_whole();  // with the cutter that made these moves
    checks_.end_spindle_event();
    spindle_tool_ = m.tool;
    mounted_ = nullptr;
  }
  if (!stands(m) && checks_.spindle_event_open()) {
    flush_whole();  // the depths still to come belong to the event
    checks_.end_spindle_event();
  }
  if (is_traverse(m)) {
    take_traverse(m, step);
  } else if (is_feed(m)) {
    take_feed(m, step);
  }
}

/// Mounts the tool of this motion if that has not been done since the last change. True if it can
/// cut.
bool CutStage::mount_for(const Motion& m) {
  if (mounted_) return mounted_->cutter.has_value();
  mounted_ = &book_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
  announce(*mounted_, m);
  return mounted_->cutter.has_value();
}

void CutStage::take_traverse(const Motion& m, const TimedStep& step) {
  // With an empty spindle a comment without a number waits for the first feed move: the traverse
  // may just clear the way for the tool change that the comment announces.
  if (!mounted_ && m.tool == 0 && !book_.has_arguments()) return;
  // Nor does a move to where nobody knows say which tool is in the spindle: many programs begin so.
  if (m.to_machine_place || m.unknown_to == kAllUnknown) return;
  if (!mount_for(m) || !m.start_known) {
    check_length(m, step, false);
    return;
  }
  if (!divide(m, step)) return;
  if (!comes_near(m)) {
    check_length(m, step, false);
    checks_.clear_traverse();
    return;
  }
  const CheckedMove move{m, step, *mounted_->cutter, divided_, mounted_->number, mounted_->guessed};
  flush_whole();
  check_length(m, step, checks_.check_traverse(move));
  if (motion_moves_.is_upright(m)) checks_.check_floor(move);
  push(m, step, false);
}

void CutStage::take_feed(const Motion& m, const TimedStep& step) {
  if (stands_still(m)) return;
  const bool known = mount_for(m);
  check_length(m, step, false);
  if (!known) {
    report_undefined(m, step);
    return;
  }
  uses_[use_].feed_mm += step.length_mm;
  if (!m.start_known) return;
  if (!watched_) program_.feeds(m, step, mounted_->number);
  note_speed(m, step);
  if (!divide(m, step)) return;
  const CheckedMove move{m, step, *mounted_->cutter, divided_, mounted_->number, mounted_->guessed};
  if (!reached_stock_) note_reach(m);
  if (!watched_) note_contact(move);
  note_depth(m, step);
  if (motion_moves_.is_upright(m)) checks_.check_floor(move);
  const bool spindle_off = stands(m);
  if (spindle_off && !checks_.spindle_event_open() && comes_near(m)) check_standing(m, step, move);
  if (ProgramChecks::is_drill(move.cutter) && !program_.drill_told() &&
      ProgramChecks::goes_sideways(m) && comes_near(m)) {
    flush_whole();
    program_.check_drill(move);
  }
  push(m, step, spindle_off);
}

void CutStage::check_length(const Motion& m, const TimedStep& step, bool touches) {
  const double radius_mm = cutter() ? cutter()->radius_mm() : 0;
  lengths_.check(m, step, radius_mm, motion_moves_.is_upright(m), touches);
}

ProbeAnswer CutStage::answer(const ProbeQuestion& question) {
  timeline_.finish();  // the machine stands before it probes: no time changes
  flush_whole();
  ProbeAnswer unknown;
  const Motion& m = question.motion;
  if (!mount_for(m)) {
    unknown.why = fmt::format("nothing tells the shape of tool {}, the probe: --tool {}=SHAPE does",
                              m.tool, m.tool);
    return unknown;
  }
  divide(m, {});
  if (divided_.size() != 1) {
    unknown.why = "the tool or the workpiece turns";
    return unknown;
  }
  return probe_contact(stock_, *mounted_->cutter, divided_[0], question.away);
}

/// What it is cut as. False: it turns so far that it cannot be.
bool CutStage::divide(const Motion& m, const TimedStep& step) {
  divided_.clear();
  const bool done = motion_moves_.append(m, *mounted_->cutter, 0, divided_);
  if (!done) report_endless_turn(m, step);
  return done;
}

bool CutStage::comes_near(const Motion& m) const {
  const Cutter& cutter = *mounted_->cutter;
  return motion_moves_.is_upright(m) ? checks_.may_touch(m, cutter.radius_mm())
                                     : checks_.may_touch(divided_, cutter);
}

void CutStage::note_reach(const Motion& m) {
  if (comes_near(m)) {
    reached_stock_ = true;
    return;
  }
  for (const CutMove& move : divided_) {
    feed_bounds_mm_.extend(move.from_mm);
    feed_bounds_mm_.extend(move.to_mm);
  }
  if (divided_.size() == 1) feed_bounds_mm_.extend(bounds_of(m));
}

void CutStage::check_turns(const Motion& m, const TimedStep& step) {
  if (rotary_check_) {
    // Sensors tremble: between two samples they are no measure of speed.
    rotary_check_->check(m, watched_ ? 0 : step.duration_s, rotary_faults_);
    if (!rotary_faults_.empty()) report_rotary_faults(step);
  }
  if (!assumptions_told_ && !motion_moves_.is_upright(m)) report_assumptions(m);
  if (turn_reported_ || stock_.takes_tilted_tools()) return;
  if (m.from_abc_deg == m.to_abc_deg) return;
  // Of an axis that the machine has not, no model would turn anything.
  if (!rotary_check_ || rotary_check_->turns_something(m)) report_ignored_turn(m, step);
}

void CutStage::check_whole(const Motion& m, const TimedStep& step) {
  if (!rotary_check_ || !stock_.takes_tilted_tools() || motion_moves_.is_upright(m)) return;
  rotary_check_->check_pole(m, rotary_faults_);
  if (!rotary_faults_.empty()) report_rotary_faults(step);
}

void CutStage::note_depth(const Motion& m, const TimedStep& step) {
  Deepest& deepest = deepest_[use_];
  const double tip_z = std::min(m.from_mm.z, m.to_mm.z);
  if (tip_z >= deepest.tip_z_mm || !motion_moves_.is_upright(m) || !comes_near(m)) return;
  if (!deepest.cutter) {
    deepest.source = m.source;
    deepest.time_s = step.start_s;
    deepest.cutter = mounted_->cutter;
  }
  deepest.tip_z_mm = tip_z;
}

void CutStage::note_speed(const Motion& m, const TimedStep& step) {
  if (step.length_mm <= 0) return;
  if (step.programmed_mm_per_min <= 0) {
    report_missing_feed(m, step);
  } else if (step.programmed_mm_per_min > kOverFeed * step.allowed_mm_per_min) {
    if (over_feed_.count++ > 0) return;
    over_feed_ = {1, m.source, step.start_s, step.programmed_mm_per_min, step.allowed_mm_per_min};
  }
}

/// The programmed move, or what the machine makes of it.
void CutStage::push(const Motion& m, const TimedStep& step, bool spindle_off) {
  if (stop_now()) return;  // while its contacts were looked for
  if (path_.empty()) {
    push_moves(m, step, spindle_off);
    return;
  }
  for_each_piece(m, step, path_, [&](const Motion& piece, const TimedStep& part) {
    if (stopped_) return;
    if (!divide(piece, part)) return;
    push_moves(piece, part, spindle_off);
  });
}

/// Those of divide().
void CutStage::push_moves(const Motion& m, const TimedStep& step, bool spindle_off) {
  const std::uint64_t id = labels_ ? labels_->number_of({mounted_->number, m.source}) : next_id_++;
  double ways = 0;
  for (const CutMove& move : divided_) ways += way_of(move);
  InFlight flight;
  flight.duration_s = step.duration_s;
  flight.start_s = step.start_s;
  flight.source = m.source;
  flight.use = use_;
  flight.feed = is_feed(m);
  flight.spindle_off = spindle_off;
  measure(m, step, flight);
  std::size_t pushed = 0;
  for (CutMove& move : divided_) {
    move.id = id;
    moves_.push_back(move);
    if (!cut_parts_.empty()) flight.cut_part = cut_parts_[pushed];
    const double share = ways > 0 ? way_of(move) / ways : 1 / static_cast<double>(divided_.size());
    flight.duration_s = step.duration_s * share;
    in_flight_.push_back(flight);
    ++pushed;
    if (moves_.size() < moves_per_cut_) continue;
    flush();
    if (stop_now()) return;
    if (work_done_ && path_.empty()) {
      const double done = static_cast<double>(pushed) / static_cast<double>(divided_.size());
      *work_done_ = work_before_ + work_searched_ + done * (work_of_step_ - work_searched_);
    }
  }
}

void CutStage::flush() {
  if (moves_.empty()) return;
  const auto begin = std::chrono::steady_clock::now();
  stock_.cut(*mounted_->cutter, moves_, reports_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double fits = static_cast<double>(moves_.size()) * kCut_s / std::max(took.count(), 1e-6);
  const double grown = std::min(fits, kGrowth * static_cast<double>(moves_per_cut_));
  const std::size_t most = stock_.takes_tilted_tools() ? kMostTiltedMovesPerCut : kMovesPerCut;
  moves_per_cut_ = static_cast<std::size_t>(
      std::clamp(grown, static_cast<double>(kLeastMovesPerCut), static_cast<double>(most)));
  moves_.clear();
  collect_reports();
}

void CutStage::flush_whole() {
  flush();
  if (in_flight_.empty()) return;
  stock_.finish(reports_);
  collect_reports();
}

void CutStage::collect_reports() {
  assert(reports_.size() <= in_flight_.size());
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const CutReport& report = reports_[i];
    const InFlight& move = in_flight_[i];
    ToolUse& use = uses_[move.use];
    if (labels_) labels_->note(report.id, report.removed_mm3, move.duration_s);
    if (move.feed && !move.measured) {
      count_feed(use, move, report);
    } else {
      use.gap_mm = std::numeric_limits<double>::infinity();
    }
    // Of a groove that is narrower than a cell only the depth may be known.
    use.max_depth_mm = std::max(use.max_depth_mm, report.depth_mm);
    if (report.film.area_mm2 > 0 && !holding_)
      films_.take(report.film, {move.source, move.start_s, use.number});
    if (report.removed_mm3 <= 0) continue;
    use.removed_mm3 += report.removed_mm3;
    if (move.spindle_off && report.depth_mm > kContactTolerance_mm) {
      checks_.deepen_spindle_event(report.depth_mm);
    }
  }
  in_flight_.erase(in_flight_.begin(),
                   in_flight_.begin() + static_cast<std::ptrdiff_t>(reports_.size()));
  reports_.clear();
}

}  // namespace kerf
