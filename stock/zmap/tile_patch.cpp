#include "stock/zmap/tile_patch.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "stock/stock_model.h"
#include "stock/zmap/tile_cut_ids.h"
#include "surface/tile_relief.h"

namespace kerf {
namespace {

/// Quadrants of a corner, as TileRelief counts them.
enum Quadrant : std::size_t { kA, kB, kC, kD };

/// Squares of fewer cells are not looked at for being level.
constexpr int kLeastSquare = 8;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Added to the number of a split corner where otherwise the number of a vertex is.
constexpr std::uint32_t kSplitCorner = std::uint32_t{1} << 31;

/// Cracks between tiles of different levels are about as deep as the surface is steep.
constexpr float kCrack_cells = 4;

/// On which sides the tile has neighbours, and how far skirts go down there.
struct Side {
  bool has_neighbor = false;
  glm::vec2 outward{0};
  float skirt_end_mm = 0;
};
struct Sides {
  Side left, right, low, high;
};

class PatchBuilder {
 public:
  /// `cut_ids` is null where they are not kept.
  PatchBuilder(const TileRelief& relief, const TileCutIds* cut_ids, const Sides& sides,
               MeshPatch& patch)
      : r_(relief), cut_ids_(cut_ids), sides_(sides), patch_(patch) {
    top_.fill(kNone);
    bottom_.fill(kNone);
    const std::size_t corners =
        static_cast<std::size_t>(r_.nx() + 1) * static_cast<std::size_t>(r_.ny() + 1);
    patch_.vertices.reserve(corners + corners / 4);
    patch_.indices.reserve(7 * corners);
    if (cut_ids_) patch_.cut_by.reserve(corners + corners / 4);
  }

  void add_surface();
  void add_skirts();

 private:
  struct SplitCorner {
    TileRelief::Split split;
    glm::vec2 xy_mm;  ///< where the wall has its course
    std::array<std::uint32_t, 4> vertex{kNone, kNone, kNone, kNone};  ///< by group
  };
  using Ring = std::array<std::uint32_t, 4 * kTileCells>;

  std::uint32_t add_vertex(const glm::vec2& xy, float z, std::uint32_t normal) {
    patch_.vertices.push_back({{xy, z}, normal});
    return static_cast<std::uint32_t>(patch_.vertices.size() - 1);
  }
  glm::vec2 unmoved(int i, int j) const { return {r_.x(i), r_.y(j)}; }
  /// Of all that stands above each other at a corner.
  glm::vec2 place_of(int i, int j) {
    return r_.is_split(TileRelief::slot(i, j)) ? split_corner(i, j).xy_mm : unmoved(i, j);
  }
  /// Much cheaper than vector::insert() for so few.
  template <std::size_t kCount>
  void append_indices(const std::array<std::uint32_t, kCount>& indices) {
    const std::size_t size = patch_.indices.size();
    patch_.indices.resize(size + kCount);
    std::copy(indices.begin(), indices.end(), patch_.indices.data() + size);
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    append_indices<3>({a, b, c});
  }

  std::uint32_t cut_by(int cell) const {
    return cut_ids_ ? cut_ids_->of(cell) : MeshPatch::kNotCut;
  }
  void set_cut_by(std::uint32_t vertex, std::uint32_t id);
  template <class InGroup>
  std::uint32_t cut_by_at(int corner, const InGroup& in_group) const;
  void set_cut_by_of_corners();

  SplitCorner& split_corner(int i, int j);
  float z_at(int i, int j, Quadrant q);
  std::uint32_t top_vertex(int i, int j, Quadrant q) {
    const int corner = TileRelief::slot(i, j);
    std::uint32_t& vertex = top_[static_cast<std::size_t>(corner)];
    if (vertex < kSplitCorner) return vertex;
    if (r_.is_split(corner)) [[unlikely]]
      return split_vertex(i, j, q);
    return vertex = add_vertex(unmoved(i, j), r_.corner_z(corner), r_.corner_normal(corner));
  }
  [[gnu::noinline]] std::uint32_t split_vertex(int i, int j, Quadrant q);
  /// Vertices of a cell, counter-clockwise from low x, y.
  std::array<std::uint32_t, 4> cell_corners(int i, int j) {
    const std::uint32_t* const row = top_.data() + TileRelief::slot(i, j);
    const std::array<std::uint32_t, 4> known{row[0], row[1], row[TileRelief::kStride + 1],
                                             row[TileRelief::kStride]};
    if ((known[0] | known[1] | known[2] | known[3]) < kSplitCorner) [[likely]]
      return known;
    return {top_vertex(i, j, kC), top_vertex(i + 1, j, kD), top_vertex(i + 1, j + 1, kA),
            top_vertex(i, j + 1, kB)};
  }
  std::uint32_t bottom_vertex(int i, int j);

  bool is_level(int i, int j, int size) const;
  /// A corner of the cell's.
  bool may_be_moved(int cell) const {
    const std::uint32_t* const row = top_.data() + cell;
    return (row[0] | row[1] | row[TileRelief::kStride] | row[TileRelief::kStride + 1]) >=
           kSplitCorner;
  }
  bool is_rising(int i, int j, const std::array<std::uint32_t, 4>& corners, float height) const;
  template <class Corner>
  void add_fan(int i, int j, int width, int height, std::uint32_t center, bool upward,
               const Corner& corner);
  void add_square(int i, int j, int size);
  void add_cells(int first_i, int first_j, int last_i, int last_j);
  bool is_seen_from(std::uint32_t center);
  void add_floor();

  struct WallEnd;
  void add_walls();
  void add_wall(int cell, bool along_y, int i, int j, bool owned_if_lower, bool owned_if_higher);
  WallEnd wall_end(int i, int j, Quadrant upper, Quadrant lower);
  /// A corner on the tile's border, and the quadrants of the cells within and beyond it.
  struct BorderEnd {
    int i, j;
    Quadrant inner, outer;
  };
  void add_skirt(const Side& side, int outer_cell, bool is_linked, const BorderEnd& from,
                 const BorderEnd& to);

  const TileRelief& r_;
  const TileCutIds* cut_ids_;
  Sides sides_;
  MeshPatch& patch_;
  std::array<std::uint32_t, TileRelief::kSlots> top_;  ///< or kSplitCorner + which
  std::array<std::uint32_t, TileRelief::kSlots> bottom_;
  std::vector<SplitCorner> splits_;
};

/// Vertices that are passed over count as not cut.
void PatchBuilder::set_cut_by(std::uint32_t vertex, std::uint32_t id) {
  if (!cut_ids_) return;
  if (patch_.cut_by.size() <= vertex) patch_.cut_by.resize(vertex + 1, MeshPatch::kNotCut);
  patch_.cut_by[vertex] = id;
}

/// Of the cells about a corner that meet there, the lowest one's: as with walls and levels, and
/// the same from either side of a border between tiles.
template <class InGroup>
std::uint32_t PatchBuilder::cut_by_at(int corner, const InGroup& in_group) const {
  const std::array<int, 4> cells = TileRelief::cells_about(corner);
  int lowest = -1;
  for (std::size_t q = 0; q < 4; ++q) {
    if (!in_group(q)) continue;
    if (lowest < 0 || r_.height(cells[q]) < r_.height(lowest)) lowest = cells[q];
  }
  return cut_by(lowest);
}

/// Those that are not split: all at once, so that their vertices are made without a look at it.
void PatchBuilder::set_cut_by_of_corners() {
  patch_.cut_by.resize(patch_.vertices.size(), MeshPatch::kNotCut);
  for (int j = 0; j <= r_.ny(); ++j) {
    for (int i = 0; i <= r_.nx(); ++i) {
      const int corner = TileRelief::slot(i, j);
      const std::uint32_t vertex = top_[static_cast<std::size_t>(corner)];
      if (vertex < kSplitCorner)
        patch_.cut_by[vertex] = cut_by_at(corner, [](std::size_t) { return true; });
    }
  }
}

PatchBuilder::SplitCorner& PatchBuilder::split_corner(int i, int j) {
  const int corner = TileRelief::slot(i, j);
  std::uint32_t& number = top_[static_cast<std::size_t>(corner)];
  if (number == kNone) {
    number = kSplitCorner + static_cast<std::uint32_t>(splits_.size());
    splits_.push_back({r_.split(corner), unmoved(i, j) + r_.shift_mm(i, j)});
  }
  return splits_[number - kSplitCorner];
}

float PatchBuilder::z_at(int i, int j, Quadrant q) {
  const int corner = TileRelief::slot(i, j);
  return r_.is_split(corner) ? split_corner(i, j).split.z[q] : r_.corner_z(corner);
}

std::uint32_t PatchBuilder::split_vertex(int i, int j, Quadrant q) {
  SplitCorner& at = split_corner(i, j);
  std::uint32_t& vertex = at.vertex[at.split.group[q]];
  if (vertex == kNone) {
    const glm::vec2 slope = at.split.slope[q];
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x, -slope.y, 1));
    vertex = add_vertex(at.xy_mm, at.split.z[q], pack_normal(normal));
    const auto in_group = [&](std::size_t r) { return at.split.group[r] == at.split.group[q]; };
    set_cut_by(vertex, cut_by_at(TileRelief::slot(i, j), in_group));
  }
  return vertex;
}

std::uint32_t PatchBuilder::bottom_vertex(int i, int j) {
  std::uint32_t& vertex = bottom_[static_cast<std::size_t>(TileRelief::slot(i, j))];
  if (vertex == kNone) {
    // Moved with the walls that reach the floor: those about a cell without material.
    const std::array<int, 4> cells = TileRelief::cells_about(TileRelief::slot(i, j));
    const bool has_hole =
        std::any_of(cells.begin(), cells.end(), [&](int cell) { return !r_.solid(cell); });
    vertex =
        add_vertex(has_hole ? place_of(i, j) : unmoved(i, j), r_.floor(), pack_normal({0, 0, -1}));
  }
  return vertex;
}

/// Cells of the square and around it all have one height, above the floor, and were cut by one
/// move.
bool PatchBuilder::is_level(int i, int j, int size) const {
  const float z = r_.height(TileRelief::slot(i, j));
  if (!(z > r_.floor())) return false;
  const std::uint32_t id = cut_by(TileRelief::slot(i, j));
  for (int y = j - 1; y <= j + size; ++y) {
    bool same = true;
    for (int x = i - 1; x <= i + size; ++x) same &= r_.height(TileRelief::slot(x, y)) == z;
    for (int x = i - 1; x <= i + size && cut_ids_; ++x)
      same &= cut_by(TileRelief::slot(x, y)) == id;
    if (!same) return false;
  }
  return true;
}

/// Triangles from `center` to every corner on the rim of a rectangle of cells.
template <class Corner>
void PatchBuilder::add_fan(int i, int j, int width, int height, std::uint32_t center, bool upward,
                           const Corner& corner) {
  Ring ring;
  std::size_t count = 0;
  for (int k = 0; k < width; ++k) ring[count++] = corner(i + k, j);
  for (int k = 0; k < height; ++k) ring[count++] = corner(i + width, j + k);
  for (int k = width; k > 0; --k) ring[count++] = corner(i + k, j + height);
  for (int k = height; k > 0; --k) ring[count++] = corner(i, j + k);
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t a = ring[n], b = ring[n + 1 < count ? n + 1 : 0];
    add_triangle(center, upward ? a : b, upward ? b : a);
  }
}

void PatchBuilder::add_square(int i, int j, int size) {
  if (i >= r_.nx() || j >= r_.ny()) return;
  const bool whole = i + size <= r_.nx() && j + size <= r_.ny();
  if (whole && size >= kLeastSquare && is_level(i, j, size)) {
    const std::uint32_t up = pack_normal({0, 0, 1});
    const int middle = size / 2;
    const int first = TileRelief::slot(i, j);
    const glm::vec2 xy = unmoved(i + middle, j + middle);
    const std::uint32_t center = add_vertex(xy, r_.height(first), up);
    set_cut_by(center, cut_by(first));
    add_fan(i, j, size, size, center, true, [&](int x, int y) { return top_vertex(x, y, kA); });
    return;
  }
  if (size > kLeastSquare) {
    const int half = size / 2;
    for (const int y : {j, j + half})
      for (const int x : {i, i + half}) add_square(x, y, half);
    return;
  }
  add_cells(i, j, std::min(i + size, r_.nx()), std::min(j + size, r_.ny()));
}

/// Cells first_i .. last_i - 1 by first_j .. last_j - 1, two triangles each.
void PatchBuilder::add_cells(int first_i, int first_j, int last_i, int last_j) {
  for (int j = first_j; j <= last_j; ++j) {
    for (int i = first_i; i <= last_i; ++i) {
      const int corner =
          TileRelief::slot(i, j);  // where it is not split, all cells are solid or none
      if (!r_.is_split(corner) && r_.solid(corner)) top_vertex(i, j, kC);
    }
  }
  // Room for all of them at once: cheaper than to look for it with every triangle.
  const std::size_t size = patch_.indices.size();
  const std::size_t cells = static_cast<std::size_t>((last_i - first_i) * (last_j - first_j));
  patch_.indices.resize(size + 6 * cells);
  std::uint32_t* out = patch_.indices.data() + size;
  for (int j = first_j; j < last_j; ++j) {
    for (int i = first_i; i < last_i; ++i) {
      const int cell = TileRelief::slot(i, j);
      if (!r_.solid(cell)) continue;
      const std::array<std::uint32_t, 4> corners = cell_corners(i, j);
      const auto [a, b, c, d] = corners;
      const auto z = [&](std::uint32_t v) { return patch_.vertices[v].position_mm.z; };
      const bool rising = may_be_moved(cell)
                              ? is_rising(i, j, corners, r_.height(cell))
                              : has_rising_diagonal({z(a), z(b), z(c), z(d)}, 2 * r_.height(cell));
      out[0] = a;
      out[1] = b;
      out[2] = rising ? c : d;
      out[3] = rising ? a : b;
      out[4] = c;
      out[5] = d;
      out += 6;
    }
  }
  patch_.indices.resize(static_cast<std::size_t>(out - patch_.indices.data()));
}

/// Whether that face of the cell is divided from its low x, y.
bool PatchBuilder::is_rising(int i, int j, const std::array<std::uint32_t, 4>& corners,
                             float height) const {
  std::array<float, 4> z;
  for (std::size_t k = 0; k < 4; ++k) z[k] = patch_.vertices[corners[k]].position_mm.z;
  std::array<glm::vec2, 4> shift;
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::vec2 unmoved_mm = unmoved(i + (k == 1 || k == 2 ? 1 : 0), j + (k > 1 ? 1 : 0));
    shift[k] = (glm::vec2(patch_.vertices[corners[k]].position_mm) - unmoved_mm) / r_.size_mm(i, j);
  }
  return has_rising_diagonal(z, 2 * height, shift);
}

/// Whether a fan may fill the tile's floor: corners on its border may be moved.
bool PatchBuilder::is_seen_from(std::uint32_t center) {
  const auto at = [&](int i, int j) {
    return glm::vec2(patch_.vertices[bottom_vertex(i, j)].position_mm);
  };
  const glm::vec2 from(patch_.vertices[center].position_mm);
  const auto is_left = [&](const glm::vec2& a, const glm::vec2& b) {
    const glm::vec2 p = a - from, q = b - from;
    return p.x * q.y - p.y * q.x > 0;
  };
  const int nx = r_.nx(), ny = r_.ny();
  bool is_seen = true;
  for (int i = 0; i < nx; ++i)
    is_seen = is_seen && is_left(at(i, 0), at(i + 1, 0)) && is_left(at(i + 1, ny), at(i, ny));
  for (int j = 0; j < ny; ++j)
    is_seen = is_seen && is_left(at(nx, j), at(nx, j + 1)) && is_left(at(0, j + 1), at(0, j));
  return is_seen;
}

void PatchBuilder::add_floor() {
  bool whole = true;
  for (int j = 0; j < r_.ny(); ++j)
    for (int i = 0; i < r_.nx(); ++i) whole &= r_.solid(TileRelief::slot(i, j));
  const auto corner = [&](int i, int j) { return bottom_vertex(i, j); };
  if (whole && r_.nx() > 1 && r_.ny() > 1) {
    const std::uint32_t center = bottom_vertex(r_.nx() / 2, r_.ny() / 2);
    if (is_seen_from(center)) return add_fan(0, 0, r_.nx(), r_.ny(), center, false, corner);
  }
  for (int j = 0; j < r_.ny(); ++j) {
    for (int i = 0; i < r_.nx(); ++i) {
      if (!r_.solid(TileRelief::slot(i, j))) continue;
      const std::array<std::uint32_t, 4> v{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                           corner(i, j + 1)};
      const bool rising = is_rising(i, j, v, r_.floor());
      add_triangle(v[0], v[rising ? 2 : 3], v[1]);
      add_triangle(v[rising ? 0 : 1], v[3], v[2]);
    }
  }
}

/// One vertical edge of a wall: heights from that of the first cell to that of the second; between
/// them those of the other cells at this corner, since walls between those end there.
struct PatchBuilder::WallEnd {
  int i, j;
  std::array<float, 4> z;
  std::size_t count = 0;
  std::array<std::uint32_t, 4> vertex;
};

PatchBuilder::WallEnd PatchBuilder::wall_end(int i, int j, Quadrant first, Quadrant second) {
  WallEnd end{i, j, {}, 0, {}};
  const int corner = TileRelief::slot(i, j);
  end.z[end.count++] = z_at(i, j, first);
  if (!r_.is_split(corner)) return end;
  const std::array<float, 4> all = split_corner(i, j).split.z;
  const float last = all[second];
  const bool down = last < end.z[0];
  for (;;) {
    std::optional<float> next;  // the nearest that lies beyond the present one
    for (const float z : all) {
      const float at = end.z[end.count - 1];
      const bool between = down ? z < at && z >= last : z > at && z <= last;
      if (between && (!next || (down ? z > *next : z < *next))) next = z;
    }
    if (!next) return end;
    end.z[end.count++] = *next;
  }
}

/// The wall between `cell` and the one before it in x (along_y) or in y, if this tile has it.
void PatchBuilder::add_wall(int cell, bool along_y, int i, int j, bool owned_if_lower,
                            bool owned_if_higher) {
  const int before = along_y ? cell - 1 : cell - TileRelief::kStride;
  if (along_y ? r_.linked_x(before) : r_.linked_y(before)) return;
  // Seen along the edge, the first cell is at the left: walls along x are turned by a quarter.
  WallEnd low = along_y ? wall_end(i, j, kD, kC) : wall_end(i + 1, j, kA, kD);
  WallEnd high = along_y ? wall_end(i, j + 1, kA, kB) : wall_end(i, j, kB, kC);
  if (low.count + high.count == 2) return;
  const float first = low.z[0] + high.z[0];
  const float second = low.z[low.count - 1] + high.z[high.count - 1];
  const bool first_is_higher = first >= second;
  if (first_is_higher ? !owned_if_lower : !owned_if_higher) return;

  // Made by what lowered the lower side; a side of the blank by nothing.
  const std::uint32_t made_by = cut_by(r_.height(cell) < r_.height(before) ? cell : before);
  const glm::vec2 axis(along_y ? 1 : 0, along_y ? 0 : 1);
  const glm::vec2 outward = first_is_higher ? axis : -axis;
  // A side of the blank is flat to its very end.
  const bool side =
      along_y
          ? (i == 0 && !sides_.left.has_neighbor) || (i == r_.nx() && !sides_.right.has_neighbor)
          : (j == 0 && !sides_.low.has_neighbor) || (j == r_.ny() && !sides_.high.has_neighbor);
  std::array<glm::vec2, 2> facing{outward, outward};
  if (!side) {
    const WallCourse course = r_.wall_course(i, j, along_y);
    facing = {course.facing(false, outward), course.facing(true, outward)};
  }
  for (WallEnd* end : {&low, &high}) {
    const glm::vec2 xy = place_of(end->i, end->j);
    const bool is_higher = along_y ? end->j > j : end->i > i;
    const std::uint32_t normal = pack_normal(glm::vec3(facing[is_higher], 0));
    for (std::size_t n = 0; n < end->count; ++n) {
      end->vertex[n] = add_vertex(xy, end->z[n], normal);
      set_cut_by(end->vertex[n], made_by);
    }
  }
  // A zip from the first cell's edge to the second's.
  std::size_t p = 0, q = 0;
  while (p + 1 < low.count || q + 1 < high.count) {
    if (q + 1 == high.count || (p + 1 < low.count && p <= q)) {
      add_triangle(low.vertex[p + 1], high.vertex[q], low.vertex[p]);
      ++p;
    } else {
      add_triangle(high.vertex[q + 1], high.vertex[q], low.vertex[p]);
      ++q;
    }
  }
}

void PatchBuilder::add_walls() {
  // Most rows have no wall, which a look at all their links together tells.
  for (int j = 0; j < r_.ny(); ++j) {
    if (r_.all_linked_x(TileRelief::slot(-1, j), r_.nx() + 1)) continue;
    for (int i = 0; i <= r_.nx(); ++i)
      add_wall(TileRelief::slot(i, j), true, i, j, i > 0, i < r_.nx());
  }
  for (int j = 0; j <= r_.ny(); ++j) {
    if (r_.all_linked_y(TileRelief::slot(0, j - 1), r_.nx())) continue;
    for (int i = 0; i < r_.nx(); ++i)
      add_wall(TileRelief::slot(i, j), false, i, j, j > 0, j < r_.ny());
  }
}

void PatchBuilder::add_surface() {
  add_square(0, 0, kTileCells);
  add_walls();
  add_floor();
  if (cut_ids_) set_cut_by_of_corners();
  patch_.skirt_begin = static_cast<std::uint32_t>(patch_.indices.size());
}

/// Below the edge of a cell's top from `from` to `to`, which runs with the outside on its right; or
/// below the wall of this tile that is there. It ends on the tile's border, wherever the top's
/// corners were moved, so that no gap is left between tiles seen from above. None where the surface
/// is level all about.
void PatchBuilder::add_skirt(const Side& side, int outer_cell, bool is_linked,
                             const BorderEnd& from, const BorderEnd& to) {
  const auto z = [&](const BorderEnd& end, Quadrant q) { return z_at(end.i, end.j, q); };
  const bool is_below_wall =
      !is_linked && z(from, from.inner) + z(to, to.inner) >= z(from, from.outer) + z(to, to.outer);
  const auto upper_z = [&](const BorderEnd& end) {
    return z(end, is_below_wall ? end.outer : end.inner);
  };
  if (upper_z(from) <= side.skirt_end_mm && upper_z(to) <= side.skirt_end_mm) return;
  const std::uint32_t level = pack_normal(glm::vec3(side.outward, 0));
  const auto add = [&](const glm::vec2& xy, float height, std::uint32_t normal, std::uint32_t id) {
    const std::uint32_t vertex = add_vertex(xy, height, normal);
    set_cut_by(vertex, id);
    return vertex;
  };
  struct Ends {
    std::uint32_t upper, lower;
  };
  const auto ends = [&](const BorderEnd& end) -> Ends {
    const glm::vec2 border = unmoved(end.i, end.j);
    if (is_below_wall) {
      const std::uint32_t id = cut_by(outer_cell);
      return {add(place_of(end.i, end.j), upper_z(end), level, id),
              add(border, side.skirt_end_mm, level, id)};
    }
    const std::uint32_t top = top_vertex(end.i, end.j, end.inner);
    // Where a skirt fills a crack it must not be seen: the top's own normals. Where it is high, it
    // may stand between walls that coarse cells have elsewhere than fine ones, and is lit as a
    // wall.
    const bool is_high = upper_z(end) - side.skirt_end_mm > kCrack_cells * r_.cell_mm();
    const std::uint32_t normal = is_high ? level : patch_.vertices[top].normal;
    const std::uint32_t id = cut_ids_ ? patch_.cut_by[top] : MeshPatch::kNotCut;
    return {top, add(border, side.skirt_end_mm, normal, id)};
  };
  const Ends a = ends(from), b = ends(to);
  add_triangle(a.lower, b.lower, b.upper);
  add_triangle(a.lower, b.upper, a.upper);
}

void PatchBuilder::add_skirts() {
  const int nx = r_.nx(), ny = r_.ny();
  const auto slot = [](int i, int j) { return TileRelief::slot(i, j); };
  for (int j = 0; j < ny; ++j) {
    if (sides_.left.has_neighbor && r_.solid(slot(0, j)))
      add_skirt(sides_.left, slot(-1, j), r_.linked_x(slot(-1, j)), {0, j + 1, kB, kA},
                {0, j, kC, kD});
    if (sides_.right.has_neighbor && r_.solid(slot(nx - 1, j)))
      add_skirt(sides_.right, slot(nx, j), r_.linked_x(slot(nx - 1, j)), {nx, j, kD, kC},
                {nx, j + 1, kA, kB});
  }
  for (int i = 0; i < nx; ++i) {
    if (sides_.low.has_neighbor && r_.solid(slot(i, 0)))
      add_skirt(sides_.low, slot(i, -1), r_.linked_y(slot(i, -1)), {i, 0, kC, kB},
                {i + 1, 0, kD, kA});
    if (sides_.high.has_neighbor && r_.solid(slot(i, ny - 1)))
      add_skirt(sides_.high, slot(i, ny), r_.linked_y(slot(i, ny - 1)), {i + 1, ny, kA, kD},
                {i, ny, kB, kC});
  }
}

/// A neighbour's border lies, whatever its level, no lower than all cells that the coarsest level
/// joins with those about the border.
Sides sides_of(const TileGrid& grid, std::uint32_t tile) {
  constexpr int kReach = 1 << (StockModel::kPatchLevels - 1);
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  const int x0 = tx * kTileCells, y0 = ty * kTileCells;
  const int x1 = x0 + kTileCells, y1 = y0 + kTileCells;
  const auto across_x = [&](bool has_neighbor, int x) {
    return Side{has_neighbor, glm::vec2(x == x0 ? -1 : 1, 0),
                grid.lowest_mm(x - kReach, y0 - kReach, x + kReach, y1 + kReach)};
  };
  const auto across_y = [&](bool has_neighbor, int y) {
    return Side{has_neighbor, glm::vec2(0, y == y0 ? -1 : 1),
                grid.lowest_mm(x0 - kReach, y - kReach, x1 + kReach, y + kReach)};
  };
  return {across_x(tx > 0, x0), across_x(tx + 1 < grid.tiles_x(), x1), across_y(ty > 0, y0),
          across_y(ty + 1 < grid.tiles_y(), y1)};
}

}  // namespace

MeshPatch make_tile_patch(const TileGrid& grid, std::uint32_t tile, int level) {
  assert(tile < grid.tile_count() && level >= 0 && level < StockModel::kPatchLevels);
  MeshPatch patch;
  patch.tile = tile;
  patch.level = level;
  patch.tiles_in_row = static_cast<std::uint32_t>(grid.tiles_x());
  const TileRelief relief(grid, tile, level);
  std::optional<TileCutIds> cut_ids;
  if (grid.keeps_cut_ids()) cut_ids.emplace(grid, tile, level);
  PatchBuilder builder(relief, cut_ids ? &*cut_ids : nullptr, sides_of(grid, tile), patch);
  builder.add_surface();
  builder.add_skirts();
  if (cut_ids) patch.cut_by.resize(patch.vertices.size(), MeshPatch::kNotCut);
  // A level tile fills a small part of what was reserved, and patches are kept until uploaded.
  if (2 * patch.vertices.size() < patch.vertices.capacity()) patch.vertices.shrink_to_fit();
  if (2 * patch.cut_by.size() < patch.cut_by.capacity()) patch.cut_by.shrink_to_fit();
  if (2 * patch.indices.size() < patch.indices.capacity()) patch.indices.shrink_to_fit();
  return patch;
}

std::uint64_t tile_patch_version(const TileGrid& grid, std::uint32_t tile) {
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  std::array<std::uint64_t, 9> versions{};
  std::size_t n = 0;
  for (int y = ty - 1; y <= ty + 1; ++y) {
    for (int x = tx - 1; x <= tx + 1; ++x, ++n) {
      if (x < 0 || y < 0 || x >= grid.tiles_x() || y >= grid.tiles_y()) continue;
      versions[n] = grid.version(static_cast<std::size_t>(y * grid.tiles_x() + x));
    }
  }
  return XXH3_64bits(versions.data(), sizeof versions);
}

}  // namespace kerf
