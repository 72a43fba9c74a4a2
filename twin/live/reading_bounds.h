// twin/live/reading_bounds.h - readings that no machine has: a bit that toppled on the way, another
// type of number than the device's.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "machine_io/position_source.h"
#include "twin/live/live_frame.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// Where each position of the samples can be: within the limits of its axis and its whole travel
/// more on either side, as far as an INI tells them; else within 100 m, or 10 000 turns.
class ReadingBounds {
 public:
  ReadingBounds(const LiveFrameOptions& frame, const TimelineOptions& timeline);

  /// "X reads -8e+14 mm; no machine is beyond -900 .. 900"; none if the sample may be one.
  std::optional<std::string> fault_of(const AxisSample& sample) const;

 private:
  struct Bound {
    std::string name;
    double low = 0;
    double high = 0;
    const char* unit = "mm";
  };
  std::array<Bound, kMaxPositions> bounds_;
};

}  // namespace kerf
