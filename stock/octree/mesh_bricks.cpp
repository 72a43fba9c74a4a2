#include "stock/octree/mesh_bricks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "mesh/mesh_lines.h"

namespace kerf::octree {
namespace {

/// Lines through all nodes along an axis.
struct NodeLines {
  int axis, width;
  MeshLines lines;

  NodeLines(const TriangleMesh& mesh, const Lattice& lattice, int along)
      : axis(along),
        width(grid_of(lattice, along).nx),
        lines(mesh, along, grid_of(lattice, along)) {}

  /// Nodes are the middles of its cells.
  static ColumnGrid grid_of(const Lattice& lattice, int axis) {
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const auto nodes = [&](int a) {
      return lattice.tiles[static_cast<std::size_t>(a)] * kTileNodes;
    };
    ColumnGrid grid;
    grid.nx = nodes(x);
    grid.ny = nodes(y);
    grid.bounds_mm.min = Vec3(lattice.place_mm(x, 0) - 0.5 * lattice.cell_mm[x],
                              lattice.place_mm(y, 0) - 0.5 * lattice.cell_mm[y], 0);
    grid.bounds_mm.max =
        grid.bounds_mm.min + Vec3(grid.nx * lattice.cell_mm[x], grid.ny * lattice.cell_mm[y], 0);
    return grid;
  }
  std::span<const LineEnd> through(const std::array<int, 3>& node) const {
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    return lines.ends(static_cast<std::size_t>(node[static_cast<std::size_t>(y)]) *
                          static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(node[static_cast<std::size_t>(x)]));
  }
};

using LinesOfAxes = std::array<std::unique_ptr<const NodeLines>, 3>;

class MeshBricks {
 public:
  MeshBricks(const Lattice& lattice, const TriangleMesh& mesh, const LinesOfAxes& lines)
      : lattice_(lattice), mesh_(mesh), lines_(lines) {}

  /// The nodes of a column of tiles, one that lies beyond them included: bits by k.
  void load(int column) {
    tile_x_ = column % lattice_.tiles[0] * kTileNodes;
    tile_y_ = column / lattice_.tiles[0] * kTileNodes;
    const std::size_t nodes = static_cast<std::size_t>(height());
    solid_.assign(static_cast<std::size_t>(kTileSide * kTileSide) * nodes, 0);
    for (int j = 0; j < kTileSide; ++j) {
      for (int i = 0; i < kTileSide; ++i) {
        if (!is_within(tile_x_ + i, tile_y_ + j)) continue;
        const auto ends = lines_[2]->through({tile_x_ + i, tile_y_ + j, 0});
        for (std::size_t n = 0; n + 1 < ends.size(); n += 2) {
          const int first = node_at_or_above(ends[n].at_mm),
                    last = node_at_or_above(ends[n + 1].at_mm);
          for (int k = first; k < last; ++k) solid_[index(i, j, k)] = 1;
        }
      }
    }
  }

  TileRef make(int level, std::uint64_t version) {
    bool any = false, all = true;
    const int first = level * kTileNodes;
    for (int j = 0; j < kTileSide; ++j)
      for (int i = 0; i < kTileSide; ++i)
        for (int k = first; k <= first + kTileNodes; ++k) {
          const bool is_solid = is_solid_at(i, j, k);
          any |= is_solid;
          all &= is_solid;
        }
    if (!any) return TileRef();
    if (all) return TileRef::solid();
    Tile* tile = new Tile;
    tile->version = version;
    for (int b = 0; b < kBricksInTile; ++b)
      tile->bricks[b] = brick(b % kTileBricks * kBrick, b / kTileBricks % kTileBricks * kBrick,
                              first + b / (kTileBricks * kTileBricks) * kBrick);
    return TileRef::adopt(tile);
  }

 private:
  static constexpr int kTileSide = kTileNodes + 1;

  int height() const { return lattice_.tiles[2] * kTileNodes; }
  bool is_within(int x, int y) const {
    return x < lattice_.tiles[0] * kTileNodes && y < lattice_.tiles[1] * kTileNodes;
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(j * kTileSide + i) * static_cast<std::size_t>(height()) +
           static_cast<std::size_t>(k);
  }
  bool is_solid_at(int i, int j, int k) const {
    return k < height() && solid_[index(i, j, k)] != 0;
  }
  int node_at_or_above(float z) const {
    const double place = (static_cast<double>(z) - lattice_.origin_mm.z) / lattice_.cell_mm.z;
    return static_cast<int>(std::clamp<double>(std::ceil(place), 0, height()));
  }

  BrickRef brick(int bi, int bj, int bk) {
    open_.open(BrickRef());
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
          if (is_solid_at(bi + i, bj + j, bk + k))
            open_.columns[j * kSide + i] =
                static_cast<std::uint16_t>(open_.columns[j * kSide + i] | 1u << k);
    for_each_crossed(open_.columns, [&](int axis, int i, int j, int k) {
      const bool from_solid = is_solid_at(bi + i, bj + j, bk + k);
      const auto e = static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
      set_crossing(axis, {tile_x_ + bi + i, tile_y_ + bj + j, bk + k}, from_solid, e);
    });
    open_.measure();
    return open_.close(false);
  }

  /// On the edge from `node` on along `axis`: where the line along it leaves the material, or
  /// enters it. Of several such places the last; where lines of other directions see the surface on
  /// the other side of a node, by rounding, that node.
  void set_crossing(int axis, const std::array<int, 3>& node, bool from_solid, std::size_t e) {
    const double begin = lattice_.place_mm(axis, node[static_cast<std::size_t>(axis)]);
    const double cell = lattice_.cell_mm[axis];
    const auto ends = lines_[static_cast<std::size_t>(axis)]->through(node);
    const LineEnd* best = nullptr;
    double least = 0;
    for (std::size_t n = from_solid ? 1 : 0; n < ends.size(); n += 2) {
      const double t = (static_cast<double>(ends[n].at_mm) - begin) / cell;
      const double beyond = std::max({0.0, -t, t - 1});
      if (best == nullptr || beyond <= least) {
        best = &ends[n];
        least = beyond;
      }
    }
    double t = 0.5;
    Vec3 normal(0);
    normal[axis] = from_solid ? 1 : -1;
    if (best != nullptr && least < 1) {
      t = (static_cast<double>(best->at_mm) - begin) / cell;
      const auto& c = mesh_.triangles[best->triangle];
      const Vec3 a(mesh_.positions_mm[c[0]]);
      const Vec3 across =
          glm::cross(Vec3(mesh_.positions_mm[c[1]]) - a, Vec3(mesh_.positions_mm[c[2]]) - a);
      const double length = glm::length(across);
      if (length > 0) normal = across / length;
    }
    open_.place[e] = static_cast<std::uint16_t>(
        std::clamp(std::lround(t * kEdgeParts), 0L, static_cast<long>(kEdgeParts - 1)));
    open_.direction[e] = pack_direction(glm::vec3(normal));
  }

  const Lattice& lattice_;
  const TriangleMesh& mesh_;
  const LinesOfAxes& lines_;
  int tile_x_ = 0, tile_y_ = 0;
  std::vector<std::uint8_t> solid_;
  OpenBrick open_;
};

}  // namespace

void fill_mesh(BrickTree& tree, const TriangleMesh& mesh, WorkerPool& pool) {
  const Lattice& lattice = tree.lattice();
  const std::uint64_t version = next_version();
  LinesOfAxes lines;
  std::atomic<int> next_axis{0};
  pool.run([&](int) {
    for (int axis = next_axis++; axis < 3; axis = next_axis++)
      lines[static_cast<std::size_t>(axis)] =
          std::make_unique<const NodeLines>(mesh, lattice, axis);
  });
  std::atomic<int> next{0};
  pool.run([&](int) {
    MeshBricks maker(lattice, mesh, lines);
    for (int column = next++; column < lattice.column_count(); column = next++) {
      maker.load(column);
      for (int level = 0; level < lattice.tiles[2]; ++level) {
        tree.set_tile(column, level, maker.make(level, version));
        tree.settle_tile(column, level);
      }
    }
  });
}

}  // namespace kerf::octree
