#include "twin/collision/convex.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kerf {
namespace {

constexpr int kMostSteps = 200;
/// Nearer than this is no distance: doubles of machine coordinates.
constexpr double kTouching_mm = 1e-7;
constexpr double kThinnest_mm = 1e-3;
constexpr double kAlongAxis = 1e-9;

Vec3 support_of(std::span<const RoundedDisc> discs, const Vec3& origin, const Vec3& axis,
                const Vec3& d) {
  const double along = glm::dot(d, axis);
  const Vec3 across = d - along * axis;
  const double length = glm::length(d);
  // What is left of a direction along the axis is rounding, and points anywhere.
  double across_length = glm::length(across);
  if (across_length < kAlongAxis * length) across_length = 0;
  const RoundedDisc* best = discs.data();
  double most = -std::numeric_limits<double>::infinity();
  for (const RoundedDisc& disc : discs) {
    const double reach =
        disc.radius_mm * across_length + disc.along_mm * along + disc.round_mm * length;
    if (reach <= most) continue;
    most = reach;
    best = &disc;
  }
  Vec3 point = origin + best->along_mm * axis;
  if (across_length > 0) point += (best->radius_mm / across_length) * across;
  if (length > 0) point += (best->round_mm / length) * d;
  return point;
}

/// A simplex of up to four points, and of it the point nearest to the origin.
class Simplex {
 public:
  void add(const Vec3& p) { points_[count_++] = p; }
  int size() const { return count_; }
  bool holds(const Vec3& p) const {
    for (int i = 0; i < count_; ++i)
      if (points_[i] == p) return true;
    return false;
  }
  /// Drops the points that are not needed for it. False: the origin is inside.
  /// `apart`: that is known not to be so.
  bool reduce(Vec3& nearest, bool apart) {
    switch (count_) {
      case 1:
        nearest = points_[0];
        return true;
      case 2:
        nearest = on_segment(0, 1);
        return true;
      case 3:
        nearest = on_triangle(0, 1, 2);
        return true;
      default:
        return on_tetrahedron(nearest, apart);
    }
  }

 private:
  void keep(std::initializer_list<int> which) {
    std::array<Vec3, 4> kept;
    int n = 0;
    for (const int i : which) kept[n++] = points_[i];
    points_ = kept;
    count_ = n;
  }

  Vec3 on_segment(int i, int j) {
    const Vec3 a = points_[i], ab = points_[j] - a;
    const double length2 = glm::dot(ab, ab);
    const double t = length2 > 0 ? -glm::dot(a, ab) / length2 : 0;
    if (t <= 0) {
      keep({i});
      return a;
    }
    if (t >= 1) {
      const Vec3 b = points_[j];
      keep({j});
      return b;
    }
    keep({i, j});
    return a + t * ab;
  }

  /// By the regions of the plane that belong to its corners, sides and inside.
  Vec3 on_triangle(int i, int j, int k) {
    const Vec3 a = points_[i], b = points_[j], c = points_[k];
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0) {
      keep({i});
      return a;
    }
    const double d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3) {
      keep({j});
      return b;
    }
    const double d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6) {
      keep({k});
      return c;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return on_segment(i, j);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return on_segment(i, k);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return on_segment(j, k);
    const Vec3 normal = glm::cross(ab, ac);
    const double area2 = glm::dot(normal, normal);
    keep({i, j, k});
    return area2 > 0 ? normal * (glm::dot(a, normal) / area2) : a;
  }

  bool on_tetrahedron(Vec3& nearest, bool apart) {
    if (search_tetrahedron(nearest, false)) return true;
    return apart && search_tetrahedron(nearest, true);
  }

  /// `all`: of faces that the origin seems to be behind, too, as it does of flat ones.
  bool search_tetrahedron(Vec3& nearest, bool all) {
    const std::array<Vec3, 4> p = points_;
    static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    double least = std::numeric_limits<double>::infinity();
    Simplex best;
    bool outside = false;
    for (const auto& face : kFaces) {
      const Vec3 &a = p[face[0]], &b = p[face[1]], &c = p[face[2]];
      const Vec3 normal = glm::cross(b - a, c - a);
      const double of_fourth = glm::dot(p[face[3]] - a, normal);
      const double of_origin = -glm::dot(a, normal);
      // Flat: each face counts.
      const double size2 = glm::dot(normal, normal);
      const bool flat =
          of_fourth * of_fourth <= 1e-20 * size2 * glm::dot(p[face[3]] - a, p[face[3]] - a);
      if (!all && !flat && of_origin * of_fourth >= 0) continue;
      outside = true;
      Simplex side;
      side.points_ = {a, b, c, c};
      side.count_ = 3;
      const Vec3 on = side.on_triangle(0, 1, 2);
      const double distance2 = glm::dot(on, on);
      if (distance2 >= least) continue;
      least = distance2;
      nearest = on;
      best = side;
    }
    if (!outside) return false;
    *this = best;
    return true;
  }

  std::array<Vec3, 4> points_{};
  int count_ = 0;
};

}  // namespace

Vec3 Convex::support(const Vec3& direction) const {
  switch (kind) {
    case Convex::Kind::kRevolved:
      return support_of(discs, origin_mm, axis, direction);
    case Convex::Kind::kBox: {
      const Vec3 &low = corners[0], &high = corners[1];
      return {direction.x > 0 ? high.x : low.x, direction.y > 0 ? high.y : low.y,
              direction.z > 0 ? high.z : low.z};
    }
    case Convex::Kind::kHull:
      break;
  }
  const Vec3* best = corners.data();
  for (const Vec3& corner : corners)
    if (glm::dot(corner, direction) > glm::dot(*best, direction)) best = &corner;
  return *best;
}

ConvexSweep::ConvexSweep(const MovingConvex& moving)
    : moving_(moving), slides_(moving.from.rotation == moving.to.rotation) {
  const Convex& solid = moving.solid;
  if (solid.kind != Convex::Kind::kRevolved) return;
  from_ = {moving.from.point(solid.origin_mm), moving.from.direction(solid.axis)};
  to_ = {moving.to.point(solid.origin_mm), moving.to.direction(solid.axis)};
  slides_ = from_.along == to_.along;
}

Vec3 ConvexSweep::support(const Vec3& direction) const {
  const Vec3 first = support_at(moving_.from, from_, direction);
  if (slides_) {
    const Vec3 way = moving_.solid.kind == Convex::Kind::kRevolved
                         ? to_.origin_mm - from_.origin_mm
                         : moving_.to.origin_mm - moving_.from.origin_mm;
    return glm::dot(way, direction) > 0 ? first + way : first;
  }
  const Vec3 last = support_at(moving_.to, to_, direction);
  return glm::dot(last, direction) > glm::dot(first, direction) ? last : first;
}

Vec3 ConvexSweep::support_at(const Pose& pose, const Axis& axis, const Vec3& direction) const {
  if (moving_.solid.kind == Convex::Kind::kRevolved)
    return support_of(moving_.solid.discs, axis.origin_mm, axis.along, direction);
  return pose.point(moving_.solid.support(glm::transpose(pose.rotation) * direction));
}

Box Convex::box_mm() const {
  Box box;
  if (kind == Kind::kBox) return {corners[0], corners[1]};
  if (kind == Kind::kHull) {
    for (const Vec3& corner : corners) box.extend(corner);
    return box;
  }
  for (int axis_number = 0; axis_number < 3; ++axis_number) {
    Vec3 d{0};
    d[axis_number] = 1;
    box.max[axis_number] = support(d)[axis_number];
    box.min[axis_number] = support(-d)[axis_number];
  }
  return box;
}

Convex eroded(const Convex& solid, double depth_mm, std::vector<RoundedDisc>& discs,
              std::array<Vec3, 2>& corners) {
  Convex thin = solid;
  if (solid.kind == Convex::Kind::kBox) {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = (solid.corners[0][axis] + solid.corners[1][axis]) / 2;
      corners[0][axis] = std::min(solid.corners[0][axis] + depth_mm, middle - kThinnest_mm / 2);
      corners[1][axis] = std::max(solid.corners[1][axis] - depth_mm, middle + kThinnest_mm / 2);
    }
    thin.corners = corners;
  }
  if (solid.kind != Convex::Kind::kRevolved) return thin;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const RoundedDisc& disc : solid.discs) {
    low = std::min(low, disc.along_mm - disc.round_mm);
    high = std::max(high, disc.along_mm + disc.round_mm);
  }
  const double middle = (low + high) / 2;
  low = std::min(low + depth_mm, middle - kThinnest_mm / 2);
  high = std::max(high - depth_mm, middle + kThinnest_mm / 2);
  discs.assign(solid.discs.begin(), solid.discs.end());
  for (RoundedDisc& disc : discs) {
    const double round = std::min(disc.round_mm, depth_mm);
    disc.round_mm -= round;
    disc.radius_mm = std::max(disc.radius_mm - (depth_mm - round), 0.0);
    disc.along_mm = std::clamp(disc.along_mm, std::min(low + disc.round_mm, high),
                               std::max(high - disc.round_mm, low));
  }
  thin.discs = discs;
  return thin;
}

double half_thickness_mm(const Convex& solid) {
  if (solid.kind == Convex::Kind::kHull) return 0;
  if (solid.kind == Convex::Kind::kBox) {
    const Vec3 size = solid.corners[1] - solid.corners[0];
    return std::min({size.x, size.y, size.z}) / 2;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low, radius = 0;
  for (const RoundedDisc& disc : solid.discs) {
    low = std::min(low, disc.along_mm - disc.round_mm);
    high = std::max(high, disc.along_mm + disc.round_mm);
    radius = std::max(radius, disc.radius_mm + disc.round_mm);
  }
  return std::min(radius, (high - low) / 2);
}

ConvexGap gap_of(const ConvexSweep& moving, const Convex& still, double cutoff_mm, double exact_mm,
                 const Vec3& guess) {
  const auto support = [&](const Vec3& d) { return moving.support(-d) - still.support(d); };
  Vec3 v = guess;
  if (v == Vec3{0}) v = {0, 0, 1};
  ConvexGap gap;
  gap.high_mm = std::numeric_limits<double>::infinity();
  gap.direction = v;
  Simplex simplex;
  for (int step = 0; step < kMostSteps; ++step) {
    const double length = glm::length(v);
    const Vec3 w = support(v);
    // All of the difference lies beyond the plane across v through w.
    const double low = glm::dot(v, w) / length;
    if (low > gap.low_mm) {
      gap.low_mm = low;
      gap.direction = v;
    }
    if (gap.low_mm > cutoff_mm || gap.high_mm - gap.low_mm <= exact_mm) return gap;
    if (simplex.size() > 0 && simplex.holds(w)) break;
    simplex.add(w);
    if (!simplex.reduce(v, gap.low_mm > kTouching_mm)) return {0, 0, gap.direction};
    const double reached = glm::length(v);
    if (reached <= kTouching_mm) return {0, 0, gap.direction};
    // No nearer any more: as near as doubles get.
    if (simplex.size() > 1 && reached >= gap.high_mm) break;
    gap.high_mm = std::min(gap.high_mm, reached);
  }
  gap.low_mm = std::min(gap.low_mm, gap.high_mm);
  return gap;
}

}  // namespace kerf
