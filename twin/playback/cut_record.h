// twin/playback/cut_record.h - how a program was cut: which motions, with which cutter, in which
// pieces; what it takes to cut a part of it again with the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "stock/cutter/cutter.h"

namespace kerf {

/// Written by RecordingStock as the program is cut for the first time; five bytes a motion.
class CutRecord {
 public:
  explicit CutRecord(std::size_t motions) : flags_(motions, 0), removed_mm3_(motions, 0) {}

  /// The motion cuts: it was given to the model.
  bool cuts(std::size_t motion) const { return (flags_[motion] & kCuts) != 0; }
  /// After it the model was finished (StockModel::finish), before anything else was cut.
  bool finishes(std::size_t motion) const { return (flags_[motion] & kFinishes) != 0; }
  /// It is the first one that its cutter cuts.
  bool mounts(std::size_t motion) const { return (flags_[motion] & kMounts) != 0; }
  /// Before it no model holds anything back: the path begins anew, or turns a sharp corner. A copy
  /// made there goes on as its original does.
  bool breaks(std::size_t motion) const { return (flags_[motion] & kBreaks) != 0; }
  /// That cut the motion, or the last one before it that was cut; null: none yet. O(log tools).
  std::shared_ptr<const Cutter> cutter(std::size_t motion) const;

  /// The cutter that stands for a tool at a motion, whether that cuts or not: the one it was or
  /// will be cut with next to the motion, as far as recorded; null: the tool has cut nothing.
  std::shared_ptr<const Cutter> cutter_of_tool(int tool, std::size_t motion) const;

  /// Seconds of cutting until a motion, as measured; from samples, between them evenly.
  double cost_s(std::size_t motion) const;

  /// Removed by each motion, 0 where that is not known yet. Any thread, also while it is written.
  std::vector<float> removed_mm3() const;

  void note_cut(std::size_t motion, int tool, const Cutter& cutter);
  void note_finish(std::size_t motion) { flags_[motion] |= kFinishes; }
  void note_break(std::size_t motion) { flags_[motion] |= kBreaks; }
  void note_cost(std::size_t motion, double cost_s);
  /// A motion may be several moves: what they remove is added up.
  void note_removed(std::size_t motion, double removed_mm3);

 private:
  static constexpr std::uint8_t kCuts = 1, kFinishes = 2, kBreaks = 4, kMounts = 8;
  struct Mount {
    std::size_t motion = 0;
    int tool = 0;
    std::shared_ptr<const Cutter> cutter;
  };
  struct Cost {
    std::size_t motion = 0;
    double cost_s = 0;
  };

  std::vector<std::uint8_t> flags_;
  mutable std::vector<float> removed_mm3_;  ///< each an atomic
  std::vector<Mount> mounts_;               ///< in order
  std::vector<Cost> costs_;                 ///< in order, not closer than kCostStep motions
  static constexpr std::size_t kCostStep = 1024;
};

}  // namespace kerf
