#include "stock/sheet/sheet_mesh.h"

#include <cmath>
#include <unordered_map>

#include "base/portable_math.h"
#include "stock/sheet/sheet_border.h"
#include "stock/sheet/triangulate.h"

namespace kerf::sheet {
namespace {

/// Walls look round where they turn by less.
constexpr double kCreaseCosine = 0.866;

/// Of one outer ring with its holes: rings in the order in which triangulate() counts corners.
struct Region {
  std::vector<const FittedRing*> rings;
};

std::vector<Region> regions_of(const Tile& tile, const std::vector<FittedRing>& fitted) {
  const std::vector<std::uint32_t> owner = owners(tile);
  std::vector<Region> regions(fitted.size());
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (tile.rings[i]->is_outer()) regions[i].rings.push_back(&fitted[i]);
  }
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!tile.rings[i]->is_outer()) regions[owner[i]].rings.push_back(&fitted[i]);
  }
  std::erase_if(regions, [](const Region& region) { return region.rings.empty(); });
  return regions;
}

std::vector<Triangle> triangles_of(const Region& region) {
  std::vector<const Ring*> rings;
  for (const FittedRing* ring : region.rings) rings.push_back(&ring->points);
  return triangulate(rings);
}

glm::vec3 place(const Point& p, double z) {
  return {static_cast<float>(to_mm(p.X)), static_cast<float>(to_mm(p.Y)), static_cast<float>(z)};
}

struct PointHash {
  std::size_t operator()(const Point& p) const {
    const auto x = static_cast<std::uint64_t>(p.X) * 0x9e3779b97f4a7c15u;
    return (x ^ static_cast<std::uint64_t>(p.Y)) * 0xc2b2ae3d27d4eb4fu >> 16;
  }
};

/// Out of the material, which lies to the left of the edge.
glm::vec3 outward(const Point& a, const Point& b) {
  const double x = static_cast<double>(b.X - a.X), y = static_cast<double>(b.Y - a.Y);
  const double length = portable::hypot(x, y);
  return {static_cast<float>(y / length), static_cast<float>(-x / length), 0.0f};
}

class PatchBuilder {
 public:
  PatchBuilder(MeshPatch& patch, double bottom_mm, double top_mm)
      : patch_(patch), bottom_(bottom_mm), top_(top_mm) {}

  void caps(const Region& region) {
    const auto first = static_cast<std::uint32_t>(patch_.vertices.size());
    const std::uint32_t up = pack_normal({0, 0, 1}), down = pack_normal({0, 0, -1});
    for (const FittedRing* ring : region.rings) {
      for (const Point& p : ring->points) patch_.vertices.push_back({place(p, top_), up});
    }
    const auto count = static_cast<std::uint32_t>(patch_.vertices.size()) - first;
    for (const FittedRing* ring : region.rings) {
      for (const Point& p : ring->points) patch_.vertices.push_back({place(p, bottom_), down});
    }
    for (const Triangle& t : triangles_of(region)) {
      triangle(first + t[0], first + t[1], first + t[2]);
      triangle(first + count + t[0], first + count + t[2], first + count + t[1]);
    }
  }

  void walls(const FittedRing& ring) {
    const std::size_t n = ring.points.size();
    const auto normal = [&](std::size_t edge) {
      return outward(ring.points[edge], ring.points[(edge + 1) % n]);
    };
    for (std::size_t i = 0; i < n; ++i) {
      if (!ring.is_edge[i]) continue;
      const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
      const glm::vec3 own = normal(i);
      const std::uint32_t a = column(ring.points[i], joint(own, normal(before)));
      const std::uint32_t b = column(ring.points[after], joint(own, normal(after)));
      triangle(a, b, b + 1);
      triangle(a, b + 1, a + 1);
    }
  }

 private:
  static std::uint32_t joint(const glm::vec3& own, const glm::vec3& other) {
    return pack_normal(glm::dot(own, other) < kCreaseCosine ? own : glm::normalize(own + other));
  }
  /// Two vertices, bottom and top; those of the wall before if they are the same.
  std::uint32_t column(const Point& p, std::uint32_t normal) {
    const MeshVertex vertex{place(p, bottom_), normal};
    const std::size_t count = patch_.vertices.size();
    if (has_column_ && patch_.vertices[count - 2].position_mm == vertex.position_mm &&
        patch_.vertices[count - 2].normal == normal)
      return static_cast<std::uint32_t>(count) - 2;
    has_column_ = true;
    patch_.vertices.push_back(vertex);
    patch_.vertices.push_back({place(p, top_), normal});
    return static_cast<std::uint32_t>(count);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
  }

  MeshPatch& patch_;
  double bottom_, top_;
  bool has_column_ = false;
};

}  // namespace

TriangleMesh extrude(const SheetGrid& grid, double bottom_mm, double top_mm) {
  TriangleMesh mesh;
  std::unordered_map<Point, std::uint32_t, PointHash> vertices;  // to its bottom; the top is next
  const auto vertex = [&](const Point& p) {
    const auto [at, is_new] =
        vertices.emplace(p, static_cast<std::uint32_t>(mesh.positions_mm.size()));
    if (is_new) {
      mesh.positions_mm.push_back(place(p, bottom_mm));
      mesh.positions_mm.push_back(place(p, top_mm));
    }
    return at->second;
  };
  std::vector<std::uint32_t> corners;
  for (std::size_t t = 0; t < grid.tile_count(); ++t) {
    const std::vector<FittedRing> fitted = fit_to_neighbours(grid, t);
    for (const Region& region : regions_of(grid.tile(t), fitted)) {
      corners.clear();
      for (const FittedRing* ring : region.rings) {
        const std::size_t first = corners.size(), n = ring->points.size();
        for (const Point& p : ring->points) corners.push_back(vertex(p));
        for (std::size_t i = 0; i < n; ++i) {
          if (!ring->is_edge[i]) continue;
          const std::uint32_t a = corners[first + i], b = corners[first + (i + 1) % n];
          mesh.triangles.push_back({a, b, b + 1});
          mesh.triangles.push_back({a, b + 1, a + 1});
        }
      }
      for (const Triangle& c : triangles_of(region)) {
        const std::uint32_t p = corners[c[0]], q = corners[c[1]], r = corners[c[2]];
        mesh.triangles.push_back({p + 1, q + 1, r + 1});
        mesh.triangles.push_back({p, r, q});
      }
    }
  }
  return mesh;
}

MeshPatch extrude_tile(const SheetGrid& grid, std::size_t tile, double bottom_mm, double top_mm) {
  MeshPatch patch;
  patch.tile = static_cast<std::uint32_t>(tile);
  PatchBuilder builder(patch, bottom_mm, top_mm);
  const std::vector<FittedRing> fitted = fit_to_neighbours(grid, tile);
  for (const Region& region : regions_of(grid.tile(tile), fitted)) builder.caps(region);
  for (const FittedRing& ring : fitted) builder.walls(ring);
  patch.skirt_begin = static_cast<std::uint32_t>(patch.indices.size());
  return patch;
}

}  // namespace kerf::sheet
