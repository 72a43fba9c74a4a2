#include "stock/zmap/tile_patch_builder.h"

#include <glm/geometric.hpp>

namespace kerf {

/// Vertices that are passed over count as not cut.
void TilePatchBuilder::set_cut_by(std::uint32_t vertex, std::uint32_t id) {
  if (!cut_ids_) return;
  if (patch_.cut_by.size() <= vertex) patch_.cut_by.resize(vertex + 1, MeshPatch::kNotCut);
  patch_.cut_by[vertex] = id;
}

/// Those that are not split: all at once, so that their vertices are made without a look at it.
void TilePatchBuilder::set_cut_by_of_corners() {
  patch_.cut_by.resize(patch_.vertices.size(), MeshPatch::kNotCut);
  for (int j = 0; j <= r_.ny(); ++j) {
    for (int i = 0; i <= r_.nx(); ++i) {
      const int corner = TileRelief::slot(i, j);
      const std::uint32_t vertex = top_[static_cast<std::size_t>(corner)];
      if (vertex < kSplitCorner) patch_.cut_by[vertex] = cut_ids_->at_corner(r_, corner);
    }
  }
}

TilePatchBuilder::SplitCorner& TilePatchBuilder::split_corner(int i, int j) {
  const int corner = TileRelief::slot(i, j);
  std::uint32_t& number = top_[static_cast<std::size_t>(corner)];
  if (number == kNone) {
    number = kSplitCorner + static_cast<std::uint32_t>(splits_.size());
    splits_.push_back({r_.split(corner), unmoved(i, j) + r_.shift_mm(i, j)});
  }
  return splits_[number - kSplitCorner];
}

float TilePatchBuilder::z_at(int i, int j, Quadrant q) {
  const int corner = TileRelief::slot(i, j);
  return r_.is_split(corner) ? split_corner(i, j).split.z[q] : r_.corner_z(corner);
}

std::uint32_t TilePatchBuilder::split_vertex(int i, int j, Quadrant q) {
  SplitCorner& at = split_corner(i, j);
  std::uint32_t& vertex = at.vertex[at.split.group[q]];
  if (vertex == kNone) {
    const glm::vec2 slope = at.split.slope[q];
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x, -slope.y, 1));
    vertex = add_vertex(at.xy_mm, at.split.z[q], pack_normal(normal));
    const auto in_group = [&](std::size_t r) { return at.split.group[r] == at.split.group[q]; };
    if (cut_ids_) set_cut_by(vertex, cut_ids_->at_corner(r_, TileRelief::slot(i, j), in_group));
  }
  return vertex;
}

std::uint32_t TilePatchBuilder::bottom_vertex(int i, int j) {
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
bool TilePatchBuilder::is_level(int i, int j, int size) const {
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
void TilePatchBuilder::add_fan(int i, int j, int width, int height, std::uint32_t center,
                               bool upward, const Corner& corner) {
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

void TilePatchBuilder::add_square(int i, int j, int size) {
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
void TilePatchBuilder::add_cells(int first_i, int first_j, int last_i, int last_j) {
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
bool TilePatchBuilder::is_rising(int i, int j, const std::array<std::uint32_t, 4>& corners,
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
bool TilePatchBuilder::is_seen_from(std::uint32_t center) {
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

void TilePatchBuilder::add_floor() {
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

/// Corners that the tiles beside this one have none of are left out.
bool TilePatchBuilder::add_plain_floor(const PlainFloor& floor) {
  if (!floor.is_plain) return false;
  const int nx = r_.nx(), ny = r_.ny();
  std::vector<std::uint32_t> ring;
  const auto add_side = [&](bool is_plain, int count, const auto& corner) {
    for (int k = 0; k < (is_plain ? 1 : count); ++k) ring.push_back(corner(k));
  };
  add_side(floor.low, nx, [&](int k) { return bottom_vertex(k, 0); });
  add_side(floor.right, ny, [&](int k) { return bottom_vertex(nx, k); });
  add_side(floor.high, nx, [&](int k) { return bottom_vertex(nx - k, ny); });
  add_side(floor.left, ny, [&](int k) { return bottom_vertex(0, ny - k); });
  const std::uint32_t center = bottom_vertex(nx / 2, ny / 2);
  for (std::size_t n = 0; n < ring.size(); ++n)
    add_triangle(center, ring[(n + 1) % ring.size()], ring[n]);
  return true;
}

void TilePatchBuilder::end_surface() {
  if (cut_ids_) set_cut_by_of_corners();
  patch_.skirt_begin = static_cast<std::uint32_t>(patch_.indices.size());
}

void TilePatchBuilder::add_surface() {
  add_square(0, 0, kTileCells);
  add_walls();
  add_floor();
  end_surface();
}

void TilePatchBuilder::add_sparse_surface(const TileNetwork& network, const PlainFloor& floor) {
  // A corner of a large triangle is never split, and has one vertex for all its cells.
  const auto vertex = [this](const TileNetwork::Corner& at) { return top_vertex(at.i, at.j, kC); };
  network.each(
      [this](int i, int j) {
        return i >= r_.nx() || j >= r_.ny() || !r_.solid(TileRelief::slot(i, j));
      },
      [this](int i, int j) { add_cells(i, j, i + 1, j + 1); },
      [&](const TileNetwork::Corner& a, const TileNetwork::Corner& b,
          const TileNetwork::Corner& c) { add_triangle(vertex(a), vertex(b), vertex(c)); });
  add_walls();
  if (!add_plain_floor(floor)) add_floor();
  end_surface();
}

}  // namespace kerf
