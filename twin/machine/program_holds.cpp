#include "twin/machine/program_holds.h"

#include "twin/motion/motion_geometry.h"

namespace kerf {

HeldTime& HeldTime::operator+=(const HeldTime& other) {
  strokes_s += other.strokes_s;
  turret_s += other.turret_s;
  regrip_s += other.regrip_s;
  pierces_s += other.pierces_s;
  pauses_s += other.pauses_s;
  return *this;
}

bool goes_somewhere(const Motion& m) { return is_move(m) && !stands_still(m); }

}  // namespace kerf
