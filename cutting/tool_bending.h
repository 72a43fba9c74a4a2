// cutting/tool_bending.h - how far a force across a tool bends its tip.
#pragma once

namespace kerf {

/// N/mm2. Sintered carbide with 10 % cobalt; high-speed steel (Altintas, Manufacturing Automation).
inline constexpr double kCarbideModulus = 600'000, kSteelModulus = 210'000;
/// Flutes bend as a rod of this share of their diameter (Kops and Vo, CIRP Annals 39 (1990) 93).
inline constexpr double kFluteShare = 0.8;

/// A tool as two round rods, one upon the other, held fast at `stickout_mm` above its tip.
///
///     ======|  |====  holder            What gives in holder and spindle comes on top: the tip of
///           |  |  shank_mm              a real tool bends more than this.
///           |  |
///           {  }  flute_mm, 0.8 of the
///           {  }  cutter's diameter
struct ToolRods {
  double diameter_mm = 0;        ///< of the flutes
  double shank_diameter_mm = 0;  ///< not 0
  double flute_mm = 0;           ///< as long as these; at least 0
  double stickout_mm = 0;
  double modulus_n_per_mm2 = kCarbideModulus;
};

/// mm of the tip for each N across the tool, `at_mm` above the tip.
double tip_bends_mm_per_n(const ToolRods& rods, double at_mm);

}  // namespace kerf
