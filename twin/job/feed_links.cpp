#include "twin/job/feed_links.h"

#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

bool moves_in_xy(const Motion& m) {
  return m.from_mm.x != m.to_mm.x || m.from_mm.y != m.to_mm.y || m.kind == MotionKind::kArc;
}

}  // namespace

bool FeedLinks::keeps_back(const Motion& m) {
  return m.start_known && lift_mm_ >= kLeastLift_mm && m.kind == MotionKind::kFeed &&
         m.from_mm.z == m.to_mm.z && moves_in_xy(m);
}

void FeedLinks::add_level(const Motion& m, double length_mm, const Box& way) {
  is_kept_ = true;
  z_mm_ = m.to_mm.z;
  level_.length_mm += length_mm;
  level_.way.extend(way);
}

std::optional<FeedLinks::Ended> FeedLinks::end_before(const Motion& m) {
  std::optional<Ended> ended = kept_back();
  if (ended)
    ended->is_link = m.start_known && !moves_in_xy(m) && m.from_mm.z - m.to_mm.z >= kLeastLift_mm;
  const double rise = m.to_mm.z - m.from_mm.z;
  const bool lifts = m.start_known && !moves_in_xy(m) && rise > 0;
  lift_mm_ = lifts ? (ended ? 0 : lift_mm_) + rise : 0;
  is_kept_ = false;
  level_ = {};
  return ended;
}

std::optional<FeedLinks::Ended> FeedLinks::kept_back() const {
  if (!is_kept_) return std::nullopt;
  return Ended{z_mm_, level_, true};
}

}  // namespace kerf
