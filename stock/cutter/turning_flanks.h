// stock/cutter/turning_flanks.h - the angles of turning tools: LinuxCNC's front and back angle, and
// how holders lay an insert. Degrees: 0 runs along +z, 90 along +x.
#pragma once

#include <optional>

namespace kerf {

/// The usual kappa of holders for a shape: C, E, W 95, D, V, K, M 93, T 91, S 75, P 60; of R none.
std::optional<double> iso_angle_deg(char shape);

/// LinuxCNC's front and back angle as its sample tables have them for an orientation, 1 .. 8.
struct FlankAngles {
  double front_deg = 0, back_deg = 0;
};
FlankAngles usual_flanks(int orientation);
/// Two angles as they are nearest to each other: 330 and 30 are -30 and 30. None: half a turn
/// apart.
std::optional<FlankAngles> nearest_flanks(FlankAngles angles);
/// Whether the flanks lie behind the nose, as the orientation has it.
bool fits_orientation(const FlankAngles& angles, int orientation);

/// Which way a tool cuts that points to -x.
enum class Hand : char {
  kRight = 'R',    ///< towards -z
  kLeft = 'L',     ///< towards +z
  kNeutral = 'N',  ///< either way, with flanks that lie alike
};
/// Where a tool of a hand has its controlled point; one in a bore points to +x.
int usual_orientation(Hand hand, bool in_bore);
Hand hand_of_orientation(int orientation);
/// How an insert lies whose corner is so wide, in a holder of this kappa (of kNeutral it plays no
/// part). Tools that point to +x are mirrored.
FlankAngles flanks_of_hand(Hand hand, int orientation, double kappa_deg, double corner_deg);

}  // namespace kerf
