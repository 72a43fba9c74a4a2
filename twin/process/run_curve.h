// twin/process/run_curve.h - what a program does over its time, in columns.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "twin/process/motion_recorder.h"

namespace kerf {

/// A thousand columns for a program of any length: when its time exceeds them, each two become one.
/// One thread.
class RunCurve final : public MotionRecorder {
 public:
  static constexpr std::size_t kMost = 1024;

  struct Column {
    double removed_mm3 = 0;
    double feed_mm = 0, feed_s = 0;  ///< way and time of feed moves
    double turns = 0;                ///< of the spindle
    /// Of the motion that takes longest of it, and where that is in the middle of that time.
    SourceRef source;
    Vec3 at_mm{0};
    double motion_s = 0;  ///< how long it takes; 0: none has been told
  };
  /// What a motion did, evenly over its time.
  struct Share {
    double start_s = 0, duration_s = 0;
    double removed_mm3 = 0;
    double feed_mm = 0;              ///< 0: it is no feed move
    double rpm = 0;                  ///< 0: the spindle stands
    const Motion* motion = nullptr;  ///< null: its columns do not say which it was
  };

  /// Shares of the past are welcome, too; those without a time count where they are.
  void add(const Share& share);

  /// A motion's way and the spindle's turns; then what it has removed, evenly over its time.
  void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) override;
  void on_cut(std::uint64_t number, double removed_mm3, double depth_mm) override;
  void restart() override { *this = RunCurve(); }
  void name_files(const std::vector<std::string>&) override {}

  double step_s() const { return step_s_; }
  std::span<const Column> columns() const { return columns_; }

 private:
  void double_step();

  struct Window {
    std::uint64_t number = 0;
    double start_s = 0, duration_s = 0;
  };

  double step_s_ = 0.0625;
  std::deque<Window> waiting_;  ///< motions of which more cuts may come
  std::vector<Column> columns_;
};

}  // namespace kerf
