// cutting/material.h - what a workpiece is made of, as far as cutting goes: a row of
// configs/materials.yaml.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace kerf {

/// No single number is true of a material: what is worked out from one is a range, too.
struct ValueRange {
  double low = 0, nominal = 0, high = 0;

  ValueRange times(double factor) const { return {low * factor, nominal * factor, high * factor}; }
  bool operator==(const ValueRange&) const = default;
};

/// m/min
struct SpeedRange {
  double low = 0, high = 0;
};

/// Specific cutting force after Kienzle (VDI-Z 94, 1952): kc = kc11 * h^-mc, the force on each mm2
/// of chip of the thickness h, in mm.
struct Material {
  std::string name;                  ///< "steel-mild"
  std::vector<std::string> aliases;  ///< "s235", "1018"
  ValueRange kc11_n_per_mm2;         ///< of a tool with the rake angle rake_deg
  double mc = 0;
  double rake_deg = 0;
  /// Of the force into the workpiece's surface, to the one in the cutting direction. Measured on
  /// aluminium alloys: 0.16 to 0.60, in the middle 0.3 (Krc to Ktc, Chin. J. Mech. Eng. 34 (2021),
  /// 10.1186/s10033-021-00536-9, table 5); of others nobody has said it here.
  ValueRange normal_share{0.16, 0.3, 0.6};
  std::optional<SpeedRange> speed_hss, speed_carbide;
  std::string source;  ///< of the numbers, for people
};

/// By its name or an alias, in any case, words apart by "-", "_" or a space. Null: none.
const Material* find_material(std::span<const Material> materials, std::string_view name);

/// The same; the error names the nearest ones, or all.
Result<const Material*> need_material(std::span<const Material> materials, std::string_view name);

/// kc11 of a tool with another rake angle: 1 % less for each degree more (Kienzle; Tabellenbuch
/// Zerspantechnik, 5th ed. 2022). Good from -15 to 30 degrees.
ValueRange kc11_at_rake(const Material& material, std::optional<double> rake_deg);

}  // namespace kerf
