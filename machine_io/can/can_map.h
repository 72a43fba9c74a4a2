// machine_io/can/can_map.h - which signals are the machine's positions, and how frames become
// samples. No sockets: the live source and the reader of candump logs share it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "machine_io/can/can_cycle.h"
#include "machine_io/can/can_signal.h"
#include "machine_io/position_source.h"

namespace kerf {

/// What a position can be, mm or degrees. A frame that says another, by more than a hundredth of
/// the span (1 without a span), is at fault, and not taken.
struct CanAxisRange {
  std::optional<double> min;
  std::optional<double> max;
  /// mm/s; for those who look at positions one after the other. Not looked at here.
  std::optional<double> max_speed_per_s;
};

/// Where on the bus the machine's numbers are. Scale each to mm, degrees, rpm.
struct CanMap {
  std::array<std::optional<CanSignal>, kMaxPositions> axes;
  std::array<CanAxisRange, kMaxPositions> ranges;
  std::optional<CanSignal> tool;           ///< tool number in the spindle, 0 = none
  std::optional<CanSignal> line;           ///< program line, 0 = idle
  std::optional<CanSignal> spindle;        ///< rpm, signed
  std::optional<CanSignal> tool_offset_z;  ///< mm
  std::optional<CanSignal> trigger;        ///< of a punch: 0 off, else on
  std::optional<CanSignal> load;           ///< of the spindle, in load_unit
  LoadUnit load_unit = LoadUnit::kPercentOfPower;

  /// The drives of one machine answer one after the other. What comes within this time can make
  /// one sample; ms, 0.1 to 10 000. Longer than the bus needs for one cycle; when drives send only
  /// what changes, the last change is shown so much later.
  double gather_ms = 50.0;
  /// The frame that drives answer with their positions of that moment: an 11-bit id, at most one
  /// byte of data. CANopen's SYNC is 0x080. -1: none; nor is it one where a signal has that id.
  int sync_id = 0x080;

  /// What the configuration calls them; for messages.
  std::array<std::string, kMaxPositions> axis_keys{"X", "Y", "Z", "A", "B", "C", "U", "V", "W"};
};

/// All that is wrong, each a sentence beginning with the key ("map.X.id: ..."). Empty: nothing.
std::vector<std::string> validate(const CanMap& map, const std::string& key = "map");

/// Position of a CiA 402 drive in its default TPDO3 (0x380 + node): statusword, then the actual
/// position 0x6064 as int32, little-endian, at byte 2. Drives may be set up otherwise: SIKO's AP10
/// has it in TPDO1 at byte 0.
CanSignal cia402_position(std::uint8_t node, double mm_per_count);

/// Position of an ODrive axis, Get_Encoder_Estimates (node << 5 | 9): float32 turns.
CanSignal odrive_position(std::uint8_t node, double mm_per_turn);

/// Puts the frames of one cycle of the bus together (CanCycle). A sample is ready
///   - when every mapped axis has come; the very first ones perhaps only with those that follow,
///     when they may be made of two cycles each;
///   - when an axis comes a second time, or CanMap::gather_ms after the first of them: the missing
///     are then known from before (if not too old), but not fresh. But where the bus is cyclic a
///     cycle that lacks a frame is dropped, and counted when the bus goes on as before. (Axes whose
///     max_age_ms is 0 come when they change: such a bus is not cyclic.)
/// A sample bears the stamp of the newest of its axes; stamps go back from one sample to
/// the next only behind kClockStepped. `host_ns` is left to the caller. Tool, line, spindle and
/// tool offset go along with the axes and make no sample by themselves. No allocation after
/// construction. O(mapped signals) per frame.
class CanAssembler {
 public:
  enum class Taken : std::uint8_t {
    kNotMapped,    ///< no signal of the map is in it
    kTaken,        ///< it is in a sample that is ready or being gathered
    kUnfit,        ///< a mapped signal does not fit: too short, not finite, no possible tool number
    kLate,         ///< its stamp is up to kLateNs before the newest: not taken
    kClockStepped  ///< its stamp is even earlier: all values were forgotten, gathering began anew
  };

  /// Frames that several queues hold can be swapped by so much; more is a clock set back.
  static constexpr std::int64_t kLateNs = 1'000'000'000;

  /// The map must be valid.
  explicit CanAssembler(const CanMap& map);

  /// Takes a frame in. `device_ns` is its stamp, 0 to 2^62. A frame makes at most kMostReady
  /// samples ready, which next() must have handed out before the next push. kUnfit: what fits of it
  /// is taken.
  Taken push(const CanFrame& frame, std::int64_t device_ns);

  /// The next sample that is ready, if there is one.
  bool next(AxisSample& sample);

  /// Makes ready what has been gathered, if anything: the log is at its end, or the bus silent.
  void flush();

  /// True while some axes of a sample have come and others are waited for.
  bool is_gathering() const { return !cycle_.is_empty() || held_count_ > 0 || is_doubted_; }

  /// The stamp behind which a frame no longer belongs to what is being gathered.
  std::int64_t gather_end_ns() const {
    if (!cycle_.is_empty()) return cycle_.first_ns() + gather_ns_;
    return is_doubted_ ? cycle_.doubted_until_ns() : cycle_.seems_shifted_until_ns();
  }

  std::int64_t gather_ns() const { return gather_ns_; }

  /// Frames are known to be lost here: what is gathered is not completed by what follows.
  void frames_lost() { is_broken_ = true; }

  /// Cycles of a cyclic bus that were dropped because a frame was missing.
  std::uint64_t incomplete() const { return incomplete_; }
  /// About the last of them: "a cycle of the bus came without X and was dropped (a frame was
  /// lost?)". Built on demand.
  std::string incomplete_text() const;

  /// Forgets every value: what comes next is a new beginning.
  void forget();

  /// About the last kUnfit: "frame 0x381 has 2 bytes, X ends in byte 6". Built on demand.
  std::string unfit_text() const;

 private:
  static constexpr std::size_t kTool = kMaxPositions;
  static constexpr std::size_t kLine = kTool + 1;
  static constexpr std::size_t kSpindle = kLine + 1;
  static constexpr std::size_t kToolOffsetZ = kSpindle + 1;
  static constexpr std::size_t kTrigger = kToolOffsetZ + 1;
  static constexpr std::size_t kLoad = kTrigger + 1;
  static constexpr std::size_t kSlots = kLoad + 1;

  struct Slot {
    CanSignal signal;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::int64_t max_age_ns = 0;  // 0: never too old
    double value = 0.0;
    std::int64_t at_ns = AxisSample::kNoTime;  // kNoTime: never read
  };
  struct Arrival {
    std::size_t slot;
    double value;
  };

  static constexpr std::size_t kMostHeld = CanCycle::kShifts - 1;
  static constexpr std::size_t kMostReady = kMostHeld + 3;

  void add(std::size_t slot, const CanSignal& signal);
  bool is_sync(const CanFrame& frame) const;
  void close();
  void close_incomplete();
  void release_held();
  void settle_doubt(std::int64_t next_ns);
  AxisSample gathered_sample() const;
  void make_ready(const AxisSample& sample);
  bool is_known(const Slot& slot) const;  // at the time of the sample being gathered
  bool note_unfit(std::size_t slot, const CanFrame& frame, CanFit fit, double value);

  std::array<std::string, kSlots> names_;
  std::array<Slot, kSlots> slots_;
  std::array<std::size_t, kSlots> used_{};  // the first used_count_: which slots are mapped
  std::size_t used_count_ = 0;
  std::int64_t gather_ns_ = 0;
  int sync_id_ = -1;
  LoadUnit load_unit_ = LoadUnit::kPercentOfPower;
  CanCycle cycle_{0, 0, false};
  std::int64_t newest_ns_ = AxisSample::kNoTime;
  std::uint64_t incomplete_ = 0;

  /// The first samples, while it is not known whether each is of one cycle.
  std::array<AxisSample, kMostHeld> held_;
  std::size_t held_count_ = 0;
  bool is_first_ = true;
  bool is_broken_ = false;
  /// The last one, while the next frame is waited for that says whether it is of one cycle.
  AxisSample doubted_;
  bool is_doubted_ = false;

  std::array<AxisSample, kMostReady> ready_;
  std::size_t ready_count_ = 0;

  struct Unfit {
    std::size_t slot = 0;
    CanFit fit = CanFit::kOther;
    std::uint8_t length = 0;
    double value = 0.0;
  };
  Unfit unfit_;
};

}  // namespace kerf
