// What a watch has come to: LiveSession's report and outcome.
#include <algorithm>

#include "base/translate.h"
#include "twin/live/live_session.h"
#include "twin/report/sheet_report.h"

namespace kerf {

void LiveSession::conclude() {
  live_.status = source_status_;
  live_.facts = shift_->facts();
  live_.facts.samples = samples_;
  live_.runs = shift_->past();
  live_.dropped = queue_.dropped();
  live_.duration_s = t_s_;
  if (t_s_ > 0) live_.rate_hz = static_cast<double>(live_.facts.samples - 1) / t_s_;
  if (!ages_ms_.empty()) {
    std::sort(ages_ms_.begin(), ages_ms_.end());
    live_.age_median_ms = static_cast<double>(ages_ms_[ages_ms_.size() / 2]);
    live_.age_p99_ms = static_cast<double>(ages_ms_[ages_ms_.size() * 99 / 100]);
  }
  if (first_ && first_->sample.device_ns != AxisSample::kNoTime) {
    live_.clock_offset_s =
        static_cast<double>(first_->sample.host_ns - first_->sample.device_ns) * 1e-9;
  }
  const LiveCutter& cutter = shift_->cutter();
  live_.load = cutter.loads().report();
  if (const ProgramAhead* program = cutter.program()) {
    report_.program = program->summary();
    if (!program->complete()) report_.program.stopped_early = true;
    // Of a program that was not read to its end the interpreter only says that it was stopped.
    if (program->complete()) {
      add_interpreter_findings(program->diagnostics(), report_.program.end_remarked,
                               report_.findings);
    }
  }
  report_.time_model = options_.log() ? tr("as logged") : tr("as it happened");
  report_.motion.duration_s = t_s_;
  report_.tools = shift_->tools();
  report_.collisions = cutter.stage().process().collisions();
  report_.pieces = cutter.stage().process().loose();
  report_.stock = stock_report(shift_->stock(), stock_facts_);
  if (const Sheet* const sheet = shift_->stock().sheet()) {
    report_.sheet = sheet_report(*sheet, cutter.stage().process(), options_.beam.density_kg_per_m3);
  }
  if (shift_->stock().turned()) {
    report_.turning =
        turning_report(shift_->stock(), cutter.stage().process(), options_.beam.density_kg_per_m3);
  }
  report_.timing.total_s = std::chrono::duration<double>(Clock::now() - start_).count();
  report_.peak_rss_mb = peak_rss_mb();
  if (stopped_ && options_.log())
    report_.partial_reason = tr("interrupted before the end of the log");
  report_.live = live_;
}

Outcome LiveSession::outcome() const {
  // A log that is stopped is not finished; a machine is watched until somebody stops.
  if (stopped_ && options_.log()) return Outcome::kInterrupted;
  const LiveReport& live = live_;
  const bool gone = !options_.log() && last_state_ != LiveState::kLive;
  // A machine that could not be asked while it stood has lost nothing; a damaged log has.
  const bool damaged = options_.log() && live.status.errors > 0;
  const bool lossy = live.dropped > 0 || live.status.lost > 0 || damaged || live.facts.gaps > 0 ||
                     live.facts.incomplete > 0 || live.facts.wild > 0 || is_at_fault(live.status) ||
                     gone;
  return lossy ? Outcome::kLossy : Outcome::kFinished;
}

}  // namespace kerf
