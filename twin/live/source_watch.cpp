#include "twin/live/source_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/live/way_cutter.h"

namespace kerf {
namespace {

/// What happens across a gap in which a machine moved less is nothing. mm.
constexpr double kGapMove_mm = 0.02;
/// Lost samples leave a gap if it is longer than this, and than so many usual periods: sources of
/// ten readings a second are believed.
constexpr double kShortGap_s = 0.1;
constexpr double kShortGapPeriods = 4;
/// Share of a new interval in the usual period.
constexpr double kPeriodShare = 0.05;
/// A jump is faster than the machine by this factor, and longer than this.
constexpr double kJumpFactor = 1.5;
constexpr double kJump_mm = 1.0;
/// Times are not exacter than this. What was held up on a busy computer follows in a burst: cycles
/// of a LinuxCNC without a real-time kernel, answers of a network, readings of a process that had
/// to wait between its stamp and its positions.
constexpr double kBurst_s = 0.05;

}  // namespace

Finding live_finding(FindingId id, Severity severity, double t_s, const Vec3& place_mm, int tool) {
  Finding finding;
  finding.id = id;
  finding.severity = severity;
  finding.time_s = t_s;
  finding.position_mm = place_mm;
  if (tool >= 0) finding.tool = tool;
  return finding;
}

SourceWatch::SourceWatch(const StockModel& stock, const LiveCutOptions& options, FindingLog& log,
                         LiveFacts& facts)
    : stock_(stock),
      options_(options),
      log_(log),
      facts_(facts),
      bounds_(options.frame, options.timeline),
      gate_(motion_bounds(options.frame, options.timeline, options.most), options.gap_s) {}

std::span<const SampleGate::Timed> SourceWatch::sift(const AxisSample& sample, double t_s,
                                                     bool lost) {
  passed_.clear();
  if (const std::size_t wild = gate_.take({sample, t_s, lost}, passed_)) note_wild(wild, t_s);
  return passed_;
}

std::span<const SampleGate::Timed> SourceWatch::finish() {
  passed_.clear();
  gate_.finish(passed_);
  return passed_;
}

bool SourceWatch::drops(const AxisSample& sample, double t_s) {
  const std::optional<std::string> fault = bounds_.fault_of(sample);
  if (!fault) return false;
  ++facts_.wild;
  if (wild_told_) return true;
  wild_told_ = true;
  Finding finding;
  finding.id = FindingId::kSourceGap;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text =
      *fault + tr(" (a damaged number? another type or unit than the device's?); such readings are "
                  "dropped and counted");
  log_.add(std::move(finding));
  return true;
}

/// Single readings that the gate has dropped.
void SourceWatch::note_wild(std::size_t count, double t_s) {
  facts_.wild += count;
  if (std::exchange(quick_told_, true)) return;
  Finding finding;
  finding.id = FindingId::kSourceGap;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text = gate_.fault() + tr(" (a damaged number?); such readings are dropped and counted");
  log_.add(std::move(finding));
}

/// As far as the tip has gone on the part, or what the axes have turned at the lever.
double SourceWatch::way_between(const Reading& before, const Reading& now) const {
  double turned_deg = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    turned_deg = std::max(turned_deg, std::abs(now.place.abc_deg[i] - before.place.abc_deg[i]));
  }
  double way_mm = std::max(glm::length(now.place.tip_mm - before.place.tip_mm),
                           glm::length(now.pose.origin_mm - before.pose.origin_mm));
  if (stock_.takes_tilted_tools()) {
    way_mm = std::max(way_mm, turned_deg * kPi / 180 * options_.follow.lever_mm);
  }
  return way_mm;
}

bool SourceWatch::too_fast(const Reading& before, const Reading& now) const {
  const double way_mm = glm::length(now.place.tip_mm - before.place.tip_mm);
  return way_mm > kJump_mm &&
         way_mm > kJumpFactor * options_.most_mm_per_s * (now.t_s - before.t_s + kBurst_s);
}

bool SourceWatch::is_long(double elapsed_s) const {
  return elapsed_s > std::max(kShortGap_s, kShortGapPeriods * period_s_);
}

SourceWatch::Break SourceWatch::break_between(const Reading& before, const Reading& now,
                                              bool lost) {
  const double elapsed_s = now.t_s - before.t_s;
  const bool fast = too_fast(before, now);
  // One jump is none of a machine; one after the other is a machine that is faster than is known.
  const bool was_fast = std::exchange(was_fast_, fast);
  // A sample that is missing in a quick row is no gap: the way is as short as between slow ones.
  const bool felt = lost && is_long(elapsed_s);
  period_s_ += kPeriodShare * (std::min(elapsed_s, options_.gap_s) - period_s_);
  if (now.restarted) return Break::kRestart;
  if (way_between(before, now) < kGapMove_mm) return Break::kNone;
  if (felt || elapsed_s > options_.gap_s) return Break::kGap;
  return fast && !was_fast ? Break::kJump : Break::kNone;
}

void SourceWatch::note_restart(const Reading& before, const Reading& now, bool runs,
                               SourceRef line) {
  const AxisSample& last = before.sample;
  const bool said_idle = last.program == ProgramState::kIdle ||
                         (last.program == ProgramState::kUnknown && last.line == 0);
  const bool at_rest = said_idle || !runs;
  const double way_mm = way_between(before, now);
  const double elapsed_s = now.t_s - before.t_s;
  if (!at_rest) {
    ++facts_.gaps;
    facts_.gap_s += elapsed_s;
    facts_.gap_max_mm = std::max(facts_.gap_max_mm, way_mm);
  }
  Finding finding =
      live_finding(FindingId::kSourceRestarted, at_rest ? Severity::kNote : Severity::kWarning,
                   now.t_s, now.pose.origin_mm, now.tool);
  finding.source = line;
  finding.text =
      at_rest ? trf("the controller ended and was started again, {:.1f} s without positions; no "
                    "program ran, and nothing is cut from where the machine stood to where it is, "
                    "{:.2f} mm away",
                    elapsed_s, way_mm)
              : trf("the controller ended in the middle of the program and was started again, "
                    "{:.1f} s without positions; what it did until it ended is not known and not "
                    "cut, the machine is {:.2f} mm further on",
                    elapsed_s, way_mm);
  log_.add(std::move(finding));
}

void SourceWatch::note_gap(const Reading& before, const Reading& now, bool jump, bool by_program,
                           SourceRef line) {
  const double way_mm = way_between(before, now);
  const double elapsed_s = now.t_s - before.t_s;
  // A machine that is homed says that it is elsewhere, and has not moved.
  const auto is_near = [&](const Vec3& tip_mm) {
    return is_near_blank(stock_, options_.process->traits().is_beam, tip_mm, tip_mm, 0);
  };
  const bool harmless = jump && !is_near(before.pose.origin_mm) && !is_near(now.pose.origin_mm);
  ++(harmless ? facts_.jumps : facts_.gaps);
  if (!harmless) {
    facts_.gap_s += elapsed_s;
    facts_.gap_max_mm = std::max(facts_.gap_max_mm, way_mm);
  }
  if (options_.gap == GapPolicy::kIgnore) return;
  Finding finding =
      live_finding(FindingId::kSourceGap, harmless ? Severity::kNote : Severity::kWarning, now.t_s,
                   now.pose.origin_mm, now.tool);
  finding.source = line;
  const char* what_then = tr("the way between is not cut (gap: cut would)");
  if (options_.gap == GapPolicy::kCut) what_then = tr("the way between is cut all the same");
  if (by_program) what_then = tr("the way between is cut as the program has it");
  if (jump) {
    finding.text = trf(
        "positions jump by {:.2f} mm within {:.3f} s, faster than the machine can be (homing? a "
        "wrong reading?); {}",
        way_mm, elapsed_s, what_then);
  } else {
    finding.text = trf("no positions for {:.3f} s, the machine is {:.2f} mm further on; {}",
                       elapsed_s, way_mm, what_then);
  }
  if (before.tool != now.tool) {
    finding.text += trf("; the tool was changed meanwhile, from {} to {}", before.tool, now.tool);
  }
  log_.add(std::move(finding));
}

}  // namespace kerf
