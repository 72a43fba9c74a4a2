// machine_io/can/can_cycle.h - which frames of a bus belong to one cycle of its drives. Knows axes
// and stamps, no values.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "machine_io/position_source.h"

namespace kerf {

/// Gathers the frames of one cycle, and learns what the bus does: how long a period is, in which
/// order the axes come, whether a SYNC stands before each cycle. When the last kLearnt cycles were
/// complete and in one order, the bus is cyclic: then a frame that is missing is noticed, because
/// its axis comes next out of its order and twice its period after its last frame. (A late frame
/// alone proves nothing: stamps of a busy computer are late by any time, but keep their order. Nor
/// does another order: drives with clocks of their own overtake each other.) Where as many are lost
/// in a row as there are axes, what is left is in order: then a cycle takes a period longer than it
/// should, and on a bus whose stamps have been calm it is doubted. If the pause behind it is that
/// between two cycles, it is of two; a frame that was late has made that pause shorter. Drives that
/// send only what changes never come so, or stop coming so: then nothing is noticed, nor held
/// against them.
///
/// Who begins to listen in the middle of a cycle gathers parts of two. That shows by the pause
/// between two cycles, when it lies within what is gathered, kShifts times in a row, as long and at
/// the same place.
///
/// No allocation. Stamps in ns.
class CanCycle {
 public:
  /// Complete cycles in a row that make a bus cyclic.
  static constexpr int kLearnt = 8;
  static constexpr int kShifts = 4;
  /// A pause between two cycles is as long as this, where it is looked for. (Frames that follow
  /// each other without a pause have none that means anything.)
  static constexpr std::int64_t kLeastPause_ns = 500'000;
  /// Complete cycles in a row, each within an eighth of a period of what it should be, that make
  /// stamps calm.
  static constexpr int kCalm = 16;
  /// So many incomplete cycles in a row are no lost frames: the drives send otherwise now.
  static constexpr int kMostIncomplete = 4;

  /// `axes`: bits of those that make a cycle complete. `may_learn`: false where some of them are
  /// said to come only when they change.
  CanCycle(std::uint16_t axes, std::int64_t gather_ns, bool may_learn)
      : axes_(axes), gather_ns_(gather_ns), may_learn_(may_learn) {}

  bool is_empty() const { return count_ == 0; }
  bool is_complete() const { return gathered_ == axes_; }
  std::uint16_t gathered() const { return gathered_; }
  std::int64_t first_ns() const { return frames_[0].at_ns; }
  std::int64_t last_ns() const { return frames_[count_ - 1].at_ns; }

  /// Whether a frame of these axes belongs to another cycle than what is gathered.
  bool ends_before(std::uint16_t axes, std::int64_t at_ns) const;
  /// A frame of what is gathered.
  void add(std::uint16_t axes, std::int64_t at_ns);
  /// Axes that have come when a SYNC comes: true if it ends their cycle.
  bool ends_at_sync();

  enum class Verdict : std::uint8_t {
    kWhole,    ///< all of one cycle
    kShifted,  ///< parts of two cycles: what is gathered now is the newer part
    kDoubted   ///< perhaps of two cycles: is_doubt_true() says so when the next frame comes
  };
  /// Of a cycle that is complete. kWhole, kDoubted: nothing is gathered any more.
  Verdict close();
  /// Of one that is not. True: the bus is cyclic, and a frame is missing.
  bool close_incomplete();
  /// Frames that were missing from the cycles between the last two complete ones, of a cyclic bus.
  int take_missing() { return std::exchange(missing_, 0); }
  std::uint16_t missing_axes() const { return missing_axes_; }

  /// The cycle that was doubted is parts of two: the next frame comes (`next_ns`), or is waited for
  /// still, so long after it. The frames that were lost are those of take_missing() then.
  bool is_doubt_true(std::int64_t next_ns);
  /// Behind this stamp it is.
  std::int64_t doubted_until_ns() const {
    return before_ns_ + std::max<std::int64_t>(0, 3 * period_ns_ / 4 - span_ns_);
  }

  /// The last complete cycle may be parts of two: it has such a pause ..
  bool has_pause() const { return widest_ns_ >= kLeastPause_ns; }
  /// .. and so have others before it, longer than the one between them.
  bool may_be_shifted() const { return shifts_ > 0; }
  /// The next frame came so soon after a complete cycle that its own widest pause may be the one
  /// between two cycles. (Many times sooner.)
  bool seems_shifted(std::int64_t next_ns) const {
    return widest_ns_ > 0 && (next_ns - before_ns_) * kPauseRatio < widest_ns_;
  }
  /// Until when a frame has to come for seems_shifted().
  std::int64_t seems_shifted_until_ns() const { return before_ns_ + widest_ns_ / kPauseRatio; }

  void forget() { *this = CanCycle(axes_, gather_ns_, may_learn_); }

 private:
  static constexpr std::int64_t kPauseRatio = 8;
  struct Frame {
    std::uint16_t axes = 0;
    std::int64_t at_ns = 0;
  };

  bool is_cyclic() const { return may_learn_ && run_ >= kLearnt; }
  bool is_out_of_order(std::uint16_t axes) const;
  void learn();
  void learn_period(std::int64_t interval_ns);
  bool may_be_of_two() const;
  void clear();

  std::uint16_t axes_;
  std::int64_t gather_ns_;
  bool may_learn_;

  std::array<Frame, kMaxPositions> frames_{};  ///< of what is gathered
  std::size_t count_ = 0;
  std::uint16_t gathered_ = 0;
  bool sync_inside_ = false;

  std::array<std::int64_t, kMaxPositions> last_of_axis_{};  ///< stamp; 0: none yet
  std::array<int, kMaxPositions> missed_{};  ///< closed cycles since then that lacked it
  std::int64_t before_ns_ = 0;               ///< last frame of the last complete cycle; 0: none yet
  std::int64_t start_ns_ = 0;       ///< and its first; 0: the cycle since then was not complete
  std::int64_t widest_ns_ = 0;      ///< its longest pause ..
  std::uint16_t after_widest_ = 0;  ///< .. and the axes of the frame behind that
  int shifts_ = 0;                  ///< complete cycles in a row that were like that
  std::int64_t period_ns_ = 0;
  std::int64_t span_ns_ = 0;     ///< from the first frame of a cycle to its last
  std::int64_t doubted_ = 0;     ///< cycles that the doubted one is parts of
  int doubts_ = 0;               ///< cycles in a row that were doubted
  int calm_ = 0;                 ///< cycles in a row that came and ended when they should
  std::uint16_t late_axes_ = 0;  ///< those behind its longest pause
  int odd_ = 0;                  ///< periods in a row that were others
  int run_ = 0;                  ///< complete cycles in a row in the same order
  std::array<std::uint16_t, kMaxPositions> order_{};  ///< that order
  int synced_ = 0;  ///< complete cycles in a row with a SYNC before and none inside
  bool sync_before_ = false;
  int pending_ = 0;  ///< incomplete cycles in a row, not yet known to be lost frames
  std::uint16_t pending_axes_ = 0;
  int missing_ = 0;
  std::uint16_t missing_axes_ = 0;
};

}  // namespace kerf
