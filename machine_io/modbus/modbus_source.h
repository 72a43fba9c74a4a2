// machine_io/modbus/modbus_source.h - positions polled from a Modbus device, TCP or RTU.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "machine_io/modbus/modbus_settings.h"
#include "machine_io/position_source.h"

namespace kerf {

/// Polls one device `poll_hz` times a second and brings the connection back by itself. Reads with
/// function codes 3 and 4 only; holds no code that could ask for anything else. Starts no thread;
/// allocates nothing per sample once connected.
///
/// A sample is handed out whole or not at all: when every read of a poll succeeded and every value
/// is plausible. Otherwise next() returns kNothing, `errors` grows and `trouble` names the fault:
///
///   nobody there        closed, tried again after 100 ms, doubling up to 5 s
///   exception reply     the connection stays; the next poll asks again
///   TCP, all else       (silence, half frames, garbage, wrong transaction, unit or length) closed
///                       and connected anew: after a late answer the stream is no longer in step
///   RTU, all else       the line must be quiet for timeout_ms (longer with every failure, up to
///                       2 s; as long as answers were seen to be late, up to 10 s); then a trial
///                       read is thrown away, and only if the line stays quiet after it are values
///                       trusted again: RTU answers carry no number that would tell an old one
///                       from a new one
///   NaN, infinite, out of the axis' range, too fast, fractional tool number
///                       named with raw words; if another word order would do, with a hint:
///                       "positions jump beyond machine limits; is word_order cdab?"
///   counter_begun and   asked for again at once, up to ten times
///   counter differ
///   counter unchanged   counted as duplicate, named as trouble after a second
///
/// When this computer's clock is set back, `host_ns` goes on by the steady clock until the clock
/// has caught up; `disordered` counts it and `trouble` says by how much.
///
/// Polls are due at fixed times. One that is late is made at once, those missed meanwhile are
/// dropped: a hang is never followed by a burst.
class ModbusSource final : public PositionSource {
 public:
  /// `settings` must be free of faults: validate(). Connects at the first next().
  explicit ModbusSource(ModbusSettings settings);
  ~ModbusSource() override;
  ModbusSource(const ModbusSource&) = delete;
  ModbusSource& operator=(const ModbusSource&) = delete;

  /// A serial line is listened to for timeout_ms before the first poll.
  /// May overrun `patience` by one timeout_ms per read of the poll, or by a name look-up.
  /// `host_ns` is taken after the last reply of the poll, and never goes back.
  Next next(AxisSample& sample, std::chrono::milliseconds patience) override;
  const SourceStatus& status() const override;
  std::string describe() const override;

 private:
  struct Poller;
  std::unique_ptr<Poller> poller_;
};

}  // namespace kerf
