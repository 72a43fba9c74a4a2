// stock/cutter/shape_limits.h - how large what SHAPE describes may be.
#pragma once

namespace kerf {

// Ranges of what is sold as a tool, with room on both sides; beyond them the text is a slip of the
// pen.
inline constexpr double kMinDiameter_mm = 0.001;
inline constexpr double kMaxDiameter_mm = 1000;
inline constexpr double kMinLength_mm = 0.001;
inline constexpr double kMaxLength_mm = 2000;
inline constexpr int kMaxTeeth = 99;
inline constexpr double kMostHelix_deg = 70;
inline constexpr double kMostRake_deg = 45;
inline constexpr double kMinChip_mm = 0.0001;
inline constexpr double kMaxChip_mm = 10;

}  // namespace kerf
