#include "twin/live/load_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/translate.h"
#include "twin/job/load_text.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

/// A spindle slower than this stands.
constexpr double kStands_rpm = 1;
/// Samples farther apart say nothing of what is between them; ways that last longer either.
constexpr double kLongStep_s = 1.5;
constexpr double kLeastCovered = 0.75 * LoadBins::kBin_s;
/// The idle load changes with the oil's temperature by so much of it.
constexpr double kIdleDrift = 0.25;
constexpr double kNoises = 3;
/// Of what the spindle is rated for: the number may be coarse.
constexpr double kLeastShare = 0.01;
/// So many times the margin a cut should take, or one that takes nothing cannot be seen.
constexpr double kSeen = 2;
constexpr double kLeastStill_s = 3, kStillTimes = 4;
/// A number that stands still through so much cutting is told.
constexpr double kStillCutting_s = 10;

double abs_rpm(const AxisSample& sample) { return std::abs(sample.spindle_rpm); }

}  // namespace

/// From what is asked at the edges to the unit of the source; NaN: nobody says what it is rated
/// for.
double LoadWatch::per_power_w() const {
  if (known_.unit == LoadUnit::kKilowatts) return 1e-3;
  if (known_.unit != LoadUnit::kPercentOfPower) return 0;
  return 100 / (1000 * wish_.spindle_power_kw);
}

double LoadWatch::per_torque_nm() const {
  switch (known_.unit) {
    case LoadUnit::kNewtonMetres:
      return 1;
    case LoadUnit::kPercentOfTorque:
      return 100 / wish_.spindle_torque_nm;
    case LoadUnit::kAmperes:
      return wish_.spindle_current_a / wish_.spindle_torque_nm;
    default:
      return 0;
  }
}

double LoadWatch::least_margin() const {
  switch (known_.unit) {
    case LoadUnit::kKilowatts:
      return kLeastShare * wish_.spindle_power_kw;
    case LoadUnit::kNewtonMetres:
      return kLeastShare * wish_.spindle_torque_nm;
    case LoadUnit::kAmperes:
      return kLeastShare * wish_.spindle_current_a;
    default:
      return kLeastShare * 100;
  }
}

void LoadWatch::take(const AxisSample& sample, double t_s) {
  const double elapsed_s = t_s_ < 0 ? 0 : t_s - t_s_;
  const double from_s = std::exchange(t_s_, t_s);
  watch_tool(sample, t_s);
  const double load = sample.load;
  if (std::isnan(load)) return;
  known_.unit = sample.load_unit;
  ++known_.samples;
  known_.least = std::min(known_.least, load);
  known_.most = std::max(known_.most, load);
  const bool is_first = std::isnan(std::exchange(last_load_, load)) || elapsed_s <= 0;
  if (is_first || elapsed_s > kLongStep_s || !wish_.material) return;
  const double rpm = std::isnan(rpm_) ? part_rpm_ : rpm_;
  bins_.spread(from_s, t_s, [&](LoadBin& bin, double seconds) {
    bin.covered_s += seconds;
    bin.load_s += load * seconds;
    bin.rpm_s += rpm * seconds;
    bin.is_steady = bin.is_steady && t_s >= tool_from_s_ && rpm >= kStands_rpm;
  });
  watch_stillness(load, t_s, elapsed_s);
}

/// Another tool: it takes a while until the load is that of the new one.
void LoadWatch::watch_tool(const AxisSample& sample, double t_s) {
  if (const double rpm = abs_rpm(sample); !std::isnan(rpm)) rpm_ = rpm;
  if (sample.tool < 0 || sample.tool == tool_) return;
  tool_ = sample.tool;
  tool_from_s_ = t_s + kSettle_s;
}

/// So it does with another speed, if it is not come to slowly. Bins in their order.
void LoadWatch::watch_speed(std::int64_t number, LoadBin& bin) {
  if (bin.covered_s <= 0) return;
  const double rpm = bin.rpm();
  is_drifting_ = !is_same_speed(rpm, settled_rpm_);
  const bool is_quick = last_rpm_.empty() || !is_same_speed(rpm, last_rpm_.front());
  if (is_quick || (is_drifting_ && known_.unit == LoadUnit::kAmperes)) {
    last_rpm_.clear();
    settled_rpm_ = rpm;
    is_drifting_ = false;
    speed_from_s_ = LoadBins::begin_of(number) + kSettle_s;
  }
  last_rpm_.push_back(rpm);
  if (last_rpm_.size() > static_cast<std::size_t>(kSlowly_bins)) last_rpm_.pop_front();
  bin.is_drifting = is_drifting_;
  bin.is_steady = bin.is_steady && LoadBins::begin_of(number) >= speed_from_s_;
}

/// Numbers that stand still may be coarse, or nobody writes them any more.
void LoadWatch::watch_stillness(double load, double t_s, double elapsed_s) {
  const bool turns = std::isnan(rpm_) || rpm_ >= kStands_rpm;
  const bool is_still = still_s_ > 0 && still_load_ == load;
  if (!turns || !is_still) {
    if (turns) known_.longest_still_s = std::max(known_.longest_still_s, still_s_);
    still_load_ = load;
    still_s_ = turns ? elapsed_s : 0;
    still_from_s_ = t_s - still_s_;
    frozen_to_s_ = still_from_s_;
    still_cut_s_ = 0;
    return;
  }
  still_s_ += elapsed_s;
  if (still_s_ <= std::max(kLeastStill_s, kStillTimes * known_.longest_still_s)) return;
  bins_.spread(frozen_to_s_, t_s, [](LoadBin& bin, double) { bin.is_frozen = true; });
  frozen_to_s_ = t_s;
}

void LoadWatch::tell_stillness(double t_s) {
  known_.still_told = true;
  Finding finding = finding_at(FindingId::kLoadDiffers, Severity::kNote, {}, t_s);
  finding.text = trf(
      "the spindle's load stands at {} {}, through {:.0f} s of cutting: nobody writes it any more, "
      "or nothing is cut; it is not judged until it moves",
      load_text(still_load_), sign_of(known_.unit), still_cut_s_);
  log_.add(std::move(finding));
}

void LoadWatch::on_load(const CutLoad& load) {
  if (load.rpm > 0) part_rpm_ = load.rpm;
  const double end_s = load.start_s + load.seconds;
  heard_s_ = std::max(heard_s_, end_s);
  const bool is_known = (!load.is_engaged || load.has_forces()) && load.seconds <= kLongStep_s;
  if (wish_.material && load.is_engaged && !load.has_forces())
    known_.unjudged_s[load.tool] += load.seconds;
  const double per_kw = 1000 * std::max(0.0, per_power_w()),
               per_nm = std::max(0.0, per_torque_nm());
  const ValueRange power = load.of(LoadKind::kPower).times(per_kw);
  const ValueRange torque = load.of(LoadKind::kTorque).times(per_nm);
  bins_.spread(load.start_s, end_s, [&](LoadBin& bin, double seconds) {
    bin.is_known = bin.is_known && is_known;
    if (!load.is_engaged) return;
    if (bin.tool == 0) bin.source = load.source;
    bin.is_mixed = bin.is_mixed || (bin.tool != 0 && bin.tool != load.tool);
    bin.tool = load.tool;
    bin.cut_s += seconds;
    bin.expected_s.low += (power.low + torque.low) * seconds;
    bin.expected_s.nominal += (power.nominal + torque.nominal) * seconds;
    bin.expected_s.high += (power.high + torque.high) * seconds;
  });
}

void LoadWatch::judge(double until_s) {
  if (known_.samples == 0 || !wish_.material) return;
  next_ = std::max(next_, bins_.first());
  for (; LoadBins::begin_of(next_ + 1) <= until_s; ++next_) {
    judge_bin(next_);
  }
  bins_.forget_before(next_ - kWindow - kShifts);
}

bool LoadWatch::is_usable(const LoadBin& bin) const {
  return bin.covered_s >= kLeastCovered && bin.is_steady && !bin.is_frozen;
}

/// Neither it nor what is a little before or behind it is a cut: loads are late, and so are ways.
bool LoadWatch::is_air(std::int64_t number) const {
  for (std::int64_t n = number - kShifts; n <= number + 1; ++n) {
    const LoadBin* const bin = bins_.find(n);
    if (bin != nullptr && (bin->cut_s > 0 || !bin->is_known)) return false;
  }
  return true;
}

std::optional<IdleLoads::Idle> LoadWatch::idle_of(double rpm, bool is_drifting) const {
  return is_drifting ? known_.idle.near(rpm, known_.unit) : known_.idle.at(rpm);
}

/// While the speed changes, the mean over the window.
std::optional<IdleLoads::Idle> LoadWatch::window_idle(std::int64_t last) const {
  const LoadBin& bin = *bins_.find(last);
  if (!bin.is_drifting) return idle_of(bin.rpm(), false);
  IdleLoads::Idle sum;
  for (std::int64_t n = last - kWindow + 1; n <= last; ++n) {
    const std::optional<IdleLoads::Idle> idle = idle_of(bins_.find(n)->rpm(), true);
    if (!idle) return std::nullopt;
    sum.load += idle->load / kWindow;
    sum.doubt += idle->doubt / kWindow;
    sum.noise = std::max(sum.noise, idle->noise);
  }
  return sum;
}

void LoadWatch::judge_bin(std::int64_t number) {
  if (bins_.find(number) == nullptr) return;
  LoadBin* const bin = bins_.at(number);
  watch_speed(number, *bin);
  if (bin->is_frozen) {
    still_cut_s_ += bin->cut_s;
    if (still_cut_s_ > kStillCutting_s && !known_.still_told)
      tell_stillness(LoadBins::begin_of(number));
  }
  if (is_usable(*bin) && is_air(number)) known_.idle.learn(bin->rpm(), bin->load());
  int tool = 0;
  if (!window_tool(number, tool)) return;
  if (const auto idle = window_idle(number)) judge_window(number, tool, *idle);
}

/// False: a bin of the window cannot be judged.
bool LoadWatch::window_tool(std::int64_t last, int& tool) const {
  for (std::int64_t n = last - kWindow - kShifts + 1; n <= last; ++n) {
    const LoadBin* const bin = bins_.find(n);
    if (bin == nullptr || !is_usable(*bin) || !bin->is_known || bin->is_mixed) return false;
    if (bin->tool == 0) continue;
    if (tool != 0 && tool != bin->tool) return false;
    tool = bin->tool;
  }
  return tool != 0;
}

double LoadWatch::window_load(std::int64_t last) const {
  double sum = 0, seconds = 0;
  for (std::int64_t n = last - kWindow + 1; n <= last; ++n) {
    sum += bins_.find(n)->load_s;
    seconds += bins_.find(n)->covered_s;
  }
  return sum / seconds;
}

LoadWatch::Expected LoadWatch::window_expected(std::int64_t last) const {
  constexpr double kLong = std::numeric_limits<double>::infinity();
  Expected out{kLong, 0, kLong, 0};
  for (int shift = 0; shift <= kShifts; ++shift) {
    ValueRange sum;
    for (std::int64_t n = last - shift - kWindow + 1; n <= last - shift; ++n) {
      const ValueRange& one = bins_.find(n)->expected_s;
      sum = {sum.low + one.low, sum.nominal + one.nominal, sum.high + one.high};
    }
    const ValueRange mean = sum.times(1 / (kWindow * LoadBins::kBin_s));
    out.low = std::min(out.low, mean.low);
    out.high = std::max(out.high, mean.high / kLeastEfficiency);
    out.nominal_low = std::min(out.nominal_low, mean.nominal);
    out.nominal_high = std::max(out.nominal_high, mean.nominal);
  }
  return out;
}

void LoadWatch::judge_window(std::int64_t last, int number, const IdleLoads::Idle& idle) {
  const Expected expected = window_expected(last);
  const double margin =
      std::max({kIdleDrift * std::abs(idle.load), kNoises * idle.noise, least_margin()}) +
      idle.doubt;
  if (expected.nominal_high <= margin) return;
  Tool& tool = known_.tools[number];
  const double cuts = window_load(last) - idle.load;
  double low = expected.low, high = expected.high;
  const bool within = cuts <= high + margin && (cuts >= low - margin || low <= kSeen * margin);
  Stretch now;
  // By what it took before in cuts that should take as much.
  Usual& usual = tool.usual[std::ilogb(expected.nominal_high)];
  if (usual.seconds >= kLearn_s) {
    const double usual_low = kLeastOfUsual * usual.ratio() * expected.nominal_low;
    const double usual_high = kMostOfUsual * usual.ratio() * expected.nominal_high;
    now.by_usual = within && (cuts > usual_high + margin || cuts < usual_low - margin);
    low = std::max(low, usual_low);
    high = std::min(high, usual_high);
  } else if (within && expected.nominal_low > kSeen * margin) {
    usual.seconds += LoadBins::kBin_s;
    usual.measured += cuts;
    usual.nominal += (expected.nominal_low + expected.nominal_high) / 2;
  }
  if (cuts > high + margin) now.side = Side::kHigher;
  const bool can_be_lower = low > kSeen * margin;
  if (can_be_lower && cuts < low - margin) now.side = Side::kLower;
  // Between cuts little should be taken: that ends no stretch of too little.
  if (now.side == Side::kWithin && !can_be_lower && stretch_.side == Side::kLower) return;
  now.seconds = LoadBins::kBin_s;
  now.begin_s = LoadBins::begin_of(last);
  for (std::int64_t n = last; n > last - kWindow && now.source.line == 0; --n) {
    if (bins_.find(n)->tool != 0) now.source = bins_.find(n)->source;
  }
  now.measured_s = (idle.load + cuts) * now.seconds;
  now.low_s = (idle.load + low) * now.seconds;
  now.high_s = (idle.load + high) * now.seconds;
  idle_ = idle.load;
  note(tool, number, now);
}

void LoadWatch::note(Tool& tool, int number, const Stretch& now) {
  tool.judged_s += now.seconds;
  tool.measured_s += now.measured_s;
  tool.low_s += now.low_s;
  tool.high_s += now.high_s;
  if (now.side != Side::kWithin) tool.differs_s += now.seconds;
  if (now.side != stretch_.side || number != stretch_tool_) {
    stretch_ = now;
    stretch_tool_ = number;
  } else {
    stretch_.seconds += now.seconds;
    stretch_.measured_s += now.measured_s;
    stretch_.low_s += now.low_s;
    stretch_.high_s += now.high_s;
    stretch_.by_usual = stretch_.by_usual || now.by_usual;
  }
  if (now.side == Side::kWithin || stretch_.seconds < kLasting_s) return;
  bool& told = now.side == Side::kLower ? tool.lower_told : tool.higher_told;
  if (!std::exchange(told, true)) tell(number, stretch_, idle_);
}

void LoadWatch::tell(int number, const Stretch& stretch, double idle) {
  Finding finding =
      finding_at(FindingId::kLoadDiffers, Severity::kWarning, stretch.source, stretch.begin_s);
  finding.tool = number;
  const auto mean = [&](double sum) { return load_text(sum / stretch.seconds); };
  finding.text = trf(
      "the spindle takes {0} {4}, and {1} to {2} {4} should be ({3} of it idle), for {5:.0f} s: ",
      mean(stretch.measured_s), mean(stretch.low_s), mean(stretch.high_s), load_text(idle),
      sign_of(known_.unit), stretch.seconds);
  finding.text += stretch.side == Side::kLower
                      ? tr("a tool that is broken or missing cuts so, or another material or depth")
                      : tr("a blunt tool cuts so, or another material or depth");
  if (stretch.by_usual) finding.text += tr("; the band is what this tool took before");
  log_.add(std::move(finding));
}

std::optional<LoadNow> LoadWatch::now() const {
  if (known_.samples == 0 || std::isnan(last_load_)) return std::nullopt;
  LoadNow out;
  out.unit = known_.unit;
  out.measured = last_load_;
  if (!wish_.material) return out;
  const auto idle = idle_of(std::isnan(rpm_) ? part_rpm_ : rpm_, is_drifting_);
  if (!idle) return out;
  // Of the last second of which all is known.
  ValueRange sum;
  const std::int64_t end = LoadBins::number_at(std::min(heard_s_, t_s_));
  const bool is_old = t_s_ - heard_s_ > 1;
  for (std::int64_t n = end - kShifts; n < end && !is_old; ++n) {
    const LoadBin* const bin = bins_.find(n);
    if (bin == nullptr || !bin->is_known) return out;
    sum.low += bin->expected_s.low;
    sum.high += bin->expected_s.high;
  }
  const double second_s = kShifts * LoadBins::kBin_s;
  out.low = idle->load + sum.low / second_s;
  out.high = idle->load + sum.high / kLeastEfficiency / second_s;
  return out;
}

std::optional<LoadReport> LoadWatch::report() const {
  if (known_.samples == 0) return std::nullopt;
  LoadReport out;
  out.unit = known_.unit;
  out.samples = known_.samples;
  out.least = known_.least;
  out.most = known_.most;
  for (const auto& [rpm, idle] : known_.idle.all()) out.idle.push_back({rpm, idle.load});
  for (const auto& [number, tool] : known_.tools) {
    if (tool.judged_s <= 0) continue;
    out.tools.push_back({number, tool.judged_s, tool.differs_s, tool.measured_s / tool.judged_s,
                         tool.low_s / tool.judged_s, tool.high_s / tool.judged_s});
  }
  for (const auto& [number, seconds] : known_.unjudged_s)
    if (seconds >= kLeastUnjudged_s) out.unjudged.push_back({number, seconds});
  return out;
}

}  // namespace kerf
