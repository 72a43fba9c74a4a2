#include "twin/process/milling/cut_loads.h"

#include <algorithm>
#include <cmath>

#include "cutting/drilling_force.h"
#include "cutting/tool_bending.h"
#include "stock/cutter/cutting_edge.h"

namespace kerf {
namespace {

constexpr double kDegrees = 180 / kPi;
/// What is more than a limit by less than this is rounding.
constexpr double kOver = 1.005;
constexpr double kOverAngle_rad = 0.1 / kDegrees;
constexpr std::size_t kMostAirPlaces = 5;

}  // namespace

void CutLoads::mount(const Cutter& cutter, int number) {
  close_air();
  const auto known = std::find_if(tools_.begin(), tools_.end(), [&](const Tool& tool) {
    return tool.number == number && tool.shape == cutter.spec();
  });
  if (known != tools_.end()) {
    tool_ = &*known;
    return;
  }
  Tool& tool = tools_.emplace_back();
  tool_ = &tool;
  tool.number = number;
  tool.shape = cutter.spec();
  tool.radius_mm = cutter.radius_mm();
  tool.teeth = cutter.teeth().value_or(0);
  tool.traits = cutter.edge_traits();
  tool.flute_mm = cutter.flute_length_mm();
  if (!cutter.holder().empty()) tool.stickout_mm = cutter.holder().front().from_z_mm;
  tool.shank_mm = cutter.shank_diameter_mm().value_or(2 * cutter.radius_mm());
  tool.point_deg = point_deg(cutter);
  const std::vector<Vec2> outline = edge_points(cutter);
  tool.profile.emplace(outline, wish_.material ? wish_.material->mc : 0);
  if (!wish_.material || tool.teeth == 0) return;
  const MillingEdges edges{tool.teeth, tool.traits.helix_deg.value_or(kUsualHelix_deg) / kDegrees};
  tool.model.emplace(*wish_.material, *tool.profile, edges, tool.traits.rake_deg);
}

std::shared_ptr<const ToolLoads> CutLoads::loads_of(int number, const std::string& shape) const {
  for (const Tool& tool : tools_) {
    if (tool.number == number && tool.shape == shape && tool.loads->chip_mm.seconds() > 0)
      return tool.loads;
  }
  return nullptr;
}

void CutLoads::forget() {
  tools_.clear();
  tool_ = nullptr;
  feed_s_ = air_s_ = 0;
  air_ = {};
  longest_air_.clear();
}

void CutLoads::note(Trouble trouble, const Part& part, double value, const ValueRange& range,
                    double extra) {
  Worst& worst = tool_->worst[trouble];
  worst.seconds += part.way.seconds;
  if (worst.is_there && value <= worst.value) return;
  worst = {true, value, range, worst.seconds, part.source, part.start_s, part.from_mm, extra};
}

void CutLoads::take(const Part& part, LoadListener* listener) {
  if (tool_ == nullptr || part.way.seconds <= 0) return;
  load_ = {};
  load_.is_engaged = part.look.is_engaged();
  feed_s_ += part.way.seconds;
  if (load_.is_engaged) {
    close_air();
    take_engaged(part);
    load_.set(LoadKind::kAngle, part.look.angle_rad * kDegrees);
  } else {
    take_air(part);
  }
  if (listener == nullptr) return;
  load_.start_s = part.start_s;
  load_.seconds = part.way.seconds;
  load_.tool = tool_->number;
  load_.source = part.source;
  load_.rpm = part.rpm;
  listener->on_load(load_);
}

void CutLoads::tell_unmeasured(double start_s, double seconds, LoadListener* listener) const {
  if (listener == nullptr || tool_ == nullptr) return;
  CutLoad load;
  load.start_s = start_s;
  load.seconds = seconds;
  load.tool = tool_->number;
  load.is_engaged = true;
  load.is_measured = false;
  listener->on_load(load);
}

void CutLoads::take_unmeasured(const Part& part, LoadListener* listener) {
  feed_s_ += part.way.seconds;
  close_air();
  tell_unmeasured(part.start_s, part.way.seconds, listener);
}

void CutLoads::take_engaged(const Part& part) {
  tool_->cut_s += part.way.seconds;
  judge_way(part);
  if (tool_->teeth == 0 || part.rpm <= 0) return;
  const double mm_per_min =
      std::min(part.way.length_mm / part.way.seconds * 60, part.most_mm_per_min);
  const double feed_mm = mm_per_min / (part.rpm * tool_->teeth);
  if (tool_->traits.most_chip_mm && feed_mm > *tool_->traits.most_chip_mm * kOver)
    note(kChip, part, feed_mm, {});
  part.look.is_plunge ? take_plunge(part, feed_mm) : take_cut(part, feed_mm);
}

/// Stretches in the air, across moves.
void CutLoads::take_air(const Part& part) {
  air_s_ += part.way.seconds;
  if (air_.seconds == 0) air_ = {0, part.start_s, part.source, part.from_mm, tool_->number};
  air_.seconds += part.way.seconds;
}

void CutLoads::close_air() {
  if (air_.seconds <= 0) return;
  const auto place = std::find_if(longest_air_.begin(), longest_air_.end(),
                                  [&](const AirWay& way) { return way.seconds < air_.seconds; });
  longest_air_.insert(place, air_);
  if (longest_air_.size() > kMostAirPlaces) longest_air_.pop_back();
  air_ = {};
}

/// What needs neither teeth nor a material.
void CutLoads::judge_way(const Part& part) {
  const EngagementLook& look = part.look;
  const double down_rad = look.is_plunge ? kPi / 2 : part.way.down_rad;
  const std::optional<double>& most = tool_->traits.most_ramp_deg;
  const bool is_gentle = most && down_rad <= *most / kDegrees + kOverAngle_rad;
  if (look.cuts_centre && !tool_->traits.cuts_centre && !is_gentle)
    note(kDown, part, look.deep_mm, {});
  if (look.cuts_centre && most && !is_gentle) note(kRamp, part, down_rad, {});
  if (look.is_plunge) return;
  const bool is_slot = look.angle_rad >= EngagementSums::kFullSlot_rad;
  if (wish_.material && is_slot && look.deep_mm > 2 * tool_->radius_mm * kOver)
    note(kSlot, part, look.deep_mm, {});
  if (wish_.wants_climb && !is_slot && look.climb < 0.5) note(kUp, part, 1 - look.climb, {});
}

void CutLoads::take_plunge(const Part& part, double feed_mm) {
  ToolLoads& loads = *tool_->loads;
  const DrillingCut cut{2 * tool_->radius_mm, tool_->teeth, tool_->point_deg,
                        feed_mm * tool_->teeth, part.rpm};
  loads.speed_m_per_min.add(kPi * cut.diameter_mm * part.rpm / 1000, part.way.seconds, part.source,
                            part.from_mm);
  if (!wish_.material) {
    const double chip_mm = feed_mm * std::sin(cut.point_deg / 2 / kDegrees);
    loads.chip_mm.add(chip_mm, part.way.seconds, part.source, part.from_mm);
    load_.set(LoadKind::kChip, chip_mm);
    return;
  }
  const DrillingLoad load = drilling_load(*wish_.material, cut, tool_->traits.rake_deg);
  loads.chip_mm.add(load.chip_mm, part.way.seconds, part.source, part.from_mm);
  load_.set(LoadKind::kChip, load.chip_mm);
  add_forces(part, load.thrust_n, load.torque_nm, load.torque_nm, load.power_w);
}

void CutLoads::take_cut(const Part& part, double feed_mm) {
  const EngagementLook& look = part.look;
  ToolLoads& loads = *tool_->loads;
  // What goes down takes chips of the way that it goes sideways.
  const MillingCut cut{feed_mm * std::cos(part.way.down_rad), std::clamp(look.entry_rad, 0.0, kPi),
                       std::clamp(look.exit_rad, 0.0, kPi), look.deep_mm, part.rpm};
  const Chip chip = chip_of(*tool_->profile, cut);
  loads.chip_mm.add(chip.most_mm, part.way.seconds, part.source, part.from_mm);
  load_.set(LoadKind::kChip, chip.most_mm);
  const double speed = kPi * look.effective_mm * part.rpm / 1000;
  loads.speed_m_per_min.add(speed, part.way.seconds, part.source, part.from_mm);
  if (!wish_.material) return;
  if (chip.most_mm < kLeastChip_mm.high) note(kThin, part, -chip.most_mm, {}, chip.most_mm);
  if (chip.most_mm < kLeastChip_mm.low) note(kThinest, part, -chip.most_mm, {}, chip.most_mm);
  const std::optional<SpeedRange>& speeds =
      wish_.material->speed_carbide ? wish_.material->speed_carbide : wish_.material->speed_hss;
  if (speeds && speed > speeds->high * kOver) note(kSpeed, part, speed, {}, speeds->high);
  MillingLoad load = tool_->model->load_of(cut);
  // The engagement is not the same all over the height of what is not flat: no more is cut than as
  // wide and as high as that.
  const double section_mm2 = tool_->profile->sum_to(cut.deep_mm).half_mm2 *
                             (std::cos(cut.entry_rad) - std::cos(cut.exit_rad));
  const auto share_of = [&](double wide_mm) {
    return section_mm2 > 0 ? std::min(1.0, wide_mm * look.deep_mm / section_mm2) : 1;
  };
  // A gap takes nothing of the most that a tooth takes beside it.
  const double share = share_of(look.wide_mm + look.gaps_mm), mean = share_of(look.wide_mm);
  const ValueRange force_n = load.force_n.times(share);
  add_forces(part, force_n, load.torque_nm.times(share), load.torque_mean_nm.times(mean),
             load.power_w.times(mean));
  add_bend(part, force_n, load.at_wall_n.times(share));
}

void CutLoads::add_forces(const Part& part, const ValueRange& force_n, const ValueRange& torque_nm,
                          const ValueRange& torque_mean_nm, const ValueRange& power_w) {
  ToolLoads& loads = *tool_->loads;
  loads.has_forces = true;
  const auto add = [&](LoadSpread& spread, ValueRange& most, const ValueRange& range) {
    spread.add(range, part.way.seconds, part.source, most, part.from_mm);
  };
  const ValueRange power_kw = power_w.times(1e-3);
  add(loads.force_n, loads.force_most_n, force_n);
  add(loads.torque_nm, loads.torque_most_nm, torque_nm);
  add(loads.power_kw, loads.power_most_kw, power_kw);
  load_.set(LoadKind::kForce, force_n);
  load_.set(LoadKind::kTorque, torque_mean_nm);
  load_.set(LoadKind::kPower, power_kw);
  if (wish_.spindle_power_kw > 0 && power_kw.high > wish_.spindle_power_kw)
    note(kPower, part, power_kw.nominal, power_kw);
  // A spindle's own mass takes what a tooth takes for a moment.
  if (wish_.spindle_torque_nm > 0 && torque_mean_nm.high > wish_.spindle_torque_nm)
    note(kTorque, part, torque_mean_nm.nominal, torque_mean_nm);
}

/// Low: of carbide, as much of it shank as may be; high: of high-speed steel.
void CutLoads::add_bend(const Part& part, const ValueRange& force_n, const ValueRange& wall_n) {
  const Tool& tool = *tool_;
  if (!tool.stickout_mm) return;
  ToolRods rods{2 * tool.radius_mm, tool.shank_mm, tool.flute_mm.value_or(*tool.stickout_mm),
                *tool.stickout_mm, kCarbideModulus};
  const double at_mm = part.look.deep_mm / 2;
  const double carbide = tip_bends_mm_per_n(rods, at_mm);
  const double steel = carbide * kCarbideModulus / kSteelModulus;
  if (!tool.flute_mm) rods.flute_mm = 0;
  const double least = tip_bends_mm_per_n(rods, at_mm);
  const ValueRange bend{least * force_n.low, carbide * force_n.nominal, steel * force_n.high};
  ToolLoads& loads = *tool_->loads;
  loads.has_bend = true;
  if (bend.nominal > loads.bend_mm.most()) loads.bend_most_mm = bend;
  loads.bend_mm.add(bend.nominal, part.way.seconds, part.source, part.from_mm);
  load_.set(LoadKind::kBend, bend);
  const double wall_mm = std::abs(carbide * wall_n.nominal);
  if (wall_mm > loads.wall_mm.most()) {
    loads.wall_most_mm = {(wall_n.low < 0 ? steel : least) * wall_n.low, carbide * wall_n.nominal,
                          (wall_n.high < 0 ? least : steel) * wall_n.high};
  }
  loads.wall_mm.add(wall_mm, part.way.seconds, part.source, part.from_mm);
  if (wish_.most_bend_mm > 0 && bend.high > wish_.most_bend_mm)
    note(kBend, part, bend.nominal, bend);
}

}  // namespace kerf
