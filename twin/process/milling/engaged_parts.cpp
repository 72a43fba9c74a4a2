#include "twin/process/milling/engaged_parts.h"

#include <algorithm>
#include <span>

namespace kerf {
namespace {

/// A longer way in material removes some cells.
constexpr double kLeastRemoving_cells = 4;
/// What a move removes from material that is there is thicker: the cross-section of a skin that
/// rounding leaves.
constexpr double kSkin_mm2 = 1e-3;
constexpr std::size_t kPartsTaken = 4096;

}  // namespace

void EngagedParts::hear(const CutLoads::Part& part) {
  ++heard_;
  queue_.push_back({part});
}

void EngagedParts::forget() {
  queue_.clear();
  begin_ = doubtful_ = heard_ = 0;
  doubtful_mm_ = 0;
}

void EngagedParts::take_as_air(Heard& heard) {
  if (log_ != nullptr) log_->take_back_cut(heard.pass, heard.part.look, heard.part.way);
  heard.part.look = {};
  tell(heard);
  loads_.take(heard.part, listener_);
}

void EngagedParts::tell(const Heard& heard) const {
  if (recorder_ != nullptr) recorder_->on_engaged(heard.motion, heard.part.look, heard.part.way);
}

/// `motion`: of the move that has been judged.
void EngagedParts::tell_until(std::uint64_t motion) const {
  if (recorder_ != nullptr)
    recorder_->on_engaged_until(doubtful_ > 0 ? queue_[begin_].motion : motion);
}

void EngagedParts::settle_first(bool cuts) {
  Heard& first = queue_[begin_];
  doubtful_mm_ -= first.part.way.length_mm;
  if (cuts) {
    tell(first);
    loads_.take(first.part, listener_);
  } else {
    take_as_air(first);
  }
  ++begin_;
  --doubtful_;
}

/// What waits, but for the last `within_mm` of it, is in the air.
void EngagedParts::settle(double within_mm) {
  while (doubtful_ > 0) {
    const double middle_mm = 0.5 * queue_[begin_].part.way.length_mm;
    settle_first(doubtful_mm_ - middle_mm <= within_mm);
  }
  doubtful_mm_ = 0;
  take_out();
}

/// Some moves are always on their way: those that have arrived are let go of in numbers.
void EngagedParts::take_out() {
  if (begin_ < std::min(kPartsTaken, queue_.size())) return;
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
}

void EngagedParts::judge(const Done& move) {
  if (move.parts > 0) judge_parts(move);
  tell_until(move.motion);
}

void EngagedParts::judge_parts(const Done& move) {
  const std::span<Heard> parts = std::span(queue_).subspan(begin_ + doubtful_, move.parts);
  const double least_mm = kLeastRemoving_cells * move.cell_mm;
  const bool removes = move.removed_mm3 > 0 || move.depth_mm > 0;
  bool is_seen = false;
  double way_mm = 0;
  for (Heard& heard : parts) {
    heard.pass = move.pass;
    heard.motion = move.motion;
    is_seen = is_seen || heard.part.look.is_engaged();
    way_mm += heard.part.way.length_mm;
  }
  if (move.may_wait && move.is_whole && parts.size() == 1 && is_seen && !removes) {
    ++doubtful_;
    doubtful_mm_ += way_mm;
    const double most_mm = std::max(move.reach_mm, least_mm);
    while (doubtful_ > 0 && doubtful_mm_ - queue_[begin_].part.way.length_mm >= most_mm)
      settle_first(false);
    take_out();
    return;
  }
  settle(removes || !move.is_whole ? std::max(move.front_mm, least_mm) : 0);
  const bool is_overlooked = move.is_whole && !is_seen && move.removed_mm3 > kSkin_mm2 * way_mm;
  for (std::size_t n = 0; n < move.parts; ++n) {
    Heard& heard = queue_[begin_++];
    CutLoads::Part& part = heard.part;
    if (is_overlooked) {
      loads_.take_unmeasured(part, listener_);
      if (log_ != nullptr) log_->take_back_air(part.way);
    } else if (move.is_whole && part.look.is_engaged() && !removes &&
               part.way.length_mm > least_mm) {
      take_as_air(heard);
    } else {
      tell(heard);
      if (move.is_whole && move.depth_mm > 0)
        part.look.deep_mm = std::min(part.look.deep_mm, move.depth_mm);
      loads_.take(part, listener_);
    }
  }
  take_out();
}

}  // namespace kerf
