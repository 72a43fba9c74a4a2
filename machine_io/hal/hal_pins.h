// machine_io/hal/hal_pins.h - the pins of a running LinuxCNC, read; and the kerf.* pins, written.
// Part of kerf-hal alone.
#pragma once

#include <time.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/hal/hal_stream.h"

namespace kerf {

/// Whether a LinuxCNC runs that this process may attach to. Looks at the shared memory's key only
/// and creates nothing: hal_init would make a HAL of its own where there is none.
enum class HalPresence { kRunning, kNone, kForbidden };
HalPresence look_for_hal();

std::int64_t now_ns(clockid_t clock);

/// This process as a component of the running HAL, named kerf-hal-PID: LinuxCNC keeps the name of a
/// component that was killed, so a fixed one could not be used twice. It links nothing and changes
/// nothing that another component made.
class HalPins {
 public:
  /// nullptr with `trouble` filled if HAL refuses. Creates the kerf.* pins, unless another
  /// component has pins of these names: then taken() is true and show() has no effect.
  /// `load_pin`: a number of whichever type, the spindle's load; empty: none.
  static std::unique_ptr<HalPins> attach(const std::string& load_pin, std::string& trouble);
  HalPins(const HalPins&) = delete;
  HalPins& operator=(const HalPins&) = delete;
  /// Sets the kerf.* pins to "no announcement, stale, not alive" (a signal keeps the last value of
  /// a pin that goes) and leaves HAL.
  ~HalPins();

  bool taken() const { return status_pins_ == nullptr; }

  /// What a reading is worth.
  enum class Reading {
    kGood,
    kNoJoints,    ///< motion's pins have gone, LinuxCNC is ending (or has not come so far)
    kServoStill,  ///< the pins are there, but nobody has written them for kServoStill_ns (yet)
  };
  static constexpr std::int64_t kServoStill_ns = 250'000'000;

  /// Fills all but head and sequence. A pin that is linked, unlinked or removed has its value
  /// elsewhere from then on: joints are found by their names again in each reading, all others ten
  /// times a second.
  Reading read(HalSampleRecord& record);

  void show(const HalStatusRecord& status);
  /// kerf.beat goes over, as long as kerf.alive is on: every kBeat_ns. From each reading.
  void beat(std::int64_t now);
  static constexpr std::int64_t kBeat_ns = 50'000'000;
  /// No status has come for kHalStatusTimeout_ns: the announcements stay, marked as old.
  void show_silence();

 private:
  struct StatusPins;
  struct Wanted;

  HalPins() = default;
  bool create_status_pins(std::string& trouble);
  static void find(Wanted& pin);
  void find_due();
  void watch_servo(std::int64_t now);
  void put(const HalStatusRecord& status);

  int component_ = -1;
  StatusPins* status_pins_ = nullptr;  ///< in HAL's shared memory
  std::vector<Wanted> wanted_;
  std::int64_t all_found_ns_ = 0;  ///< CLOCK_MONOTONIC
  std::optional<std::uint32_t> servo_period_;
  std::int64_t beat_ns_ = 0;  ///< CLOCK_MONOTONIC of the last change of kerf.beat
  std::int64_t servo_seen_ns_ = -kServoStill_ns;  ///< CLOCK_MONOTONIC of the last new period
};

}  // namespace kerf
