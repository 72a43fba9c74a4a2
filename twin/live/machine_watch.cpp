#include "twin/live/machine_watch.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/live/source_watch.h"

namespace kerf {
namespace {

/// Positions beyond the machine's limits by so much for so long are not its own.
constexpr double kBeyond_mm = 1.0;
constexpr double kBeyond_s = 2.0;
/// An axis that has turned by less stands. Degrees.
constexpr double kTurnTold_deg = 0.01;

}  // namespace

MachineWatch::MachineWatch(const StockModel& stock, const LiveCutOptions& options, FindingLog& log)
    : stock_(stock), options_(options), log_(log) {}

void MachineWatch::note_length(int tool, double t_s) {
  if (tool <= 0 || tool == length_told_) return;
  length_told_ = tool;
  Finding finding;
  finding.id = FindingId::kLengthUnknown;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.tool = tool;
  finding.text = trf(
      "nothing tells the length of tool {} (the source does not, and no tool table has it): its "
      "tip "
      "is taken to be where the machine's position is (machine.tool_length: none says so, too)",
      tool);
  log_.add(std::move(finding));
}

void MachineWatch::note_limits(const Vec3& machine_mm, int line, double t_s) {
  if (beyond_told_) return;
  int beyond = -1;
  for (int i = 0; i < 3; ++i) {
    const AxisLimits& axis = options_.timeline.limits.axes[static_cast<std::size_t>(i)];
    const bool outside =
        machine_mm[i] < axis.min - kBeyond_mm || machine_mm[i] > axis.max + kBeyond_mm;
    if (axis.present && outside) beyond = i;
  }
  if (beyond < 0 || line == 0) {
    beyond_since_s_.reset();
    return;
  }
  if (!beyond_since_s_) beyond_since_s_ = t_s;
  if (t_s - *beyond_since_s_ < kBeyond_s) return;
  beyond_told_ = true;
  const AxisLimits& axis = options_.timeline.limits.axes[static_cast<std::size_t>(beyond)];
  Finding finding;
  finding.id = FindingId::kAxisLimit;
  finding.severity = Severity::kWarning;
  finding.time_s = t_s;
  finding.text =
      trf("{} stands at {:.2f} mm, beyond the limits of the machine ({:g} to {:g} mm): are these "
          "positions "
          "of "
          "another machine, or in another unit?",
          "XYZ"[beyond], machine_mm[beyond], axis.min, axis.max);
  log_.add(std::move(finding));
}

void MachineWatch::note_turn(const Reading& now, SourceRef line) {
  if (!first_abc_deg_) first_abc_deg_ = now.place.abc_deg;
  if (turn_told_ || stock_.takes_tilted_tools()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double turned_deg = now.place.abc_deg[i] - (*first_abc_deg_)[i];
    if (!(std::abs(turned_deg) > kTurnTold_deg)) continue;
    turn_told_ = true;
    Finding finding = live_finding(FindingId::kRotaryIgnored, Severity::kError, now.t_s,
                                   now.pose.origin_mm, now.tool);
    finding.source = line;
    finding.text = trf(
        "{} has turned by {:.2f} degrees, and the model {} is for upright tools over a workpiece "
        "that lies still: it is cut as if A, B and C stood (--model octree follows them)",
        "ABC"[i], turned_deg, stock_.name());
    log_.add(std::move(finding));
    return;
  }
}

void MachineWatch::note_unseen_axes(const Reading& now, const ToolPath* path) {
  if (unseen_told_ || !path || !options_.timeline.kinematics_known) return;
  if (options_.frame.workpiece_frame || !stock_.takes_tilted_tools()) return;
  unseen_told_ = true;
  std::string unseen;
  for (std::size_t i = 0; i < 3; ++i) {
    if (now.abc_known[i] || !path->machine().chain.is_driven_by(3 + i)) continue;
    unseen.append(unseen.empty() ? "" : tr(" and ")).append(1, kAxisLetters[3 + i]);
  }
  if (unseen.empty()) return;
  Finding finding = live_finding(FindingId::kRotaryIgnored, Severity::kWarning, now.t_s,
                                 now.pose.origin_mm, now.tool);
  finding.text = trf(
      "the machine turns about {}, and no position of it comes: it is taken to stand at 0", unseen);
  log_.add(std::move(finding));
}

void MachineWatch::note_unseen_beam(const Reading& now) {
  if (!options_.process->traits().is_beam || beam_told_ || !std::isnan(now.sample.spindle_rpm))
    return;
  beam_told_ = true;
  Finding finding =
      live_finding(FindingId::kNoBeam, Severity::kWarning, now.t_s, now.place.tip_mm, now.tool);
  finding.text =
      tr("nothing tells when the beam is on: the source has no spindle speed, and no program is "
         "followed (--program); nothing is cut until it does");
  log_.add(std::move(finding));
}

void MachineWatch::note_unseen_trigger(const Reading& now, const SeenStrokes& strokes) {
  if (beam_told_ || strokes.is_told()) return;
  beam_told_ = true;
  Finding finding =
      live_finding(FindingId::kNoHit, Severity::kWarning, now.t_s, now.place.tip_mm, now.tool);
  finding.text =
      trf("nothing tells when the punch strikes: the source has {} (punch.trigger in {}), and no "
          "program is followed (--program); nothing is punched until it does",
          strokes.missing(), options_.process->turret()->path);
  log_.add(std::move(finding));
}

}  // namespace kerf
