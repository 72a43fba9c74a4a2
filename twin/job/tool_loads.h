// twin/job/tool_loads.h - what the cuts of one tool were like: values, for the report.
#pragma once

#include <array>
#include <cstddef>

#include "base/geometry.h"
#include "cutting/material.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// Of one quantity over the time of a tool's cuts.
class LoadSpread {
 public:
  /// `at_mm`: where, in the workpiece.
  void add(double value, double seconds, const SourceRef& source, const Vec3& at_mm = Vec3(0));
  /// By its nominal value; `most` becomes the greatest.
  void add(const ValueRange& range, double seconds, const SourceRef& source, ValueRange& most,
           const Vec3& at_mm = Vec3(0)) {
    if (range.nominal > most_) most = range;
    add(range.nominal, seconds, source, at_mm);
  }

  double most() const { return most_; }
  const SourceRef& most_at() const { return most_at_; }
  const Vec3& most_mm() const { return most_mm_; }
  double seconds() const { return seconds_; }
  /// What it was not above for this share of the time, to 1.5 %; 0 of nothing.
  double not_above(double share) const;

 private:
  /// By their logarithm, kLeast to kMost.
  static constexpr std::size_t kBins = 2048;
  static constexpr double kLeast = 1e-6, kMost = 1e7;
  std::array<double, kBins> seconds_in_{};
  double most_ = 0, seconds_ = 0;
  SourceRef most_at_;
  Vec3 most_mm_{0};
};

/// Where teeth are known; from force_n on of a known material. Of ranges the nominal values are
/// spread; `force_most_n` .. are those of the greatest.
struct ToolLoads {
  LoadSpread chip_mm;  ///< greatest thickness at each place
  LoadSpread speed_m_per_min;
  bool has_forces = false;
  LoadSpread force_n, torque_nm, power_kw;
  ValueRange force_most_n, torque_most_nm, power_most_kw;
  bool has_bend = false;
  LoadSpread bend_mm, wall_mm;
  ValueRange bend_most_mm, wall_most_mm;
};

}  // namespace kerf
