// twin/live/load_bins.h - the load that a spindle has, and the one that it should have, by time.
#pragma once

#include <cstdint>
#include <deque>

#include "cutting/material.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// What lies within a quarter of a second. Loads are in the unit of the source.
struct LoadBin {
  double covered_s = 0;      ///< of it, with a load that was told
  double load_s = 0;         ///< load times time
  double cut_s = 0;          ///< of it, in material
  bool is_known = true;      ///< what it should take
  ValueRange expected_s;     ///< that, times time
  double rpm_s = 0;          ///< speed times time covered
  bool is_steady = true;     ///< neither its speed nor the tool has changed for a while
  bool is_drifting = false;  ///< its speed changes slowly, and has come far since it was steady
  bool is_frozen = false;    ///< the number stands still
  int tool = 0;              ///< that cuts; 0: none
  bool is_mixed = false;     ///< two do
  SourceRef source;          ///< of the first cut
  double load() const { return covered_s > 0 ? load_s / covered_s : 0; }
  /// 0: the spindle stands, or nobody tells.
  double rpm() const { return covered_s > 0 ? rpm_s / covered_s : 0; }
};

/// Bins in their order, made where they are needed; old ones can be forgotten. One thread.
class LoadBins {
 public:
  static constexpr double kBin_s = 0.25;

  static std::int64_t number_at(double t_s) { return static_cast<std::int64_t>(t_s / kBin_s); }
  static double begin_of(std::int64_t number) { return static_cast<double>(number) * kBin_s; }

  /// Of a time that is not forgotten; else nullptr.
  LoadBin* at(std::int64_t number);
  const LoadBin* find(std::int64_t number) const;
  void forget_before(std::int64_t number);
  std::int64_t first() const { return first_; }

  /// Calls `visit(bin, seconds)` for what each bin has of the time between.
  template <class Visit>
  void spread(double from_s, double to_s, Visit&& visit) {
    for (std::int64_t n = number_at(from_s); begin_of(n) < to_s || n == number_at(from_s); ++n) {
      const double begin_s = n == number_at(from_s) ? from_s : begin_of(n);
      const double end_s = begin_of(n + 1) < to_s ? begin_of(n + 1) : to_s;
      if (LoadBin* const bin = at(n)) visit(*bin, end_s - begin_s);
    }
  }

 private:
  std::deque<LoadBin> bins_;
  std::int64_t first_ = 0;
  bool is_begun_ = false;
};

}  // namespace kerf
