#include "twin/playback/packed_way.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

constexpr float kSteps = 65535;
/// A motion may begin faster than it goes on.
constexpr float kMostSpeed = 2;

std::uint16_t packed(float share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0F, 1.0F) * kSteps));
}

float unpacked_share(std::uint16_t value) { return static_cast<float>(value) / kSteps; }

}  // namespace

PackedWay::PackedWay(const WayInTime& way)
    : in_time_(way.in_time),
      out_time_(way.out_time),
      ramp_(way.ramp),
      in_way_(packed(way.in_way)),
      out_way_(packed(way.out_way)),
      from_(packed(way.from / kMostSpeed)),
      to_(packed(way.to / kMostSpeed)) {
  if (way.slow_from == way.slow_to) return;
  ramp_ = -way.slow_to / way.slow_from;
  from_ = packed(way.cap);
}

WayInTime PackedWay::unpacked() const {
  WayInTime way;
  way.in_time = in_time_;
  way.out_time = out_time_;
  way.in_way = unpacked_share(in_way_);
  way.out_way = unpacked_share(out_way_);
  if (ramp_ < 0) {
    way.slow_to = -ramp_;
    way.cap = unpacked_share(from_);
    return way;
  }
  way.ramp = ramp_;
  way.from = kMostSpeed * unpacked_share(from_);
  way.to = kMostSpeed * unpacked_share(to_);
  return way;
}

}  // namespace kerf
