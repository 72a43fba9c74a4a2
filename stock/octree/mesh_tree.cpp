#include "stock/octree/mesh_tree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <span>

namespace kerf::octree {
namespace {

/// Of a cell: by so much lines stand beside their nodes. Meshes of models have their corners on
/// nodes and half way between; nothing of them is at such places.
constexpr double kBeside[2] = {1.37e-6, 2.11e-6};
/// Of a cell: an edge's crossing may be found so far beyond its ends, since lines of different axes
/// stand beside their nodes differently.
constexpr double kBeyond = 0.01;

struct LineCrossing {
  double at = 0;  ///< along the line, in nodes
  std::uint32_t triangle = 0;
  bool enters = false;  ///< going up the line
};

/// Twice the area of p, a, b, as seen along an axis, and the same but for the sign of b, a: an edge
/// that two triangles share leaves no line between them.
double side_of(const Vec2& p, const Vec2& a, std::uint32_t a_number, const Vec2& b,
               std::uint32_t b_number) {
  const bool is_turned = a_number > b_number;
  const Vec2 low = is_turned ? b : a, high = is_turned ? a : b;
  double area = (high.x - low.x) * (p.y - low.y) - (high.y - low.y) * (p.x - low.x);
  if (area == 0) area = std::numeric_limits<double>::min();
  return is_turned ? -area : area;
}

/// Where the lines along one axis meet the surface.
class LineFamily {
 public:
  LineFamily(const Lattice& lattice, const PlacedSurface& surface, int axis)
      : lattice_(lattice), surface_(surface), axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3) {
    count_u_ = nodes(u_);
    count_v_ = nodes(v_);
    const std::size_t lines =
        static_cast<std::size_t>(count_u_) * static_cast<std::size_t>(count_v_);
    begins_.assign(lines + 1, 0);
    each([&](std::size_t line, const LineCrossing&) { ++begins_[line + 1]; });
    for (std::size_t n = 0; n < lines; ++n) begins_[n + 1] += begins_[n];
    crossings_.resize(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    each([&](std::size_t line, const LineCrossing& c) { crossings_[next[line]++] = c; });
    for (std::size_t n = 0; n < lines; ++n) {
      std::sort(crossings_.begin() + static_cast<std::ptrdiff_t>(begins_[n]),
                crossings_.begin() + static_cast<std::ptrdiff_t>(begins_[n + 1]),
                [](const LineCrossing& a, const LineCrossing& b) { return a.at < b.at; });
    }
  }

  /// Of the line through this node. None beyond the lattice.
  std::span<const LineCrossing> line(const std::array<int, 3>& node) const {
    const int u = node[static_cast<std::size_t>(u_)], v = node[static_cast<std::size_t>(v_)];
    if (u < 0 || v < 0 || u >= count_u_ || v >= count_v_) return {};
    const std::size_t n = line_number(u, v);
    return std::span(crossings_).subspan(begins_[n], begins_[n + 1] - begins_[n]);
  }

 private:
  int nodes(int axis) const { return lattice_.cells[static_cast<std::size_t>(axis)] + 2; }
  std::size_t line_number(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(count_u_) +
           static_cast<std::size_t>(u);
  }

  template <class See>
  void each(const See& see) const {
    const std::vector<Vec3>& points = surface_.points_mm();
    const auto& triangles = surface_.mesh().triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Vec2 p[3];
      double along[3];
      for (std::size_t n = 0; n < 3; ++n) {
        const Vec3 q = (points[triangles[t][n]] - lattice_.origin_mm) / lattice_.cell_mm;
        p[n] = Vec2(q[u_] - kBeside[0], q[v_] - kBeside[1]);
        along[n] = q[axis_];
      }
      const auto [low_u, high_u] = std::minmax({p[0].x, p[1].x, p[2].x});
      const auto [low_v, high_v] = std::minmax({p[0].y, p[1].y, p[2].y});
      const int first_u = std::max(0, static_cast<int>(std::ceil(low_u)));
      const int last_u = std::min(count_u_ - 1, static_cast<int>(std::floor(high_u)));
      const int first_v = std::max(0, static_cast<int>(std::ceil(low_v)));
      const int last_v = std::min(count_v_ - 1, static_cast<int>(std::floor(high_v)));
      for (int v = first_v; v <= last_v; ++v) {
        for (int u = first_u; u <= last_u; ++u) {
          const Vec2 at(u, v);
          double side[3];
          for (std::size_t n = 0; n < 3; ++n) {
            const std::size_t a = (n + 1) % 3, b = (n + 2) % 3;
            side[n] = side_of(at, p[a], triangles[t][a], p[b], triangles[t][b]);
          }
          const bool left = side[0] > 0 && side[1] > 0 && side[2] > 0;
          const bool right = side[0] < 0 && side[1] < 0 && side[2] < 0;
          if (!left && !right) continue;
          const double sum = side[0] + side[1] + side[2];
          const double w = (side[0] * along[0] + side[1] * along[1] + side[2] * along[2]) / sum;
          const auto [low, high] = std::minmax({along[0], along[1], along[2]});
          // Counter-clockwise as seen from +axis: there the outside is above.
          see(line_number(u, v),
              LineCrossing{std::clamp(w, low, high), static_cast<std::uint32_t>(t), right});
        }
      }
    }
  }

  const Lattice& lattice_;
  const PlacedSurface& surface_;
  int axis_, u_, v_;
  int count_u_ = 0, count_v_ = 0;
  std::vector<std::size_t> begins_;
  std::vector<LineCrossing> crossings_;
};

class MeshBricks {
 public:
  MeshBricks(const Lattice& lattice, const PlacedSurface& surface,
             const std::array<std::unique_ptr<LineFamily>, 3>& lines)
      : lattice_(lattice), surface_(surface), lines_(lines) {}

  BrickRef make(const std::array<int, 3>& first) {
    open_->open(BrickRef());
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        open_->columns[j * kSide + i] = column({first[0] + i, first[1] + j, first[2]});
    for_each_crossed(open_->columns, [&](int axis, int i, int j, int k) {
      const std::size_t e =
          static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
      const bool enters = (open_->columns[j * kSide + i] >> k & 1u) == 0;
      const std::array<int, 3> node{first[0] + i, first[1] + j, first[2] + k};
      const double at = node[static_cast<std::size_t>(axis)];
      Vec3 normal(0);
      normal[axis] = enters ? -1 : 1;
      double part = 0.5;
      if (const LineCrossing* const c = nearest(axis, node, enters)) {
        part = c->at - at;
        normal = normal_of(c->triangle, normal);
      }
      open_->place[e] = static_cast<std::uint16_t>(
          std::clamp(std::lround(part * kEdgeParts), 0L, static_cast<long>(kEdgeParts - 1)));
      open_->direction[e] = pack_direction(glm::vec3(normal));
    });
    for (int j = 0; j < kBrick; ++j)
      for (int i = 0; i < kBrick; ++i) open_->update_volume(i, j, 0xff);
    return open_->close(false);
  }

 private:
  bool is_end(int axis, int node) const {
    return node < 1 || node > lattice_.cells[static_cast<std::size_t>(axis)];
  }
  /// kSide nodes upward from this one.
  std::uint16_t column(const std::array<int, 3>& node) const {
    if (is_end(0, node[0]) || is_end(1, node[1])) return 0;
    const std::span<const LineCrossing> line = lines_[2]->line(node);
    unsigned bits = 0;
    int depth = 0;
    std::size_t next = 0;
    for (int k = 0; k < kSide; ++k) {
      const int z = node[2] + k;
      for (; next < line.size() && line[next].at < z; ++next) depth += line[next].enters ? 1 : -1;
      if (depth > 0 && !is_end(2, z)) bits |= 1u << k;
    }
    return static_cast<std::uint16_t>(bits);
  }
  /// On the edge from this node upward along the axis, of those that go the same way the nearest to
  /// its middle; null: the lines of this axis see none.
  const LineCrossing* nearest(int axis, const std::array<int, 3>& node, bool enters) const {
    const double low = node[static_cast<std::size_t>(axis)];
    const LineCrossing* best = nullptr;
    for (const LineCrossing& c : lines_[static_cast<std::size_t>(axis)]->line(node)) {
      if (c.at > low + 1 + kBeyond) break;
      if (c.enters != enters || c.at < low - kBeyond) continue;
      if (!best || std::abs(c.at - low - 0.5) < std::abs(best->at - low - 0.5)) best = &c;
    }
    return best;
  }
  Vec3 normal_of(std::uint32_t triangle, const Vec3& none) const {
    const auto& corners = surface_.mesh().triangles[triangle];
    const std::vector<Vec3>& points = surface_.points_mm();
    const Vec3 n = glm::cross(points[corners[1]] - points[corners[0]],
                              points[corners[2]] - points[corners[0]]);
    const double length = glm::length(n);
    return length > 0 ? n / length : none;
  }

  const Lattice& lattice_;
  const PlacedSurface& surface_;
  const std::array<std::unique_ptr<LineFamily>, 3>& lines_;
  std::unique_ptr<OpenBrick> open_ = std::make_unique<OpenBrick>();
};

}  // namespace

PlacedSurface::PlacedSurface(const TriangleMesh& mesh, const Placement& placement) : mesh_(mesh) {
  points_.reserve(mesh.positions_mm.size());
  for (const glm::vec3& p : mesh.positions_mm) {
    points_.push_back(placement.placed(Vec3(p)));
    bounds_.extend(points_.back());
  }
}

BrickTree mesh_tree(const Lattice& lattice, const PlacedSurface& surface, WorkerPool& pool) {
  std::array<std::unique_ptr<LineFamily>, 3> lines;
  std::atomic<int> next_axis{0};
  pool.run([&](int) {
    for (int axis = next_axis++; axis < 3; axis = next_axis++)
      lines[static_cast<std::size_t>(axis)] = std::make_unique<LineFamily>(lattice, surface, axis);
  });
  BrickTree tree(lattice);
  const std::uint64_t version = next_version();
  std::atomic<int> next{0};
  pool.run([&](int) {
    MeshBricks bricks(lattice, surface, lines);
    for (int column = next++; column < lattice.column_count(); column = next++) {
      for (int level = 0; level < lattice.tiles[2]; ++level) {
        const std::array<int, 3> at{column % lattice.tiles[0], column / lattice.tiles[0], level};
        Tile* tile = new Tile;
        tile->version = version;
        for (int b = 0; b < kBricksInTile; ++b) {
          const int in_tile[3] = {b % kTileBricks, b / kTileBricks % kTileBricks,
                                  b / (kTileBricks * kTileBricks)};
          std::array<int, 3> first{};
          for (std::size_t a = 0; a < 3; ++a) first[a] = at[a] * kTileNodes + in_tile[a] * kBrick;
          tile->bricks[b] = bricks.make(first);
        }
        tree.set_tile(column, level, TileRef::adopt(tile));
        tree.settle_tile(column, level);
      }
    }
  });
  return tree;
}

}  // namespace kerf::octree
