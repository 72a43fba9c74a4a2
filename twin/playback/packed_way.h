// twin/playback/packed_way.h - how the way of a motion goes in its time, in 28 bytes.
#pragma once

#include "interp_bridge/timing/way_in_time.h"

namespace kerf {

/// Gives it back bit for bit. What a motion under G96 does not need makes room for what only it
/// has.
class PackedWay {
 public:
  explicit PackedWay(const WayInTime& way);
  WayInTime unpacked() const;

 private:
  float in_way_, in_time_, out_way_, out_time_;
  float ramp_;       ///< negative: under G96, slowness
  float from_, to_;  ///< under G96 the cap, and nothing
};

}  // namespace kerf
