#include "twin/process/turning/turn_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "base/translate.h"
#include "cutting/drilling_force.h"
#include "stock/cutter/cutting_edge.h"
#include "stock/cutter/turning_shape.h"
#include "twin/job/load_text.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// What is more than a limit by less than this is rounding.
constexpr double kOver = 1.005;
/// A drill that goes along so near to the axis drills.
constexpr double kOnAxis_mm = 0.01;

std::string range_text(const ValueRange& range, const char* unit) {
  return trf("{} {} ({} to {})", load_text(range.nominal), unit, load_text(range.low),
             load_text(range.high));
}

ValueRange exactly(double value) { return {value, value, value}; }

}  // namespace

void TurnLoads::mount(const Cutter& cutter, int number) {
  const auto known = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& tool) {
    return tool.number == number && tool.shape == cutter.spec();
  });
  tool_ = static_cast<std::size_t>(known - tools_.begin());
  if (known != tools_.end()) return;
  Tool& tool = tools_.emplace_back();
  tool.number = number;
  tool.shape = cutter.spec();
  tool.is_insert = is_turning_shape(cutter.spec());
  if (tool.is_insert) {
    tool.most_feed_mm = insert_use_of(cutter).max_feed_mm;
    return;
  }
  tool.most_feed_mm = cutter.edge_traits().most_chip_mm;
  tool.radius_mm = cutter.radius_mm();
  tool.point_deg = point_deg(cutter);
  tool.teeth = cutter.teeth().value_or(0);
  tool.rake_deg = cutter.edge_traits().rake_deg;
}

std::shared_ptr<const ToolLoads> TurnLoads::loads_of(int number, const std::string& shape) const {
  for (const Tool& tool : tools_) {
    if (tool.number == number && tool.shape == shape && tool.loads->chip_mm.seconds() > 0)
      return tool.loads;
  }
  return nullptr;
}

void TurnLoads::forget() {
  tools_.clear();
  tool_ = 0;
}

void TurnLoads::note(Trouble trouble, const Part& part, double seconds, const ValueRange& range) {
  Worst& worst = tools_[tool_].worst[trouble];
  worst.seconds += seconds;
  if (worst.is_there && range.nominal <= worst.range.nominal) return;
  worst = {true, range, worst.seconds, part.source, part.start_s, part.from_mm};
}

void TurnLoads::tell_unmeasured(int tool, SourceRef source, double start_s, double seconds,
                                LoadListener* listener) {
  if (listener == nullptr) return;
  CutLoad load;
  load.start_s = start_s;
  load.seconds = seconds;
  load.tool = tool;
  load.source = source;
  load.is_engaged = true;
  load.is_measured = false;
  listener->on_load(load);
}

/// Where on a part the cut begins is not known: what is in the air comes first.
void TurnLoads::tell(const Part& part, CutLoad& load, LoadListener& listener) const {
  const TurnedWay& way = part.way;
  const double cut_s = way.length_mm > 0 ? way.seconds * way.cut_mm / way.length_mm : 0;
  load.tool = tools_[tool_].number;
  load.source = part.source;
  load.rpm = part.rpm;
  if (way.seconds > cut_s) {
    CutLoad air;
    air.tool = load.tool, air.source = load.source, air.rpm = load.rpm;
    air.start_s = part.start_s;
    air.seconds = way.seconds - cut_s;
    listener.on_load(air);
  }
  if (cut_s <= 0) return;
  load.start_s = part.start_s + way.seconds - cut_s;
  load.seconds = cut_s;
  load.is_engaged = true;
  listener.on_load(load);
}

void TurnLoads::take(const Part& part, LoadListener* listener) {
  if (tool_ >= tools_.size()) return;
  CutLoad load;
  add(part, load);
  if (listener != nullptr) tell(part, load, *listener);
}

void TurnLoads::add(const Part& part, CutLoad& told) {
  const TurnedWay& way = part.way;
  if (way.cut_mm <= 0 || way.feed_mm_per_rev <= 0 || part.rpm <= 0) return;
  const Tool& tool = tools_[tool_];
  const double seconds = way.seconds * way.cut_mm / way.length_mm;
  if (!tool.is_insert) {
    if (tool.teeth > 0 && part.radius_mm <= kOnAxis_mm) add_drilling(part, seconds, told);
    return;
  }
  const TurningLoad load =
      turning_load(wish_.material.value_or(Material{}),
                   {way.depth_mm, way.feed_mm_per_rev, part.sine, part.radius_mm, part.rpm});
  if (tool.most_feed_mm && way.feed_mm_per_rev > *tool.most_feed_mm * kOver)
    note(kFeed, part, seconds, exactly(way.feed_mm_per_rev));
  add_chip(part, seconds, load.chip_mm, load.speed_m_per_min, told);
  if (wish_.material)
    add_forces(part, seconds, {load.force_n, load.torque_nm, load.power_w.times(1e-3)}, told);
}

/// Into a bore it cuts a ring, the force of which acts farther out.
void TurnLoads::add_drilling(const Part& part, double seconds, CutLoad& told) {
  const Tool& tool = tools_[tool_];
  const double feed_mm = part.way.feed_mm_per_rev;
  const double tooth_mm = feed_mm / tool.teeth;
  if (tool.most_feed_mm && tooth_mm > *tool.most_feed_mm * kOver)
    note(kFeed, part, seconds, exactly(tooth_mm));
  const DrillingCut cut{2 * tool.radius_mm, tool.teeth, tool.point_deg, feed_mm, part.rpm};
  add_chip(part, seconds, tooth_mm * portable::sin(tool.point_deg * kPi / 360),
           kPi * cut.diameter_mm * part.rpm / 1000, told);
  if (!wish_.material) return;
  const DrillingLoad load = drilling_load(*wish_.material, cut, tool.rake_deg);
  const double wide = std::min(1.0, part.way.depth_mm / tool.radius_mm);
  const double ring = wide * (2 - wide);
  add_forces(
      part, seconds,
      {load.thrust_n.times(wide), load.torque_nm.times(ring), load.power_w.times(1e-3 * ring)},
      told);
}

void TurnLoads::add_chip(const Part& part, double seconds, double chip_mm, double speed_m_per_min,
                         CutLoad& told) {
  ToolLoads& loads = *tools_[tool_].loads;
  loads.chip_mm.add(chip_mm, seconds, part.source);
  loads.speed_m_per_min.add(speed_m_per_min, seconds, part.source);
  told.set(LoadKind::kChip, chip_mm);
  if (!wish_.material) return;
  const std::optional<SpeedRange>& speeds =
      wish_.material->speed_carbide ? wish_.material->speed_carbide : wish_.material->speed_hss;
  if (speeds && speed_m_per_min > speeds->high * kOver)
    note(kSpeed, part, seconds, exactly(speed_m_per_min));
}

void TurnLoads::add_forces(const Part& part, double seconds, const Forces& forces, CutLoad& told) {
  ToolLoads& loads = *tools_[tool_].loads;
  loads.has_forces = true;
  loads.force_n.add(forces.force_n, seconds, part.source, loads.force_most_n);
  loads.torque_nm.add(forces.torque_nm, seconds, part.source, loads.torque_most_nm);
  loads.power_kw.add(forces.power_kw, seconds, part.source, loads.power_most_kw);
  told.set(LoadKind::kForce, forces.force_n);
  told.set(LoadKind::kTorque, forces.torque_nm);
  told.set(LoadKind::kPower, forces.power_kw);
  if (wish_.spindle_power_kw > 0 && forces.power_kw.high > wish_.spindle_power_kw)
    note(kPower, part, seconds, forces.power_kw);
  if (wish_.spindle_torque_nm > 0 && forces.torque_nm.high > wish_.spindle_torque_nm)
    note(kTorque, part, seconds, forces.torque_nm);
}

void TurnLoads::tell(const Tool& tool, Trouble trouble, FindingId id, double limit,
                     const std::string& text) {
  const Worst& worst = tool.worst[trouble];
  const Severity severity = worst.range.low > limit ? Severity::kWarning : Severity::kNote;
  Finding finding = finding_at(id, severity, worst.source, worst.time_s);
  finding.tool = tool.number;
  finding.position_mm = worst.at_mm;
  finding.text = text + trf(" (for {} in all)", span_text(worst.seconds));
  log_.add(std::move(finding));
}

void TurnLoads::tell(const Tool& tool) {
  const auto& worst = tool.worst;
  const double never = std::numeric_limits<double>::infinity();
  if (worst[kFeed].is_there)
    tell(tool, kFeed, FindingId::kChipLoadHigh, *tool.most_feed_mm,
         tool.is_insert ? trf("feed {:.3g} mm a turn, above the {:.3g} mm of max_f=",
                              worst[kFeed].range.nominal, *tool.most_feed_mm)
                        : trf("feed per tooth {:.3g} mm, above the {:.3g} mm of chip=",
                              worst[kFeed].range.nominal, *tool.most_feed_mm));
  if (worst[kSpeed].is_there) {
    const std::optional<SpeedRange>& speeds =
        wish_.material->speed_carbide ? wish_.material->speed_carbide : wish_.material->speed_hss;
    tell(tool, kSpeed, FindingId::kCuttingSpeed, never,
         trf("cutting speed {:.0f} m/min; of {} up to {:.0f} is known", worst[kSpeed].range.nominal,
             wish_.material->name, speeds->high));
  }
  if (worst[kPower].is_there)
    tell(tool, kPower, FindingId::kOverPower, wish_.spindle_power_kw,
         trf("takes {}; the spindle has {:g} kW", range_text(worst[kPower].range, "kW"),
             wish_.spindle_power_kw));
  if (worst[kTorque].is_there)
    tell(tool, kTorque, FindingId::kOverTorque, wish_.spindle_torque_nm,
         trf("takes {}; the spindle has {:g} Nm", range_text(worst[kTorque].range, "Nm"),
             wish_.spindle_torque_nm));
}

void TurnLoads::finish() {
  for (const Tool& tool : tools_) tell(tool);
}

}  // namespace kerf
