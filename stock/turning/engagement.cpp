#include "stock/turning/engagement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::turning {
namespace {

bool is_film(std::span<const Point> ring) {
  std::uint64_t area2 = 0;
  double around = 0;
  const Point* before = &ring.back();
  for (const Point& p : ring) {
    area2 += static_cast<std::uint64_t>(area2_of(*before, p));
    around +=
        std::hypot(static_cast<double>(p.X - before->X), static_cast<double>(p.Y - before->Y));
    before = &p;
  }
  return std::abs(static_cast<double>(static_cast<std::int64_t>(area2))) <
         ConvexCut::kFilm * around;
}

/// A point as the tool sees it, in units.
struct Seen {
  double across = 0, along = 0;
};

/// Of the tool's front at its beginning, between or beside its corners.
double front_at(const GridPart::Lead& lead, double across) {
  const auto after = std::upper_bound(lead.across.begin(), lead.across.end(), across);
  if (after == lead.across.begin()) return lead.along.front();
  if (after == lead.across.end()) return lead.along.back();
  const auto i = static_cast<std::size_t>(after - lead.across.begin());
  const double share = (across - lead.across[i - 1]) / (lead.across[i] - lead.across[i - 1]);
  return lead.along[i - 1] + share * (lead.along[i] - lead.along[i - 1]);
}

/// The least way from the front to the material along an edge: at its ends or before a corner of
/// the front, which bulges.
double way_to(const GridPart::Lead& lead, const Seen& a, const Seen& b) {
  const Seen &low = a.across < b.across ? a : b, &high = a.across < b.across ? b : a;
  double least =
      std::min(low.along - front_at(lead, low.across), high.along - front_at(lead, high.across));
  auto corner = std::upper_bound(lead.across.begin(), lead.across.end(), low.across);
  for (; corner != lead.across.end() && *corner < high.across; ++corner) {
    const double share = (*corner - low.across) / (high.across - low.across);
    const double along = low.along + share * (high.along - low.along);
    const auto i = static_cast<std::size_t>(corner - lead.across.begin());
    least = std::min(least, along - lead.along[i]);
  }
  return least;
}

}  // namespace

void Engagement::extend(const Engagement& other) {
  if (!other.any) return;
  if (!any) first = other.first;
  any = true;
  across_mm = std::max(across_mm, other.across_mm);
  depth_mm = std::max(depth_mm, other.depth_mm);
  for (std::size_t i = 0; i < side_mm.size(); ++i)
    side_mm[i] = std::max(side_mm[i], other.side_mm[i]);
}

Engagement engagement_of(const ConvexCut& cut, const GridPart::Lead& lead, const Point& way) {
  Engagement engagement;
  const double length = std::hypot(static_cast<double>(way.X), static_cast<double>(way.Y));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cut.removed_count(); ++i) {
    const std::span<const Point> ring = cut.removed(i);
    if (is_film(ring)) continue;
    engagement.any = true;
    if (length == 0) continue;
    const Vec2 ahead(static_cast<double>(way.X) / length, static_cast<double>(way.Y) / length);
    const auto see = [&](const Point& p) {
      const auto z = static_cast<double>(p.X), r = static_cast<double>(p.Y);
      return Seen{ahead.x * r - ahead.y * z, ahead.x * z + ahead.y * r};
    };
    Seen before = see(ring.back()), low = before, high = before;
    for (const Point& p : ring) {
      const Seen at = see(p);
      least = std::min(least, way_to(lead, before, at));
      low = {std::min(low.across, at.across), std::min(low.along, at.along)};
      high = {std::max(high.across, at.across), std::max(high.along, at.along)};
      before = at;
    }
    const double across_mm = (high.across - low.across) / kUnitsPerMm;
    const double along_mm = (high.along - low.along) / kUnitsPerMm;
    engagement.across_mm = std::max(engagement.across_mm, across_mm);
    engagement.depth_mm = std::max(engagement.depth_mm, std::min(across_mm, along_mm));
    std::array<double, kInsertSides> sides{};
    for (std::size_t k = 0; k < lead.sides.size(); ++k) {
      const double met =
          std::min(high.across, lead.across[k + 1]) - std::max(low.across, lead.across[k]);
      if (met > 0) sides[static_cast<std::size_t>(lead.sides[k])] += met / kUnitsPerMm;
    }
    for (std::size_t k = 0; k < sides.size(); ++k)
      engagement.side_mm[k] = std::max(engagement.side_mm[k], sides[k]);
  }
  if (length > 0 && engagement.any) engagement.first = std::clamp(least / length, 0.0, 1.0);
  return engagement;
}

}  // namespace kerf::turning
