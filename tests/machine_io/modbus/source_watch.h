// tests/machine_io/modbus/source_watch.h - asks a source and judges every sample it hands out.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

#include "machine_io/modbus/modbus_source.h"
#include "tests/machine_io/modbus/faulty_device.h"

namespace kerf {

/// A sample of a FaultyDevice is right when all its values are of one moment, and that moment is
/// after the call that handed it out began: the device takes its values when it is asked, and a
/// poll is asked for and answered in one call. (No limit for an age, which a loaded computer would
/// break.)
class SourceWatch {
 public:
  explicit SourceWatch(PositionSource& source) : source_(source) {}

  PositionSource::Next step(std::chrono::milliseconds patience = std::chrono::milliseconds(50)) {
    AxisSample sample;
    const double begin_s = FaultyDevice::now_s();
    const auto next = source_.next(sample, patience);
    if (next == PositionSource::Next::kSample) judge(sample, begin_s);
    return next;
  }

  /// Asks until `done()`; false when that takes longer than `limit`.
  template <class Done>
  bool until(Done done, std::chrono::seconds limit = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      step();
    }
    return true;
  }

  bool more_samples(std::uint64_t count) {
    const std::uint64_t wanted = source_.status().samples + count;
    return until([&] { return source_.status().samples >= wanted; });
  }
  bool trouble_with(const std::string& text) {
    return until([&] {
      return source_.status().state == SourceState::kConnecting &&
             source_.status().trouble.find(text) != std::string::npos;
    });
  }

 private:
  void judge(const AxisSample& sample, double begin_s) {
    const double x = sample.position[0];
    EXPECT_GE(x, begin_s) << "an old reading passes for a new one";
    EXPECT_LE(x, FaultyDevice::now_s());
    EXPECT_EQ(sample.position[1], 2 * x + 1);
    EXPECT_EQ(sample.position[2], -x);
    EXPECT_EQ(sample.position[3], static_cast<double>(static_cast<float>(100 + std::fmod(x, 1))));
    EXPECT_EQ(sample.known, 0x000f);
    EXPECT_EQ(sample.fresh, 0x000f);
    EXPECT_EQ(sample.tool, 7);
    EXPECT_EQ(sample.line, 321);
    EXPECT_TRUE(std::isnan(sample.spindle_rpm));
    EXPECT_TRUE(std::isnan(sample.tool_offset_z_mm));
    EXPECT_EQ(sample.device_ns, AxisSample::kNoTime);
    EXPECT_GT(sample.host_ns, last_host_ns_);
    last_host_ns_ = sample.host_ns;
    EXPECT_EQ(source_.status().state, SourceState::kReading);
  }

  PositionSource& source_;
  std::int64_t last_host_ns_ = 0;
};

}  // namespace kerf
