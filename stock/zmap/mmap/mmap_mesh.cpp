#include "stock/zmap/mmap/mmap_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <vector>

#include "base/portable_math.h"
#include "stock/zmap/mmap/column_patch.h"
#include "stock/zmap/tile_patch.h"

namespace kerf {
namespace {

/// Heights of the mesh are multiples of this, mm: less than the heights of columns are promised
/// with. So no edge is so short that its middle would be one of its ends.
constexpr float kHeightStep_mm = 1.0f / 4096;

struct PositionHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::uint32_t b : bits) h = (h ^ b) * 0xff51afd7ed558ccdu, h ^= h >> 32;
    return static_cast<std::size_t>(h);
  }
};

/// Patches joined: corners at the same place become one.
class Welder {
 public:
  void add(const MeshPatch& patch) {
    number_.clear();
    for (const MeshVertex& vertex : patch.vertices) {
      glm::vec3 at = vertex.position_mm;
      at.z = std::rint(at.z / kHeightStep_mm) * kHeightStep_mm;
      number_.push_back(find(at));
    }
    const auto indices = patch.surface_indices();
    for (std::size_t n = 0; n < indices.size(); n += 3) {
      const std::array<std::uint32_t, 3> t{number_[indices[n]], number_[indices[n + 1]],
                                           number_[indices[n + 2]]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
    }
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t find(const glm::vec3& p) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };
    const auto [place, fresh] = known_.try_emplace(
        {bits(p.x), bits(p.y), bits(p.z)}, static_cast<std::uint32_t>(mesh_.positions_mm.size()));
    if (fresh) mesh_.positions_mm.push_back(p);
    return place->second;
  }
  TriangleMesh mesh_;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PositionHash> known_;
  std::vector<std::uint32_t> number_;
};

/// Side n of a triangle goes from its corner n to the next one; sides are numbered 3 t + n.
using Side = std::uint32_t;

class Separator {
 public:
  Separator(TriangleMesh& mesh, float inset_mm) : mesh_(mesh), inset_mm_(inset_mm) {}

  void run() {
    drop_flaps();
    pair_sides();
    split_corners();
    move_apart();
    split_shared_edges();
  }

 private:
  static Side next(Side side) { return side % 3 == 2 ? side - 2 : side + 1; }
  std::uint32_t& corner(Side side) { return mesh_.triangles[side / 3][side % 3]; }
  std::uint32_t from(Side side) const { return mesh_.triangles[side / 3][side % 3]; }
  std::uint32_t to(Side side) const { return from(next(side)); }
  Vec3 position(std::uint32_t vertex) const { return Vec3(mesh_.positions_mm[vertex]); }
  std::vector<std::pair<std::uint64_t, Side>> sorted_sides() const;
  void pair_many(std::span<const std::pair<std::uint64_t, Side>> sides);
  void drop_flaps();
  void pair_sides();
  void split_corners();
  void move_apart();
  void split_shared_edges();
  Vec3 normal(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return glm::cross(position(b) - position(a), position(c) - position(a));
  }
  /// Out along `normal`, if there is one; farther for each of those at one place, since sheets that
  /// lie on each other have the same normals.
  Vec3 inset(const Vec3& normal, std::size_t number) const {
    const double length = glm::length(normal);
    const double distance =
        static_cast<double>(inset_mm_) * (1 + 0.5 * static_cast<double>(number));
    return length > 1e-9 ? distance / length * normal : Vec3(distance, 0, 0);
  }
  std::uint32_t root(std::uint32_t c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }

  TriangleMesh& mesh_;
  float inset_mm_;
  std::vector<Side> pair_;
  std::vector<std::uint32_t> parent_;    ///< of corners, numbered as the sides that begin there
  std::vector<std::uint32_t> original_;  ///< of a corner's vertex: the one it was before
  std::size_t vertices_before_ = 0;
};

/// Two triangles back to back enclose nothing.
void Separator::drop_flaps() {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> sorted;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    std::array<std::uint32_t, 3> key = mesh_.triangles[t];
    std::sort(key.begin(), key.end());
    sorted.push_back({key, t});
  }
  std::sort(sorted.begin(), sorted.end());
  const auto is_even = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh_.triangles[t];
    return (a < b) + (b < c) + (c < a) == 2;
  };
  std::vector<char> dropped(mesh_.triangles.size());
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    const auto& [key, t] = sorted[n];
    const auto& [last_key, last] = sorted[n - 1];
    if (key == last_key && !dropped[last] && is_even(t) != is_even(last))
      dropped[t] = dropped[last] = 1;
  }
  std::uint32_t number = 0;
  std::erase_if(mesh_.triangles, [&](const auto&) { return dropped[number++] != 0; });
}

std::vector<std::pair<std::uint64_t, Side>> Separator::sorted_sides() const {
  std::vector<std::pair<std::uint64_t, Side>> sides(3 * mesh_.triangles.size());
  for (Side s = 0; s < sides.size(); ++s) {
    const std::uint64_t low = std::min(from(s), to(s)), high = std::max(from(s), to(s));
    sides[s] = {low << 32 | high, s};
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

void Separator::pair_sides() {
  const auto sides = sorted_sides();
  pair_.assign(sides.size(), 0);
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first; last < sides.size() && sides[last].first == sides[first].first;) ++last;
    if (last - first == 2) {
      pair_[sides[first].second] = sides[first + 1].second;
      pair_[sides[first + 1].second] = sides[first].second;
    } else {
      pair_many(std::span(sides).subspan(first, last - first));
    }
  }
}

/// An edge of several sides: going round it, each triangle behind which the material begins belongs
/// to the next one at which it ends. So pieces of material that touch here come apart.
void Separator::pair_many(std::span<const std::pair<std::uint64_t, Side>> sides) {
  const std::uint32_t a = static_cast<std::uint32_t>(sides[0].first >> 32);
  const std::uint32_t b = static_cast<std::uint32_t>(sides[0].first);
  const Vec3 axis = glm::normalize(position(b) - position(a));
  const Vec3 u = glm::normalize(std::abs(axis.z) < 0.9 ? glm::cross(axis, Vec3(0, 0, 1))
                                                       : glm::cross(axis, Vec3(1, 0, 0)));
  const Vec3 v = glm::cross(axis, u);
  struct Around {
    double angle;
    bool material_begins;
    Side side;
  };
  std::vector<Around> around;
  for (const auto& [key, side] : sides) {
    const Vec3 w = position(to(next(side))) - position(a);
    around.push_back({portable::atan2(glm::dot(w, v), glm::dot(w, u)), from(side) != a, side});
  }
  std::sort(around.begin(), around.end(), [](const Around& x, const Around& y) {
    if (x.angle != y.angle) return x.angle < y.angle;
    return x.material_begins != y.material_begins ? x.material_begins : x.side < y.side;
  });
  const std::size_t n = around.size();
  std::vector<bool> used(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!around[i].material_begins) continue;
    for (std::size_t k = 1; k < n; ++k) {
      const std::size_t other = (i + k) % n;
      if (around[other].material_begins || used[other]) continue;
      used[other] = true;
      pair_[around[i].side] = around[other].side;
      pair_[around[other].side] = around[i].side;
      break;
    }
  }
}

/// Triangles that hang together about a vertex by their paired sides share it; each other such fan
/// gets a vertex of its own.
void Separator::split_corners() {
  const std::size_t corners = 3 * mesh_.triangles.size();
  parent_.resize(corners);
  for (std::uint32_t c = 0; c < corners; ++c) parent_[c] = c;
  const auto unite = [&](std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  };
  for (Side s = 0; s < corners; ++s) {
    unite(s, next(pair_[s]));  // a side's pair runs the other way
    unite(next(s), pair_[s]);
  }
  vertices_before_ = mesh_.positions_mm.size();
  std::vector<std::uint32_t> first_fan(vertices_before_, static_cast<std::uint32_t>(corners));
  std::vector<std::uint32_t> vertex_of_fan(corners);
  original_.resize(vertices_before_);
  for (std::uint32_t v = 0; v < vertices_before_; ++v) original_[v] = v;
  for (std::uint32_t c = 0; c < corners; ++c) {
    if (root(c) != c) continue;
    const std::uint32_t v = from(c);
    if (first_fan[v] == corners) {
      first_fan[v] = c;
      vertex_of_fan[c] = v;
    } else {
      vertex_of_fan[c] = static_cast<std::uint32_t>(mesh_.positions_mm.size());
      mesh_.positions_mm.push_back(mesh_.positions_mm[v]);
      original_.push_back(v);
    }
  }
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t fan = root(c);
    if (vertex_of_fan[fan] != from(c)) corner(c) = vertex_of_fan[fan];
  }
}

/// Vertices of several fans go into the material of their own.
void Separator::move_apart() {
  std::vector<char> is_shared(mesh_.positions_mm.size());
  for (std::size_t v = vertices_before_; v < original_.size(); ++v)
    is_shared[v] = is_shared[original_[v]] = 1;
  std::vector<Vec3> outward(mesh_.positions_mm.size(), Vec3(0));
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vec3 n = normal(t);
    const double length = glm::length(n);
    if (length == 0) continue;
    for (const std::uint32_t v : mesh_.triangles[t])
      if (is_shared[v]) outward[v] += n / length;
  }
  std::vector<std::size_t> copies(vertices_before_);
  for (std::size_t v = 0; v < outward.size(); ++v) {
    if (is_shared[v]) mesh_.positions_mm[v] -= glm::vec3(inset(outward[v], copies[original_[v]]++));
  }
}

/// Pairs of sides between the same two vertices get a vertex each in their middle.
void Separator::split_shared_edges() {
  const auto sides = sorted_sides();
  struct Pair {
    Side s, p;
    std::size_t number;  ///< of those at this edge
  };
  std::vector<Pair> pairs;
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first; last < sides.size() && sides[last].first == sides[first].first;) ++last;
    std::size_t number = 0;
    for (std::size_t n = first; last - first > 2 && n < last; ++n)
      if (sides[n].second < pair_[sides[n].second])
        pairs.push_back({sides[n].second, pair_[sides[n].second], number++});
  }
  // A triangle may be divided at several sides: each time only what is left of it keeps its number.
  std::vector<std::array<std::uint32_t, 3>> middles(mesh_.triangles.size(), {0, 0, 0});
  std::vector<std::size_t> divided;
  for (const auto& [s, p, number] : pairs) {
    const Vec3 n = normal(s / 3) + normal(p / 3);
    const Vec3 middle = 0.5 * (position(from(s)) + position(to(s))) - inset(n, number);
    const auto vertex = static_cast<std::uint32_t>(mesh_.positions_mm.size());
    mesh_.positions_mm.push_back(glm::vec3(middle));
    for (const Side side : {s, p}) {
      middles[side / 3][side % 3] = vertex;
      divided.push_back(side / 3);
    }
  }
  std::sort(divided.begin(), divided.end());
  divided.erase(std::unique(divided.begin(), divided.end()), divided.end());
  for (const std::size_t t : divided) {
    // The corners and middles in order, as a fan about one of the middles: no piece is without
    // area, as no two of its corners lie on one side with the fan's.
    std::vector<std::uint32_t> ring;
    std::size_t start = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      ring.push_back(mesh_.triangles[t][n]);
      if (middles[t][n] == 0) continue;
      start = ring.size();
      ring.push_back(middles[t][n]);
    }
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start), ring.end());
    mesh_.triangles[t] = {ring[0], ring[1], ring[2]};
    for (std::size_t n = 2; n + 1 < ring.size(); ++n)
      mesh_.triangles.push_back({ring[0], ring[n], ring[n + 1]});
  }
}

}  // namespace

TriangleMesh separate_touching(TriangleMesh mesh, float inset_mm) {
  Separator(mesh, inset_mm).run();
  return mesh;
}

TriangleMesh mesh_columns(const TileGrid& grid, const GapGrid& gaps) {
  Welder welder;
  for (std::uint32_t tile = 0; tile < grid.tile_count(); ++tile) {
    welder.add(gaps_near(grid, gaps, tile) ? make_column_patch(grid, gaps, tile, 0)
                                           : make_tile_patch(grid, tile, 0));
  }
  TriangleMesh mesh = welder.take();
  const double cell = std::min(grid.cell_x_mm(), grid.cell_y_mm());
  return separate_touching(std::move(mesh), static_cast<float>(0.01 * cell));
}

}  // namespace kerf
