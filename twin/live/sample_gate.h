// twin/live/sample_gate.h - single readings that no machine can have between their neighbours: a
// damaged number, a bit that toppled, within the machine's travel.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "machine_io/position_source.h"
#include "twin/live/live_frame.h"
#include "twin/machine/timeline.h"

namespace kerf {

/// What each position of the samples can do. Of positions that turn nothing is judged: some
/// controllers count them from 0 to 360.
struct MotionBounds {
  /// Of a machine of which nothing is told: beyond milling machines and lasers.
  static constexpr double kMost_per_s2 = 30e3;

  struct Bound {
    bool judged = false;
    std::string name;                                             ///< "X"
    double most_per_s2 = kMost_per_s2;                            ///< mm/s2
    double most_per_s = std::numeric_limits<double>::infinity();  ///< mm/s
  };
  std::array<Bound, kMaxPositions> bounds;
};

/// What the user says of the machine.
struct PositionMost {
  double per_s = std::numeric_limits<double>::infinity();  ///< mm/s, of each axis
  double per_s2 = 0;                                       ///< mm/s2; 0: not said
  /// Of single positions, where their map says it. mm/s.
  std::array<double, kMaxPositions> of_position_per_s = [] {
    std::array<double, kMaxPositions> none{};
    none.fill(std::numeric_limits<double>::infinity());
    return none;
  }();
};

/// By the INI, as far as there is one, and the user's word, which goes before it.
MotionBounds motion_bounds(const LiveFrameOptions& frame, const TimelineOptions& timeline,
                           const PositionMost& most);

/// A machine that is elsewhere for one sample, or two, and back in the next, went there and back
/// within the time between its neighbours. How far it comes in that time with the acceleration a of
/// its axis, and its speed v, is a T^2 / 8 and v T / 2. A reading that lies farther off the way
/// between its neighbours is wild, and is dropped. What is elsewhere and stays there is no such
/// reading: a machine is homed, a source begins again.
///
/// Times are not exacter than kInexact_s. A sample that cannot be judged yet waits for the next
/// one; all others go through at once.
class SampleGate {
 public:
  /// What was held up on a busy computer follows in a burst, or is read later than it is stamped.
  static constexpr double kInexact_s = 0.05;
  /// Readings tremble, and machines are better than what is written of them.
  static constexpr double kFloor_mm = 1.0;
  static constexpr double kFactor = 1.5;
  /// Samples that are elsewhere one after the other: beyond so many the machine is there.
  static constexpr std::size_t kMostWild = 2;

  struct Timed {
    AxisSample sample;
    double t_s = 0;
    bool lost = false;  ///< others are known to be missing before it
  };

  /// `gap_s`: across longer pauses nothing is judged.
  SampleGate(MotionBounds bounds, double gap_s) : bounds_(std::move(bounds)), gap_s_(gap_s) {}

  /// The next sample. What may pass is appended to `out` in its order. The wild ones' number; then
  /// fault() tells of the last of them.
  std::size_t take(const Timed& next, std::vector<Timed>& out);
  /// No other comes: what waits passes.
  void finish(std::vector<Timed>& out);

  /// "X reads 20 mm, and -19.98 mm just before and after it: no machine is so quick".
  const std::string& fault() const { return fault_; }

 private:
  double farthest_mm(std::size_t index, double between_s) const;
  bool is_suspect(const Timed& next) const;
  bool is_wild(const Timed& one, const Timed& next);
  void pass(const Timed& one, std::vector<Timed>& out);

  MotionBounds bounds_;
  double gap_s_;
  bool has_last_ = false;
  Timed last_;  ///< that has passed
  /// Speed of each position there, mm/s.
  std::array<double, kMaxPositions> speed_{};
  std::array<Timed, kMostWild> waiting_;
  std::size_t waiting_count_ = 0;
  std::string fault_;
};

}  // namespace kerf
