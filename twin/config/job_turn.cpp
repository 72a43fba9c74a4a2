#include "twin/config/job_turn.h"

namespace kerf {

Placement JobTurn::turn() const {
  if (touched) {
    Placement all = *Placement::by_points(touched->was_mm, touched->is_mm);
    all.at_mm = Vec3(0);
    return all;
  }
  const Placement first = flip != 0 ? Placement::flipped(flip) : Placement();
  return first.then(Placement::turned(rotate_deg));
}

Placement JobTurn::placement(const Box& solid_mm) const {
  if (touched) return *Placement::by_points(touched->was_mm, touched->is_mm);
  Placement out = turn().about((solid_mm.min + solid_mm.max) / 2.0);
  const Box box = out.placed(solid_mm);
  Vec3 origin(0);
  switch (zero) {
    case Zero::kStays:
      break;
    case Zero::kTop:
      origin.z = box.max.z;
      break;
    case Zero::kCorner:
      origin = Vec3(box.min.x, box.min.y, box.max.z);
      break;
    case Zero::kMiddle:
      origin = Vec3((box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, box.max.z);
      break;
    case Zero::kPoint:
      origin = point_mm;
      break;
  }
  out.at_mm -= origin;
  return out;
}

}  // namespace kerf
