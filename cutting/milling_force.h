// cutting/milling_force.h - what the teeth of a milling tool do at one place of its way: chips,
// forces, torque, power.
//
//          y | normal to the feed            Angles after Altintas (Manufacturing Automation,
//            |                               2nd ed. 2012, ch. 2): phi of a tooth runs from the
//     0 ..-'"|"'-..                          normal of the feed in the sense of rotation, 0 .. pi;
//     .'     |     '.  phi                   pi/2 is straight ahead. Conventional (up) milling
//    /       |-------\---> x, feed           begins at 0, climb milling ends at pi: there is the
//    \       |  pi/2 /                       wall. A chip is fz sin(phi) sin(kappa) thick. Forces
//     `.     |     .'                        act on the tool: x against or along the feed, y
//     pi ''-.|.-''                           across it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "cutting/edge_profile.h"
#include "cutting/material.h"

namespace kerf {

/// Integrals over phi that forces are made of, for one exponent mc. A value; 25 kB.
class ChipIntegrals {
 public:
  explicit ChipIntegrals(double mc);

  double mc() const { return mc_; }
  /// From 0 to phi, 0 .. pi, each with the factor sin^(1-mc): of 1, of cos, of sin.
  struct Sum {
    double plain = 0, cosine = 0, sine = 0;
  };
  Sum to(double phi_rad) const;
  /// sin^(1-mc)(phi).
  static double chip_power(double phi_rad, double mc);

 private:
  static constexpr int kSteps = 1024;
  double mc_ = 0;
  std::array<Sum, kSteps + 1> sums_{};
};

/// The teeth of a tool, as far as they cut.
struct MillingEdges {
  int teeth = 0;
  /// Teeth lag behind their tips by tan(helix) / radius each mm of height.
  double helix_rad = 0;
};

/// The tool at one place of its way. Its engagement is taken to be the same over the height.
struct MillingCut {
  double feed_per_tooth_mm = 0;
  double entry_rad = 0, exit_rad = 0;  ///< 0 <= entry < exit <= pi
  double deep_mm = 0;                  ///< ap
  double rpm = 0;
};

/// Chips alone: known of any material, and of none.
struct Chip {
  double most_mm = 0;  ///< at the thickest place of the arc and of the edge
  /// Over all edge that is in material: its section by its length.
  double mean_mm = 0;
};
Chip chip_of(const EdgeProfile& profile, const MillingCut& cut);

/// m/min, at the widest place of the tool that cuts.
double cutting_speed_m_per_min(const EdgeProfile& profile, const MillingCut& cut);

/// Forces on the tool for kc11 = 1 N/mm2: all of them go with it. Of one revolution.
struct UnitForces {
  double tangential_mean_n = 0, tangential_most_n = 0;  ///< all teeth together
  double torque_mean_nm = 0, torque_most_nm = 0;
  /// By the low, nominal and high normal_share: along the feed and across it.
  struct Sideways {
    double feed_mean_n = 0, normal_mean_n = 0;
    double most_n = 0;  ///< of both together
    /// Across, while an edge passes the wall that stays, away from it (it is left too thick) or
    /// into it (below 0): what has the greatest amount. 0 where no wall stays (a slot counts both).
    double at_wall_n = 0;
  };
  std::array<Sideways, 3> sideways{};
};

/// About 3 us (flat, 4 teeth), of a ball 12; within 0.5 % of the means and 2.5 % of the peaks that
/// fine slices have.
UnitForces unit_forces(const ChipIntegrals& integrals, const EdgeProfile& profile,
                       const MillingEdges& edges, const MillingCut& cut,
                       const ValueRange& normal_share);

/// What is worked out for a material: each value with its range. Power is that at the cutting edge;
/// what a spindle loses comes on top.
struct MillingLoad {
  Chip chip;
  double speed_m_per_min = 0;
  ValueRange force_n;       ///< greatest, along and across the feed together
  ValueRange tangential_n;  ///< greatest, in the direction of the cut
  ValueRange torque_nm;     ///< greatest of a revolution
  ValueRange torque_mean_nm;
  ValueRange power_w;         ///< mean of a revolution
  ValueRange feed_force_n;    ///< mean; below 0: against the feed
  ValueRange normal_force_n;  ///< mean
  ValueRange at_wall_n;       ///< UnitForces::Sideways::at_wall_n
};

/// One tool in one material. What repeats is worked out once: cuts one after the other that differ
/// in feed and rpm alone take 0.1 us. One thread.
class MillingModel {
 public:
  /// `rake_deg`: of the tool; none: that which the material's kc11 is of.
  MillingModel(const Material& material, EdgeProfile profile, const MillingEdges& edges,
               std::optional<double> rake_deg);

  MillingLoad load_of(const MillingCut& cut) const;
  /// Forces, torque (not power) and chips grow with the feed per tooth to this power: 1 - mc. Power
  /// at a constant rpm does, too.
  double feed_exponent() const { return 1 - profile_.mc(); }
  const EdgeProfile& profile() const { return profile_; }
  const ValueRange& kc11_n_per_mm2() const { return kc11_; }

 private:
  EdgeProfile profile_;
  ChipIntegrals integrals_;
  MillingEdges edges_;
  ValueRange kc11_, share_;
  /// The last cut, at 1 mm per tooth.
  mutable MillingCut last_;
  mutable UnitForces unit_;
};

/// Arc of a tool that cuts so wide, with the uncut side of the way on one side: conventional from
/// 0, climb to pi. `wide_mm` up to 2 * radius_mm.
struct CutArcAngles {
  double entry_rad = 0, exit_rad = 0;
};
CutArcAngles conventional_arc(double radius_mm, double wide_mm);
CutArcAngles climb_arc(double radius_mm, double wide_mm);

/// Below this thickness an edge rubs and tears nothing off: 0.2 to 0.3 of its radius (Vogler,
/// DeVor, Kapoor, J. Manuf. Sci. Eng. 126 (2004) 695: ferrite and pearlite); of edges with a radius
/// of 5 to 20 um, as new tools have them.
inline constexpr ValueRange kLeastChip_mm{0.001, 0.003, 0.006};

}  // namespace kerf
