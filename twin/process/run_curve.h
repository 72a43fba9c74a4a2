// twin/process/run_curve.h - what a program does over its time, in columns.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kerf {

/// A thousand columns for a program of any length: when its time exceeds them, each two become one.
/// One thread.
class RunCurve {
 public:
  static constexpr std::size_t kMost = 1024;

  struct Column {
    double removed_mm3 = 0;
    double feed_mm = 0, feed_s = 0;  ///< way and time of feed moves
    double turns = 0;                ///< of the spindle
  };
  /// What a motion did, evenly over its time.
  struct Share {
    double start_s = 0, duration_s = 0;
    double removed_mm3 = 0;
    double feed_mm = 0;  ///< 0: it is no feed move
    double rpm = 0;      ///< 0: the spindle stands
  };

  /// Shares of the past are welcome, too; those without a time count where they are.
  void add(const Share& share);

  double step_s() const { return step_s_; }
  std::span<const Column> columns() const { return columns_; }

 private:
  void double_step();

  double step_s_ = 0.0625;
  std::vector<Column> columns_;
};

}  // namespace kerf
