#include "stock/turning/engagement.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace kerf::turning {
namespace {

/// Places are told apart to a 64th of a unit: so slopes stay where doubles add up.
double place_of(double value) { return std::nearbyint(value * 64) / 64; }

/// Of the tool's front at its beginning, between or beside its corners.
double front_at(const GridPart::Lead& lead, double across) {
  const auto after = std::upper_bound(lead.across.begin(), lead.across.end(), across);
  if (after == lead.across.begin()) return lead.along.front();
  if (after == lead.across.end()) return lead.along.back();
  const auto i = static_cast<std::size_t>(after - lead.across.begin());
  const double share = (across - lead.across[i - 1]) / (lead.across[i] - lead.across[i - 1]);
  return lead.along[i - 1] + share * (lead.along[i] - lead.along[i - 1]);
}

/// Thinner on the average than what two traces of a nose that stands at one place leave of each
/// other: each is a chain of chords. They are within kArcBound_mm of the arc, but beside the corner
/// that a way has moved along it (GridPart::touch), where a chord is half as long again, and there
/// is 0.3 um between them. Such shreds are long beside their thickness, and where a tool leaves
/// along them they would be as deep as they are long.
bool is_trace(std::span<const Point> ring) {
  constexpr double kTraces = 4 * kArcBound_mm * kUnitsPerMm;
  double around = 0;
  Point last = ring.back();
  for (const Point& p : ring) {
    around += portable::hypot(static_cast<double>(p.X - last.X), static_cast<double>(p.Y - last.Y));
    last = p;
  }
  return static_cast<double>(twice_area(ring)) < kTraces * around;
}

}  // namespace

void Engagement::join(const Engagement& other) {
  if (!other.any) return;
  first = any ? std::min(first, other.first) : other.first;
  any = true;
  across_mm = std::max(across_mm, other.across_mm);
  way_mm = std::max(way_mm, other.way_mm);
  for (std::size_t i = 0; i < side_mm.size(); ++i)
    side_mm[i] = std::max(side_mm[i], other.side_mm[i]);
  if (other.edge_mm > edge_mm) edge_mm = other.edge_mm, edge_across_mm = other.edge_across_mm;
}

void Engagement::extend(const Engagement& other) {
  const double before_mm = way_mm;
  const bool was_any = any;
  const double was_first = first;
  join(other);
  const auto of = [&](InsertSide side) { return other.side_mm[static_cast<std::size_t>(side)]; };
  const double both_mm = std::min(of(InsertSide::kFront), of(InsertSide::kBack));
  flanks_mm = std::max(flanks_mm, both_mm);
  way_mm = before_mm + other.way_mm;
  if (was_any) first = was_first;
}

void Sections::add_edge(double from, double from_height, double to, double to_height) {
  if (from == to) return;
  const double slope = (to_height - from_height) / (to - from);
  if (from < to) {  // along the lower side
    events_.push_back({from, -from_height, -slope});
    events_.push_back({to, to_height, slope});
  } else {
    events_.push_back({to, to_height, slope});
    events_.push_back({from, -from_height, -slope});
  }
}

void Sections::finish() {
  std::sort(events_.begin(), events_.end(),
            [](const Event& a, const Event& b) { return a.place < b.place; });
  pieces_.clear();
  Piece piece;
  for (std::size_t i = 0; i < events_.size();) {
    const double place = events_[i].place, width = pieces_.empty() ? 0 : place - piece.place;
    piece.area += width * (piece.height + piece.slope * width / 2);
    piece.height += piece.slope * width;
    piece.place = place;
    for (; i < events_.size() && events_[i].place == place; ++i) {
      piece.height += events_[i].jump;
      piece.slope += events_[i].slope;
    }
    pieces_.push_back(piece);
  }
}

void Sections::spans_above(double least, double shortest, std::vector<Span>& spans) const {
  spans.clear();
  const auto add = [&](double low, double high) {
    if (high <= low) return;
    if (!spans.empty() && spans.back().high == low) {
      spans.back().high = high;
    } else {
      if (!spans.empty() && spans.back().high - spans.back().low < shortest) spans.pop_back();
      spans.push_back({low, high});
    }
  };
  for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const double end = pieces_[i + 1].place;
    const double last = piece.height + piece.slope * (end - piece.place);
    const bool before = piece.height >= least, after = last >= least;
    if (!before && !after) continue;
    const double at = piece.place + (least - piece.height) / piece.slope;
    add(before ? piece.place : std::clamp(at, piece.place, end),
        after ? end : std::clamp(at, piece.place, end));
  }
  if (!spans.empty() && spans.back().high - spans.back().low < shortest) spans.pop_back();
}

double Sections::area_before(std::size_t piece, double place) const {
  const Piece& p = pieces_[piece];
  const double width = place - p.place;
  return p.area + width * (p.height + p.slope * width / 2);
}

double Sections::greatest_mean(double window) const {
  if (pieces_.empty()) return 0;
  const double first = pieces_.front().place, last = pieces_.back().place;
  if (last - first <= window) return pieces_.back().area / std::max(last - first, 1.0);
  // Windows that begin or end where the chain turns.
  double greatest = 0;
  for (std::size_t begin = 0, end = 0; begin < pieces_.size(); ++begin) {
    const double to = std::min(pieces_[begin].place + window, last);
    while (end + 1 < pieces_.size() && pieces_[end + 1].place <= to) ++end;
    greatest = std::max(greatest, area_before(end, to) - pieces_[begin].area);
  }
  for (std::size_t begin = 0, end = 0; end < pieces_.size(); ++end) {
    const double from = std::max(pieces_[end].place - window, first);
    while (begin + 1 < pieces_.size() && pieces_[begin + 1].place <= from) ++begin;
    greatest = std::max(greatest, pieces_[end].area - area_before(begin, from));
  }
  return greatest / window;
}

Engagement EngagementGauge::measure(const ConvexCut& cut, const GridPart::Lead& lead,
                                    const Point& way) {
  Engagement engagement;
  const double length = portable::hypot(static_cast<double>(way.X), static_cast<double>(way.Y));
  if (length == 0) {
    for (std::size_t i = 0; i < cut.removed_count(); ++i) {
      constexpr double kLeast = 2 * ConvexCut::kFilm * ConvexCut::kFilm;
      engagement.any = engagement.any || static_cast<double>(twice_area(cut.removed(i))) > kLeast;
    }
    return engagement;
  }
  ahead_.clear();
  across_.clear();
  for (std::size_t i = 0; i < cut.removed_count(); ++i) {
    if (is_trace(cut.removed(i))) continue;
    add_piece(cut.removed(i), lead,
              Vec2(static_cast<double>(way.X), static_cast<double>(way.Y)) / length);
  }
  ahead_.finish();
  ahead_.spans_above(ConvexCut::kFilm, ConvexCut::kFilm, spans_);
  if (spans_.empty()) return engagement;
  engagement.any = true;
  engagement.first = std::clamp(spans_.front().low / length, 0.0, 1.0);
  for (const Sections::Span& span : spans_)
    engagement.way_mm += (span.high - span.low) / kUnitsPerMm;
  engagement.across_mm = ahead_.greatest_mean(kSteady) / kUnitsPerMm;
  across_.finish();
  across_.spans_above(ConvexCut::kFilm, ConvexCut::kFilm, spans_);
  for (const Sections::Span& span : spans_) {
    for (std::size_t k = 0; k < lead.sides.size(); ++k) {
      const double met =
          std::min(span.high, lead.across[k + 1]) - std::max(span.low, lead.across[k]);
      if (met <= 0) continue;
      engagement.side_mm[static_cast<std::size_t>(lead.sides[k])] += met / kUnitsPerMm;
      const double slope =
          (lead.along[k + 1] - lead.along[k]) / (lead.across[k + 1] - lead.across[k]);
      engagement.edge_across_mm += met / kUnitsPerMm;
      engagement.edge_mm += met / kUnitsPerMm * portable::hypot(1.0, slope);
    }
  }
  return engagement;
}

/// Its edges are straight as the tool sees them between corners of the front.
void EngagementGauge::add_piece(std::span<const Point> ring, const GridPart::Lead& lead,
                                const Vec2& way) {
  /// In units: across the way and along it, and how far the front is to go until it is there.
  struct Seen {
    double across = 0, along = 0, ahead = 0;
  };
  const auto see = [&](const Point& p) {
    const auto z = static_cast<double>(p.X), r = static_cast<double>(p.Y);
    const double across = place_of(way.x * r - way.y * z), along = way.x * z + way.y * r;
    return Seen{across, along, place_of(along - front_at(lead, across))};
  };
  Seen corner = see(ring.back()), from = corner;
  const auto add = [&](const Seen& next) {
    // Counter-clockwise is seen clockwise by way of (ahead, across), as it is by (along, across).
    ahead_.add_edge(corner.ahead, corner.across, next.ahead, next.across);
    across_.add_edge(next.across, next.ahead, corner.across, corner.ahead);
    corner = next;
  };
  for (const Point& p : ring) {
    const Seen to = see(p);
    const auto first =
        std::upper_bound(lead.across.begin(), lead.across.end(), std::min(from.across, to.across));
    const auto last = std::lower_bound(first, lead.across.end(), std::max(from.across, to.across));
    const auto begin = static_cast<std::size_t>(first - lead.across.begin()),
               end = static_cast<std::size_t>(last - lead.across.begin());
    const auto add_before = [&](std::size_t i) {
      const double across = place_of(lead.across[i]);
      const double share = (lead.across[i] - from.across) / (to.across - from.across);
      const double along = from.along + share * (to.along - from.along);
      add({across, along, place_of(along - lead.along[i])});
    };
    if (from.across < to.across) {
      for (std::size_t i = begin; i < end; ++i) add_before(i);
    } else {
      for (std::size_t i = end; i-- > begin;) add_before(i);
    }
    add(to);
    from = to;
  }
}

}  // namespace kerf::turning
