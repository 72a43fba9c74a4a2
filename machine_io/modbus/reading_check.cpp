#include "machine_io/modbus/reading_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/translate.h"

namespace kerf {
namespace {

/// A single jump may be a torn value: the order is asked for only when they go on.
constexpr int kJumpsBeforeAsking = 2;
/// Positions are rounded to the device's counts: between two close polls that alone makes speed.
constexpr double kJumpFloor = 1;
/// A position read with the right order is 0 or above this. (Half of all 32-bit patterns are floats
/// nearer to 0 than a metre, most of them much nearer than this: they convince nobody.)
constexpr double kLeastConvincing = 1e-6;
/// A wrong word order misreads some positions as small ones that nothing gives away. After one that
/// did, none is believed for as long as this.
constexpr std::chrono::seconds kSuspicion{1};
/// How far outside a reading must be before the word order is suspected, in spans; what is nearer
/// is a matter of limits.
constexpr double kFarOutside = 1;
/// The span when only one limit is given, mm or degrees.
constexpr double kAssumedSpan = 1000;
/// What is left of a limit when the other is not given, mm or degrees.
constexpr double kSlackWithoutSpan = 1;

WordOrder with_words_swapped(WordOrder order) {
  switch (order) {
    case WordOrder::kAbcd:
      return WordOrder::kCdab;
    case WordOrder::kCdab:
      return WordOrder::kAbcd;
    case WordOrder::kBadc:
      return WordOrder::kDcba;
    case WordOrder::kDcba:
      break;
  }
  return WordOrder::kBadc;
}

}  // namespace

ReadingCheck::ReadingCheck(const ModbusSettings& settings) : settings_(settings) {}

bool ReadingCheck::absurd(double value) const {
  return !std::isfinite(value) || std::abs(value) > kAbsurd;
}

bool ReadingCheck::outside(std::size_t axis, double value) const {
  const ModbusAxisRange& range = settings_.ranges[axis];
  const double slack = range.min && range.max ? (*range.max - *range.min) / 100 : kSlackWithoutSpan;
  return (range.min && value < *range.min - slack) || (range.max && value > *range.max + slack);
}

bool ReadingCheck::far_outside(std::size_t axis, double value) const {
  const ModbusAxisRange& range = settings_.ranges[axis];
  const double far =
      kFarOutside * (range.min && range.max ? *range.max - *range.min : kAssumedSpan);
  return (range.min && value < *range.min - far) || (range.max && value > *range.max + far);
}

bool ReadingCheck::convincing(std::size_t axis, double value) const {
  const ModbusRegister& wanted = *settings_.axes[axis];
  const double raw = (value - wanted.offset) / wanted.scale;
  return !absurd(value) && !outside(axis, value) && (raw == 0 || std::abs(raw) > kLeastConvincing);
}

bool ReadingCheck::tiny(std::size_t axis, const AxisReading& reading) const {
  const ModbusRegister& wanted = *settings_.axes[axis];
  if (wanted.type != ModbusType::kFloat32 && wanted.type != ModbusType::kFloat64) return false;
  const double raw = decode_registers(wanted.type, wanted.order, reading.raw[axis].data());
  if (raw == 0 || !(std::abs(raw) < kTiny)) return false;
  const double swapped = value_in(axis, with_words_swapped(wanted.order), reading);
  return swapped != wanted.offset && convincing(axis, swapped);
}

bool ReadingCheck::jumped(std::size_t axis, double from, double to,
                          SteadyClock::duration time) const {
  const double seconds = std::chrono::duration<double>(time).count();
  return std::abs(to - from) > settings_.ranges[axis].max_speed_per_s * seconds + kJumpFloor;
}

double ReadingCheck::value_in(std::size_t axis, WordOrder order, const AxisReading& reading) const {
  const ModbusRegister& wanted = *settings_.axes[axis];
  return decode_registers(wanted.type, order, reading.raw[axis].data()) * wanted.scale +
         wanted.offset;
}

bool ReadingCheck::moves_gently(const AxisReading& from, const AxisReading& to,
                                std::optional<WordOrder> order) const {
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!settings_.axes[i]) continue;
    const double a = order ? value_in(i, *order, from) : from.value[i];
    const double b = order ? value_in(i, *order, to) : to.value[i];
    if (order && !(convincing(i, a) && convincing(i, b))) return false;
    if (jumped(i, a, b, to.time - from.time)) return false;
  }
  return true;
}

std::optional<WordOrder> ReadingCheck::cure_for_values(const AxisReading& reading) const {
  for (const WordOrder order : kWordOrders) {
    bool cures = true;
    for (std::size_t i = 0; i < kMaxPositions && cures; ++i) {
      if (!settings_.axes[i]) continue;
      const double value = reading.value[i];
      if (!absurd(value) && !outside(i, value) && !tiny(i, reading)) continue;
      cures = convincing(i, value_in(i, order, reading));
    }
    if (cures) return order;
  }
  return std::nullopt;
}

std::optional<WordOrder> ReadingCheck::cure_for_jumps(const AxisReading& reading) const {
  for (const WordOrder order : kWordOrders) {
    if (moves_gently(*last_, reading, order) && moves_gently(*candidate_, reading, order)) {
      return order;
    }
  }
  return std::nullopt;
}

void ReadingCheck::complain(std::size_t axis, const AxisReading& reading, std::string_view what,
                            std::optional<WordOrder> cure) {
  const std::size_t words = word_count(settings_.axes[axis]->type);
  std::string raw;
  for (std::size_t i = 0; i < words; ++i) raw += fmt::format(" {:04X}", reading.raw[axis][i]);
  const std::string found =
      trf("{} reads {:.6g}, raw{}", kAxisKeys[axis], reading.value[axis], raw);
  if (cure) suspicious_until_ = reading.time + kSuspicion;
  trouble_ = cure ? trf("positions jump beyond machine limits; is word_order {}? ({}: {})",
                        name_of(*cure), found, what)
                  : fmt::format("{}: {}", found, what);
}

/// Looks at each value for itself.
bool ReadingCheck::values_are_good(const AxisReading& reading) {
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!settings_.axes[i]) continue;
    if (absurd(reading.value[i]) || tiny(i, reading)) {
      complain(i, reading, tr("not a position"), cure_for_values(reading));
      return false;
    }
    if (outside(i, reading.value[i])) {
      const ModbusAxisRange& range = settings_.ranges[i];
      const std::string what = trf("outside {} .. {}", range.min ? fmt::to_string(*range.min) : "",
                                   range.max ? fmt::to_string(*range.max) : "");
      complain(i, reading, what,
               far_outside(i, reading.value[i]) ? cure_for_values(reading) : std::nullopt);
      return false;
    }
  }
  return true;
}

bool ReadingCheck::accept(const AxisReading& reading) {
  if (!values_are_good(reading) || reading.time < suspicious_until_) return false;
  const bool agrees = !last_ || moves_gently(*last_, reading, std::nullopt) ||
                      (candidate_ && moves_gently(*candidate_, reading, std::nullopt));
  if (agrees) {
    last_ = reading;
    candidate_.reset();
    jumps_ = 0;
    return true;
  }
  ++jumps_;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!settings_.axes[i] ||
        !jumped(i, last_->value[i], reading.value[i], reading.time - last_->time)) {
      continue;
    }
    const std::string what =
        trf("jumps from {:.6g}; kept back until another agrees", last_->value[i]);
    const bool ask = jumps_ >= kJumpsBeforeAsking && candidate_;
    complain(i, reading, what, ask ? cure_for_jumps(reading) : std::nullopt);
    break;
  }
  candidate_ = reading;
  return false;
}

}  // namespace kerf
