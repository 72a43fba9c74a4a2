#include "twin/playback/packed_way.h"

namespace kerf {

PackedWay::PackedWay(const WayInTime& way)
    : in_way_(way.in_way),
      in_time_(way.in_time),
      out_way_(way.out_way),
      out_time_(way.out_time),
      ramp_(way.ramp),
      from_(way.from),
      to_(way.to) {
  if (way.slowness == 1) return;
  ramp_ = -way.slowness;
  from_ = way.cap;
}

WayInTime PackedWay::unpacked() const {
  WayInTime way;
  way.in_way = in_way_;
  way.in_time = in_time_;
  way.out_way = out_way_;
  way.out_time = out_time_;
  if (ramp_ < 0) {
    way.slowness = -ramp_;
    way.cap = from_;
  } else {
    way.ramp = ramp_;
    way.from = from_;
    way.to = to_;
  }
  return way;
}

}  // namespace kerf
