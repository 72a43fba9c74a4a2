#include "machine_io/hal/hal_pins.h"

#include <hal.h>
#include <sys/shm.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace kerf {
namespace {

/// Key of HAL's shared memory on uspace: "HAL2". There is one HAL to an IPC namespace.
constexpr key_t kHalKey = 0x48414C32;

constexpr std::array<char, kHalAxes> kAxisLetters{'x', 'y', 'z', 'a', 'b', 'c', 'u', 'v', 'w'};

/// LinuxCNC's own limit of joints.
constexpr std::uint32_t kMostJoints = 16;

struct BitPin {
  const char* name;
  std::uint32_t bit;
};
constexpr std::array<BitPin, 5> kBitPins{{{"motion.in-position", kHalInPosition},
                                          {"halui.program.is-running", kHalProgramRunning},
                                          {"halui.program.is-paused", kHalProgramPaused},
                                          {"halui.program.is-idle", kHalProgramIdle},
                                          {"halui.mode.is-auto", kHalModeAuto}}};

/// Places of the pins in HalPins::wanted_, in the order of their creation.
constexpr std::size_t kJoints = 0;
constexpr std::size_t kAxisOffsets = kJoints + kMostJoints;
constexpr std::size_t kToolOffsets = kAxisOffsets + kHalAxes;
constexpr std::size_t kSpindle = kToolOffsets + kHalAxes;
constexpr std::size_t kVelocity = kSpindle + 1;
constexpr std::size_t kLine = kVelocity + 1;
constexpr std::size_t kTool = kLine + 1;
constexpr std::size_t kServoPeriod = kTool + 1;
constexpr std::size_t kBits = kServoPeriod + 1;
constexpr std::size_t kLoad = kBits + kBitPins.size();  // the last, and not always there

/// No type of HAL.
constexpr auto kAnyNumber = HAL_TYPE_UNSPECIFIED;

double number_of(hal_type_t type, const hal_data_u& value) {
  switch (type) {
    case HAL_FLOAT:
      return value.f;
    case HAL_S32:
      return value.s;
    case HAL_U32:
      return value.u;
    default:
      return kHalAbsent;
  }
}

}  // namespace

std::int64_t now_ns(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// Pointers to the pins' values; HAL moves them when a pin is linked, so they live in its memory.
struct HalPins::StatusPins {
  hal_bit_t* collision_ahead;
  hal_float_t* collision_seconds;
  hal_s32_t* finding_line;
  hal_bit_t* off_path;
  hal_float_t* off_path_mm;
  hal_bit_t* stale;
  hal_bit_t* alive;
  hal_u32_t* heartbeat;
  hal_bit_t* beat;
  hal_bit_t* program_ok;
  hal_s32_t* findings;
  hal_float_t* time_left;
};

struct HalPins::Wanted {
  std::string name;
  hal_type_t type;
  const hal_data_u* value = nullptr;  ///< nullptr: no such pin now
  hal_type_t found_type = HAL_TYPE_UNSPECIFIED;
};

HalPresence look_for_hal() {
  if (shmget(kHalKey, 0, 0600) >= 0) return HalPresence::kRunning;
  return errno == ENOENT ? HalPresence::kNone : HalPresence::kForbidden;
}

std::unique_ptr<HalPins> HalPins::attach(const std::string& load_pin, std::string& trouble) {
  std::unique_ptr<HalPins> pins(new HalPins);
  const std::string name = "kerf-hal-" + std::to_string(getpid());
  pins->component_ = hal_init(name.c_str());
  if (pins->component_ < 0) {
    trouble = filled_in(HalMessage::kNoComponent, name + ": " + std::strerror(-pins->component_));
    return nullptr;
  }
  for (std::uint32_t joint = 0; joint < kMostJoints; ++joint) {
    pins->wanted_.push_back({"joint." + std::to_string(joint) + ".pos-fb", HAL_FLOAT});
  }
  for (const char letter : kAxisLetters) {
    pins->wanted_.push_back({std::string("axis.") + letter + ".eoffset", HAL_FLOAT});
  }
  for (const char letter : kAxisLetters) {
    pins->wanted_.push_back({std::string("motion.tooloffset.") + letter, HAL_FLOAT});
  }
  pins->wanted_.push_back({"spindle.0.speed-out", HAL_FLOAT});
  pins->wanted_.push_back({"motion.current-vel", HAL_FLOAT});
  pins->wanted_.push_back({"motion.program-line", HAL_S32});
  pins->wanted_.push_back({"iocontrol.0.tool-number", HAL_S32});
  pins->wanted_.push_back({"motion.servo.last-period", HAL_U32});
  for (const BitPin& pin : kBitPins) pins->wanted_.push_back({pin.name, HAL_BIT});
  if (!load_pin.empty()) pins->wanted_.push_back({load_pin, kAnyNumber});
  if (!pins->create_status_pins(trouble)) return nullptr;
  hal_ready(pins->component_);
  return pins;
}

bool HalPins::create_status_pins(std::string& trouble) {
  hal_type_t type{};
  hal_data_u* value = nullptr;
  bool connected = false;
  if (hal_get_pin_value_by_name("kerf.alive", &type, &value, &connected) == 0) return true;
  auto* pins = static_cast<StatusPins*>(hal_malloc(sizeof(StatusPins)));
  if (pins == nullptr) {
    trouble = filled_in(HalMessage::kHalFull);
    return false;
  }
  const int results[] = {
      hal_pin_bit_new("kerf.collision-ahead", HAL_OUT, &pins->collision_ahead, component_),
      hal_pin_float_new("kerf.collision-seconds", HAL_OUT, &pins->collision_seconds, component_),
      hal_pin_s32_new("kerf.finding-line", HAL_OUT, &pins->finding_line, component_),
      hal_pin_bit_new("kerf.off-path", HAL_OUT, &pins->off_path, component_),
      hal_pin_float_new("kerf.off-path-mm", HAL_OUT, &pins->off_path_mm, component_),
      hal_pin_bit_new("kerf.stale", HAL_OUT, &pins->stale, component_),
      hal_pin_bit_new("kerf.alive", HAL_OUT, &pins->alive, component_),
      hal_pin_u32_new("kerf.heartbeat", HAL_OUT, &pins->heartbeat, component_),
      hal_pin_bit_new("kerf.beat", HAL_OUT, &pins->beat, component_),
      hal_pin_bit_new("kerf.program-ok", HAL_OUT, &pins->program_ok, component_),
      hal_pin_s32_new("kerf.findings", HAL_OUT, &pins->findings, component_),
      hal_pin_float_new("kerf.time-left", HAL_OUT, &pins->time_left, component_),
  };
  for (const int result : results) {
    if (result == 0) continue;
    trouble = filled_in(HalMessage::kNoPin, std::strerror(-result));
    return false;
  }
  status_pins_ = pins;
  put(HalStatusRecord{});
  show_silence();
  *status_pins_->heartbeat = 0;
  *status_pins_->beat = false;
  return true;
}

HalPins::~HalPins() {
  if (component_ < 0) return;
  if (status_pins_ != nullptr) {
    put(HalStatusRecord{});
    show_silence();
  }
  hal_exit(component_);
}

void HalPins::find(Wanted& pin) {
  hal_type_t type{};
  hal_data_u* value = nullptr;
  bool connected = false;
  const bool found = hal_get_pin_value_by_name(pin.name.c_str(), &type, &value, &connected) == 0 &&
                     (type == pin.type || pin.type == kAnyNumber);
  pin.value = found ? value : nullptr;
  pin.found_type = type;
}

/// HAL searches its whole list for each name, so only the positions are found again each time.
void HalPins::find_due() {
  constexpr std::int64_t kFindAllEvery_ns = 100'000'000;
  const std::int64_t now = now_ns(CLOCK_MONOTONIC);
  const bool all = now - all_found_ns_ >= kFindAllEvery_ns;
  if (all) all_found_ns_ = now;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const bool is_position = i < kJoints + kHalAxes && wanted_[i].value != nullptr;
    if (all || is_position) find(wanted_[i]);
  }
}

/// The period is measured in ticks of the processor, so it differs from cycle to cycle.
void HalPins::watch_servo(std::int64_t now) {
  const hal_data_u* period = wanted_[kServoPeriod].value;
  if (period == nullptr) {
    servo_seen_ns_ = now;
  } else if (period->u != servo_period_) {
    // The first reading has nothing to differ from: it may be the rest of a LinuxCNC that died.
    if (servo_period_) servo_seen_ns_ = now;
    servo_period_ = period->u;
  }
}

HalPins::Reading HalPins::read(HalSampleRecord& record) {
  find_due();
  const auto number = [this](std::size_t place) {
    const hal_data_u* value = wanted_[place].value;
    return value != nullptr ? double{value->f} : kHalAbsent;
  };
  const auto joints = [&](std::array<double, kHalAxes>& out) {
    for (std::size_t i = 0; i < kHalAxes; ++i) out[i] = number(kJoints + i);
  };
  // LinuxCNC writes one joint after the other. Twice the same: all of one servo cycle.
  constexpr int kAttempts = 4;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::array<double, kHalAxes> again{};
    joints(record.joint);
    record.realtime_ns = now_ns(CLOCK_REALTIME);
    record.monotonic_ns = now_ns(CLOCK_MONOTONIC);
    joints(again);
    if (std::memcmp(again.data(), record.joint.data(), sizeof(again)) == 0) break;
  }
  record.joint_count = 0;
  while (record.joint_count < kMostJoints &&
         wanted_[kJoints + record.joint_count].value != nullptr) {
    ++record.joint_count;
  }
  for (std::size_t i = 0; i < kHalAxes; ++i) {
    record.axis_offset[i] = number(kAxisOffsets + i);
    record.tool_offset[i] = number(kToolOffsets + i);
  }
  record.spindle_rpm = number(kSpindle);
  record.velocity = number(kVelocity);
  record.load = kHalAbsent;
  if (wanted_.size() > kLoad && wanted_[kLoad].value != nullptr)
    record.load = number_of(wanted_[kLoad].found_type, *wanted_[kLoad].value);
  record.known = kHalPinsTaken;
  record.on = taken() ? kHalPinsTaken : 0U;
  const auto integer = [&](std::size_t place, HalBit bit, std::int32_t& out) {
    const hal_data_u* value = wanted_[place].value;
    out = value != nullptr ? value->s : 0;
    if (value != nullptr) record.known |= bit;
  };
  integer(kLine, kHalProgramLine, record.program_line);
  integer(kTool, kHalToolNumber, record.tool_number);
  for (std::size_t i = 0; i < kBitPins.size(); ++i) {
    const hal_data_u* value = wanted_[kBits + i].value;
    if (value == nullptr) continue;
    record.known |= kBitPins[i].bit;
    if (value->b) record.on |= kBitPins[i].bit;
  }
  watch_servo(record.monotonic_ns);
  if (record.joint_count == 0) return Reading::kNoJoints;
  const bool moves = record.monotonic_ns - servo_seen_ns_ <= kServoStill_ns;
  return moves ? Reading::kGood : Reading::kServoStill;
}

void HalPins::put(const HalStatusRecord& status) {
  *status_pins_->collision_seconds = status.collision_seconds;
  *status_pins_->finding_line = status.finding_line;
  *status_pins_->collision_ahead = status.collision_ahead != 0;
  *status_pins_->off_path_mm = status.off_path_mm;
  *status_pins_->off_path = status.off_path != 0;
  *status_pins_->stale = status.stale != 0;
  *status_pins_->program_ok = status.program_ok != 0 && status.stale == 0;
  *status_pins_->findings = status.findings;
  *status_pins_->time_left = status.time_left_s;
}

void HalPins::show(const HalStatusRecord& status) {
  if (taken()) return;
  put(status);
  *status_pins_->heartbeat = *status_pins_->heartbeat + 1;
  *status_pins_->alive = true;
}

void HalPins::beat(std::int64_t now) {
  if (taken() || !*status_pins_->alive || now - beat_ns_ < kBeat_ns) return;
  beat_ns_ = now;
  *status_pins_->beat = !*status_pins_->beat;
}

void HalPins::show_silence() {
  if (taken()) return;
  *status_pins_->stale = true;
  *status_pins_->alive = false;
  *status_pins_->program_ok = false;  // what nobody vouches for is no leave to start
}

}  // namespace kerf
