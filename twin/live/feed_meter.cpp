#include "twin/live/feed_meter.h"

#include <glm/geometric.hpp>

namespace kerf {

void FeedMeter::take(double t_s, const Vec3& at_mm) {
  if (!places_.empty()) {
    const double since_s = t_s - places_.back().t_s;
    if (since_s < 0.0 || since_s > kLongestGap_s) forget();
  }
  // The newest one stands for its neighbours until it is far enough from the one before.
  const std::size_t count = places_.size();
  if (count >= 2 && places_[count - 1].t_s - places_[count - 2].t_s < kApart_s) places_.pop_back();
  places_.push_back({t_s, at_mm});
  // One place remains that is as old as the window, so that all of it counts.
  while (places_.size() > 2 && places_[1].t_s <= t_s - kWindow_s) places_.pop_front();
}

std::optional<double> FeedMeter::mm_per_min() const {
  if (places_.size() < 2) return std::nullopt;
  const double lasted_s = places_.back().t_s - places_.front().t_s;
  if (lasted_s < 0.25 * kWindow_s) return std::nullopt;
  double way_mm = 0.0;
  for (std::size_t i = 1; i < places_.size(); ++i) {
    way_mm += glm::distance(places_[i - 1].at_mm, places_[i].at_mm);
  }
  return 60.0 * way_mm / lasted_s;
}

}  // namespace kerf
