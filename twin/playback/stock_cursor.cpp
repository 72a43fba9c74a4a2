#include "twin/playback/stock_cursor.h"

#include <cassert>

#include "twin/motion/floating_tap.h"
#include "twin/playback/recording_stock.h"

namespace kerf {
namespace {

constexpr std::size_t kMotionsAtOnce = 1024;
constexpr double kCellsAtOnce = 2e6;
/// Keyframes are not thought of more often than this.
constexpr std::size_t kMotionsAnOffer = 256;
/// From the traverse to its R to its way out a tapping cycle has no more motions: a dwell, signals.
constexpr std::size_t kLongestTap = 16;

}  // namespace

StockCursor::StockCursor(const ProgramTrack& track, const MotionMoves& moves,
                         const CutRecord& record, KeyframeStore& store)
    : track_(track), motion_moves_(moves), record_(record), store_(store) {
  stock_ = store_.at_or_before(0)->stock->snapshot();
}

void StockCursor::jump_near(std::size_t goal) {
  const Keyframe* frame = store_.at_or_before(goal);
  assert(frame);
  if (motion_ <= goal && frame->motion <= motion_) return;
  if (!near_ || near_motion_ != frame->motion) {
    near_ = frame->stock->snapshot();
    near_motion_ = frame->motion;
  }
  stock_ = near_->snapshot();
  motion_ = offered_ = frame->motion;
}

void StockCursor::offer_keyframe() {
  if (motion_ < offered_ + kMotionsAnOffer || !record_.breaks(motion_)) return;
  offered_ = motion_;
  const double cost_s = record_.cost_s(motion_);
  if (store_.wants(motion_, cost_s)) store_.add(motion_, cost_s, stock_->snapshot());
}

bool StockCursor::approach(std::size_t goal) {
  if (goal != goal_ || motion_ > goal) jump_near(goal);
  goal_ = goal;
  const std::size_t first = motion_;
  double cells = 0;
  moves_.clear();
  std::shared_ptr<const Cutter> cutter;
  const auto cut = [&] {
    if (!moves_.empty()) stock_->cut(*cutter, moves_, reports_);
    moves_.clear();
  };
  while (motion_ < goal && motion_ - first < kMotionsAtOnce && cells < kCellsAtOnce) {
    if (record_.breaks(motion_) && motion_ >= offered_ + kMotionsAnOffer) {
      cut();
      offer_keyframe();
    }
    const std::size_t motion = motion_++;
    if (!record_.cuts(motion)) continue;
    if (!cutter || record_.mounts(motion)) {
      cut();
      cutter = record_.cutter(motion);
    }
    const std::size_t first_move = moves_.size();
    track_.append_moves(motion, motion_moves_, *cutter, moves_);
    lead_taps(motion, *cutter, std::span(moves_).subspan(first_move));
    for (const CutMove& move : std::span(moves_).subspan(first_move)) {
      cells += cells_under(move, *cutter, stock_->cell_mm());
    }
    if (!record_.finishes(motion)) continue;
    cut();
    stock_->finish(reports_);
  }
  cut();
  reports_.clear();
  return motion_ == goal;
}

/// What a lathe's process makes of G84 and G74.
void StockCursor::lead_taps(std::size_t motion, const Cutter& cutter,
                            std::span<CutMove> moves) const {
  if (stock_->turned() == nullptr || cutter.insert() || cutter.live()) return;
  std::size_t first = motion;
  while (first > 0 && motion - first < kLongestTap && !track_.is_traverse(first)) --first;
  FloatingTap tap;
  double lead_mm = 0;
  for (std::size_t n = first; n <= motion; ++n) lead_mm = tap.lead_mm(track_.motion(n));
  if (lead_mm == 0) return;
  for (CutMove& move : moves) move.lead_mm = lead_mm;
}

std::unique_ptr<StockModel> StockCursor::picture(double fraction) const {
  std::unique_ptr<StockModel> copy = stock_->snapshot();
  if (fraction <= 0 || motion_ >= track_.size() || !record_.cuts(motion_)) return copy;
  const std::shared_ptr<const Cutter> cutter = record_.cutter(motion_);
  std::vector<CutMove> part;
  track_.append_part(motion_, fraction, motion_moves_, *cutter, part);
  lead_taps(motion_, *cutter, part);
  std::vector<CutReport> reports;
  copy->cut(*cutter, part, reports);
  copy->finish(reports);
  return copy;
}

}  // namespace kerf
