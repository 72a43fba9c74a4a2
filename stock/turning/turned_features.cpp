#include "stock/turning/turned_features.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/portable_math.h"
#include "stock/turning/contour_arcs.h"

namespace kerf {
namespace {

using turning::ContourPiece;
using turning::CurvedContour;
using Kind = TurnedFeature::Kind;

double length_of(const ContourPiece& piece) {
  if (piece.arc) return piece.arc->radius_mm * std::abs(piece.arc->sweep_rad);
  return glm::distance(piece.from_mm, piece.to_mm);
}

/// Out of the material, which lies to the left, in the middle of the piece.
Vec2 outward_of(const ContourPiece& piece) {
  if (!piece.arc) {
    const Vec2 way = piece.to_mm - piece.from_mm;
    return {way.y, -way.x};
  }
  const Vec2 arm = piece.from_mm - piece.arc->center_mm;
  const double angle = portable::atan2(arm.y, arm.x) + piece.arc->sweep_rad / 2;
  return (piece.arc->sweep_rad > 0 ? 1.0 : -1.0) * Vec2(portable::cos(angle), portable::sin(angle));
}

bool is_on_axis(const ContourPiece& piece) {
  return !piece.arc && piece.from_mm.y == 0 && piece.to_mm.y == 0;
}

/// Whether a place of the circle lies on the arc.
bool sweeps(const ContourPiece& piece, double angle_rad) {
  const Vec2 arm = piece.from_mm - piece.arc->center_mm;
  const double sense = piece.arc->sweep_rad > 0 ? 1 : -1;
  double along = std::fmod(sense * (angle_rad - portable::atan2(arm.y, arm.x)), 2 * kPi);
  if (along < 0) along += 2 * kPi;
  return along <= std::abs(piece.arc->sweep_rad);
}

/// Least and greatest z and r.
std::pair<Vec2, Vec2> extent_of(const ContourPiece& piece) {
  Vec2 low = glm::min(piece.from_mm, piece.to_mm), high = glm::max(piece.from_mm, piece.to_mm);
  if (!piece.arc) return {low, high};
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double angle = quarter * kPi / 2;
    if (!sweeps(piece, angle)) continue;
    const Vec2 at = piece.arc->center_mm +
                    piece.arc->radius_mm * Vec2(portable::cos(angle), portable::sin(angle));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  return {low, high};
}

TurnedFeature surface_of(const ContourPiece& piece) {
  TurnedFeature f;
  const auto [low, high] = extent_of(piece);
  f.low_z_mm = low.x;
  f.high_z_mm = high.x;
  f.low_d_mm = 2 * low.y;
  f.high_d_mm = 2 * high.y;
  f.is_inside = outward_of(piece).y < 0;
  if (piece.arc) {
    f.kind = Kind::kRadius;
    f.radius_mm = piece.arc->radius_mm;
    f.is_hollow = piece.arc->sweep_rad < 0;
  } else if (high.y - low.y <= kSameFeature_mm) {
    f.kind = Kind::kCylinder;
    f.low_d_mm = f.high_d_mm = piece.from_mm.y + piece.to_mm.y;
  } else if (high.x - low.x <= kSameFeature_mm) {
    f.kind = Kind::kFace;
    f.low_z_mm = f.high_z_mm = (piece.from_mm.x + piece.to_mm.x) / 2;
    f.is_inside = false;
  } else {
    f.kind = Kind::kTaper;
    f.angle_deg = portable::atan((high.y - low.y) / (high.x - low.x)) * 180 / kPi;
  }
  return f;
}

/// Whether b goes on where a ends with the same surface.
bool goes_on(const TurnedFeature& a, const TurnedFeature& b) {
  const auto same = [](double x, double y) { return std::abs(x - y) <= 2 * kSameFeature_mm; };
  if (a.kind != b.kind || a.is_inside != b.is_inside) return false;
  if (a.kind == Kind::kCylinder) return same(a.low_d_mm, b.low_d_mm);
  if (a.kind == Kind::kFace) return same(a.low_z_mm, b.low_z_mm);
  return false;
}

void extend(TurnedFeature& a, const TurnedFeature& b) {
  if (a.kind == Kind::kCylinder) {
    a.low_z_mm = std::min(a.low_z_mm, b.low_z_mm);
    a.high_z_mm = std::max(a.high_z_mm, b.high_z_mm);
  } else {
    a.low_d_mm = std::min(a.low_d_mm, b.low_d_mm);
    a.high_d_mm = std::max(a.high_d_mm, b.high_d_mm);
  }
}

/// Pieces of a contour that count, each contour by itself, from a place where a surface begins.
CurvedContour counted(CurvedContour contour) {
  std::erase_if(contour,
                [](const ContourPiece& piece) { return length_of(piece) < kLeastFeature_mm; });
  const auto axis = std::find_if(contour.begin(), contour.end(), is_on_axis);
  if (axis != contour.end()) std::rotate(contour.begin(), axis, contour.end());
  return contour;
}

/// Grooves of a contour: stretches of it as heights above their floor, which outside is the least
/// radius and inside the greatest.
class GrooveFinder {
 public:
  explicit GrooveFinder(const CurvedContour& contour) : contour_(contour) {}

  void append_to(std::vector<TurnedFeature>& features) const {
    for (std::size_t i = 0; i < contour_.size(); ++i) {
      if (const std::optional<TurnedFeature> groove = groove_at(i)) features.push_back(*groove);
    }
  }

 private:
  /// A way up a wall, from the floor on; places (z, height).
  using Wall = std::vector<Vec2>;

  const ContourPiece& piece(std::size_t i) const { return contour_[i % contour_.size()]; }

  /// A floor is a cylinder, or a hollow arc through its lowest place.
  std::optional<TurnedFeature> groove_at(std::size_t i) const {
    const ContourPiece& floor = piece(i);
    if (is_on_axis(floor)) return std::nullopt;
    const TurnedFeature surface = surface_of(floor);
    const double sign = surface.is_inside ? -1 : 1;
    double floor_r = (surface.is_inside ? surface.high_d_mm : surface.low_d_mm) / 2;
    if (surface.kind == Kind::kRadius) {
      if (!surface.is_hollow || !sweeps(floor, -sign * kPi / 2)) return std::nullopt;
    } else if (surface.kind != Kind::kCylinder) {
      return std::nullopt;
    }
    const Wall before = wall(i, -1, sign, floor_r), after = wall(i, 1, sign, floor_r);
    const double rim = std::min(before.back().y, after.back().y);
    if (rim <= kLeastFeature_mm) return std::nullopt;
    const double a = place_at(before, rim), b = place_at(after, rim);
    TurnedFeature groove;
    groove.kind = Kind::kGroove;
    groove.is_inside = surface.is_inside;
    groove.low_z_mm = std::min(a, b);
    groove.high_z_mm = std::max(a, b);
    const double rim_r = floor_r + sign * rim;
    groove.low_d_mm = 2 * std::min(floor_r, rim_r);
    groove.high_d_mm = 2 * std::max(floor_r, rim_r);
    return groove;
  }

  /// As far as it rises and does not come back over the groove.
  Wall wall(std::size_t floor, int direction, double sign, double floor_r) const {
    const auto height = [&](const Vec2& p) { return sign * (p.y - floor_r); };
    const ContourPiece& begin = piece(floor);
    const Vec2 start = direction > 0 ? begin.to_mm : begin.from_mm;
    // Outside the contour runs to lower z, inside to higher.
    const double outward_z = -sign * direction;
    Wall wall{{start.x, std::max(height(start), 0.0)}};
    for (std::size_t k = 1; k < contour_.size(); ++k) {
      const std::size_t n = contour_.size();
      const ContourPiece& next = piece(direction > 0 ? floor + k : floor + n - k);
      const Vec2 to = direction > 0 ? next.to_mm : next.from_mm;
      const Vec2 last = wall.back();
      if (is_on_axis(next) || height(to) <= last.y + kSameFeature_mm) break;
      if ((to.x - last.x) * outward_z < -kSameFeature_mm) break;
      wall.push_back({to.x, height(to)});
    }
    return wall;
  }

  static double place_at(const Wall& wall, double height) {
    for (std::size_t i = 1; i < wall.size(); ++i) {
      if (wall[i].y < height) continue;
      const double share = (height - wall[i - 1].y) / (wall[i].y - wall[i - 1].y);
      return wall[i - 1].x + share * (wall[i].x - wall[i - 1].x);
    }
    return wall.back().x;
  }

  const CurvedContour& contour_;
};

}  // namespace

std::vector<TurnedFeature> features_of(const TurnedPart& part) {
  std::vector<TurnedFeature> features;
  for (const turning::Contour& ring : part.contours()) {
    const CurvedContour contour = counted(turning::with_arcs(ring));
    const std::size_t first = features.size();
    for (const ContourPiece& piece : contour) {
      if (is_on_axis(piece)) continue;
      const TurnedFeature surface = surface_of(piece);
      if (features.size() > first && goes_on(features.back(), surface)) {
        extend(features.back(), surface);
      } else {
        features.push_back(surface);
      }
    }
    GrooveFinder(contour).append_to(features);
  }
  std::stable_sort(features.begin(), features.end(),
                   [](const TurnedFeature& a, const TurnedFeature& b) {
                     return a.low_z_mm + a.high_z_mm > b.low_z_mm + b.high_z_mm;
                   });
  return features;
}

}  // namespace kerf
