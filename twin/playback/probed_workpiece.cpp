#include "twin/playback/probed_workpiece.h"

#include <utility>

#include "twin/job/stock_choice.h"

namespace kerf {

ProbedWorkpiece::ProbedWorkpiece(const SessionOptions& options, const ProgramFront& front,
                                 std::stop_token stop)
    : stock_(front.stock.stock->snapshot()),
      resolver_(front.tools, row_of(*stock_).can_cut),
      stage_(*stock_, resolver_, log_, options.timeline) {
  log_.set_muted(true);
  stage_.stop_by(std::move(stop));
  CheckOptions checks{.blank_guessed = front.blank_guessed, .below_mm = options.below_mm};
  checks.collisions.cut_by_shank = options.collisions.cut_by_shank;
  stage_.check_by(checks);
}

void ProbedWorkpiece::take(std::span<const Motion> motions, const WorkpieceFrame& frame) {
  stage_.set_frame(frame);
  stage_.take(motions);
}

}  // namespace kerf
