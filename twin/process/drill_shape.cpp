#include "twin/process/drill_shape.h"

#include <cmath>

namespace kerf {

bool is_drill(const Cutter& cutter) { return cutter.spec().rfind("drill:", 0) == 0; }

double drill_point_deg(const Cutter& cutter) {
  double rise = 0, run = 0;
  for (const ProfilePiece& piece : cutter.profile()) {
    if (piece.r1 <= piece.r0) break;
    rise = piece.z1;
    run = piece.r1;
  }
  return run > 0 ? 2 * std::atan2(run, rise) * 180 / kPi : 180;
}

}  // namespace kerf
