// twin/playback/planned_steps.h - the path that the machine runs, as motions of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "twin/planned_pieces.h"
#include "twin/playback/program_track.h"
#include "twin/timeline.h"

namespace kerf {

/// Hands steps to a builder. Of a step with a planned path each piece becomes a motion with the
/// step's line, tool and feed, and with its share, by length, of the step's time; others go on as
/// they are. That is what CutStage cuts with PlannerOptions::with_path.
class PlannedSteps final : public StepSink {
 public:
  explicit PlannedSteps(ProgramTrackBuilder& builder) : builder_(builder) {}

  void step(const Motion& motion, const TimedStep& timed,
            std::span<const PathPiece> path) override {
    begin_.push_back(pieces_);
    for_each_piece(motion, timed, path, [this](const Motion& piece, const TimedStep& part) {
      ++pieces_;
      builder_.step(piece, part, {});
    });
  }

  /// Number in the track of the first motion of a step; of one that has not come: how many there
  /// are.
  std::size_t first_of(std::size_t step) const {
    return step < begin_.size() ? begin_[step] : pieces_;
  }

 private:
  ProgramTrackBuilder& builder_;
  std::vector<std::uint32_t> begin_;  ///< by step
  std::uint32_t pieces_ = 0;
};

}  // namespace kerf
