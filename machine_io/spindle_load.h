// machine_io/spindle_load.h - what a machine's own load of its spindle is counted in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace kerf {

/// Drives tell a percentage of what they are rated for, some of power, some of torque; or power,
/// torque, or the current of the motor.
enum class LoadUnit : std::uint8_t {
  kPercentOfPower,
  kPercentOfTorque,
  kKilowatts,
  kNewtonMetres,
  kAmperes,
};
inline constexpr std::size_t kLoadUnits = 5;

/// Of configurations: "percent" is that of power.
inline constexpr std::array<std::string_view, kLoadUnits> kLoadUnitWords{
    "percent", "percent-torque", "kW", "Nm", "A"};
/// Of recordings and logs.
inline constexpr std::array<std::string_view, kLoadUnits> kLoadColumns{
    "load_percent", "load_percent_torque", "load_kw", "load_nm", "load_a"};
/// Behind a number, for people.
inline constexpr std::array<std::string_view, kLoadUnits> kLoadSigns{"%", "%", "kW", "Nm", "A"};

constexpr std::string_view word_of(LoadUnit unit) {
  return kLoadUnitWords[static_cast<std::size_t>(unit)];
}
constexpr std::string_view column_of(LoadUnit unit) {
  return kLoadColumns[static_cast<std::size_t>(unit)];
}
constexpr std::string_view sign_of(LoadUnit unit) {
  return kLoadSigns[static_cast<std::size_t>(unit)];
}

/// No spindle has more of any of them; what says so is a wrong register or a torn number.
inline constexpr double kMostLoad = 1e5;

}  // namespace kerf
