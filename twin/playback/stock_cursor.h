// twin/playback/stock_cursor.h - the workpiece at a place of the program, carried to and fro.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "stock/stock_model.h"
#include "twin/machine/motion_moves.h"
#include "twin/playback/cut_record.h"
#include "twin/playback/keyframe_store.h"
#include "twin/playback/program_track.h"

namespace kerf {

/// Goes on from where it stands or from the keyframe before the goal, whichever is nearer, and cuts
/// what lies between exactly as it was cut the first time: the same moves in the same order,
/// finished in the same places. So the workpiece does not depend on the way. Passing through long
/// gaps it leaves new keyframes. One thread.
class StockCursor {
 public:
  /// `moves`: how the program's motions are cut; as they were recorded.
  StockCursor(const ProgramTrack& track, const MotionMoves& moves, const CutRecord& record,
              KeyframeStore& store);

  /// All motions before this one are cut.
  std::size_t motion() const { return motion_; }
  /// A piece of the way to `goal`, about a millisecond's worth. True when it is there. The program
  /// must have been recorded up to the goal.
  bool approach(std::size_t goal);

  /// The workpiece here, with the part up to `fraction` of the motion that comes next. That part is
  /// in the copy alone. With a fraction the record must hold that motion.
  std::unique_ptr<StockModel> picture(double fraction) const;

 private:
  void jump_near(std::size_t goal);
  void offer_keyframe();
  void lead_taps(std::size_t motion, const Cutter& cutter, std::span<CutMove> moves) const;

  const ProgramTrack& track_;
  const MotionMoves& motion_moves_;
  const CutRecord& record_;
  KeyframeStore& store_;
  std::unique_ptr<StockModel> stock_;
  /// The keyframe that was gone to last, so that going back to it again and again is quick.
  std::unique_ptr<StockModel> near_;
  std::size_t near_motion_ = 0;
  std::size_t motion_ = 0;
  std::size_t goal_ = 0;
  std::size_t offered_ = 0;  ///< where a keyframe was last thought of
  std::vector<CutMove> moves_;
  std::vector<CutReport> reports_;  ///< of no interest
};

}  // namespace kerf
