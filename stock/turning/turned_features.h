// stock/turning/turned_features.h - what a turned part has: diameters, faces, tapers, radii,
// grooves.
#pragma once

#include <cstdint>
#include <vector>

#include "stock/turning/turned_part.h"

namespace kerf {

/// A surface of a turned part, or a groove in one. mm, degrees; a diameter is twice the radius.
///
///        face   cylinder  taper                    groove: between walls that rise on either side,
///      |<---->|..........-._                       from its floor to the lower of the two rims
///      |                    `-.____ radius
///   ---+---------------------------'--- z
struct TurnedFeature {
  enum class Kind : std::uint8_t { kCylinder, kFace, kTaper, kRadius, kGroove };
  Kind kind = Kind::kCylinder;
  bool is_inside = false;              ///< of a bore: it looks towards the axis
  double low_z_mm = 0, high_z_mm = 0;  ///< equal: a face
  double low_d_mm = 0, high_d_mm = 0;  ///< of a cylinder equal; of a groove floor and rim
  double angle_deg = 0;                ///< kTaper: of the flank with the axis, above 0
  double radius_mm = 0;                ///< kRadius
  bool is_hollow = false;              ///< kRadius: as in a corner, not as on an edge
  double depth_mm() const { return (high_d_mm - low_d_mm) / 2; }
  double width_mm() const { return high_z_mm - low_z_mm; }
};

/// From the highest z to the lowest, by their middles. Lines and arcs are those of contour_arcs.h;
/// what is shorter than kLeastFeature_mm is left out, and surfaces that go on behind such with the
/// same diameter, place or arc are one. The axis is no surface, flats of a bar are none either.
std::vector<TurnedFeature> features_of(const TurnedPart& part);
inline constexpr double kLeastFeature_mm = 0.002;
/// Diameters and places that are as near are equal; and a slope of less over a surface is none.
inline constexpr double kSameFeature_mm = 2e-4;

}  // namespace kerf
