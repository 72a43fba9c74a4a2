// twin/cli/borrowed_source.h - one source for several sessions, one after the other.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "machine_io/position_source.h"

namespace kerf {

/// What outlives a session of the source that it watches.
struct SharedSource {
  explicit SharedSource(std::unique_ptr<PositionSource> one) : source(std::move(one)) {}
  std::unique_ptr<PositionSource> source;
  /// The last sample said that a program runs or stands in its middle.
  std::atomic<bool> is_running{false};
};

/// Of a session: what the source has met before it counts for nothing.
class BorrowedSource final : public PositionSource {
 public:
  /// `shared` must outlive it, and is asked by one of them at a time.
  explicit BorrowedSource(SharedSource& shared)
      : shared_(shared), before_(shared.source->status()), status_(since_then()) {}

  Next next(AxisSample& sample, std::chrono::milliseconds patience) override {
    const Next next = shared_.source->next(sample, patience);
    if (next == Next::kSample) {
      // What waited while nobody asked is no loss of this session.
      if (std::exchange(is_first_, false)) before_.lost = shared_.source->status().lost;
      shared_.is_running =
          sample.program == ProgramState::kRunning || sample.program == ProgramState::kPaused;
    }
    status_ = since_then();
    return next;
  }
  const SourceStatus& status() const override { return status_; }
  std::string describe() const override { return shared_.source->describe(); }

 private:
  SourceStatus since_then() const {
    SourceStatus now = shared_.source->status();
    now.samples -= before_.samples;
    now.errors -= before_.errors;
    now.reconnects -= before_.reconnects;
    now.lost -= before_.lost;
    return now;
  }

  SharedSource& shared_;
  SourceStatus before_;
  SourceStatus status_;
  bool is_first_ = true;
};

}  // namespace kerf
