#include "viewer/raycast/height_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <utility>

#include "surface/wall_course.h"
#include "viewer/raycast/parallel.h"

namespace kerf {

/// The ray over the base plane, x and y in cells from the grid's corner; z in mm.
struct HeightSurface::GridRay {
  double x, y, z;
  double dx, dy, dz;
  double per_dx, per_dy, per_dz;  ///< 1 / dx; large where the ray does not move in x
  double t_min;
  double z_at(double t) const { return z + t * dz; }
  double t_at_x(int line) const { return (line - x) * per_dx; }
  double t_at_y(int line) const { return (line - y) * per_dy; }
};

namespace {

constexpr int kCells = SurfaceTile::kCells;
constexpr int kBlockCells = SurfaceTile::kBlockCells;
/// A direction that moves less than this in x (cells, against t) moves not at all.
constexpr double kStill = 1e-30;
/// A ray that meets a cell's top no lower than this below it has met the top, not a wall (share of
/// a cell): between tops that hang together there is no wall, but rounding.
constexpr double kLeastWall = 1e-4;
/// A ray straight down that misses the edge of a moved top by no more (in cells) is over both tops
/// at that edge: rounding must leave no gap between them.
constexpr double kOnEdge = 1e-9;

/// Walks over squares of `size` x `size` cells within squares [i0, i1) x [j0, j1), counted in
/// squares, from t0 to t1, and calls visit(i, j, from_t, to_t) until it returns true. Where lines
/// are crossed is computed from the line, not summed up: it does not depend on where the walk
/// began.
template <int size, class Ray, class Visit>
inline bool walk(const Ray& ray, int i0, int j0, int i1, int j1, double t0, double t1,
                 const Visit& visit) {
  const auto square = [](double at, int low, int high) {
    return std::clamp(static_cast<int>(std::floor(at * (1.0 / size))), low, high - 1);
  };
  int i = square(ray.x + t0 * ray.dx, i0, i1);
  int j = square(ray.y + t0 * ray.dy, j0, j1);
  const int step_x = ray.dx >= 0 ? 1 : -1, step_y = ray.dy >= 0 ? 1 : -1;
  const int far_x = ray.dx >= 0 ? 1 : 0, far_y = ray.dy >= 0 ? 1 : 0;
  double next_x = ray.t_at_x((i + far_x) * size), next_y = ray.t_at_y((j + far_y) * size);
  double t = t0;
  for (;;) {
    const bool along_x = next_x < next_y;
    const double end = std::min(along_x ? next_x : next_y, t1);
    if (end > t || end == t1) {
      if (visit(i, j, t, std::max(t, end))) return true;
      t = std::max(t, end);
    }
    if (end >= t1) return false;
    if (along_x) {
      i += step_x;
      if (i < i0 || i >= i1) return false;
      next_x = ray.t_at_x((i + far_x) * size);
    } else {
      j += step_y;
      if (j < j0 || j >= j1) return false;
      next_y = ray.t_at_y((j + far_y) * size);
    }
  }
}

/// Height of a cell's top at (u, v), 0 .. 1 each, in the triangle below or above the diagonal.
double height_in(const CellTop& top, bool is_below, double u, double v) {
  const double a = static_cast<double>(top.a), b = static_cast<double>(top.b);
  const double c = static_cast<double>(top.c), d = static_cast<double>(top.d);
  if (top.is_rising)
    return is_below ? a + u * (b - a) + v * (c - b) : a + u * (c - d) + v * (d - a);
  return is_below ? a + u * (b - a) + v * (d - a) : c + (1 - u) * (d - c) + (1 - v) * (b - c);
}

/// Above 0 on the far side of the cell's diagonal ("below" in height_in is <= 0).
double side_of_diagonal(const CellTop& top, double u, double v) {
  return top.is_rising ? v - u : u + v - 1;
}

/// Where between t0 and t1 the ray gets below the cell's top; at t0 if it is below there already.
template <class GridRay>
inline bool meet_cell(const CellTop& top, const GridRay& ray, int i, int j, double t0, double t1,
                      double* t) {
  const double u0 = ray.x + t0 * ray.dx - i, v0 = ray.y + t0 * ray.dy - j;
  const double u1 = ray.x + t1 * ray.dx - i, v1 = ray.y + t1 * ray.dy - j;
  const double s0 = side_of_diagonal(top, u0, v0), s1 = side_of_diagonal(top, u1, v1);
  const double above0 = ray.z_at(t0) - height_in(top, s0 <= 0, u0, v0);
  if (above0 < 0) {
    *t = t0;
    return true;
  }
  double from_t = t0, above = above0;
  if ((s0 <= 0) != (s1 <= 0)) {
    const double middle_t = t0 + (t1 - t0) * (s0 / (s0 - s1));
    const double u = ray.x + middle_t * ray.dx - i, v = ray.y + middle_t * ray.dy - j;
    const double middle = ray.z_at(middle_t) - height_in(top, s0 <= 0, u, v);
    if (middle < 0) {
      *t = t0 + (middle_t - t0) * (above0 / (above0 - middle));
      return true;
    }
    from_t = middle_t;
    above = middle;
  }
  const double above1 = ray.z_at(t1) - height_in(top, s1 <= 0, u1, v1);
  if (above1 >= 0) return false;
  *t = from_t + (t1 - from_t) * (above / (above - above1));
  return true;
}

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// A cell's top where its corners are moved: x and y in cells from the grid's corner.
struct MovedTop {
  struct Triangle {
    std::array<std::size_t, 3> corner;  ///< counter-clockwise from above
  };
  std::array<Vec2, 4> at;
  std::array<double, 4> z;
  std::array<Triangle, 2> triangles;  ///< `below` the diagonal (height_in) and above it

  MovedTop(const CellTop& top, int i, int j)
      : at{Vec2(i, j), Vec2(i + 1, j), Vec2(i + 1, j + 1), Vec2(i, j + 1)},
        z{static_cast<double>(top.a), static_cast<double>(top.b), static_cast<double>(top.c),
          static_cast<double>(top.d)} {
    triangles[0] = {{0, 1, top.is_rising ? 2u : 3u}};
    triangles[1] = {{top.is_rising ? 0u : 1u, 2, 3}};
    for (std::size_t k = 0; top.moved != nullptr && k < 4; ++k) at[k] += Vec2(top.moved->shift[k]);
  }
  /// What share each corner of the triangle has in the point.
  std::array<double, 3> shares(const Triangle& triangle, const Vec2& point) const {
    const auto& [a, b, c] = triangle.corner;
    const double area = cross(at[b] - at[a], at[c] - at[a]);
    const double in_b = cross(point - at[a], at[c] - at[a]) / area;
    const double in_c = cross(at[b] - at[a], point - at[a]) / area;
    return {1 - in_b - in_c, in_b, in_c};
  }
  double height(const Triangle& triangle, const Vec2& point) const {
    const std::array<double, 3> share = shares(triangle, point);
    const auto& [a, b, c] = triangle.corner;
    return share[0] * z[a] + share[1] * z[b] + share[2] * z[c];
  }
  /// That in which a point of the top lies.
  const Triangle& triangle_at(const Vec2& point) const {
    const bool is_rising = triangles[0].corner[2] == 2;
    const Vec2 from = at[is_rising ? 0 : 1], to = at[is_rising ? 2 : 3];
    const bool is_left = cross(to - from, point - from) > 0;
    return triangles[is_left == is_rising ? 1 : 0];
  }
};

/// Cuts t0 .. t1 to where the ray is over the triangle; false if it never is.
template <class GridRay>
bool clip(const MovedTop& top, const MovedTop::Triangle& triangle, const GridRay& ray, double* t0,
          double* t1) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2& from = top.at[triangle.corner[k]];
    const Vec2 way = top.at[triangle.corner[(k + 1) % 3]] - from;
    const double inside = cross(way, Vec2(ray.x, ray.y) - from);
    const double change = cross(way, Vec2(ray.dx, ray.dy));
    if (change == 0) {
      if (inside < -kOnEdge) return false;
    } else if (change > 0) {
      *t0 = std::max(*t0, -inside / change);
    } else {
      *t1 = std::min(*t1, -inside / change);
    }
  }
  return *t0 <= *t1;
}

/// Least and greatest height of the grid's cells [i0, i1) x [j0, j1).
void extend_heights(const HeightGrid& grid, int i0, int j0, int i1, int j1, double* low,
                    double* high) {
  for (int j = std::max(0, j0); j < std::min(grid.ny(), j1); ++j) {
    for (int i = std::max(0, i0); i < std::min(grid.nx(), i1); ++i) {
      const auto z = static_cast<double>(grid.height(i, j));
      *low = std::min(*low, z);
      *high = std::max(*high, z);
    }
  }
}

/// Not brought to unit length, as OpenGL does before it mixes them.
glm::vec3 unpacked(std::uint32_t bits) {
  const auto value = [bits](int shift) {
    // The sign is bit 9 of ten.
    return static_cast<float>(static_cast<std::int32_t>(bits << (22 - shift)) >> 22);
  };
  return {value(0), value(10), value(20)};
}

/// Have cells of this block of the tile changed? Cells beyond the grid are never written.
bool differs(const float* a, const float* b, int block_x, int block_y) {
  constexpr int kFloats = HeightGrid::kBlockX * HeightGrid::kBlockY;
  constexpr int kWide = kBlockCells / HeightGrid::kBlockX * kFloats;
  constexpr int kRow = kCells / HeightGrid::kBlockX * kFloats;
  constexpr int kHigh = kBlockCells / HeightGrid::kBlockY;
  for (int row = block_y * kHigh; row < (block_y + 1) * kHigh; ++row) {
    const auto at = static_cast<std::size_t>(row * kRow + block_x * kWide);
    if (std::memcmp(a + at, b + at, kWide * sizeof(float)) != 0) return true;
  }
  return false;
}

}  // namespace

std::vector<Box> HeightSurface::changes(const HeightGrid& next, std::vector<int>* tiles) const {
  std::vector<Box> boxes;
  std::vector<bool> is_dirty(tiles_.size());
  const Box& bounds = next.bounds_mm();
  const auto add_block = [&](int i, int j) {
    const int i0 = i - kSurfaceReach, i1 = i + kBlockCells + kSurfaceReach;
    const int j0 = j - kSurfaceReach, j1 = j + kBlockCells + kSurfaceReach;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    extend_heights(*grid_, i0, j0, i1, j1, &low, &high);
    extend_heights(next, i0, j0, i1, j1, &low, &high);
    boxes.push_back({Vec3(bounds.min.x + i0 * cell_mm_.x, bounds.min.y + j0 * cell_mm_.y, low),
                     Vec3(bounds.min.x + i1 * cell_mm_.x, bounds.min.y + j1 * cell_mm_.y, high)});
    for (int ty = std::max(0, j0) / kCells; ty <= std::min(next.ny() - 1, j1 - 1) / kCells; ++ty)
      for (int tx = std::max(0, i0) / kCells; tx <= std::min(next.nx() - 1, i1 - 1) / kCells; ++tx)
        is_dirty[static_cast<std::size_t>(ty * tiles_x_ + tx)] = true;
  };
  for (int ty = 0; ty < tiles_y_; ++ty) {
    for (int tx = 0; tx < tiles_x_; ++tx) {
      const float *before = grid_->tile(tx, ty), *after = next.tile(tx, ty);
      if (before == after) continue;
      for (int y = 0; y < SurfaceTile::kBlocks; ++y)
        for (int x = 0; x < SurfaceTile::kBlocks; ++x)
          if (differs(before, after, x, y))
            add_block(tx * kCells + x * kBlockCells, ty * kCells + y * kBlockCells);
    }
  }
  for (std::size_t n = 0; n < is_dirty.size(); ++n)
    if (is_dirty[n]) tiles->push_back(static_cast<int>(n));
  return boxes;
}

std::vector<Box> HeightSurface::update(std::shared_ptr<const HeightGrid> grid, int threads) {
  if (grid == grid_) return {};
  std::vector<Box> boxes;
  std::vector<int> dirty;
  const bool is_alike = grid && grid_ && grid->nx() == grid_->nx() && grid->ny() == grid_->ny() &&
                        grid->bounds_mm() == grid_->bounds_mm();
  if (is_alike) {
    boxes = changes(*grid, &dirty);
    grid_ = std::move(grid);
  } else {
    for (const HeightGrid* one : {grid_.get(), grid.get()})
      if (one) boxes.push_back(one->bounds_mm());
    grid_ = std::move(grid);
    tiles_x_ = grid_ ? grid_->tiles_x() : 0;
    tiles_y_ = grid_ ? grid_->tiles_y() : 0;
    if (grid_) cell_mm_ = {grid_->cell_x_mm(), grid_->cell_y_mm()};
    per_cell_mm_ = 1.0 / cell_mm_;
    tiles_.clear();
    tiles_.resize(static_cast<std::size_t>(tiles_x_ * tiles_y_));
    tile_tops_.resize(tiles_.size());
    for (int n = 0; n < tiles_x_ * tiles_y_; ++n) dirty.push_back(n);
  }
  make_tiles(dirty, threads);
  return boxes;
}

void HeightSurface::make_tiles(const std::vector<int>& tiles, int threads) {
  constexpr std::size_t kLeastForTwo = 4;
  for_each_piece(tiles.size(), threads, kLeastForTwo, [&](std::size_t n) {
    const auto at = static_cast<std::size_t>(tiles[n]);
    tiles_[at] = make_surface_tile(*grid_, tiles[n] % tiles_x_, tiles[n] / tiles_x_);
    tile_tops_[at] = tiles_[at].top;
  });
  top_ = SurfaceTile::kNothing;
  for (const float top : tile_tops_) top_ = std::max(top_, top);
}

HeightSurface::GridRay HeightSurface::to_grid(const Ray& ray) const {
  const Vec3& corner = grid_->bounds_mm().min;
  GridRay out;
  out.x = (ray.origin_mm.x - corner.x) * per_cell_mm_.x;
  out.y = (ray.origin_mm.y - corner.y) * per_cell_mm_.y;
  out.z = ray.origin_mm.z;
  const auto moved = [](double d) { return std::abs(d) < kStill ? 0.0 : d; };
  out.dx = moved(ray.direction_mm.x * per_cell_mm_.x);
  out.dy = moved(ray.direction_mm.y * per_cell_mm_.y);
  out.dz = moved(ray.direction_mm.z);
  out.per_dx = 1.0 / (out.dx == 0 ? kStill : out.dx);
  out.per_dy = 1.0 / (out.dy == 0 ? kStill : out.dy);
  out.per_dz = 1.0 / (out.dz == 0 ? kStill : out.dz);
  out.t_min = ray.t_min;
  return out;
}

/// Cuts the ray to the box from the floor to the greatest height.
bool HeightSurface::enter(const GridRay& ray, double* t0, double* t1, bool* through_floor) const {
  double in = ray.t_min, out = std::numeric_limits<double>::infinity();
  const auto cut = [&](double low, double high, double at, double d, double per_d) {
    if (d == 0) return at >= low && at <= high;
    const double a = (low - at) * per_d, b = (high - at) * per_d;
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
    return in < out;
  };
  const auto floor = static_cast<double>(grid_->floor_mm());
  if (!cut(floor, static_cast<double>(top_), ray.z, ray.dz, ray.per_dz)) return false;
  const double in_z = in;
  if (!cut(0, grid_->nx(), ray.x, ray.dx, ray.per_dx)) return false;
  if (!cut(0, grid_->ny(), ray.y, ray.dy, ray.per_dy)) return false;
  if (!(in < out)) return false;
  *t0 = in;
  *t1 = out;
  *through_floor = ray.dz > 0 && in == in_z && in > ray.t_min;
  return true;
}

CellTop HeightSurface::cell(int i, int j) const {
  const SurfaceTile& at = tile(i / kCells, j / kCells);
  if (!at.detail) return {at.top, at.top, at.top, at.top, at.top > SurfaceTile::kNothing, true};
  return cell_top(*at.detail, i % kCells, j % kCells);
}

template <class Visit>
void HeightSurface::visit_about(int i, int j, const Visit& visit) const {
  for (int y = std::max(0, j - 1); y <= std::min(grid_->ny() - 1, j + 1); ++y) {
    for (int x = std::max(0, i - 1); x <= std::min(grid_->nx() - 1, i + 1); ++x) {
      const CellTop top = cell(x, y);
      if (top.is_solid) visit(x, y, top);
    }
  }
}

/// As meet_cell, between where the ray comes into the square of a cell with moved corners and where
/// it leaves it.
bool HeightSurface::meet_moved(const GridRay& ray, int i, int j, double t0, double t1,
                               SurfaceHit* hit) const {
  double nearest = std::numeric_limits<double>::infinity();
  const auto meet = [&](int x, int y, double t) {
    if (t < nearest) *hit = {nearest = t, x, y, false};
  };
  visit_about(i, j, [&](int x, int y, const CellTop& cell_top) {
    const MovedTop top(cell_top, x, y);
    for (const MovedTop::Triangle& triangle : top.triangles) {
      double from = t0, to = t1;
      if (!clip(top, triangle, ray, &from, &to)) continue;
      const auto above = [&](double t) {
        return ray.z_at(t) - top.height(triangle, Vec2(ray.x + t * ray.dx, ray.y + t * ray.dy));
      };
      const double above0 = above(from), above1 = above(to);
      if (above0 < 0) {
        meet(x, y, from);
      } else if (above1 < 0) {
        meet(x, y, from + (to - from) * (above0 / (above0 - above1)));
      }
    }
  });
  return nearest < std::numeric_limits<double>::infinity();
}

/// Whether a point of the floor is below a cell with material, and below which.
bool HeightSurface::is_over_material(const Vec2& at, int* i, int* j) const {
  *i = std::clamp(static_cast<int>(at.x), 0, grid_->nx() - 1);
  *j = std::clamp(static_cast<int>(at.y), 0, grid_->ny() - 1);
  const CellTop own = cell(*i, *j);
  if (own.moved == nullptr) return own.is_solid;
  bool is_found = false;
  visit_about(*i, *j, [&](int x, int y, const CellTop& cell_top) {
    const MovedTop top(cell_top, x, y);
    const auto is_over = [&](const MovedTop::Triangle& triangle) {
      const std::array<double, 3> share = top.shares(triangle, at);
      return std::min({share[0], share[1], share[2]}) >= -kOnEdge;
    };
    if (is_found || !(is_over(top.triangles[0]) || is_over(top.triangles[1]))) return;
    is_found = true;
    *i = x;
    *j = y;
  });
  return is_found;
}

bool HeightSurface::trace(const Ray& world_ray, SurfaceHit* hit) const {
  if (!grid_) return false;
  const GridRay ray = to_grid(world_ray);
  double t0, t1;
  bool through_floor = false;
  if (!enter(ray, &t0, &t1, &through_floor)) return false;
  if (through_floor) {
    int i, j;
    if (is_over_material(Vec2(ray.x + t0 * ray.dx, ray.y + t0 * ray.dy), &i, &j)) {
      *hit = {t0, i, j, true};
      return true;
    }
  }
  const auto passes_above = [&ray](double from, double to, float top) {
    return std::min(ray.z_at(from), ray.z_at(to)) > static_cast<double>(top);
  };
  const auto in_tile = [&](int tx, int ty, double from, double to) {
    const std::size_t number = static_cast<std::size_t>(ty * tiles_x_ + tx);
    if (passes_above(from, to, tile_tops_[number])) return false;
    const SurfaceTile::Detail* const detail = tiles_[number].detail.get();
    const float* const tops = tiles_[number].block_top.data();
    const auto in_block = [&](int bx, int by, double block_from, double block_to) {
      const int x = bx % SurfaceTile::kBlocks, y = by % SurfaceTile::kBlocks;
      if (passes_above(block_from, block_to, tops[y * SurfaceTile::kBlocks + x])) return false;
      const auto in_cell = [&](int i, int j, double cell_from, double cell_to) {
        const CellTop top = detail ? cell_top(*detail, i % kCells, j % kCells) : cell(i, j);
        if (top.moved != nullptr) [[unlikely]]
          return meet_moved(ray, i, j, cell_from, cell_to, hit);
        if (!top.is_solid) return false;
        const float high = std::max(std::max(top.a, top.b), std::max(top.c, top.d));
        if (passes_above(cell_from, cell_to, high)) return false;
        if (!meet_cell(top, ray, i, j, cell_from, cell_to, &hit->t)) return false;
        hit->i = i;
        hit->j = j;
        hit->floor = false;
        return true;
      };
      return walk<1>(ray, bx * kBlockCells, by * kBlockCells,
                     std::min((bx + 1) * kBlockCells, grid_->nx()),
                     std::min((by + 1) * kBlockCells, grid_->ny()), block_from, block_to, in_cell);
    };
    return walk<kBlockCells>(
        ray, tx * SurfaceTile::kBlocks, ty * SurfaceTile::kBlocks,
        std::min((tx + 1) * SurfaceTile::kBlocks, (grid_->nx() + kBlockCells - 1) / kBlockCells),
        std::min((ty + 1) * SurfaceTile::kBlocks, (grid_->ny() + kBlockCells - 1) / kBlockCells),
        from, to, in_block);
  };
  return walk<kCells>(ray, 0, 0, tiles_x_, tiles_y_, t0, t1, in_tile);
}

glm::vec3 HeightSurface::normal(const Ray& world_ray, const SurfaceHit& hit) const {
  if (hit.floor) return {0, 0, -1};
  const GridRay ray = to_grid(world_ray);
  const double u = std::clamp(ray.x + hit.t * ray.dx - hit.i, 0.0, 1.0);
  const double v = std::clamp(ray.y + hit.t * ray.dy - hit.j, 0.0, 1.0);
  const CellTop top = cell(hit.i, hit.j);
  if (top.moved != nullptr) return moved_normal(ray, hit, top);
  const bool is_below = side_of_diagonal(top, u, v) <= 0;
  const double z = ray.z_at(hit.t);
  if (height_in(top, is_below, u, v) - z > kLeastWall * std::min(cell_mm_.x, cell_mm_.y)) {
    // The side by which the ray came in last.
    const int step_x = ray.dx >= 0 ? 1 : -1, step_y = ray.dy >= 0 ? 1 : -1;
    const bool across_x = ray.t_at_x(hit.i + (step_x < 0)) >= ray.t_at_y(hit.j + (step_y < 0));
    return wall_normal(hit.i, hit.j, across_x, across_x ? step_x : step_y, across_x ? v : u);
  }
  return top_normal(hit.i, hit.j, top, u, v);
}

std::optional<glm::vec3> HeightSurface::normal_beside(const Ray& world_ray, double t,
                                                      double within_mm) const {
  const GridRay ray = to_grid(world_ray);
  const double x = ray.x + t * ray.dx, y = ray.y + t * ray.dy;
  const double i = std::floor(x), j = std::floor(y);
  if (!(i >= 0 && j >= 0 && i < grid_->nx() && j < grid_->ny())) return std::nullopt;
  const CellTop top = cell(static_cast<int>(i), static_cast<int>(j));
  if (top.moved != nullptr || !top.is_solid) return std::nullopt;
  const double u = x - i, v = y - j;
  const double height = height_in(top, side_of_diagonal(top, u, v) <= 0, u, v);
  if (std::abs(height - ray.z_at(t)) > within_mm) return std::nullopt;
  return top_normal(static_cast<int>(i), static_cast<int>(j), top, u, v);
}

/// Between the normals of a cell's corners.
glm::vec3 HeightSurface::top_normal(int i, int j, const CellTop& top, double u, double v) const {
  const SurfaceTile& at = tile(i / kCells, j / kCells);
  if (!at.detail) return {0, 0, 1};
  const bool is_below = side_of_diagonal(top, u, v) <= 0;
  const int x = i % kCells, y = j % kCells;
  std::array<std::uint32_t, 4> packed;
  const auto code = at.detail->code[static_cast<std::size_t>(y * kCells + x)];
  if (code >> 2 != 0) {
    packed = at.detail->splits[(code >> 2) - 1u].normal;
  } else {
    const std::uint32_t* const low =
        at.detail->normal.data() + static_cast<std::size_t>(y * (kCells + 1) + x);
    packed = {low[0], low[1], low[kCells + 2], low[kCells + 1]};
  }
  const glm::vec3 a = unpacked(packed[0]), b = unpacked(packed[1]);
  const glm::vec3 c = unpacked(packed[2]), d = unpacked(packed[3]);
  const auto p = static_cast<float>(u), q = static_cast<float>(v);
  glm::vec3 sum;
  if (top.is_rising) {
    sum = is_below ? a + p * (b - a) + q * (c - b) : a + p * (c - d) + q * (d - a);
  } else {
    sum = is_below ? a + p * (b - a) + q * (d - a) : c + (1 - p) * (d - c) + (1 - q) * (b - c);
  }
  return glm::normalize(sum);
}

glm::vec3 HeightSurface::moved_normal(const GridRay& ray, const SurfaceHit& hit,
                                      const CellTop& cell_top) const {
  const MovedTop top(cell_top, hit.i, hit.j);
  const Vec2 point(ray.x + hit.t * ray.dx, ray.y + hit.t * ray.dy);
  const MovedTop::Triangle& triangle = top.triangle_at(point);
  if (top.height(triangle, point) - ray.z_at(hit.t) <=
      kLeastWall * std::min(cell_mm_.x, cell_mm_.y)) {
    const std::array<double, 3> share = top.shares(triangle, point);
    glm::vec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k)
      sum += static_cast<float>(share[k]) * unpacked(cell_top.moved->normal[triangle.corner[k]]);
    return glm::normalize(sum);
  }
  // By the side that the point lies on, of those by which the ray can come in.
  std::size_t side = 4;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 way = top.at[(k + 1) % 4] - top.at[k];
    const double off = std::abs(cross(way, point - top.at[k])) / glm::length(way);
    if (cross(way, Vec2(ray.dx, ray.dy)) <= 0 || off >= nearest) continue;
    nearest = off;
    side = k;
  }
  if (side == 4) return {0, 0, 1};  // straight down
  const Vec2 way = top.at[(side + 1) % 4] - top.at[side];
  const double along = std::clamp(glm::dot(point - top.at[side], way) / glm::dot(way, way), 0., 1.);
  const bool across_x = side % 2 == 1;
  return wall_normal(hit.i, hit.j, across_x, side == 0 || side == 3 ? 1 : -1,
                     side < 2 ? along : 1 - along);
}

/// Of the wall by which a ray came into cell (i, j) across x (or y), in direction `step`, at
/// `along` 0 .. 1 of the edge: between the directions of the wall at the edge's two ends.
glm::vec3 HeightSurface::wall_normal(int i, int j, bool across_x, int step, double along) const {
  const glm::vec2 outward = across_x ? glm::vec2(-step, 0) : glm::vec2(0, -step);
  const int other_i = across_x ? i - step : i, other_j = across_x ? j : j - step;
  if (!grid_->contains(other_i, other_j)) return {outward, 0};
  const float middle = 0.5f * (grid_->height(i, j) + grid_->height(other_i, other_j));
  const WallCourse course(
      std::max(i, other_i), std::max(j, other_j), across_x, middle, WallCourse::kMaxReach,
      [this](int x, int y) { return grid_->height(x, y); },
      [this](int x, int y) { return grid_->contains(x, y); });
  const glm::vec2 way = glm::mix(course.facing(false, outward), course.facing(true, outward),
                                 static_cast<float>(along));
  return {glm::normalize(way), 0};
}

}  // namespace kerf
