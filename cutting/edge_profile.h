// cutting/edge_profile.h - the cutting edge of a milling tool over its height.
//
//     z ^     |          kappa: the angle between the edge and the plane across the axis, 90
//       |    _|          degrees at the side of a flat cutter, 0 at the tip of a ball. A chip is
//       |  .'            sin(kappa) times as thick there as it would be at the side, and the edge
//       +-'------> r     1 / sin(kappa) times as long as it is high.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "base/geometry.h"

namespace kerf {

/// Made once for each tool and material exponent; what is asked of it afterwards is a look into a
/// table. A value; 15 kB.
class EdgeProfile {
 public:
  /// `outline`: radius and height above the tip, from the axis outward and upward, mm; neither
  /// sinks. What is above the last point is a cylinder. Level pieces (the bottom of a flat cutter)
  /// do not cut sideways. `mc`: Material::mc.
  EdgeProfile(std::span<const Vec2> outline, double mc);

  /// A flat cutter.
  static EdgeProfile cylinder(double radius_mm, double mc);

  double radius_mm() const { return radius_mm_; }
  double mc() const { return mc_; }

  /// From the tip up to a height: what the edge adds up to.
  struct Sum {
    /// Of sin(kappa)^-mc dz: times kc11 (fz sin(phi))^(1-mc) it is the force in the cutting
    /// direction.
    double push_mm = 0;
    /// Of sin(kappa)^(1-mc) dz: the same of the force towards the axis.
    double inward_mm = 0;
    /// Of r sin(kappa)^-mc dz: of the torque.
    double turn_mm2 = 0;
    double length_mm = 0;  ///< of the edge
    double half_mm2 = 0;   ///< of r dz: half of the tool's section
    Sum operator-(const Sum& other) const {
      return {push_mm - other.push_mm, inward_mm - other.inward_mm, turn_mm2 - other.turn_mm2,
              length_mm - other.length_mm, half_mm2 - other.half_mm2};
    }
  };
  Sum sum_to(double height_mm) const;
  /// The widest place up to that height.
  double radius_to(double height_mm) const;
  /// The greatest sin(kappa) up to that height: 1 at a side.
  double steepest_to(double height_mm) const;
  /// From there on it is a cylinder.
  double side_from_mm() const { return side_from_mm_; }

 private:
  static constexpr int kSteps = 256;
  struct Row {
    Sum sum;
    double radius_mm = 0, steepest = 0;
  };
  Row row_at(double height_mm) const;

  double radius_mm_ = 0, side_from_mm_ = 0, mc_ = 0;
  std::array<Row, kSteps + 1> rows_{};  ///< over the height up to side_from_mm_, by its square root
};

}  // namespace kerf
