// What CutLoads tells when the program is over.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/job/load_text.h"
#include "twin/process/finding_at.h"
#include "twin/process/milling/cut_loads.h"

namespace kerf {
namespace {

/// Chips at the ends of cuts are thin in any program.
constexpr double kThinShare = 0.5;
/// Below that nobody minds.
/// How a tool enters a cut, or comes round a corner, is no way to mill.
constexpr double kLeastWay_s = 0.1, kLeastWayShare = 0.05;
constexpr double kLeastAir_s = 5, kLeastAirShare = 0.1, kLeastAirPlace_s = 0.5;

std::string range_text(const ValueRange& range, const char* unit) {
  return trf("{} {} ({} to {})", load_text(range.nominal), unit, load_text(range.low),
             load_text(range.high));
}

}  // namespace

void CutLoads::tell(const Tool& tool, Trouble trouble, FindingId id, Severity severity,
                    std::string text) {
  const Worst& worst = tool.worst[trouble];
  Finding finding = finding_at(id, severity, worst.source, worst.time_s);
  finding.tool = tool.number;
  finding.position_mm = worst.at_mm;
  finding.text = std::move(text);
  log_.add(std::move(finding));
}

void CutLoads::tell(const Tool& tool) {
  const auto there = [&](Trouble trouble) { return tool.worst[trouble].is_there; };
  const auto& worst = tool.worst;
  // The whole range beyond the limit, or its high end alone.
  const auto judged = [](const ValueRange& range, double limit) {
    return range.low > limit ? Severity::kWarning : Severity::kNote;
  };
  const auto for_so_long = [&](Trouble trouble) {
    return trf(" (for {} in all)", span_text(worst[trouble].seconds));
  };
  if (there(kChip)) {
    tell(tool, kChip, FindingId::kChipLoadHigh, Severity::kWarning,
         trf("feed per tooth {:.3g} mm, above the {:.3g} mm of chip=", worst[kChip].value,
             *tool.traits.most_chip_mm) +
             for_so_long(kChip));
  }
  const double thin_s = kThinShare * tool.cut_s;
  const bool is_thinest = there(kThinest) && worst[kThinest].seconds > thin_s;
  if (is_thinest || (there(kThin) && worst[kThin].seconds > thin_s)) {
    const Trouble trouble = is_thinest ? kThinest : kThin;
    tell(tool, trouble, FindingId::kChipThin, is_thinest ? Severity::kWarning : Severity::kNote,
         trf("chips {:.2g} mm thick at most; edges rub below {:.2g} to {:.2g} mm",
             worst[trouble].extra, kLeastChip_mm.low, kLeastChip_mm.high) +
             for_so_long(trouble));
  }
  if (there(kSlot)) {
    tell(tool, kSlot, FindingId::kFullSlot, Severity::kNote,
         trf("a full slot {:.3g} mm deep, with a tool of {:.3g} mm", worst[kSlot].value,
             2 * tool.radius_mm) +
             for_so_long(kSlot));
  }
  if (there(kDown)) {
    tell(tool, kDown, FindingId::kPlunge, Severity::kError,
         tr("goes down into material, and does not cut at its centre (centre=no)"));
  }
  if (there(kRamp)) {
    tell(tool, kRamp, FindingId::kRampSteep, Severity::kWarning,
         trf("goes down into material at {:.1f} degrees, steeper than the {:g} of ramp=",
             worst[kRamp].value * 180 / kPi, *tool.traits.most_ramp_deg));
  }
  if (there(kSpeed)) {
    tell(tool, kSpeed, FindingId::kCuttingSpeed, Severity::kNote,
         trf("cutting speed {:.0f} m/min; of {} up to {:.0f} is known", worst[kSpeed].value,
             wish_.material->name, worst[kSpeed].extra) +
             for_so_long(kSpeed));
  }
  if (there(kPower)) {
    tell(tool, kPower, FindingId::kOverPower, judged(worst[kPower].range, wish_.spindle_power_kw),
         trf("takes {}; the spindle has {:g} kW", range_text(worst[kPower].range, "kW"),
             wish_.spindle_power_kw) +
             for_so_long(kPower));
  }
  if (there(kTorque)) {
    tell(tool, kTorque, FindingId::kOverTorque,
         judged(worst[kTorque].range, wish_.spindle_torque_nm),
         trf("takes {}; the spindle has {:g} Nm", range_text(worst[kTorque].range, "Nm"),
             wish_.spindle_torque_nm) +
             for_so_long(kTorque));
  }
  if (there(kBend)) {
    tell(tool, kBend, FindingId::kDeflection, judged(worst[kBend].range, wish_.most_bend_mm),
         trf("its tip bends by {}; allowed are {:g} mm", range_text(worst[kBend].range, "mm"),
             wish_.most_bend_mm) +
             for_so_long(kBend));
  }
  const double up_s = worst[kUp].seconds;
  if (there(kUp) && (up_s >= kLeastWay_s || up_s >= kLeastWayShare * tool.cut_s)) {
    tell(tool, kUp, FindingId::kConventional, Severity::kWarning,
         tr("conventional milling, where climb milling is wanted") + for_so_long(kUp));
  }
}

/// Once a program, at the longest way.
void CutLoads::tell_air() {
  if (longest_air_.empty() || air_s_ < kLeastAir_s || air_s_ < kLeastAirShare * feed_s_) return;
  std::string places;
  for (const AirWay& way : longest_air_) {
    if (way.seconds < kLeastAirPlace_s) break;
    if (!places.empty()) places += ", ";
    places += trf("line {} {:.1f} s", way.source.line, way.seconds);
  }
  const AirWay& longest = longest_air_.front();
  Finding finding =
      finding_at(FindingId::kAirCut, Severity::kNote, longest.source, longest.start_s);
  finding.tool = longest.tool;
  finding.position_mm = longest.at_mm;
  finding.text =
      trf("{:.1f} s of {:.1f} s at feed are in no material; most from {}", air_s_, feed_s_, places);
  log_.add(std::move(finding));
}

void CutLoads::finish() {
  close_air();
  for (const Tool& tool : tools_) tell(tool);
  tell_air();
}

}  // namespace kerf
