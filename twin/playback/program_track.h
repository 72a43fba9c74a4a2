// twin/playback/program_track.h - a whole program as a timeline: motions with their times, packed,
// for access in any order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/stock_model.h"
#include "twin/machine/motion_moves.h"
#include "twin/machine/timeline.h"
#include "twin/playback/packed_column.h"
#include "twin/playback/packed_way.h"

namespace kerf {

/// A place in a program: all motions before `motion` are done, and of that one the part up to
/// `fraction` of its way. `motion` == size() is the end. `time_s` is the program time; within a
/// pause between two motions it alone moves.
struct TrackPosition {
  std::size_t motion = 0;
  double fraction = 0;  ///< [0, 1)
  double time_s = 0;
  bool operator==(const TrackPosition&) const = default;
};

/// The motions of a program, in order, numbered from 0, with their times. Immutable once built, so
/// any number of threads may read it. A motion comes out bit for bit as it went in; a million of a
/// CAM program take about 22 MB (bytes()). Reading one costs about 0.1 us.
class ProgramTrack {
 public:
  std::size_t size() const { return line_.size(); }
  bool empty() const { return size() == 0; }

  Motion motion(std::size_t i) const;
  /// As the planner gave it.
  TimedStep step(std::size_t i) const;
  /// cut_move_from(motion(i), i), at a fifth of the cost.
  CutMove cut_move(std::size_t i) const;
  /// What motion(i) is cut as, with i for an id: MotionMoves::append(), or where the motions
  /// before count OrderedMoves::append().
  void append_moves(std::size_t i, const MotionMoves& moves, const Cutter& cutter,
                    std::vector<CutMove>& out) const;
  /// The same of its way up to `fraction`.
  void append_part(std::size_t i, double fraction, const MotionMoves& moves, const Cutter& cutter,
                   std::vector<CutMove>& out) const;
  MotionKind kind(std::size_t i) const { return mode_of(i).kind; }
  bool is_traverse(std::size_t i) const;
  int tool(std::size_t i) const { return mode_of(i).tool; }
  SourceRef source(std::size_t i) const;
  Vec3 to_mm(std::size_t i) const;
  Vec3 from_mm(std::size_t i) const;

  double start_s(std::size_t i) const { return start_s_.real_at(i); }
  double end_s(std::size_t i) const { return start_s(i) + motion_s(i); }
  double motion_s(std::size_t i) const;  ///< end_s() - start_s(), before it was rounded
  /// How the way of motion i goes in its time.
  WayInTime way(std::size_t i) const {
    const std::uint64_t number = way_.at(i);
    return number == 0 ? WayInTime{} : ways_[static_cast<std::size_t>(number) - 1].unpacked();
  }
  /// Of the whole program.
  double duration_s() const { return empty() ? 0 : end_s(size() - 1); }

  /// SourceRef::file indexes this.
  const std::vector<std::string>& files() const { return files_; }
  /// Where the workpiece lies in the machine.
  const WorkpieceFrame& frame() const { return frame_; }

  /// The place at a time; before the first motion and after the last one the ends of the program.
  /// Within a motion the tip moves as the planner has it (WayInTime). O(log n).
  TrackPosition place_at(double time_s) const;
  /// Just before motion i; its start, or (i == size()) the end of the program.
  TrackPosition place_before(std::size_t i) const;

  /// First motion of the line, of those with number >= from; in a loop a line comes back. Nothing
  /// if there is none. O(log n).
  std::optional<std::size_t> first_of_line(SourceRef line, std::size_t from = 0) const;
  /// The line itself if it has motions, else the next one of its file that has.
  std::optional<SourceRef> line_with_motions(SourceRef line) const;

  /// A block's motions follow each other and have the same line. (Two runs of a loop whose body is
  /// one line are one block.)
  bool starts_block(std::size_t i) const { return (block_start_[i / 64] >> (i % 64) & 1) != 0; }
  /// First motion of the block after the one that motion i belongs to; size(): none.
  std::size_t next_block(std::size_t i) const;
  /// First motion of the last block that begins before motion i; 0: there is none.
  std::size_t previous_block(std::size_t i) const;

  /// Motions at which another tool comes into the spindle, in order.
  std::span<const std::uint32_t> tool_changes() const { return tool_changes_; }
  /// The first one after motion i, the last one before it.
  std::optional<std::size_t> next_tool_change(std::size_t i) const;
  std::optional<std::size_t> previous_tool_change(std::size_t i) const;

  std::size_t bytes() const;

 private:
  friend class ProgramTrackBuilder;
  /// A motion that does not begin where the one before ended.
  struct Jump {
    std::uint32_t motion = 0;
    Vec3 from_mm{0};
    std::array<double, 3> from_abc_deg{};
    Vec3 from_uvw_mm{0};
  };
  ProgramTrack() = default;
  const Motion& mode_of(std::size_t i) const {
    return modes_[static_cast<std::size_t>(mode_.at(i))];
  }
  const Jump* jump_at(std::size_t i) const;
  std::size_t motion_of_line(std::size_t index) const {
    return static_cast<std::size_t>(lines_.at(index));
  }
  /// Index into lines_ of the first block that is not before (line, motion).
  std::size_t line_lower_bound(SourceRef line, std::size_t motion) const;

  using Of = PackedColumn::Of;
  std::array<PackedColumn, 3> to_mm_{PackedColumn(Of::kReals), PackedColumn(Of::kReals),
                                     PackedColumn(Of::kReals)};
  std::array<PackedColumn, 3> to_abc_deg_{PackedColumn(Of::kReals), PackedColumn(Of::kReals),
                                          PackedColumn(Of::kReals)};
  std::array<PackedColumn, 3> to_uvw_mm_{PackedColumn(Of::kReals), PackedColumn(Of::kReals),
                                         PackedColumn(Of::kReals)};
  std::array<PackedColumn, 3> arc_center_mm_{PackedColumn(Of::kReals), PackedColumn(Of::kReals),
                                             PackedColumn(Of::kReals)};
  PackedColumn arc_sweep_rad_{Of::kReals};
  PackedColumn feed_{Of::kReals};
  PackedColumn spindle_rpm_{Of::kReals};
  PackedColumn start_s_{Of::kReals};
  /// Most motions take the time until the next one begins. This is added to the bits of that, as
  /// whole numbers, where a motion takes another one; behind the last one nothing begins.
  PackedColumn duration_change_{Of::kIntegers};
  PackedColumn programmed_{Of::kReals};
  PackedColumn allowed_{Of::kReals};
  PackedColumn line_{Of::kIntegers};
  PackedColumn selected_tool_{Of::kIntegers};
  PackedColumn selected_at_{Of::kIntegers};  ///< file and line
  PackedColumn mode_{Of::kIntegers};         ///< indexes modes_
  PackedColumn way_{Of::kIntegers};          ///< 0: even; else ways_[way - 1]
  std::vector<PackedWay> ways_;
  std::vector<Motion> modes_;               ///< all that motions share; what varies is zero
  std::vector<Jump> jumps_;                 ///< in order
  std::vector<std::uint64_t> block_start_;  ///< a bit a motion
  PackedColumn lines_{Of::kIntegers};       ///< first motions of blocks, by (file, line, motion)
  std::vector<std::uint32_t> tool_changes_;
  std::vector<std::string> files_;
  WorkpieceFrame frame_;
};

/// Takes the steps of a Timeline and makes a track of them. About 0.2 us a motion.
class ProgramTrackBuilder final : public StepSink {
 public:
  /// More would not fit the 32-bit numbers of motions; further ones are counted, not kept.
  static constexpr std::size_t kMaxMotions = 0xffff'ffff;

  ProgramTrackBuilder();
  void step(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path) override;
  std::uint64_t left_out() const { return left_out_; }
  /// Once; the builder is empty afterwards.
  std::shared_ptr<const ProgramTrack> build(std::vector<std::string> files,
                                            const WorkpieceFrame& frame);

 private:
  /// The bits of what motions share.
  using ModeKey = std::array<std::uint64_t, 38>;
  static ModeKey key_of(const Motion& motion);
  std::uint64_t mode_of(const Motion& motion);
  void sort_lines();
  void note_duration(double until_next_s);

  std::unique_ptr<ProgramTrack> track_;
  std::map<ModeKey, std::uint32_t> mode_numbers_;
  ModeKey last_key_{};
  std::uint32_t last_mode_ = 0;
  Motion previous_;
  double previous_start_s_ = 0, previous_duration_s_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace kerf
