// stock/turning/thread_gauge.h - threads found on a turned part, measured as on a projector.
//
//        pitch
//      |<----->|                      Measured on the section at one angle, where the groove has
//      ___    ___    ___ ___ major    its full form: where it takes as much of the section as at
//     /   |  /   |  /   |             most places. Of tapers the section is sheared until crests
//    /     |/     |/    |_ minor      are level.
//
#pragma once

#include <vector>

#include "stock/turning/turned_part.h"

namespace kerf {

/// mm, diameters; of an outer thread the minor one is that of the roots.
struct MeasuredThread {
  bool is_internal = false;
  bool is_right_hand = true;
  int starts = 1;
  double lead_mm = 0;  ///< along the axis, in a turn
  double pitch_mm() const { return lead_mm / starts; }
  double major_mm = 0, minor_mm = 0;
  double pitch_diameter_mm = 0;  ///< where groove and ridge are equally wide
  double depth_mm() const { return (major_mm - minor_mm) / 2; }
  double angle_rad = 0;  ///< between the flanks of a groove, at the pitch diameter
  double taper = 0;      ///< how much the diameter grows along +z, a length
  double at_z_mm = 0;    ///< where diameters are taken, the middle of the full form
  /// The groove's middle has its full form from here to there.
  double low_z_mm = 0, high_z_mm = 0;
  double full_length_mm() const { return high_z_mm - low_z_mm; }
  /// So much farther it goes on that is not full: through a face, a chamfer, or rising.
  double low_run_out_mm = 0, high_run_out_mm = 0;
};

/// Of grooves along the axis or slanting, with a full form of half a turn and more; by rising z.
/// Scrolls on faces are none. Exact but for the grid, as long as sections are: 1 um is safe. A
/// groove that is interrupted counts where it is longest. Some milliseconds a thread.
std::vector<MeasuredThread> measure_threads(const TurnedPart& part);

}  // namespace kerf
