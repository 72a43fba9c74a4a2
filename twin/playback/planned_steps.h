// twin/playback/planned_steps.h - the path that the machine runs, as motions of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "twin/motion_geometry.h"
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
    if (path.empty()) {
      ++pieces_;
      builder_.step(motion, timed, {});
      return;
    }
    double whole_mm = 0;
    for (const PathPiece& piece : path) whole_mm += path_length_mm(motion_of(motion, piece));
    TimedStep part = timed;
    for (const PathPiece& piece : path) {
      const Motion moved = motion_of(motion, piece);
      part.length_mm = path_length_mm(moved);
      part.duration_s = whole_mm > 0 ? timed.duration_s * part.length_mm / whole_mm
                                     : timed.duration_s / static_cast<double>(path.size());
      ++pieces_;
      builder_.step(moved, part, {});
      part.start_s += part.duration_s;
      // A programmed feed that the axes cannot do is told once.
      part.allowed_mm_per_min = part.programmed_mm_per_min;
    }
  }

  /// Number in the track of the first motion of a step; of one that has not come: how many there
  /// are.
  std::size_t first_of(std::size_t step) const {
    return step < begin_.size() ? begin_[step] : pieces_;
  }

 private:
  static Motion motion_of(const Motion& motion, const PathPiece& piece) {
    Motion moved = motion;
    if (piece.curved) {
      moved.kind = MotionKind::kArc;
    } else if (motion.kind == MotionKind::kArc) {
      moved.kind = MotionKind::kFeed;
    }
    moved.from_mm = piece.from_mm;
    moved.to_mm = piece.to_mm;
    moved.arc = piece.arc;
    return moved;
  }

  ProgramTrackBuilder& builder_;
  std::vector<std::uint32_t> begin_;  ///< by step
  std::uint32_t pieces_ = 0;
};

}  // namespace kerf
