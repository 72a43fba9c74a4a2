#include "stock/turning/revolve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace kerf::turning {
namespace {

/// Surfaces look round where they turn by less.
constexpr double kCreaseCosine = 0.866;
constexpr int kFewestSegments = 12;

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double squared = glm::dot(way, way);
  const double share = squared > 0 ? std::clamp(glm::dot(p - a, way) / squared, 0.0, 1.0) : 0;
  return glm::distance(p, a + share * way);
}

/// Directions round the axis, the first once more at the end.
std::vector<Vec2> directions(int segments) {
  std::vector<Vec2> all;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    all.emplace_back(std::cos(angle), std::sin(angle));
  }
  all.push_back(all.front());
  return all;
}

glm::vec3 place(const Vec2& zr, const Vec2& direction) {
  return {static_cast<float>(zr.y * direction.x), static_cast<float>(zr.y * direction.y),
          static_cast<float>(zr.x)};
}

/// The strip between two rings of corners, counter-clockwise seen from outside; a ring of one
/// corner, on the axis, has step 0.
template <class Triangle>
void add_strip(int segments, std::uint32_t from, std::uint32_t from_step, std::uint32_t to,
               std::uint32_t to_step, bool wraps, Triangle&& triangle) {
  for (int i = 0; i < segments; ++i) {
    const auto a = static_cast<std::uint32_t>(i);
    const auto b = wraps && i + 1 == segments ? 0 : a + 1;
    const std::uint32_t p = from + a * from_step, next_p = from + b * from_step;
    const std::uint32_t q = to + a * to_step, next_q = to + b * to_step;
    if (from_step != 0) triangle(p, q, next_p);
    if (to_step != 0) triangle(next_p, q, next_q);
  }
}

std::vector<Vec2> closed_chain(const Contour& contour) {
  std::vector<Vec2> chain;
  for (const Point& p : contour.ring()) chain.push_back(to_mm(p));
  chain.push_back(chain.front());
  return chain;
}

void keep_corners(std::span<const Vec2> chain, double tolerance_mm, std::size_t first,
                  std::size_t last, std::vector<char>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  kept[first] = kept[last] = 1;
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    double farthest = tolerance_mm;
    std::size_t at = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double distance = distance_to_line(chain[i], chain[begin], chain[end]);
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
    }
    if (at == begin) continue;
    kept[at] = 1;
    open.push_back({begin, at});
    open.push_back({at, end});
  }
}

}  // namespace

int segments_for(double radius_mm, double tolerance_mm) {
  if (!(radius_mm > tolerance_mm)) return kFewestSegments;
  const double half = std::acos(1 - tolerance_mm / radius_mm);
  return std::max(kFewestSegments, static_cast<int>(std::ceil(kPi / half)));
}

std::vector<Vec2> simplified(std::span<const Vec2> chain, double tolerance_mm) {
  if (!(tolerance_mm > 0) || chain.size() < 4) return {chain.begin(), chain.end()};
  std::vector<char> kept(chain.size(), 0);
  const std::size_t last = chain.size() - 1;
  if (chain.front() == chain.back()) {
    // Two corners that are sure to stay, and of a ring three.
    std::size_t far = 1;
    for (std::size_t i = 1; i < last; ++i) {
      if (glm::distance(chain[i], chain[0]) > glm::distance(chain[far], chain[0])) far = i;
    }
    std::size_t third = far == 1 ? 2 : 1;
    for (std::size_t i = 1; i < last; ++i) {
      if (i != far && distance_to_line(chain[i], chain[0], chain[far]) >
                          distance_to_line(chain[third], chain[0], chain[far]))
        third = i;
    }
    const std::array<std::size_t, 4> corners{0, std::min(far, third), std::max(far, third), last};
    for (std::size_t i = 0; i < 3; ++i)
      keep_corners(chain, tolerance_mm, corners[i], corners[i + 1], kept);
  } else {
    keep_corners(chain, tolerance_mm, 0, last, kept);
  }
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (kept[i] != 0) result.push_back(chain[i]);
  }
  return result;
}

TriangleMesh revolve(std::span<const Contour> contours, double tolerance_mm) {
  Unit radius = 0;
  for (const Contour& contour : contours) radius = std::max(radius, contour.box().max_y);
  const double half = tolerance_mm > 0 ? tolerance_mm / 2 : 0;
  const int segments = segments_for(to_mm(radius), half > 0 ? half : kFinest_mm / 2);
  const std::vector<Vec2> around = directions(segments);
  TriangleMesh mesh;
  for (const Contour& contour : contours) {
    const std::vector<Vec2> chain = simplified(closed_chain(contour), half);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> rings;  // first vertex and step
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const bool on_axis = chain[i].y == 0;
      rings.emplace_back(static_cast<std::uint32_t>(mesh.positions_mm.size()), on_axis ? 0 : 1);
      for (int k = 0; k < (on_axis ? 1 : segments); ++k)
        mesh.positions_mm.push_back(place(chain[i], around[static_cast<std::size_t>(k)]));
    }
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const auto [from, from_step] = rings[i];
      const auto [to, to_step] = rings[(i + 1) % rings.size()];
      add_strip(segments, from, from_step, to, to_step, true,
                [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                  mesh.triangles.push_back({a, b, c});
                });
    }
  }
  return mesh;
}

namespace {

/// Chains of a contour between two lines across the axis, in its direction; a closed one where it
/// never leaves.
class BandChains {
 public:
  BandChains(Unit low, Unit high, bool has_high_face)
      : low_(low), high_(high), has_high_face_(has_high_face) {}

  std::vector<std::vector<Vec2>> of(const Contour& contour) {
    const Ring ring = contour.ring();
    chains_.clear();
    open_ = false;
    for (std::size_t i = 0; i < ring.size(); ++i)
      add_edge(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
    // The contour's beginning may be within the band: then the last chain goes on as the first.
    if (open_ && chains_.size() > 1 && chains_.back().back() == chains_.front().front()) {
      std::vector<Vec2>& last = chains_.back();
      last.insert(last.end(), chains_.front().begin() + 1, chains_.front().end());
      std::swap(chains_.front(), last);
      chains_.pop_back();
    }
    return std::move(chains_);
  }

 private:
  void add_edge(const Point& a, const Point& b) {
    bool inside = false;
    if (a.X == b.X) {
      inside = a.X >= low_ && (a.X < high_ || (a.X == high_ && has_high_face_));
      if (inside) return add(to_mm(a), to_mm(b), true);
    } else if (std::max(a.X, b.X) > low_ && std::min(a.X, b.X) < high_) {
      const bool leaves = b.X < low_ || b.X > high_;
      return add(clipped(a, b), clipped(b, a), !leaves);
    }
    open_ = false;
  }
  /// `a`, or where the edge enters the band on the way from it. The same for either direction.
  Vec2 clipped(const Point& a, const Point& b) const {
    if (a.X >= low_ && a.X <= high_) return to_mm(a);
    const Unit border = a.X < low_ ? low_ : high_;
    const Point &left = a.X < b.X ? a : b, &right = a.X < b.X ? b : a;
    const double share =
        static_cast<double>(border - left.X) / static_cast<double>(right.X - left.X);
    return {to_mm(border), to_mm(left.Y) + share * (to_mm(right.Y) - to_mm(left.Y))};
  }
  void add(const Vec2& from, const Vec2& to, bool stays) {
    if (!open_) chains_.push_back({from});
    chains_.back().push_back(to);
    open_ = stays;
  }

  Unit low_, high_;
  bool has_high_face_;
  std::vector<std::vector<Vec2>> chains_;
  bool open_ = false;
};

/// Out of the material, which lies to the left of the edge: along z and r.
Vec2 outward(const Vec2& a, const Vec2& b) {
  const Vec2 way = glm::normalize(b - a);
  return {way.y, -way.x};
}

class PatchBuilder {
 public:
  explicit PatchBuilder(MeshPatch& patch) : patch_(patch), around_(directions(kPatchSegments)) {}

  void add_chain(std::span<const Vec2> chain) {
    const std::size_t edges = chain.size() - 1;
    const bool closed = chain.front() == chain.back();
    const auto normal = [&](std::size_t i) { return outward(chain[i], chain[i + 1]); };
    const auto joint = [&](std::size_t edge, std::size_t other) {
      const Vec2 own = normal(edge), beside = normal(other);
      return glm::dot(own, beside) < kCreaseCosine ? own : glm::normalize(own + beside);
    };
    for (std::size_t i = 0; i < edges; ++i) {
      const bool has_before = i > 0 || closed, has_after = i + 1 < edges || closed;
      const Vec2 begin = has_before ? joint(i, i > 0 ? i - 1 : edges - 1) : normal(i);
      const Vec2 end = has_after ? joint(i, i + 1 < edges ? i + 1 : 0) : normal(i);
      if (chain[i].y == 0 && chain[i + 1].y == 0) continue;  // the axis
      const std::uint32_t from = ring(chain[i], begin), to = ring(chain[i + 1], end);
      add_strip(kPatchSegments, from, 1, to, 1, false,
                [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangle(a, b, c); });
    }
  }

 private:
  /// The ring before where it is the same.
  std::uint32_t ring(const Vec2& at, const Vec2& normal) {
    if (at == last_at_ && normal == last_normal_) return last_ring_;
    last_at_ = at;
    last_normal_ = normal;
    last_ring_ = static_cast<std::uint32_t>(patch_.vertices.size());
    for (const Vec2& direction : around_) {
      patch_.vertices.push_back({place(at, direction), pack_normal(place(normal, direction))});
    }
    return last_ring_;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::vec3 &p = patch_.vertices[a].position_mm, &q = patch_.vertices[b].position_mm,
                    &r = patch_.vertices[c].position_mm;
    if (p == q || q == r || r == p) return;  // at the axis
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
  }

  MeshPatch& patch_;
  std::vector<Vec2> around_;
  Vec2 last_at_{-1, -1}, last_normal_{0};  // r is never negative
  std::uint32_t last_ring_ = 0;
};

}  // namespace

MeshPatch revolve_band(std::span<const Contour> contours, Unit low_z, Unit high_z,
                       bool has_high_face, double tolerance_mm) {
  MeshPatch patch;
  PatchBuilder builder(patch);
  BandChains chains(low_z, high_z, has_high_face);
  for (const Contour& contour : contours) {
    if (contour.box().max_x < low_z || contour.box().min_x > high_z) continue;
    for (const std::vector<Vec2>& chain : chains.of(contour))
      builder.add_chain(simplified(chain, tolerance_mm));
  }
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

std::vector<std::vector<Vec2>> band_chains(const Contour& contour, Unit low_z, Unit high_z,
                                           bool has_high_face) {
  return BandChains(low_z, high_z, has_high_face).of(contour);
}

}  // namespace kerf::turning
