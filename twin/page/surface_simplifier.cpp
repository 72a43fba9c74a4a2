#include "twin/page/surface_simplifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry.h"

namespace kerf {
namespace {

/// Sum of the squared distances from planes, as a function of a point.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, xw = 0, yy = 0, yz = 0, yw = 0, zz = 0, zw = 0, ww = 0;

  void add_plane(const Vec3& n, double w) {
    xx += n.x * n.x, xy += n.x * n.y, xz += n.x * n.z, xw += n.x * w;
    yy += n.y * n.y, yz += n.y * n.z, yw += n.y * w;
    zz += n.z * n.z, zw += n.z * w;
    ww += w * w;
  }
  void add(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, xw += q.xw, yy += q.yy;
    yz += q.yz, yw += q.yw, zz += q.zz, zw += q.zw, ww += q.ww;
  }
  double at(const Vec3& p) const {
    return xx * p.x * p.x + yy * p.y * p.y + zz * p.z * p.z +
           2 * (xy * p.x * p.y + xz * p.x * p.z + yz * p.y * p.z) +
           2 * (xw * p.x + yw * p.y + zw * p.z) + ww;
  }
};

class Simplifier {
 public:
  Simplifier(PageSurface& surface, bool keeps_rim)
      : surface_(surface),
        places_(surface.corners.begin(), surface.corners.end()),
        quadrics_(surface.corners.size()),
        stays_(surface.corners.size(), 0),
        stamps_(surface.corners.size(), 0) {
    // Near the origin sums of squares keep their digits.
    Box box;
    for (const Vec3& place : places_) box.extend(place);
    const Vec3 middle = box.empty() ? Vec3{0} : (box.min + box.max) / 2.0;
    for (Vec3& place : places_) place -= middle;
    for (std::size_t t = 0; t < count(); ++t) {
      const std::array<std::uint32_t, 3> corners = corners_of(t);
      const Vec3 across = normal_of(corners);
      const double length = glm::length(across);
      if (length == 0) continue;
      const Vec3 normal = across / length;
      for (const std::uint32_t corner : corners)
        quadrics_[corner].add_plane(normal, -glm::dot(normal, places_[corners[0]]));
      hold_border(corners, normal);
    }
    index();
    if (keeps_rim) find_rim();
  }

  std::size_t count() const { return surface_.indices.size() / 3; }

  /// Draws together what it can, once over all edges; how many triangles went. `again`: as far as
  /// the pass before, so that only what has changed since may go now.
  std::size_t pass(double most_mm, std::size_t least_triangles, bool again) {
    const std::size_t before = count();
    std::size_t left = before;
    const double most2 = most_mm * most_mm;
    moved_.assign(places_.size(), 0);
    if (again)
      std::swap(changed_, looked_at_);
    else
      looked_at_.assign(places_.size(), 1);
    changed_.assign(places_.size(), 0);
    for (std::size_t t = 0; t < before && left > least_triangles; ++t) {
      for (std::size_t k = 0; k < 3 && !is_gone(t); ++k) {
        const std::uint32_t a = surface_.indices[3 * t + k],
                            b = surface_.indices[3 * t + (k + 1) % 3];
        // Its other triangle has the edge the other way round.
        if (a > b || moved_[a] || moved_[b] || !(looked_at_[a] | looked_at_[b])) continue;
        if (may_go(a, b, most2)) {
          left -= collapse(a, b);
        } else if (may_go(b, a, most2)) {
          left -= collapse(b, a);
        }
      }
    }
    compact();
    index();
    return before - count();
  }

 private:
  static constexpr std::uint32_t kGone = 0xffff'ffff;
  static constexpr double kBorder = 20;
  /// Least height of a triangle, in longest edges.
  static constexpr double kSliver = 1e-4;
  /// Cosine of the angle by which a triangle may turn at a time.
  static constexpr double kLeastCosine = 0.8;

  bool is_gone(std::size_t t) const { return surface_.indices[3 * t] == kGone; }
  std::array<std::uint32_t, 3> corners_of(std::size_t t) const {
    return {surface_.indices[3 * t], surface_.indices[3 * t + 1], surface_.indices[3 * t + 2]};
  }
  Vec3 normal_of(const std::array<std::uint32_t, 3>& c) const {
    return glm::cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]);
  }
  std::span<const std::uint32_t> around(std::uint32_t corner) const {
    return std::span(around_).subspan(first_[corner], first_[corner + 1] - first_[corner]);
  }

  /// Where groups meet there is an edge, as of a surface, that may move kBorder times as far.
  void hold_border(const std::array<std::uint32_t, 3>& corners, const Vec3& normal) {
    if (surface_.groups.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      if (surface_.groups[a] != surface_.groups[b] || surface_.groups[a] == surface_.groups[c])
        continue;
      const Vec3 across = glm::cross(places_[b] - places_[a], normal);
      const double length = glm::length(across);
      if (length == 0) continue;
      const Vec3 held = across / (length * kBorder);
      for (const std::uint32_t corner : {a, b})
        quadrics_[corner].add_plane(held, -glm::dot(held, places_[a]));
    }
  }

  /// Which triangles lie around each corner.
  void index() {
    first_.assign(places_.size() + 1, 0);
    for (const std::uint32_t corner : surface_.indices) ++first_[corner + 1];
    for (std::size_t i = 0; i < places_.size(); ++i) first_[i + 1] += first_[i];
    around_.resize(surface_.indices.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < surface_.indices.size(); ++i)
      around_[next[surface_.indices[i]]++] = static_cast<std::uint32_t>(i / 3);
  }

  void find_rim() {
    for (std::uint32_t a = 0; a < places_.size(); ++a) {
      for (const std::uint32_t t : around(a)) {
        for (const std::uint32_t b : corners_of(t)) {
          if (b == a) continue;
          const auto shared = std::ranges::count_if(around(a), [&](std::uint32_t other) {
            const auto corners = corners_of(other);
            return std::ranges::find(corners, b) != corners.end();
          });
          if (shared != 2) stays_[a] = stays_[b] = 1;
        }
      }
    }
  }

  bool may_go(std::uint32_t from, std::uint32_t to, double most2) {
    if (stays_[from]) return false;
    if (!surface_.groups.empty() && surface_.groups[from] != surface_.groups[to]) return false;
    const Vec3& there = places_[to];
    return quadrics_[from].at(there) + quadrics_[to].at(there) <= most2 && is_sound(from, to) &&
           keeps_shape(from, to);
  }

  /// Around the edge there are two triangles, and no more corners that both its ends know.
  bool is_sound(std::uint32_t from, std::uint32_t to) {
    stamp_ += 2;
    for (const std::uint32_t t : around(from)) {
      if (is_gone(t)) continue;
      for (const std::uint32_t corner : corners_of(t)) stamps_[corner] = stamp_;
    }
    int shared = 0;
    for (const std::uint32_t t : around(to)) {
      if (is_gone(t)) continue;
      for (const std::uint32_t corner : corners_of(t)) {
        if (corner == from || corner == to || stamps_[corner] != stamp_) continue;
        stamps_[corner] = stamp_ + 1;
        ++shared;
      }
    }
    return shared == 2;
  }

  bool keeps_shape(std::uint32_t from, std::uint32_t to) const {
    for (const std::uint32_t t : around(from)) {
      if (is_gone(t)) continue;
      std::array<std::uint32_t, 3> corners = corners_of(t);
      if (std::ranges::find(corners, to) != corners.end()) continue;
      const Vec3 before = normal_of(corners);
      std::ranges::replace(corners, from, to);
      const Vec3 after = normal_of(corners);
      double longest2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = places_[corners[(k + 1) % 3]] - places_[corners[k]];
        longest2 = std::max(longest2, glm::dot(edge, edge));
      }
      const double length = glm::length(after);
      if (length < kSliver * longest2) return false;
      if (glm::dot(before, after) < kLeastCosine * glm::length(before) * length) return false;
    }
    return true;
  }

  /// How many triangles are gone with it.
  std::size_t collapse(std::uint32_t from, std::uint32_t to) {
    std::size_t gone = 0;
    for (const std::uint32_t t : around(from)) {
      if (is_gone(t)) continue;
      const auto corners = std::span(surface_.indices).subspan(3 * std::size_t{t}, 3);
      for (const std::uint32_t corner : corners) changed_[corner] = 1;
      if (std::ranges::find(corners, to) != corners.end()) {
        corners[0] = kGone;
        ++gone;
      } else {
        std::ranges::replace(corners, from, to);
      }
    }
    quadrics_[to].add(quadrics_[from]);
    moved_[from] = moved_[to] = changed_[to] = 1;
    return gone;
  }

  void compact() {
    std::size_t end = 0;
    for (std::size_t t = 0; t < count(); ++t) {
      if (is_gone(t)) continue;
      std::copy_n(surface_.indices.begin() + static_cast<std::ptrdiff_t>(3 * t), 3,
                  surface_.indices.begin() + static_cast<std::ptrdiff_t>(end));
      end += 3;
    }
    surface_.indices.resize(end);
  }

  PageSurface& surface_;
  std::vector<Vec3> places_;
  std::vector<Quadric> quadrics_;
  // By corner, yes or no: a byte each, which is quicker to read than a bit.
  std::vector<char> stays_, moved_;
  std::vector<char> changed_;    ///< what lies about it, in this pass
  std::vector<char> looked_at_;  ///< in this pass: it has changed in the one before
  std::vector<std::uint32_t> first_, around_, stamps_;
  std::uint32_t stamp_ = 0;
};

}  // namespace

void simplify_surface(PageSurface& surface, const SimplifyOptions& options) {
  Simplifier simplifier(surface, options.keeps_rim);
  // From fine to coarse, so that what costs least goes first; each as long as it is worth it.
  for (const double share : {0.2, 1.0}) {
    for (bool again = false;; again = true) {
      if (simplifier.count() <= options.least_triangles) return;
      const std::size_t before = simplifier.count();
      if (simplifier.pass(share * options.most_mm, options.least_triangles, again) <
          before / 16 + 1)
        break;
    }
  }
}

}  // namespace kerf
