#include "stock/octree/blank_bricks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/mesh_body.h"
#include "stock/octree/mesh_bricks.h"

namespace kerf::octree {
namespace {

constexpr double kSlack_mm = 1e-6;

/// Signed distance or less, negative inside, and where it grows.
struct Field {
  double f;
  Vec3 normal;
};

Field larger(const Field& a, const Field& b) { return a.f >= b.f ? a : b; }

Field slab(const BlankBody& body, int axis, const Vec3& p) {
  Vec3 up(0);
  up[axis] = 1;
  return larger({body.bounds_mm.min[axis] - p[axis], -up},
                {p[axis] - body.bounds_mm.max[axis], up});
}

Field field_of(const BlankBody& body, const Vec3& p) {
  if (body.kind == BlankBody::Kind::kBox)
    return larger(larger(slab(body, 0, p), slab(body, 1, p)), slab(body, 2, p));
  const int axis = body.axis - 'x';
  Vec3 out = p - body.center_mm;
  out[axis] = 0;
  const double r = glm::length(out);
  const Vec3 normal = r > 0 ? out / r : Vec3(0);
  Field field = larger({r - body.diameter_mm / 2, normal}, slab(body, axis, p));
  if (body.kind == BlankBody::Kind::kTube)
    field = larger(field, {body.inner_diameter_mm / 2 - r, -normal});
  return field;
}

Field field_of(const Blank& blank, const Vec3& p) {
  Field best{std::numeric_limits<double>::infinity(), Vec3(0)};
  for (const BlankBody& body : blank.bodies) {
    const Field field = field_of(body, p);
    if (field.f < best.f) best = field;
  }
  return best;
}

struct BrickMaker {
  const Lattice& lattice;
  const Blank& blank;
  OpenBrick open;

  Vec3 node(const int first[3], int i, int j, int k) const {
    return {lattice.place_mm(0, first[0] + i), lattice.place_mm(1, first[1] + j),
            lattice.place_mm(2, first[2] + k)};
  }

  /// Part of the edge from `a` to `b` at which the surface is (false position, kept from sticking).
  double crossing(const Vec3& a, const Vec3& b) const {
    double low = 0, high = 1, f_low = field_of(blank, a).f, f_high = field_of(blank, b).f;
    double t = 0.5;
    for (int step = 0; step < 60 && high - low > 1e-9; ++step) {
      t = low + (high - low) * f_low / (f_low - f_high);
      const double f = field_of(blank, a + t * (b - a)).f;
      if (std::abs(f) < 1e-10 * glm::length(b - a)) break;
      if ((f < 0) == (f_low < 0)) {
        low = t;
        f_low = f;
        f_high /= 2;
      } else {
        high = t;
        f_high = f;
        f_low /= 2;
      }
    }
    return t;
  }

  BrickRef make(int bx, int by, int bz) {
    const int first[3] = {bx * kBrick, by * kBrick, bz * kBrick};
    open.open(BrickRef());
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
          if (field_of(blank, node(first, i, j, k)).f < 0)
            open.columns[j * kSide + i] =
                static_cast<std::uint16_t>(open.columns[j * kSide + i] | 1u << k);
    for_each_crossed(open.columns, [&](int axis, int i, int j, int k) {
      const Vec3 a = node(first, i, j, k);
      Vec3 b = a;
      b[axis] = lattice.place_mm(axis, first[axis] + (axis == 0 ? i : axis == 1 ? j : k) + 1);
      const double t = crossing(a, b);
      const std::size_t e =
          static_cast<std::size_t>(axis * kBrickNodes + (j * kBrick + i) * kBrick + k);
      open.place[e] = static_cast<std::uint16_t>(
          std::clamp(std::lround(t * kEdgeParts), 0L, static_cast<long>(kEdgeParts - 1)));
      open.direction[e] = pack_direction(glm::vec3(field_of(blank, a + t * (b - a)).normal));
    });
    open.measure();
    return open.close(false);
  }
};

/// What a piece of `nodes` nodes from `first` on sees of a single box: along each axis nothing but
/// inside (0), its low end (1), its high end (2), both (3), or nothing but outside (4).
int ends_seen(const Lattice& lattice, const std::array<int, 3>& first, int nodes) {
  int key = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const std::size_t a = static_cast<std::size_t>(axis);
    const int last = lattice.cells[a];
    int seen = (first[a] < 1 ? 1 : 0) + (first[a] + nodes > last ? 2 : 0);
    if (first[a] > last) seen = 4;
    key = key * 5 + seen;
  }
  return key;
}
constexpr int kEndsSeen = 5 * 5 * 5;

TileRef make_tile(BrickMaker& maker, const std::array<int, 3>& at,
                  std::array<BrickRef, kEndsSeen>* alike, std::array<bool, kEndsSeen>* known,
                  std::uint64_t version) {
  Tile* tile = new Tile;
  tile->version = version;
  for (int b = 0; b < kBricksInTile; ++b) {
    const std::array<int, 3> brick{at[0] * kTileBricks + b % kTileBricks,
                                   at[1] * kTileBricks + b / kTileBricks % kTileBricks,
                                   at[2] * kTileBricks + b / (kTileBricks * kTileBricks)};
    if (!alike) {
      tile->bricks[b] = maker.make(brick[0], brick[1], brick[2]);
      continue;
    }
    const std::size_t key = static_cast<std::size_t>(ends_seen(
        maker.lattice, {brick[0] * kBrick, brick[1] * kBrick, brick[2] * kBrick}, kBrick));
    if (!(*known)[key]) (*alike)[key] = maker.make(brick[0], brick[1], brick[2]);
    (*known)[key] = true;
    tile->bricks[b] = (*alike)[key];
  }
  return TileRef::adopt(tile);
}

void fill_box(BrickTree& tree, const Blank& blank) {
  const Lattice& lattice = tree.lattice();
  BrickMaker maker{lattice, blank, {}};
  std::array<BrickRef, kEndsSeen> bricks;
  std::array<bool, kEndsSeen> known_bricks{}, known_tiles{};
  std::array<TileRef, kEndsSeen> tiles;
  const std::uint64_t version = next_version();
  for (std::uint32_t number = 0; number < tree.tile_count(); ++number) {
    const std::array<int, 3> at = lattice.tile_at(number);
    const int column = at[1] * lattice.tiles[0] + at[0];
    const std::size_t key = static_cast<std::size_t>(ends_seen(
        lattice, {at[0] * kTileNodes, at[1] * kTileNodes, at[2] * kTileNodes}, kTileNodes));
    if (!known_tiles[key]) {
      tree.set_tile(column, at[2], make_tile(maker, at, &bricks, &known_bricks, version));
      tree.settle_tile(column, at[2]);
      tiles[key] = tree.tile(column, at[2]);
      known_tiles[key] = true;
    }
    tree.set_tile(column, at[2], tiles[key]);
  }
}

void fill_bodies(BrickTree& tree, const Blank& blank, WorkerPool& pool) {
  const Lattice& lattice = tree.lattice();
  const std::uint64_t version = next_version();
  const double clear = glm::length(lattice.cell_mm) * kTileNodes / 2 + kSlack_mm;
  std::atomic<int> next{0};
  pool.run([&](int) {
    BrickMaker maker{lattice, blank, {}};
    for (int column = next++; column < lattice.column_count(); column = next++) {
      for (int level = 0; level < lattice.tiles[2]; ++level) {
        const std::array<int, 3> at{column % lattice.tiles[0], column / lattice.tiles[0], level};
        Vec3 middle;
        for (int a = 0; a < 3; ++a)
          middle[a] = lattice.place_mm(a, at[static_cast<std::size_t>(a)] * kTileNodes) +
                      lattice.cell_mm[a] * kTileNodes / 2;
        const double f = field_of(blank, middle).f;
        if (f > clear) continue;
        tree.set_tile(
            column, level,
            f < -clear ? TileRef::solid() : make_tile(maker, at, nullptr, nullptr, version));
        tree.settle_tile(column, level);
      }
    }
  });
}

}  // namespace

BrickTree blank_tree(const Lattice& lattice, const Blank& blank, WorkerPool& pool) {
  BrickTree tree(lattice);
  if (blank.mesh && blank.mesh->body) {
    fill_mesh(tree, blank.mesh->body->mesh, pool);
    return tree;
  }
  if (blank.bodies.size() == 1 && blank.bodies[0].kind == BlankBody::Kind::kBox)
    fill_box(tree, blank);
  else
    fill_bodies(tree, blank, pool);
  return tree;
}

BrickTree solid_tree(const Lattice& lattice) {
  BrickTree tree(lattice);
  for (int column = 0; column < lattice.column_count(); ++column)
    for (int level = 0; level < lattice.tiles[2]; ++level)
      tree.set_tile(column, level, TileRef::solid());
  return tree;
}

std::int64_t volume_of(const BrickTree& tree) {
  constexpr std::int64_t kBrickVolume = std::int64_t{kBrickNodes} * kNodeVolume;
  std::int64_t volume = 0;
  for (std::uint32_t number = 0; number < tree.tile_count(); ++number) {
    const TileRef& tile = tree.tile(number);
    if (tile.is_solid()) volume += kBricksInTile * kBrickVolume;
    if (!tile.get()) continue;
    for (const BrickRef& brick : tile->bricks)
      volume += brick.get() ? brick->volume : brick.is_solid() ? kBrickVolume : 0;
  }
  return volume;
}

}  // namespace kerf::octree
