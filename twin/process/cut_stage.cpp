#include "twin/process/cut_stage.h"

#include <cassert>
#include <cmath>

#include "twin/motion/motion_geometry.h"

namespace kerf {
CutStage::CutStage(StockModel& stock, ToolResolver& tools, FindingLog& log,
                   const TimelineOptions& options, const ProcessPlan& plan)
    : site_{stock,
            tools,
            log,
            FeedCheck(options.limits_known, options.planner.limits_origin, log),
            {},
            {},
            options.limits_known},
      traits_(plan.traits()),
      kinematics_(options.kinematics),
      joint_limits_(options.joint_limits),
      timeline_(options, *this),
      axis_limits_(options.limits, log),
      lost_feeds_(log),
      dwells_(log),
      process_(plan.make(site_)) {}

void CutStage::set_frame(const WorkpieceFrame& frame) {
  axis_limits_.set_frame(frame);
  site_.kinematics = kinematics_;
  site_.frame = frame;
  if (!kinematics_) {
    const bool may_mill = site_.stock.milling_cell_mm() > 0;
    if (may_mill && !site_.moves.mills())
      site_.moves = MotionMoves::of(site_.stock, nullptr, frame);
    return;
  }
  const ToolPath* const before = machine_moves_.path();
  const Result<bool> follows = machine_moves_.follow(kinematics_, frame, site_.stock.cell_mm());
  assert(follows);  // who made the machine has tried it
  if (before != nullptr && !follows.value()) return;
  site_.moves = site_.stock.takes_tilted_tools() ? machine_moves_
                                                 : MotionMoves::of(site_.stock, kinematics_, frame);
  if (!rotary_check_) rotary_check_.emplace(*machine_moves_.path(), joint_limits_);
}

void CutStage::set_materials(std::span<const TorchMaterial> materials) {
  timeline_.set_materials(materials);
  process_->set_materials(materials);
}

void CutStage::stop_by(const std::stop_token& stop) {
  site_.progress.stop_by(stop);
  process_->stop_by(stop);
}

void CutStage::take(std::span<const Motion> motions) {
  for (const Motion& motion : motions) {
    ++taken_;
    timeline_.push(motion);
  }
  hand_over();
}

void CutStage::take_timed(const Motion& motion, const TimedStep& timed,
                          std::span<const PathPiece> path) {
  site_.timed = true;
  ++taken_;
  step(motion, timed, path);
}

void CutStage::hold_reports() {
  site_.holding = true;
  report_from_ = kNever;
}

void CutStage::step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) {
  if (site_.holding) {
    site_.log.set_muted(true);
    if (stepped_ == report_from_) begin_reporting();
  }
  site_.motion = stepped_++;
  if (site_.recorder && !site_.holding) site_.recorder->on_step(site_.motion, motion, timed);
  site_.progress.begin_step(work_of(motion), path.empty());
  if (!site_.progress.stop_now()) cut(motion, timed, path);
  site_.progress.end_step();
  site_.log.set_muted(false);
}

double CutStage::work_of(const Motion& m) {
  double turned_deg = 0;
  for (std::size_t i = 0; i < 3; ++i) turned_deg += std::abs(m.to_abc_deg[i] - m.from_abc_deg[i]);
  return path_length_mm(m) + turned_deg;
}

void CutStage::begin_reporting() {
  process_->begin_reporting();
  axis_limits_.forget_events();
  timeline_.begin_totals();
  site_.feeds.forget();
  dwells_.forget();
  machine_place_told_ = unknown_feed_told_ = false;
  invented_limits_told_ = false;
  site_.holding = false;
  site_.log.set_muted(false);
}

void CutStage::finish(bool whole) {
  timeline_.finish();
  complete();
  if (site_.holding) begin_reporting();  // with nothing
  // Of a machine that was made up one note is enough.
  if (!invented_limits_told_) site_.feeds.report();
  dwells_.report();
  process_->finish(whole);
}

ProbeAnswer CutStage::answer(const ProbeQuestion& question) {
  timeline_.finish();  // the machine stands before it probes: no time changes
  return process_->answer(question);
}

void CutStage::cut(const Motion& m, const TimedStep& step, std::span<const PathPiece> path) {
  axis_limits_.check(m, step);
  if (!site_.watched) lost_feeds_.watch(m, step);
  dwells_.note(m, step);
  if (traits_.turns && (m.unknown_from | m.unknown_to) != 0) report_unknown_place(m, step);
  if (m.from_uvw_mm != m.to_uvw_mm) check_slides(m, step);
  if (traits_.turns) check_turns(m, step);
  const bool is_displaced = !traits_.by_length && m.length.displaces;
  if (is_displaced) {
    process_->take(as_programmed(m), step, path);
  } else {
    process_->take(m, step, path);
  }
}

void CutStage::check_turns(const Motion& m, const TimedStep& step) {
  if (rotary_check_) {
    // Sensors tremble: between two samples they are no measure of speed.
    rotary_check_->check(m, site_.watched ? 0 : step.duration_s, rotary_faults_);
    if (!rotary_faults_.empty()) report_rotary_faults(step);
  }
  if (!assumptions_told_ && !site_.moves.is_upright(m)) report_assumptions(m);
  // On a lathe the process knows what C turns.
  if (turn_reported_ || site_.stock.takes_tilted_tools() || site_.stock.turned()) return;
  if (m.from_abc_deg == m.to_abc_deg) return;
  // Of an axis that the machine has not, no model would turn anything.
  if (!rotary_check_ || rotary_check_->turns_something(m)) report_ignored_turn(m, step);
}

void CutStage::check_whole(const Motion& m, const TimedStep& step) {
  if (!rotary_check_ || !site_.stock.takes_tilted_tools() || site_.moves.is_upright(m)) return;
  rotary_check_->check_pole(m, rotary_faults_);
  if (!rotary_faults_.empty()) report_rotary_faults(step);
}

}  // namespace kerf
