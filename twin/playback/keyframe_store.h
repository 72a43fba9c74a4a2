// twin/playback/keyframe_store.h - copies of the workpiece along a program, as many as a budget of
// memory holds, where they save the most time.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "stock/stock_model.h"

namespace kerf {

/// The workpiece before a motion.
struct Keyframe {
  std::size_t motion = 0;
  double cost_s = 0;  ///< seconds of cutting from the start of the program to here, as measured
  std::unique_ptr<StockModel> stock;  ///< packed: only snapshot() of it may be looked at
  std::size_t bytes = 0;              ///< that it keeps for itself alone
  bool is_packed = false;             ///< all that can be
};

/// Keeps keyframes in order of their motions, packed where the model can (StockModel::pack; a
/// Z-map: to a third). The first one (the blank) stays for ever and does not count. When the others
/// exceed the budget, the one goes whose absence lengthens the worst seek least: a seek costs at
/// most the cutting between two neighbours. One thread.
class KeyframeStore {
 public:
  /// `finest_s`: closer than this (seconds of cutting) no keyframe is wanted.
  explicit KeyframeStore(std::size_t budget_bytes, double finest_s = 0.004)
      : budget_bytes_(budget_bytes), finest_s_(finest_s) {}

  /// Is a keyframe there, of that cost, worth a copy? At the end: when it is far enough from the
  /// last one. Between two: when it divides a gap that is among the worst.
  bool wants(std::size_t motion, double cost_s) const;
  /// `motion` is not in the store yet.
  void add(std::size_t motion, double cost_s, std::unique_ptr<StockModel> stock);

  /// The last one at or before the motion; null: none.
  const Keyframe* at_or_before(std::size_t motion) const;
  /// Cutting cost of the longest way from one keyframe to the next.
  double worst_s() const;

  std::size_t count() const { return frames_.size(); }
  std::size_t bytes() const { return bytes_; }
  std::size_t budget_bytes() const { return budget_bytes_; }

 private:
  std::size_t upper_bound(std::size_t motion) const;
  void pack(std::size_t frame);
  void measure(std::size_t frame);
  void thin();

  std::size_t budget_bytes_;
  double finest_s_;
  std::vector<Keyframe> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace kerf
