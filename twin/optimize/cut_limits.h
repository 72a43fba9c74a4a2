// twin/optimize/cut_limits.h - how fast a tool may go where it is engaged as it is, and what it has
// to bear at a feed.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "cutting/material.h"
#include "cutting/milling_force.h"
#include "stock/cutter/cutter.h"
#include "twin/process/engagement.h"

namespace kerf {

/// What can be limited.
enum class CutLimit : std::uint8_t { kChip, kRate, kForce, kPower, kDeflection };
inline constexpr std::array kCutLimits{CutLimit::kChip, CutLimit::kRate, CutLimit::kForce,
                                       CutLimit::kPower, CutLimit::kDeflection};
/// "chip_mm", "rate_mm3_s": keys of reports.
const char* key_of(CutLimit limit);

/// A value for each of them.
template <class Value>
struct PerLimit {
  std::array<Value, kCutLimits.size()> values{};
  Value& operator[](CutLimit limit) { return values[static_cast<std::size_t>(limit)]; }
  const Value& operator[](CutLimit limit) const { return values[static_cast<std::size_t>(limit)]; }
};

/// What the user allows: mm, mm3/s, N, kW.
struct FeedAims {
  PerLimit<std::optional<double>> most;
  std::optional<double> most_feed_mm_per_min;
  std::optional<double> air_feed_mm_per_min;
  bool splits = false;
  bool unrolls = false;
  double spindle_torque_nm = 0;      ///< with a material: at no speed more; 0: not known
  double spindle_max_rpm = 0;        ///< what it really does where more is asked for; 0: not known
  std::optional<Material> material;  ///< for forces

  bool limits_cutting() const {
    for (const auto& one : most.values) {
      if (one) return true;
    }
    return spindle_torque_nm > 0;
  }
  bool needs_teeth() const {
    return most[CutLimit::kChip] || most[CutLimit::kForce] || most[CutLimit::kPower] ||
           most[CutLimit::kDeflection] || spindle_torque_nm > 0;
  }
};

/// Of one tool, in one material if that is given.
///
/// Chip: the thickest, fz sin(phi) sin(kappa) at most over the arc and the edge that are in
/// material (chip_of()): a tool that cuts a quarter of its diameter at a wall has 0.87 of its feed
/// per tooth, a ball of 3 mm radius that is 0.5 mm deep 0.55. Never less than kLeastShare of it:
/// then edges are no longer sharp. Rate: the section of what is removed, across the way, times the
/// feed. Force (along and across the feed together, its peak), power (mean of a revolution, at the
/// edge), deflection (of the tip of a carbide tool under that force): by MillingModel, or
/// drilling_load() straight down, at the high end of the material's range. About 3 us a look, of a
/// ball 12; without a material 50 ns.
class CutLimits {
 public:
  static constexpr double kLeastShare = 0.05;

  CutLimits(const Cutter& cutter, const std::optional<Material>& material);

  bool knows_teeth() const { return teeth_ > 0; }
  /// What it removes is no more than its section, and may be less: it is no flat tool.
  bool is_rounded() const { return is_rounded_; }
  bool knows_stickout() const { return stickout_mm_.has_value(); }

  /// Of a place where the tool is engaged.
  struct Place {
    PerLimit<double> at_1mm;  ///< loads at 1 mm per tooth; of the rate at 1 mm/min
    double teeth_per_min = 0;
    double exponent = 1;  ///< of the feed, that forces grow with
    double rpm = 0;
  };
  /// `rpm`: of the spindle. Without it, or teeth, nothing is known but the rate.
  Place place(const EngagementLook& look, double rpm) const;

  /// The greatest feed, mm/min, that keeps within all limits; infinity: none applies.
  static double most_feed(const FeedAims& aims, const Place& place);
  /// At that feed. What is not known is 0.
  static PerLimit<double> loads(const Place& place, double mm_per_min);

  /// Across the way; of what goes straight down its disc.
  double section_mm2(const EngagementLook& look) const;

 private:
  /// Of the tool's outline up to that depth, as wide as the engagement is.
  double outline_mm2(const EngagementLook& look) const;
  void add_forces(const EngagementLook& look, double rpm, Place& place) const;

  int teeth_ = 0;
  bool is_rounded_ = false;
  double radius_mm_ = 0, shank_mm_ = 0, point_deg_ = 180;
  std::optional<double> flute_mm_, stickout_mm_, rake_deg_;
  EdgeProfile profile_;
  std::optional<Material> material_;
  std::optional<MillingModel> model_;
};

}  // namespace kerf
