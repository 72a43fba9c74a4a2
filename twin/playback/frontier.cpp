#include "twin/playback/frontier.h"

#include <algorithm>
#include <utility>

#include "twin/job/stock_choice.h"

namespace kerf {
namespace {

/// A piece of work: about a millisecond.
constexpr std::size_t kMotionsAtOnce = 512;
constexpr double kCellsAtOnce = 1e6;
/// Where tools' engagement is measured a motion takes some 20 us more.
constexpr std::size_t kMeasuredAtOnce = 64;

MotionMoves moves_of(const StockModel& blank, const TimelineOptions& options,
                     const ProgramTrack& track, const ProcessPlan& process) {
  MotionMoves moves = MotionMoves::of(blank, options.kinematics, track.frame());
  moves.set_ordered(process.moves());
  return moves;
}

}  // namespace

Frontier::Frontier(const ProgramTrack& track, std::unique_ptr<StockModel> blank, ToolSources tools,
                   const TimelineOptions& options, KeyframeStore& store, const ReportScope& scope,
                   const ProcessPlan& process, std::span<const TorchMaterial> materials,
                   const CheckOptions& checks)
    : track_(track),
      moves_(moves_of(*blank, options, track, process)),
      record_(track.size()),
      stock_(std::move(blank), track, moves_, record_, store),
      resolver_(std::move(tools), row_of(stock_).can_cut),
      stage_(stock_, resolver_, log_, options, process),
      scope_(scope) {
  stage_.set_frame(track.frame());
  stage_.check_by(checks);
  stage_.judge_blank(scope.blank);
  stage_.set_materials(materials);
  if (scope_.from > 0) stage_.hold_reports();
}

void Frontier::measure_loads(std::shared_ptr<const ProgramTrack> track) {
  stage_.log_engagement(engagement_.emplace(false));
  stage_.hear_loads(*(loads_ = std::make_shared<LoadRecord>(std::move(track))));
}

/// The motion at reached_, or all pieces of its step. Returns the number of the motion behind it.
std::size_t Frontier::take_one(std::size_t settled) {
  // The workpiece keeps moves by the numbers of their motions (RecordingStock).
  if (loads_) stage_.number_from(reached_);
  if (!steps_.track) {
    stock_.expect(settled, reached_ + 1);
    stage_.take_timed(track_.motion(reached_), track_.step(reached_));
    return reached_ + 1;
  }
  const std::size_t step = next_step_++;
  const std::size_t end =
      next_step_ < steps_.first_pieces.size() ? steps_.first_pieces[next_step_] : track_.size();
  const Motion programmed = steps_.track->motion(step);
  path_.clear();
  for (std::size_t i = reached_; i < end; ++i) {
    const Motion piece = track_.motion(i);
    path_.push_back({piece.kind == MotionKind::kArc, piece.from_mm, piece.to_mm, piece.arc});
  }
  // A motion that has no path, or is run through as it is.
  if (path_.size() == 1 && path_[0].curved == (programmed.kind == MotionKind::kArc) &&
      path_[0].from_mm == programmed.from_mm && path_[0].to_mm == programmed.to_mm) {
    path_.clear();
  }
  stock_.expect(settled, end);
  stage_.take_timed(programmed, steps_.track->step(step), path_);
  return end;
}

void Frontier::advance(std::size_t end) {
  end = std::min(end, track_.size());
  const std::size_t first = reached_;
  const std::shared_ptr<const Cutter> cutter = first < end ? record_.cutter(first) : nullptr;
  const std::size_t most = loads_ ? kMeasuredAtOnce : kMotionsAtOnce;
  double cells = 0;
  while (reached_ < end && reached_ - first < most && cells < kCellsAtOnce) {
    if (reached_ == scope_.from && scope_.from > 0) stage_.release_reports();
    for (const std::size_t next = take_one(first); reached_ < next; ++reached_) {
      if (cutter) cells += cells_under(track_.cut_move(reached_), *cutter, stock_.cell_mm());
    }
  }
  stage_.take({});  // hands over what it has collected
  if (reached_ < track_.size() || complete_) return;
  stage_.finish(scope_.whole);
  complete_ = true;
}

}  // namespace kerf
