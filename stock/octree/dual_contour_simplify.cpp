#include "stock/octree/dual_contour_simplify.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

namespace kerf {
namespace {

/// Triangles at a vertex that is taken out, and at one that others are moved onto.
constexpr std::size_t kMostNeighbours = 24;
/// Cosine of 15 degrees: triangles at an edge that are turned by more have an edge of the part
/// between them. With shorter turns the slab decides.
constexpr float kEdgeOfPart = 0.9659258f;
/// Least ratio of height to base of a new triangle, unless there was a flatter one.
constexpr float kFlattest = 0.05f;
/// Least cosine between a new triangle and the slab: a sliver's normal is not well known.
constexpr float kLeastFacing = 0.5f;
/// Share of the vertices that a pass must take out to be followed by another one.
constexpr std::size_t kLeastGain = 100;
constexpr int kMostPasses = 40;

float height_to_base(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const float base =
      std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return base > 0.0f ? glm::length(glm::cross(b - a, c - a)) / base : 0.0f;
}

/// The triangles about a vertex u, in order; positions from u, where single precision is good.
struct Star {
  std::size_t count = 0;
  std::array<std::uint32_t, kMostNeighbours> ring;  ///< counter-clockwise
  std::array<glm::vec3, kMostNeighbours> from_u;    ///< of the ring
  std::array<glm::vec3, kMostNeighbours> area;  ///< normal of (u, n, n + 1), twice the area long
  float error_mm = 0;                           ///< greatest of the triangles
  float flattest = 1;                           ///< least height to base of the triangles

  std::size_t after(std::size_t n) const { return n + 1 == count ? 0 : n + 1; }
  std::size_t before(std::size_t n) const { return n == 0 ? count - 1 : n - 1; }
};

/// The triangles from ring vertex `first` round to `last`, as seen across their mean plane.
struct Fan {
  std::size_t first, last;
  glm::vec3 normal{0};
  float thickness_mm = 0;

  Fan(const Star& star, std::size_t from, std::size_t to) : first(from), last(to) {
    std::size_t n = from;
    do {
      normal += star.area[n];
      n = star.after(n);
    } while (n != to);
    const float length = glm::length(normal);
    normal = length > 0.0f ? normal / length : normal;
    float low = 0.0f, high = 0.0f;
    n = from;
    do {
      measure(star, n, &low, &high);
      n = star.after(n);
    } while (n != to);
    measure(star, to, &low, &high);
    thickness_mm = high - low;
  }
  void measure(const Star& star, std::size_t n, float* low, float* high) const {
    const float height = glm::dot(star.from_u[n], normal);
    *low = std::min(*low, height);
    *high = std::max(*high, height);
  }
};

class Simplifier {
 public:
  Simplifier(SimplifiedMesh* simplified, double tolerance_mm)
      : positions_(simplified->mesh.positions_mm),
        triangles_(simplified->mesh.triangles),
        error_mm_(simplified->error_mm),
        is_locked_(simplified->is_locked),
        tolerance_mm_(static_cast<float>(tolerance_mm)) {}

  std::vector<std::uint32_t> run() {
    std::size_t vertices = positions_.size();
    for (int pass = 0; pass < kMostPasses; ++pass) {
      index_triangles();
      is_busy_.assign(positions_.size(), 0);
      mark_.assign(positions_.size(), 0);
      std::size_t gone = 0;
      for (std::uint32_t u = 0; u < positions_.size(); ++u) gone += try_take_out(u) ? 1 : 0;
      drop_dead_triangles();
      vertices -= std::min(vertices, gone);
      if (gone * kLeastGain < vertices) break;
    }
    return drop_vertices();
  }

 private:
  void index_triangles();
  bool try_take_out(std::uint32_t u);
  bool find_star(std::uint32_t u, Star* star) const;
  bool may_join(const Star& star, std::size_t onto);
  float flattest_after(const Star& star, std::size_t onto, std::span<const Fan> fans) const;
  void move(std::uint32_t u, const Star& star, std::size_t onto, float error_mm);
  void drop_dead_triangles();
  std::vector<std::uint32_t> drop_vertices();
  std::span<const std::uint32_t> triangles_at(std::uint32_t v) const {
    return std::span(at_vertex_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

  std::vector<glm::vec3>& positions_;
  std::vector<std::array<std::uint32_t, 3>>& triangles_;  ///< dead: all kTakenOut
  std::vector<float>& error_mm_;
  std::vector<std::uint8_t>& is_locked_;
  float tolerance_mm_;
  std::vector<std::uint32_t> begin_, at_vertex_;  ///< as they were at the start of the pass
  std::vector<std::uint32_t> valence_;            ///< as it is now
  std::vector<std::uint8_t> is_busy_;  ///< vertices whose triangles changed during the pass
  std::vector<std::uint8_t> mark_;     ///< all 0 between calls
};

void Simplifier::index_triangles() {
  begin_.assign(positions_.size() + 1, 0);
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t v : triangle) ++begin_[v + 1];
  }
  valence_.assign(begin_.begin() + 1, begin_.end());
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  at_vertex_.resize(3 * triangles_.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t v : triangles_[t]) at_vertex_[next[v]++] = t;
  }
}

/// False if the vertex has too many triangles, or they are no single closed ring.
bool Simplifier::find_star(std::uint32_t u, Star* star) const {
  const std::span<const std::uint32_t> around = triangles_at(u);
  if (around.size() < 3 || around.size() > kMostNeighbours) return false;
  std::array<std::array<std::uint32_t, 2>, kMostNeighbours> ends;  // of the side opposite to u
  for (std::size_t n = 0; n < around.size(); ++n) {
    const std::array<std::uint32_t, 3>& t = triangles_[around[n]];
    const std::size_t place = t[0] == u ? 0 : t[1] == u ? 1 : 2;
    ends[n] = {t[(place + 1) % 3], t[(place + 2) % 3]};
    star->error_mm = std::max(star->error_mm, error_mm_[around[n]]);
  }
  star->count = around.size();
  std::uint32_t next = ends[0][0];
  for (std::size_t n = 0; n < around.size(); ++n) {
    star->ring[n] = next;
    star->from_u[n] = positions_[next] - positions_[u];
    const auto side = std::find_if(ends.begin(), ends.begin() + around.size(),
                                   [&](const auto& pair) { return pair[0] == next; });
    if (side == ends.begin() + around.size()) return false;
    next = (*side)[1];
    if (next == star->ring[0] && n + 1 < around.size()) return false;
  }
  if (next != star->ring[0]) return false;
  for (std::size_t n = 0; n < star->count; ++n) {
    const glm::vec3 &a = star->from_u[n], &b = star->from_u[star->after(n)];
    star->area[n] = glm::cross(a, b);
    star->flattest = std::min(star->flattest, height_to_base(glm::vec3(0), a, b));
  }
  return true;
}

/// Whether u and the vertex have exactly the two neighbours of their edge in common.
bool Simplifier::may_join(const Star& star, std::size_t onto) {
  const std::uint32_t v = star.ring[onto];
  const std::size_t left = star.before(onto), right = star.after(onto);
  if (is_busy_[v] != 0 || valence_[v] + star.count > kMostNeighbours + 4) return false;
  if (valence_[star.ring[left]] <= 3 || valence_[star.ring[right]] <= 3) return false;
  bool is_apart = true;
  for (std::size_t n = 0; n < star.count; ++n) {
    if (n == onto || n == left || n == right) continue;
    mark_[star.ring[n]] = 1;
    // Between two locked vertices there may be an edge already, in a part of the mesh not seen.
    if (is_locked_[v] != 0 && is_locked_[star.ring[n]] != 0) is_apart = false;
  }
  for (const std::uint32_t t : triangles_at(v)) {
    for (const std::uint32_t w : triangles_[t]) is_apart = is_apart && mark_[w] == 0;
  }
  for (std::size_t n = 0; n < star.count; ++n) mark_[star.ring[n]] = 0;
  return is_apart;
}

/// Least height to base of the triangles that are left, or -1 if one does not face as its fan does.
float Simplifier::flattest_after(const Star& star, std::size_t onto,
                                 std::span<const Fan> fans) const {
  float flattest = 1.0f;
  const glm::vec3& v = star.from_u[onto];
  for (const Fan& fan : fans) {
    std::size_t n = fan.first;
    do {
      const std::size_t next = star.after(n);
      if (n != onto && next != onto) {
        const glm::vec3 area = glm::cross(star.from_u[n] - v, star.from_u[next] - v);
        if (!(glm::dot(area, fan.normal) > kLeastFacing * glm::length(area))) return -1.0f;
        flattest = std::min(flattest, height_to_base(v, star.from_u[n], star.from_u[next]));
      }
      n = next;
    } while (n != fan.last);
  }
  return flattest;
}

/// Ring vertices at edges of the part; those to triangles without an area do not count.
std::size_t find_edges_of_part(const Star& star, std::array<std::size_t, 3>* edges) {
  std::size_t found = 0;
  for (std::size_t n = 0; n < star.count && found < 3; ++n) {
    const glm::vec3 &one = star.area[star.before(n)], &other = star.area[n];
    const float lengths = glm::length(one) * glm::length(other);
    if (glm::dot(one, other) < kEdgeOfPart * lengths) (*edges)[found++] = n;
  }
  return found;
}

float distance_to_segment(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 way = b - a;
  const float square = glm::dot(way, way);
  const float t = square > 0.0f ? std::clamp(-glm::dot(a, way) / square, 0.0f, 1.0f) : 0.0f;
  return glm::length(a + t * way);
}

bool Simplifier::try_take_out(std::uint32_t u) {
  if (is_locked_[u] != 0 || is_busy_[u] != 0) return false;
  Star star;
  if (!find_star(u, &star)) return false;
  std::array<std::size_t, 3> edges;
  const std::size_t edge_count = find_edges_of_part(star, &edges);
  if (edge_count != 0 && edge_count != 2) return false;
  const std::size_t from = edge_count == 2 ? edges[0] : 0, to = edge_count == 2 ? edges[1] : 0;
  const std::array<Fan, 2> both{Fan(star, from, to), Fan(star, to, from)};
  const std::span<const Fan> fans(both.data(), edge_count == 2 ? 2 : 1);
  float error_mm = star.error_mm + std::max(both[0].thickness_mm, both[1].thickness_mm);
  if (edge_count == 2) error_mm += distance_to_segment(star.from_u[from], star.from_u[to]);
  if (error_mm > tolerance_mm_) return false;
  std::size_t best = star.count;
  float best_flattest = std::min(kFlattest, star.flattest);
  for (std::size_t n = 0; n < star.count; ++n) {
    if (edge_count == 2 && n != from && n != to) continue;
    if (!may_join(star, n)) continue;
    const float flattest = flattest_after(star, n, fans);
    if (flattest <= best_flattest) continue;
    best_flattest = flattest;
    best = n;
  }
  if (best == star.count) return false;
  move(u, star, best, error_mm);
  return true;
}

void Simplifier::move(std::uint32_t u, const Star& star, std::size_t onto, float error_mm) {
  const std::uint32_t v = star.ring[onto];
  for (const std::uint32_t t : triangles_at(u)) {
    std::array<std::uint32_t, 3>& triangle = triangles_[t];
    if (triangle[0] == v || triangle[1] == v || triangle[2] == v) {
      triangle = {kTakenOut, kTakenOut, kTakenOut};
      continue;
    }
    for (std::uint32_t& corner : triangle) corner = corner == u ? v : corner;
    error_mm_[t] = error_mm;
  }
  is_busy_[u] = 1;
  for (std::size_t n = 0; n < star.count; ++n) is_busy_[star.ring[n]] = 1;
  --valence_[star.ring[star.before(onto)]];
  --valence_[star.ring[star.after(onto)]];
  valence_[v] += static_cast<std::uint32_t>(star.count) - 4;
}

void Simplifier::drop_dead_triangles() {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (triangles_[t][0] == kTakenOut) continue;
    triangles_[kept] = triangles_[t];
    error_mm_[kept++] = error_mm_[t];
  }
  triangles_.resize(kept);
  error_mm_.resize(kept);
}

std::vector<std::uint32_t> Simplifier::drop_vertices() {
  std::vector<std::uint32_t> number(positions_.size(), kTakenOut);
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (is_locked_[v] != 0) number[v] = 0;
  }
  for (const auto& triangle : triangles_) {
    for (const std::uint32_t v : triangle) number[v] = 0;
  }
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kTakenOut) continue;
    positions_[kept] = positions_[v];
    is_locked_[kept] = is_locked_[v];
    number[v] = kept++;
  }
  positions_.resize(kept);
  is_locked_.resize(kept);
  for (auto& triangle : triangles_) {
    for (std::uint32_t& v : triangle) v = number[v];
  }
  return number;
}

}  // namespace

std::vector<std::uint32_t> simplify(SimplifiedMesh* simplified, double tolerance_mm) {
  return Simplifier(simplified, tolerance_mm).run();
}

}  // namespace kerf
