#include "machine_io/mtconnect/device_state.h"

#include <cmath>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// mm or degrees: 10 km, 27 000 turns. No machine is beyond.
constexpr double kMostPosition = 1e7;
constexpr double kMostTurns_rpm = 1e6;
constexpr double kMostOffset_mm = 1e4;

/// MTConnect's words for what a program does; MANUAL and MDI have none that counts.
ProgramState program_of(std::string_view execution, std::string_view mode) {
  if (mode == "MANUAL" || mode == "MANUAL_DATA_INPUT" || mode == "EDIT") {
    return ProgramState::kIdle;
  }
  if (execution == "ACTIVE") return ProgramState::kRunning;
  for (const std::string_view word : {"INTERRUPTED", "FEED_HOLD", "OPTIONAL_STOP", "WAIT",
                                      "PROGRAM_STOPPED", "PROGRAM_OPTIONAL_STOP"}) {
    if (execution == word) return ProgramState::kPaused;
  }
  for (const std::string_view word : {"READY", "STOPPED", "PROGRAM_COMPLETED"}) {
    if (execution == word) return ProgramState::kIdle;
  }
  return ProgramState::kUnknown;
}

}  // namespace

DeviceState::DeviceState(ItemPlan plan, LoadUnit load_unit, std::int64_t gather_ns)
    : plan_(std::move(plan)), gather_ns_(gather_ns) {
  now_.load_unit = load_unit;
}

void DeviceState::complain(const Observation& one, std::string_view wanted) {
  ++damaged_;
  trouble_ = trf("data item {} reads '{}': must be {}", one.id, shown(one.text), wanted);
}

/// NaN: it is not known, or was no such number.
double DeviceState::number_of(const Observation& one, const TakenItem& item, double most) {
  if (!one.is_available()) return kNothing;
  const std::optional<double> value = parse_decimal(one.text);
  const double result = value ? *value * item.scale + item.offset : kNothing;
  if (std::abs(result) <= most) return result;
  complain(one, trf("a number from {:g} to {:g}", -most, most));
  return kNothing;
}

std::int32_t DeviceState::whole_of(const Observation& one, const TakenItem& item) {
  // Tools have names at some machines, and lines their N words.
  const std::optional<double> value = parse_decimal(one.text);
  if (!value) return AxisSample::kUnknown;
  const double result = *value * item.scale + item.offset;
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  if (result >= 0 && result <= kMost && result == std::round(result)) {
    return static_cast<std::int32_t>(result);
  }
  complain(one, tr("a whole number, 0 or more"));
  return AxisSample::kUnknown;
}

void DeviceState::set_axis(std::size_t axis, const TakenItem& item, std::string_view text) {
  const std::optional<double> value = parse_decimal(text);
  const double position = value ? *value * item.scale + item.offset : kNothing;
  if (std::abs(position) <= kMostPosition) {
    now_.set(axis, position);
    return;
  }
  now_.known = static_cast<std::uint16_t>(now_.known & ~(1U << axis));
  now_.fresh = static_cast<std::uint16_t>(now_.fresh & ~(1U << axis));
}

/// "10.5 -3 0": X, Y and Z.
bool DeviceState::set_path(const Observation& one) {
  if (!plan_.path_position || one.id != plan_.path_position->id) return false;
  const std::vector<std::string_view> words = words_of(one.text);
  if (one.is_available() && words.size() != 3) complain(one, tr("three numbers"));
  for (std::size_t i = 0; i < 3; ++i) {
    set_axis(i, *plan_.path_position, words.size() == 3 ? words[i] : "");
  }
  return true;
}

/// True: it is a data item that counts.
bool DeviceState::apply(const Observation& one) {
  if (set_path(one)) return true;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!plan_.axes[i] || plan_.axes[i]->id != one.id) continue;
    const double value = number_of(one, *plan_.axes[i], kMostPosition);
    set_axis(i, *plan_.axes[i], std::isnan(value) ? "" : std::string_view(one.text));
    return true;
  }
  const auto is = [&](const std::optional<TakenItem>& item) { return item && item->id == one.id; };
  const auto word = [&](const std::string& id, std::string& out) {
    if (id.empty() || id != one.id) return false;
    out = one.text;
    return true;
  };
  if (is(plan_.tool)) return now_.tool = whole_of(one, *plan_.tool), true;
  if (is(plan_.line)) return now_.line = whole_of(one, *plan_.line), true;
  if (is(plan_.spindle)) return rpm_ = number_of(one, *plan_.spindle, kMostTurns_rpm), true;
  if (is(plan_.load)) return now_.load = number_of(one, *plan_.load, kMostLoad), true;
  if (is(plan_.tool_offset_z)) {
    now_.tool_offset_z_mm = number_of(one, *plan_.tool_offset_z, kMostOffset_mm);
    return true;
  }
  if (!plan_.tool_offsets.empty() && one.id == plan_.tool_offsets) {
    now_.tool_offset_z_mm = kNothing;
    for (const auto& [key, text] : one.cells) {
      if (key == "Z") now_.tool_offset_z_mm = parse_decimal(text).value_or(kNothing);
    }
    return true;
  }
  if (!plan_.availability.empty() && one.id == plan_.availability) {
    is_available_ = one.is_available();
    return true;
  }
  return word(plan_.execution, execution_) || word(plan_.mode, mode_) ||
         word(plan_.direction, direction_);
}

/// What hangs on more than one data item.
void DeviceState::settle() {
  now_.program = program_of(execution_, mode_);
  now_.spindle_rpm = rpm_;
  if (direction_ == "COUNTER_CLOCKWISE") now_.spindle_rpm = -std::abs(rpm_);
  if (direction_ == "CLOCKWISE") now_.spindle_rpm = std::abs(rpm_);
}

/// The axis, or the path, that it is of has been told for this sample already.
bool DeviceState::is_told(const Observation& one) const {
  if (plan_.path_position && one.id == plan_.path_position->id) return (now_.fresh & 1U) != 0;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (plan_.axes[i] && plan_.axes[i]->id == one.id) return (now_.fresh >> i & 1U) != 0;
  }
  return false;
}

std::vector<DeviceState::Stamped> DeviceState::take(std::span<const Observation> observations) {
  std::vector<Stamped> out;
  const auto close = [&] {
    if (!std::exchange(is_open_, false)) return;
    settle();
    fresh_before_ = now_.fresh;
    out.push_back({now_, newest_ns_, missing().empty()});
  };
  if (observations.empty()) close();
  for (const Observation& one : observations) {
    const bool is_late = std::abs(one.stamp_ns - begun_ns_) > gather_ns_;
    // An axis that is told twice has been at both places.
    if (is_open_ && (is_late || is_told(one))) close();
    if (!is_open_) now_.fresh = 0;
    if (!apply(one)) continue;
    if (!is_open_) begun_ns_ = newest_ns_ = one.stamp_ns;
    newest_ns_ = std::max(newest_ns_, one.stamp_ns);
    is_open_ = true;
  }
  // An axis that was told with these the last time may be in the next answer.
  if ((fresh_before_ & ~now_.fresh) == 0 || now_.fresh == 0) close();
  return out;
}

AxisSample DeviceState::sample() const {
  AxisSample out = now_;
  out.fresh = out.known;
  return out;
}

std::uint16_t DeviceState::mapped() const {
  std::uint16_t bits = 0;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (plan_.axes[i] || (plan_.path_position && i < 3)) {
      bits = static_cast<std::uint16_t>(bits | 1U << i);
    }
  }
  return bits;
}

std::string DeviceState::missing() const {
  if (!is_available_) return tr("the agent says that the machine is UNAVAILABLE");
  // Where none of X Y Z is told, those that are.
  constexpr std::uint16_t kTip = 7;
  const std::uint16_t all = mapped();
  const std::uint16_t needed = (all & kTip) != 0 ? all & kTip : all;
  const auto lacking = static_cast<std::uint16_t>(needed & ~now_.known);
  if (lacking == 0) return {};
  std::string letters;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((lacking >> i & 1U) == 0) continue;
    letters += letters.empty() ? "" : ", ";
    letters += "XYZABCUVW"[i];
  }
  return trf("the agent has no position of {} (UNAVAILABLE)", letters);
}

}  // namespace kerf
