#include "machine_io/modbus/modbus_source.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "machine_io/modbus/modbus_link.h"
#include "machine_io/modbus/poll_plan.h"
#include "machine_io/modbus/poll_schedule.h"
#include "machine_io/modbus/reading_check.h"

namespace kerf {
namespace {

using std::chrono::milliseconds;

/// A counter may stand still for some polls of a device slower than poll_hz.
constexpr std::chrono::seconds kCounterPatience{1};
/// Answers within so much of twice the usual time are not late.
constexpr std::int64_t kPrompt_ns = 5'000'000;
/// The usual time grows by one part in so many at each answer.
constexpr std::int64_t kSlowing = 16;
constexpr double kMaxNumber = 2147483647;  ///< tool or line: int32
constexpr double kMaxRpm = 1e6;
constexpr double kMaxToolOffset_mm = 1e4;
/// A tool or line number read as a float and scaled.
constexpr double kWholeTolerance = 1e-6;
constexpr int kIllegalAddress = 2;
constexpr int kIllegalValue = 3;

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::unique_ptr<ModbusLink> make_link(const ModbusSettings& settings) {
  return settings.rtu ? make_rtu_link(settings) : make_tcp_link(settings);
}

enum class Extra : std::uint8_t {
  kTool,
  kLine,
  kSpindle,
  kToolOffset,
  kTrigger,
  kLoad,
  kCounterBegun,
  kCounter
};
constexpr std::string_view kExtraKeys[] = {"tool",    "line", "spindle",       "tool_offset_z",
                                           "trigger", "load", "counter_begun", "counter"};
/// Answers of two cycles in a row that are asked for again. A cycle takes the device microseconds.
constexpr int kMostTornAnswers = 10;

bool is_whole(double value) {
  return value >= 0 && value <= kMaxNumber && std::abs(value - std::round(value)) < kWholeTolerance;
}

bool is_plausible(Extra what, double value) {
  switch (what) {
    case Extra::kTool:
    case Extra::kLine:
    case Extra::kTrigger:
      return is_whole(value);
    case Extra::kSpindle:
      return std::abs(value) <= kMaxRpm;
    case Extra::kToolOffset:
      return std::abs(value) <= kMaxToolOffset_mm;
    case Extra::kLoad:
      return std::abs(value) <= kMostLoad;
    case Extra::kCounterBegun:
    case Extra::kCounter:
      break;
  }
  return true;
}

std::string_view allowed(Extra what) {
  switch (what) {
    case Extra::kTool:
    case Extra::kLine:
    case Extra::kTrigger:
      return tr("a whole number, 0 or more");
    case Extra::kSpindle:
      return tr("-1e6 to 1e6 rpm");
    case Extra::kLoad:
      return "-1e5 to 1e5";
    default:
      return tr("-1e4 to 1e4 mm");
  }
}

}  // namespace

struct ModbusSource::Poller {
  explicit Poller(ModbusSettings given);

  Next next(AxisSample& sample, milliseconds patience);

  bool ready(SteadyClock::time_point deadline);
  bool poll(AxisSample& sample);
  bool read_all();
  bool fill(AxisSample& sample);
  bool fill_extra(AxisSample& sample, Extra what, double value, const std::uint16_t* words);
  bool read_whole_cycle();
  bool counter_moved();
  std::int64_t lateness_ns(std::int64_t took_ns);
  void failed(std::string trouble);

  double value_of(std::size_t item) const {
    const ModbusRegister& wanted = wanted_[item];
    return decode_registers(wanted.type, wanted.order, words_of(item)) * wanted.scale +
           wanted.offset;
  }
  const std::uint16_t* words_of(std::size_t item) const { return &words_[plan_.first_word[item]]; }

  const ModbusSettings settings_;
  std::vector<ModbusRegister> wanted_;  ///< axes_ first, then extras_
  std::vector<std::size_t> axes_;
  std::vector<Extra> extras_;
  PollPlan plan_;
  std::vector<std::uint16_t> words_;

  std::unique_ptr<ModbusLink> link_;
  PollSchedule schedule_;
  BackOff back_off_;
  SteadyClock::time_point next_attempt_{};
  bool has_connected_ = false;
  bool unsettled_ = false;

  ReadingCheck check_;
  AxisReading reading_;
  HostStamp host_stamp_;
  std::int64_t asked_ns_ = 0;  ///< CLOCK_MONOTONIC, of the last answer
  std::int64_t usual_ns_ = 0;  ///< from question to answer
  std::optional<double> counter_;
  SteadyClock::time_point counter_moved_{};
  SourceStatus status_;
};

ModbusSource::Poller::Poller(ModbusSettings given)
    : settings_(std::move(given)),
      link_(make_link(settings_)),
      schedule_(settings_.poll_hz),
      check_(settings_) {
  for (std::size_t i = 0; i < kMaxPositions; ++i) {
    if (!settings_.axes[i]) continue;
    axes_.push_back(i);
    wanted_.push_back(*settings_.axes[i]);
  }
  const std::pair<Extra, const std::optional<ModbusRegister>&> extras[] = {
      {Extra::kTool, settings_.tool},
      {Extra::kLine, settings_.line},
      {Extra::kSpindle, settings_.spindle},
      {Extra::kToolOffset, settings_.tool_offset_z},
      {Extra::kTrigger, settings_.trigger},
      {Extra::kLoad, settings_.load},
      {Extra::kCounterBegun, settings_.counter_begun},
      {Extra::kCounter, settings_.counter}};
  for (const auto& [what, wanted] : extras) {
    if (!wanted) continue;
    extras_.push_back(what);
    wanted_.push_back(*wanted);
  }
  plan_ = plan_reads(wanted_, settings_.max_gap);
  words_.resize(plan_.words);
}

void ModbusSource::Poller::failed(std::string trouble) {
  ++status_.errors;
  status_.state = SourceState::kConnecting;
  status_.trouble = std::move(trouble);
}

/// Connects, or brings questions and answers into step again. False: not yet, or it failed.
bool ModbusSource::Poller::ready(SteadyClock::time_point deadline) {
  if (!link_->is_open()) {
    if (next_attempt_ > deadline) {
      sleep_until(deadline);
      return false;
    }
    sleep_until(next_attempt_);
    // The next wait is known before the attempt: connecting that takes long is not punished twice.
    next_attempt_ = SteadyClock::now() + back_off_.next();
    if (!link_->open()) {
      failed(link_->trouble());
      return false;
    }
    if (has_connected_) ++status_.reconnects;
    has_connected_ = true;
    unsettled_ = true;
  }
  if (!unsettled_) return true;
  const ModbusLink::Settling settling = link_->settle(deadline);
  status_.errors += link_->take_failures();
  switch (settling) {
    case ModbusLink::Settling::kSettled:
      unsettled_ = false;
      schedule_.start(SteadyClock::now());
      return true;
    case ModbusLink::Settling::kWaiting:
      if (!link_->trouble().empty()) status_.trouble = link_->trouble();
      return false;
    case ModbusLink::Settling::kBroken:
      failed(link_->trouble());
      return false;
  }
  return false;
}

bool ModbusSource::Poller::read_all() {
  asked_ns_ = now_ns(CLOCK_MONOTONIC);
  for (const PollRead& read : plan_.reads) {
    switch (link_->read(read, &words_[read.first_word])) {
      case ModbusLink::Answer::kWords:
        continue;
      case ModbusLink::Answer::kException: {
        failed(link_->trouble());
        back_off_.reset();
        const int code = link_->exception_code();
        if (read.has_gaps && (code == kIllegalAddress || code == kIllegalValue)) {
          status_.trouble += tr("; from now on without the registers between");
          plan_ = plan_reads(wanted_, 0);
          words_.resize(plan_.words);
        }
        return false;
      }
      case ModbusLink::Answer::kBroken:
        failed(link_->trouble());
        unsettled_ = true;
        return false;
    }
  }
  return true;
}

/// read_all() until the answer is of one cycle, where the device tells.
bool ModbusSource::Poller::read_whole_cycle() {
  for (int torn = 0; torn < kMostTornAnswers; ++torn) {
    if (!read_all()) return false;
    if (!settings_.counter_begun) return true;
    const std::size_t last = wanted_.size() - 1;
    if (value_of(last) == value_of(last - 1)) return true;
  }
  const std::size_t last = wanted_.size() - 1;
  failed(trf("{} answers in a row are of two cycles: counter_begun reads {:.0f}, counter {:.0f}",
             kMostTornAnswers, value_of(last - 1), value_of(last)));
  return false;
}

/// By how much now is later than the reading, `took_ns` after it was asked for. What took longer
/// than usual was held up behind the reading: on its way, or because this program had to wait.
std::int64_t ModbusSource::Poller::lateness_ns(std::int64_t took_ns) {
  // It gets slower slowly, and quicker at once.
  usual_ns_ = usual_ns_ == 0 ? took_ns : std::min(took_ns, usual_ns_ + usual_ns_ / kSlowing);
  return std::max<std::int64_t>(0, took_ns - 2 * usual_ns_ - kPrompt_ns);
}

/// Whether the device has done anything since the last poll.
bool ModbusSource::Poller::counter_moved() {
  if (extras_.empty() || extras_.back() != Extra::kCounter) return true;
  const double value = value_of(wanted_.size() - 1);
  const SteadyClock::time_point now = SteadyClock::now();
  if (counter_ != value) {
    counter_ = value;
    counter_moved_ = now;
    return true;
  }
  ++status_.duplicates;
  if (now - counter_moved_ >= kCounterPatience) {
    status_.state = SourceState::kConnecting;
    status_.trouble = trf(
        "the counter stands at {:.0f} for {:.0f} s: the device answers but its program does not "
        "run",
        value, std::chrono::duration<double>(now - counter_moved_).count());
  }
  return false;
}

bool ModbusSource::Poller::fill_extra(AxisSample& sample, Extra what, double value,
                                      const std::uint16_t* words) {
  if (!is_plausible(what, value)) {
    failed(trf("{} reads {:.6g}, raw {:04X} ...: must be {}",
               kExtraKeys[static_cast<std::size_t>(what)], value, words[0], allowed(what)));
    return false;
  }
  switch (what) {
    case Extra::kTool:
      sample.tool = static_cast<std::int32_t>(std::lround(value));
      break;
    case Extra::kLine:
      sample.line = static_cast<std::int32_t>(std::lround(value));
      break;
    case Extra::kSpindle:
      sample.spindle_rpm = value;
      break;
    case Extra::kToolOffset:
      sample.tool_offset_z_mm = value;
      break;
    case Extra::kTrigger:
      sample.trigger = static_cast<std::int32_t>(std::lround(value));
      break;
    case Extra::kLoad:
      sample.load = value;
      sample.load_unit = settings_.load_unit;
      break;
    case Extra::kCounterBegun:
    case Extra::kCounter:
      break;
  }
  return true;
}

bool ModbusSource::Poller::fill(AxisSample& sample) {
  for (std::size_t item = 0; item < axes_.size(); ++item) {
    const std::size_t axis = axes_[item];
    reading_.value[axis] = value_of(item);
    std::copy_n(words_of(item), word_count(wanted_[item].type), reading_.raw[axis].begin());
    sample.set(axis, reading_.value[axis]);
  }
  if (!check_.accept(reading_)) {
    failed(check_.trouble());
    return false;
  }
  for (std::size_t i = 0; i < extras_.size(); ++i) {
    const std::size_t item = axes_.size() + i;
    if (!fill_extra(sample, extras_[i], value_of(item), words_of(item))) return false;
  }
  return true;
}

/// One poll. False: no sample came of it; whether that was a fault, the status says.
bool ModbusSource::Poller::poll(AxisSample& sample) {
  if (!read_whole_cycle()) return false;
  const std::int64_t steady_ns = now_ns(CLOCK_MONOTONIC);
  const std::int64_t late_ns = lateness_ns(steady_ns - asked_ns_);
  const std::int64_t host_ns = host_stamp_.stamp(now_ns(CLOCK_REALTIME), steady_ns) - late_ns;
  back_off_.reset();
  AxisSample filled;
  reading_.time = SteadyClock::now() - std::chrono::nanoseconds(late_ns);
  if (!counter_moved() || !fill(filled)) return false;
  sample = filled;
  sample.host_ns = host_ns;
  if (host_stamp_.stepped_back_ns() > 0) {
    ++status_.disordered;
    status_.trouble = trf("this computer's clock was set back by {:.3f} s",
                          static_cast<double>(host_stamp_.stepped_back_ns()) * 1e-9);
  }
  ++status_.samples;
  status_.state = SourceState::kReading;
  return true;
}

PositionSource::Next ModbusSource::Poller::next(AxisSample& sample, milliseconds patience) {
  const SteadyClock::time_point deadline = SteadyClock::now() + patience;
  for (;;) {
    if (!ready(deadline)) return Next::kNothing;
    if (schedule_.due() > deadline) {
      sleep_until(deadline);
      return Next::kNothing;
    }
    sleep_until(schedule_.due());
    schedule_.begun(SteadyClock::now());
    const std::uint64_t errors = status_.errors;
    if (poll(sample)) return Next::kSample;
    if (status_.errors != errors) return Next::kNothing;
  }
}

ModbusSource::ModbusSource(ModbusSettings settings)
    : poller_(std::make_unique<Poller>(std::move(settings))) {}
ModbusSource::~ModbusSource() = default;

PositionSource::Next ModbusSource::next(AxisSample& sample, milliseconds patience) {
  return poller_->next(sample, patience);
}

const SourceStatus& ModbusSource::status() const { return poller_->status_; }

std::string ModbusSource::describe() const {
  const ModbusSettings& s = poller_->settings_;
  if (s.rtu) {
    return trf("modbus rtu {} {} {}{}{} unit {}", s.device, s.baud, s.data_bits, s.parity,
               s.stop_bits, s.unit);
  }
  return trf("modbus tcp {}:{} unit {}", s.host, s.port, s.unit);
}

}  // namespace kerf
