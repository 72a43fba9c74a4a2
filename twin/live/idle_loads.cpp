#include "twin/live/idle_loads.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

constexpr double kSameSpeed = 0.1;
/// From the quartiles' distance to a standard deviation.
constexpr double kQuartiles = 1.35;

}  // namespace

bool is_same_speed(double a, double b) { return std::abs(a - b) <= kSameSpeed * std::max(a, b); }

/// The nearest of those that are the same.
const IdleLoads::Speed* IdleLoads::find(double rpm) const {
  const Speed* nearest = nullptr;
  for (const Speed& speed : speeds_) {
    if (!is_same_speed(speed.rpm, rpm)) continue;
    if (nearest == nullptr || std::abs(speed.rpm - rpm) < std::abs(nearest->rpm - rpm))
      nearest = &speed;
  }
  return nearest;
}

void IdleLoads::learn(double rpm, double load) {
  if (find(rpm) == nullptr) speeds_.push_back({rpm, {}, 0});
  Speed& speed = speeds_[static_cast<std::size_t>(find(rpm) - speeds_.data())];
  if (speed.loads.size() < kBins) {
    speed.loads.push_back(load);
  } else {
    speed.loads[speed.next++ % kBins] = load;
  }
}

IdleLoads::Idle IdleLoads::Speed::idle() const {
  std::vector<double> sorted = loads;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 4], high = sorted[sorted.size() * 3 / 4];
  return {low, (high - low) / kQuartiles, 0};
}

std::optional<IdleLoads::Idle> IdleLoads::at(double rpm) const {
  const Speed* const speed = find(rpm);
  if (speed == nullptr || !speed->is_enough()) return std::nullopt;
  return speed->idle();
}

std::optional<IdleLoads::Idle> IdleLoads::near(double rpm, LoadUnit unit) const {
  if (const std::optional<Idle> idle = at(rpm)) return idle;
  const Speed *slower = nullptr, *faster = nullptr;
  for (const Speed& speed : speeds_) {
    if (!speed.is_enough()) continue;
    if (speed.rpm <= rpm && (slower == nullptr || speed.rpm > slower->rpm)) slower = &speed;
    if (speed.rpm > rpm && (faster == nullptr || speed.rpm < faster->rpm)) faster = &speed;
  }
  if (slower == nullptr && faster == nullptr) return std::nullopt;
  if (slower != nullptr && faster != nullptr) {
    const Idle low = slower->idle(), high = faster->idle();
    const double share = (rpm - slower->rpm) / (faster->rpm - slower->rpm);
    return Idle{low.load + share * (high.load - low.load), std::max(low.noise, high.noise),
                kBend * std::abs(high.load - low.load)};
  }
  const Speed& known = slower != nullptr ? *slower : *faster;
  const bool is_torque = unit == LoadUnit::kPercentOfTorque || unit == LoadUnit::kNewtonMetres;
  const double ratio = rpm / known.rpm, most = is_torque ? ratio : ratio * ratio;
  const Idle idle = known.idle();
  return Idle{idle.load * 0.5 * (1 + most), idle.noise, std::abs(idle.load * 0.5 * (most - 1))};
}

std::vector<IdleLoads::Measured> IdleLoads::all() const {
  std::vector<Measured> out;
  for (const Speed& speed : speeds_) {
    if (speed.is_enough()) out.push_back({speed.rpm, speed.idle()});
  }
  return out;
}

}  // namespace kerf
