#include "twin/playback/frontier.h"

#include <algorithm>
#include <utility>

#include "twin/stock_choice.h"

namespace kerf {
namespace {

/// A piece of work: about a millisecond.
constexpr std::size_t kMotionsAtOnce = 512;
constexpr double kCellsAtOnce = 1e6;

MotionMoves moves_of(const StockModel& blank, const TimelineOptions& options,
                     const ProgramTrack& track, const std::optional<BeamSettings>& beam,
                     const TurretPointer& turret) {
  MotionMoves moves = MotionMoves::of(blank, options.kinematics, track.frame());
  if (turret) {
    moves.punch(PunchMoves(turret));
  } else if (beam) {
    moves.burn(TorchMoves(beam->trigger, beam->pierce_mm));
  }
  return moves;
}

}  // namespace

Frontier::Frontier(const ProgramTrack& track, std::unique_ptr<StockModel> blank, ToolSources tools,
                   const TimelineOptions& options, KeyframeStore& store, const ReportScope& scope,
                   const std::optional<BeamSettings>& beam, const TurretPointer& turret,
                   const CheckOptions& checks)
    : track_(track),
      moves_(moves_of(*blank, options, track, beam, turret)),
      record_(track.size()),
      stock_(std::move(blank), track, moves_, record_, store),
      book_(std::move(tools), row_of(stock_).can_cut),
      stage_(stock_, book_, log_, options),
      scope_(scope) {
  stage_.set_frame(track.frame());
  stage_.check_by(checks);
  if (turret) {
    stage_.punch(turret);
  } else if (beam) {
    stage_.burn(*beam);
  }
  if (scope_.from > 0) stage_.hold_reports();
}

void Frontier::advance(std::size_t end) {
  end = std::min(end, track_.size());
  const std::size_t first = reached_;
  const std::shared_ptr<const Cutter> cutter = first < end ? record_.cutter(first) : nullptr;
  double cells = 0;
  for (; reached_ < end && reached_ - first < kMotionsAtOnce && cells < kCellsAtOnce; ++reached_) {
    stock_.expect(first, reached_ + 1);
    if (reached_ == scope_.from && scope_.from > 0) stage_.release_reports();
    stage_.take_timed(track_.motion(reached_), track_.step(reached_));
    if (cutter) cells += cells_under(track_.cut_move(reached_), *cutter, stock_.cell_mm());
  }
  stage_.take({});  // hands over what it has collected
  if (reached_ < track_.size() || complete_) return;
  stage_.finish(scope_.whole);
  complete_ = true;
}

}  // namespace kerf
