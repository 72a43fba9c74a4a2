// machine_io/modbus/reading_check.h - whether what a device says can be where a machine is.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "machine_io/modbus/modbus_settings.h"
#include "machine_io/modbus/poll_schedule.h"

namespace kerf {

/// The axes of one poll: for each axis of the settings its value and the words it was made of.
struct AxisReading {
  SteadyClock::time_point time{};
  std::array<double, kMaxPositions> value{};  ///< after scale and offset
  std::array<std::array<std::uint16_t, 4>, kMaxPositions> raw{};
};

/// Tells positions from misread registers:
///   absurd    NaN, infinite or beyond kAbsurd
///   outside   beyond min or max by more than a hundredth of the span (1 without a span): machines
///             overshoot their limits a little
///   tiny      a float below kTiny that is a position with its words swapped: 100.0 read so is
///             2.4e-41, and would pass for 0
///   jump      faster than max_speed_per_s since the last reading that was accepted. Believed when
///             the next reading agrees with it: the axis was homed, or the line was cut meanwhile
/// When another word order would make every faulty axis right, the trouble asks for it, and nothing
/// is accepted for a second: some misread positions look sound. (Of static float32 axes within
/// limits a wrong order can go unnoticed; moving ones give it away.)
class ReadingCheck {
 public:
  static constexpr double kAbsurd = 1e7;  ///< mm or degrees: 10 km, 27 000 turns
  static constexpr double kTiny = 1e-20;  ///< raw; rounding noise of positions is about 1e-17

  explicit ReadingCheck(const ModbusSettings& settings);

  /// Whether `reading` may be handed out. If not, trouble() says why.
  bool accept(const AxisReading& reading);
  const std::string& trouble() const { return trouble_; }

 private:
  bool absurd(double value) const;
  bool outside(std::size_t axis, double value) const;
  bool far_outside(std::size_t axis, double value) const;
  bool tiny(std::size_t axis, const AxisReading& reading) const;
  /// Whether `value`, from another word order than configured, looks like a position.
  bool convincing(std::size_t axis, double value) const;
  bool jumped(std::size_t axis, double from, double to, SteadyClock::duration time) const;
  /// Whether no axis jumps between the two, both read in `order` or (nullopt) as configured.
  bool moves_gently(const AxisReading& from, const AxisReading& to,
                    std::optional<WordOrder> order) const;
  double value_in(std::size_t axis, WordOrder order, const AxisReading& reading) const;
  std::optional<WordOrder> cure_for_values(const AxisReading& reading) const;
  std::optional<WordOrder> cure_for_jumps(const AxisReading& reading) const;
  bool values_are_good(const AxisReading& reading);
  void complain(std::size_t axis, const AxisReading& reading, std::string_view what,
                std::optional<WordOrder> cure);

  const ModbusSettings settings_;
  std::optional<AxisReading> last_;       ///< accepted
  std::optional<AxisReading> candidate_;  ///< jumped, and waits for another that agrees
  SteadyClock::time_point suspicious_until_{};
  int jumps_ = 0;  ///< in a row
  std::string trouble_;
};

}  // namespace kerf
