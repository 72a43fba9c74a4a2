// twin/job/tool_loads.h - what the cuts of one tool were like: values, for the report.
#pragma once

#include <array>
#include <cstddef>

#include "cutting/material.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// Of one quantity over the time of a tool's cuts.
class LoadSpread {
 public:
  void add(double value, double seconds, const SourceRef& source);
  /// By its nominal value; `most` becomes the greatest.
  void add(const ValueRange& range, double seconds, const SourceRef& source, ValueRange& most) {
    if (range.nominal > most_) most = range;
    add(range.nominal, seconds, source);
  }

  double most() const { return most_; }
  const SourceRef& most_at() const { return most_at_; }
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
