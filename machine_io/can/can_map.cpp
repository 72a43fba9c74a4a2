#include "machine_io/can/can_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kNanosecondsPerMillisecond = 1e6;
constexpr double kLeastGather_ms = 0.1;
constexpr double kMostGather_ms = 10'000.0;

bool same_bits(const CanBits& a, const CanBits& b) {
  return a.start_bit == b.start_bit && a.length == b.length && a.endian == b.endian;
}

bool same_place(const CanSignal& a, const CanSignal& b) {
  if (a.id != b.id || a.extended != b.extended || !same_bits(a.bits, b.bits)) return false;
  if (a.mux.has_value() != b.mux.has_value()) return false;
  return !a.mux || (same_bits(a.mux->bits, b.mux->bits) && a.mux->value == b.mux->value);
}

/// Every mapped signal with the last part of its key.
std::vector<std::pair<std::string, const CanSignal*>> mapped_signals(const CanMap& map) {
  std::vector<std::pair<std::string, const CanSignal*>> all;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (map.axes[i]) all.emplace_back(map.axis_keys[i], &*map.axes[i]);
  }
  if (map.tool) all.emplace_back("tool", &*map.tool);
  if (map.line) all.emplace_back("line", &*map.line);
  if (map.spindle) all.emplace_back("spindle", &*map.spindle);
  if (map.tool_offset_z) all.emplace_back("tool_offset_z", &*map.tool_offset_z);
  if (map.trigger) all.emplace_back("trigger", &*map.trigger);
  if (map.load) all.emplace_back("load", &*map.load);
  return all;
}

/// Not an id that means something else.
int sync_id_of(const CanMap& map) {
  for (const auto& [name, signal] : mapped_signals(map)) {
    if (!signal->extended && static_cast<int>(signal->id) == map.sync_id) return -1;
  }
  return map.sync_id;
}

std::int64_t nanoseconds(double milliseconds) {
  return std::llround(milliseconds * kNanosecondsPerMillisecond);
}

}  // namespace

std::vector<std::string> validate(const CanMap& map, const std::string& key) {
  std::vector<std::string> faults;
  const auto signals = mapped_signals(map);
  for (const auto& [name, signal] : signals) {
    const auto of_signal = validate(*signal, key + "." + name);
    faults.insert(faults.end(), of_signal.begin(), of_signal.end());
  }
  if (std::none_of(map.axes.begin(), map.axes.end(), [](const auto& a) { return a.has_value(); })) {
    faults.push_back(trf("{}: no axis is mapped; at least one of {} is needed", key,
                         fmt::join(map.axis_keys, ", ")));
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!same_place(*signals[i].second, *signals[k].second)) continue;
      faults.push_back(
          trf("{0}.{1}: reads the same bits of frame {2} as {0}.{3}", key, signals[i].first,
              can_id_text(signals[i].second->id, signals[i].second->extended), signals[k].first));
    }
  }
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    const CanAxisRange& range = map.ranges[i];
    if (range.min && range.max && !(*range.min < *range.max)) {
      faults.push_back(trf("{}.{}.max: {} is not allowed; must be above min {}", key,
                           map.axis_keys[i], *range.max, *range.min));
    }
  }
  if (map.sync_id < -1 || map.sync_id > static_cast<int>(kMaxStandardCanId)) {
    faults.push_back(
        trf("{}.sync_id: {} is not allowed; must be 0 to 0x7FF, or -1 for none", key, map.sync_id));
  }
  if (!(map.gather_ms >= kLeastGather_ms && map.gather_ms <= kMostGather_ms)) {
    faults.push_back(trf("{}.gather_ms: {} is not allowed; must be {} to {} ms", key, map.gather_ms,
                         kLeastGather_ms, kMostGather_ms));
  }
  return faults;
}

CanSignal cia402_position(std::uint8_t node, double mm_per_count) {
  CanSignal signal;
  signal.id = 0x380U + node;
  signal.bits = {can_start_of_byte(2, CanEndian::kLittle), 32, CanEndian::kLittle};
  signal.scale = mm_per_count;
  return signal;
}

CanSignal odrive_position(std::uint8_t node, double mm_per_turn) {
  CanSignal signal;
  signal.id = static_cast<std::uint32_t>(node) << 5U | 9U;
  signal.bits = {0, 32, CanEndian::kLittle};
  signal.type = CanType::kFloat32;
  signal.scale = mm_per_turn;
  return signal;
}

CanAssembler::CanAssembler(const CanMap& map) : gather_ns_(nanoseconds(map.gather_ms)) {
  std::uint16_t axes = 0;
  bool is_cyclic = true;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    names_[i] = map.axis_keys[i];
    if (!map.axes[i]) continue;
    add(i, *map.axes[i]);
    // Machines overshoot their limits a little.
    const CanAxisRange& range = map.ranges[i];
    const double slack = range.min && range.max ? (*range.max - *range.min) / 100 : 1;
    if (range.min) slots_[i].low = *range.min - slack;
    if (range.max) slots_[i].high = *range.max + slack;
    axes = static_cast<std::uint16_t>(axes | 1U << i);
    is_cyclic = is_cyclic && map.axes[i]->max_age_ms > 0;
  }
  cycle_ = CanCycle(axes, gather_ns_, is_cyclic);
  names_[kTool] = "tool";
  names_[kLine] = "line";
  names_[kSpindle] = "spindle";
  names_[kToolOffsetZ] = "tool_offset_z";
  names_[kTrigger] = "trigger";
  names_[kLoad] = "load";
  if (map.tool) add(kTool, *map.tool);
  if (map.line) add(kLine, *map.line);
  if (map.spindle) add(kSpindle, *map.spindle);
  if (map.tool_offset_z) add(kToolOffsetZ, *map.tool_offset_z);
  if (map.trigger) add(kTrigger, *map.trigger);
  if (map.load) add(kLoad, *map.load);
  load_unit_ = map.load_unit;
  sync_id_ = sync_id_of(map);
}

void CanAssembler::add(std::size_t slot, const CanSignal& signal) {
  slots_[slot].signal = signal;
  slots_[slot].max_age_ns = nanoseconds(signal.max_age_ms);
  used_[used_count_++] = slot;
}

void CanAssembler::forget() {
  for (Slot& slot : slots_) slot.at_ns = AxisSample::kNoTime;
  cycle_.forget();
  held_count_ = 0;
  is_doubted_ = false;
  is_first_ = true;
  ready_count_ = 0;
  newest_ns_ = AxisSample::kNoTime;
}

/// Data of a SYNC is its count at most.
bool CanAssembler::is_sync(const CanFrame& frame) const {
  return sync_id_ >= 0 && !frame.error && !frame.remote && !frame.extended &&
         frame.id == static_cast<std::uint32_t>(sync_id_) && frame.length <= 1;
}

bool CanAssembler::note_unfit(std::size_t slot, const CanFrame& frame, CanFit fit, double value) {
  if (fit == CanFit::kValue) {
    // Tools and lines are counts; anything else is a wrong map or a damaged frame.
    if (slot < kMaxPositions) {
      if (value >= slots_[slot].low && value <= slots_[slot].high) return false;
    } else if (slot == kLoad) {
      if (std::abs(value) <= kMostLoad) return false;
    } else if (slot != kTool && slot != kLine && slot != kTrigger) {
      return false;
    } else if (std::round(value) >= 0.0 &&
               std::round(value) <= static_cast<double>(std::numeric_limits<std::int32_t>::max())) {
      return false;
    }
  }
  unfit_ = {slot, fit, frame.length, value};
  return true;
}

CanAssembler::Taken CanAssembler::push(const CanFrame& frame, std::int64_t device_ns) {
  assert(ready_count_ == 0);
  if (is_sync(frame)) {
    if (cycle_.ends_at_sync()) {
      close_incomplete();
      cycle_.ends_at_sync();
    }
    return Taken::kNotMapped;
  }
  std::array<Arrival, kSlots> arrivals;
  std::size_t count = 0;
  std::uint16_t axes = 0;
  bool unfit = false;
  for (std::size_t i = 0; i < used_count_; ++i) {
    const std::size_t slot = used_[i];
    const CanReading reading = read_can_signal(frame, slots_[slot].signal);
    if (reading.fit == CanFit::kOther) continue;
    if (note_unfit(slot, frame, reading.fit, reading.value)) {
      unfit = true;
      continue;
    }
    arrivals[count++] = {slot, reading.value};
    if (slot < kMaxPositions) axes = static_cast<std::uint16_t>(axes | 1U << slot);
  }
  if (count == 0) return unfit ? Taken::kUnfit : Taken::kNotMapped;

  bool stepped = false;
  if (newest_ns_ != AxisSample::kNoTime && device_ns < newest_ns_) {
    if (newest_ns_ - device_ns <= kLateNs) return Taken::kLate;
    forget();
    stepped = true;
  }
  if (axes != 0 && is_doubted_) settle_doubt(device_ns);
  if (std::exchange(is_broken_, false) && !cycle_.is_empty()) close_incomplete();
  if (axes != 0 && held_count_ > 0 && cycle_.is_empty() && !cycle_.seems_shifted(device_ns)) {
    release_held();
  }
  if (cycle_.ends_before(axes, device_ns)) close_incomplete();
  newest_ns_ = device_ns;
  for (std::size_t i = 0; i < count; ++i) {
    slots_[arrivals[i].slot].value = arrivals[i].value;
    slots_[arrivals[i].slot].at_ns = device_ns;
  }
  if (axes != 0) {
    cycle_.add(axes, device_ns);
    if (cycle_.is_complete()) close();
  }
  if (stepped) return Taken::kClockStepped;
  return unfit ? Taken::kUnfit : Taken::kTaken;
}

/// A whole cycle is gathered.
void CanAssembler::close() {
  const AxisSample sample = gathered_sample();
  const CanCycle::Verdict verdict = cycle_.close();
  if (verdict == CanCycle::Verdict::kShifted) {
    // What was held is of two cycles, too.
    held_count_ = 0;
    return;
  }
  if (verdict == CanCycle::Verdict::kDoubted) {
    release_held();
    doubted_ = sample;
    is_doubted_ = true;
    return;
  }
  const bool is_first = std::exchange(is_first_, false);
  if (is_first ? cycle_.has_pause() : held_count_ > 0 && cycle_.may_be_shifted()) {
    assert(held_count_ < held_.size());
    held_[held_count_++] = sample;
    return;
  }
  release_held();
  make_ready(sample);
  incomplete_ += static_cast<std::uint64_t>(cycle_.take_missing());
}

void CanAssembler::close_incomplete() {
  release_held();
  const AxisSample sample = gathered_sample();
  if (!cycle_.close_incomplete()) make_ready(sample);
}

void CanAssembler::release_held() {
  for (std::size_t i = 0; i < held_count_; ++i) make_ready(held_[i]);
  held_count_ = 0;
}

/// A frame of the next cycle has come, or none comes any more.
void CanAssembler::settle_doubt(std::int64_t next_ns) {
  is_doubted_ = false;
  if (!cycle_.is_doubt_true(next_ns)) {
    make_ready(doubted_);
    return;
  }
  incomplete_ += static_cast<std::uint64_t>(cycle_.take_missing());
}

void CanAssembler::make_ready(const AxisSample& sample) {
  assert(ready_count_ < ready_.size());
  ready_[ready_count_++] = sample;
}

void CanAssembler::flush() {
  if (is_doubted_) settle_doubt(std::numeric_limits<std::int64_t>::max());
  if (cycle_.is_empty()) {
    release_held();
  } else {
    close_incomplete();
  }
}

bool CanAssembler::is_known(const Slot& slot) const {
  if (slot.at_ns == AxisSample::kNoTime) return false;
  return slot.max_age_ns == 0 || cycle_.last_ns() - slot.at_ns <= slot.max_age_ns;
}

AxisSample CanAssembler::gathered_sample() const {
  AxisSample sample;
  sample.device_ns = cycle_.last_ns();
  for (std::size_t i = 0; i < used_count_; ++i) {
    const Slot& slot = slots_[used_[i]];
    if (!is_known(slot)) continue;
    switch (used_[i]) {
      case kTool:
        sample.tool = static_cast<std::int32_t>(std::lround(slot.value));
        break;
      case kLine:
        sample.line = static_cast<std::int32_t>(std::lround(slot.value));
        break;
      case kSpindle:
        sample.spindle_rpm = slot.value;
        break;
      case kToolOffsetZ:
        sample.tool_offset_z_mm = slot.value;
        break;
      case kTrigger:
        sample.trigger = static_cast<std::int32_t>(std::lround(slot.value));
        break;
      case kLoad:
        sample.load = slot.value;
        sample.load_unit = load_unit_;
        break;
      default:
        sample.position[used_[i]] = slot.value;
        sample.known = static_cast<std::uint16_t>(sample.known | 1U << used_[i]);
    }
  }
  sample.fresh = cycle_.gathered() & sample.known;
  return sample;
}

bool CanAssembler::next(AxisSample& sample) {
  if (ready_count_ == 0) return false;
  sample = ready_[0];
  std::copy(ready_.begin() + 1, ready_.end(), ready_.begin());
  --ready_count_;
  return true;
}

std::string CanAssembler::incomplete_text() const {
  std::string names;
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if ((cycle_.missing_axes() >> i & 1U) == 0) continue;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", names_[i]);
  }
  return trf("a cycle of the bus came without {} and was dropped (a frame was lost?)", names);
}

std::string CanAssembler::unfit_text() const {
  const CanSignal& signal = slots_[unfit_.slot].signal;
  const std::string what = trf("frame {} has ", can_id_text(signal.id, signal.extended));
  const std::string& name = names_[unfit_.slot];
  switch (unfit_.fit) {
    case CanFit::kTooShort:
      return trf("{}{} bytes, too few for {}: {} bits from bit {} on", what, unfit_.length, name,
                 signal.bits.length, signal.bits.start_bit);
    case CanFit::kNotFinite:
      return trf("{}no finite number in {}; is its type or byte order another?", what, name);
    case CanFit::kValue:
      if (unfit_.slot < kMaxPositions) {
        return trf("{}{:g} in {}, beyond min or max and what a machine may overshoot", what,
                   unfit_.value, name);
      }
      if (unfit_.slot == kLoad)
        return trf("{}{:g} in {}, more than any spindle has", what, unfit_.value, name);
      return trf("{}{} in {}, which must be 0 or above", what, unfit_.value, name);
    case CanFit::kOther:
      break;
  }
  return {};
}

}  // namespace kerf
