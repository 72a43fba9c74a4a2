#include "twin/playback/load_record.h"

#include <algorithm>

namespace kerf {
namespace {

/// A load that is in the time of a motion for less than this part of its own time, and of the
/// motion's, ends where that one begins, or begins where it ends, but for rounding.
constexpr double kBeside = 0.01;

}  // namespace

void LoadRecord::find_motions(const CutLoad& load) {
  motions_.clear();
  const double end_s = load.start_s + load.seconds;
  // Mostly it is the motion of the load before, or one of the next.
  constexpr std::size_t kNear = 8;
  const auto is_past = [&](std::size_t i) { return track_->end_s(i) <= load.start_s; };
  std::size_t at = motion_;
  for (std::size_t n = 0; n < kNear && at < track_->size() && is_past(at); ++n) ++at;
  if (at >= track_->size() || is_past(at) || track_->start_s(at) > load.start_s)
    at = track_->place_at(load.start_s).motion;
  motion_ = at;
  for (; at < track_->size() && track_->start_s(at) < end_s; ++at) {
    const double from_s = std::max(load.start_s, track_->start_s(at));
    const double shared_s = std::min(end_s, track_->end_s(at)) - from_s;
    const double least_s =
        kBeside * std::min(load.seconds, track_->end_s(at) - track_->start_s(at));
    if (shared_s > least_s) motions_.push_back(at);
  }
}

void LoadRecord::on_load(const CutLoad& load) {
  if (!load.is_engaged || !load.is_measured) return;
  find_motions(load);
  const std::lock_guard lock(mutex_);
  curve_.on_load(load);
  for (std::size_t k = 0; k < kLoadKinds; ++k) {
    const double nominal = load.values[k].nominal;
    if (!(nominal > 0)) continue;
    std::vector<float>& values = of_motion_[k];
    if (values.empty()) values.resize(track_->size());
    for (const std::size_t motion : motions_)
      values[motion] = std::max(values[motion], static_cast<float>(nominal));
  }
}

void LoadRecord::restart() {
  const std::lock_guard lock(mutex_);
  curve_.restart();
  for (std::vector<float>& values : of_motion_) values.clear();
}

LoadCurve LoadRecord::curve() const {
  const std::lock_guard lock(mutex_);
  return curve_;
}

std::vector<float> LoadRecord::by_motion(LoadKind kind) const {
  const std::lock_guard lock(mutex_);
  return of_motion_[static_cast<std::size_t>(kind)];
}

}  // namespace kerf
