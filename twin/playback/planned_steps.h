// twin/playback/planned_steps.h - the path that the machine runs, as motions of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "twin/machine/planned_pieces.h"
#include "twin/machine/timeline.h"
#include "twin/playback/program_track.h"
#include "twin/playback/programmed_steps.h"

namespace kerf {

/// Hands steps to a builder. Of a step with a planned path each piece becomes a motion with the
/// step's line, tool and feed, and with its share, by length, of the step's time; others go on as
/// they are. That is what CutStage cuts with PlannerOptions::with_path.
/// `keep_programmed`: the steps are kept as they come, too.
class PlannedSteps final : public StepSink {
 public:
  explicit PlannedSteps(ProgramTrackBuilder& builder, bool keep_programmed = false)
      : builder_(builder) {
    if (keep_programmed) programmed_.emplace();
  }

  void step(const Motion& motion, const TimedStep& timed,
            std::span<const PathPiece> path) override {
    begin_.push_back(pieces_);
    if (programmed_) programmed_->step(motion, timed, {});
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

  /// Once; empty unless they have been kept.
  ProgrammedSteps take_programmed(const std::vector<std::string>& files,
                                  const WorkpieceFrame& frame) {
    if (!programmed_) return {};
    return {programmed_->build(files, frame), std::move(begin_)};
  }

 private:
  ProgramTrackBuilder& builder_;
  std::optional<ProgramTrackBuilder> programmed_;
  std::vector<std::uint32_t> begin_;  ///< by step
  std::uint32_t pieces_ = 0;
};

}  // namespace kerf
