// twin/playback/packed_way.h - how the way of a motion goes in its time, in 20 bytes.
#pragma once

#include <cstdint>

#include "interp_bridge/timing/way_in_time.h"

namespace kerf {

/// Shares of the way and of speeds are kept to a sixty-thousandth, times as floats: places come out
/// within 0.01 mm on ways of up to half a metre.
class PackedWay {
 public:
  explicit PackedWay(const WayInTime& way);
  WayInTime unpacked() const;

 private:
  float in_time_, out_time_;
  float ramp_;  ///< negative: under G96, slowness at the end over that at the start
  std::uint16_t in_way_, out_way_;
  std::uint16_t from_, to_;  ///< speeds over twice the greatest; under G96 the cap, and nothing
};

}  // namespace kerf
