// twin/optimize/cut_limits.h - how fast a tool may go where it is engaged as it is, and what it has
// to bear at a feed.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "stock/cutter/cutter.h"
#include "twin/process/engagement.h"

namespace kerf {

/// What can be limited; places in CutLoads.
enum class CutLimit : std::uint8_t { kChip, kRate };
inline constexpr std::array kCutLimits{CutLimit::kChip, CutLimit::kRate};
/// "chip_mm", "rate_mm3_s": keys of reports.
const char* key_of(CutLimit limit);

using CutLoads = std::array<double, kCutLimits.size()>;
inline double& load_of(CutLoads& loads, CutLimit limit) {
  return loads[static_cast<std::size_t>(limit)];
}
inline double load_of(const CutLoads& loads, CutLimit limit) {
  return loads[static_cast<std::size_t>(limit)];
}

/// What the user allows.
struct FeedAims {
  std::array<std::optional<double>, kCutLimits.size()> most{};  ///< by CutLimit
  std::optional<double> most_feed_mm_per_min;
  std::optional<double> air_feed_mm_per_min;
  bool splits = false;

  const std::optional<double>& of(CutLimit limit) const {
    return most[static_cast<std::size_t>(limit)];
  }
  bool limits_cutting() const {
    for (const auto& one : most) {
      if (one) return true;
    }
    return false;
  }
};

/// Of one tool. About 50 ns a look.
///
/// Chip thickness: h = fz sin(phi) sin(kappa), with the feed per tooth fz, the angle phi of the
/// tooth from the normal of the way and the lead angle kappa of the edge; the greatest over the arc
/// that is in material, and over the depth. So a tool that cuts a quarter of its diameter at a wall
/// has h = 0.87 fz, a ball 0.5 mm deep with 3 mm radius in a full slot h = 0.55 fz.
/// Rate: the section of what is removed, across the way, times the feed.
class CutLimits {
 public:
  explicit CutLimits(const Cutter& cutter);

  bool knows_teeth() const { return teeth_ > 0; }
  /// The greatest feed, mm/min, that keeps within all limits; infinity: none applies.
  /// `rpm`: of the spindle; 0, or teeth that are not known: nothing is known of chips.
  double most_feed(const FeedAims& aims, const EngagementLook& look, double rpm) const;
  /// At that feed. What is not known is 0.
  CutLoads loads(const EngagementLook& look, double rpm, double mm_per_min) const;

  /// sin(phi) sin(kappa): of the feed per tooth, the part that the thickest chip has.
  double chip_share(const EngagementLook& look) const;
  /// Across the way; of what goes straight down its disc.
  static double section_mm2(const EngagementLook& look);

 private:
  double lead_sine(double deep_mm) const;

  int teeth_ = 0;
  static constexpr int kDepths = 64;
  double lead_height_mm_ = 0;               ///< above it the edge is upright
  std::array<double, kDepths + 1> lead_{};  ///< greatest sin(kappa) up to each part of that
};

}  // namespace kerf
