// tests/twin/live/listed_source.h - samples in place of a machine.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "machine_io/position_source.h"

namespace kerf {

/// Hands out what it is given, then waits or ends.
class ListedSource final : public PositionSource {
 public:
  explicit ListedSource(std::vector<AxisSample> samples, bool ends = true)
      : samples_(samples.begin(), samples.end()), ends_(ends) {}
  Next next(AxisSample& sample, std::chrono::milliseconds patience) override {
    if (!samples_.empty()) {
      sample = samples_.front();
      if (sample.host_ns == AxisSample::kNoTime) sample.host_ns = 0;
      samples_.pop_front();
      ++status_.samples;
      status_.state = SourceState::kReading;
      return Next::kSample;
    }
    if (ends_) {
      status_.state = end_state;
      return Next::kEnd;
    }
    std::this_thread::sleep_for(patience);
    return Next::kNothing;
  }
  const SourceStatus& status() const override { return status_; }
  std::string describe() const override { return "a list"; }

  SourceState end_state = SourceState::kEnded;
  SourceStatus status_;

 private:
  std::deque<AxisSample> samples_;
  bool ends_;
};

}  // namespace kerf
