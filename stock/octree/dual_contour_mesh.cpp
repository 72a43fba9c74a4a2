#include "stock/octree/dual_contour_mesh.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <map>

#include "base/worker_pool.h"
#include "stock/octree/dual_contour_simplify.h"

namespace kerf {
namespace {

/// A vertex as seen from another tile: piece `piece` of the field's cell `cell`.
struct VertexName {
  std::array<int, 3> cell;
  std::uint8_t piece;
  auto operator<=>(const VertexName&) const = default;
};

/// The surface of one tile. Vertices: those of its own cells, then those of the tiles before it.
struct TileMesh {
  SimplifiedMesh part;
  std::uint32_t own = 0;
  std::vector<VertexName> foreign;  ///< names of the vertices from `own` on
  struct Border {
    VertexName name;
    std::uint32_t vertex;
  };
  std::vector<Border> border;  ///< own vertices that other tiles use, by name
};

bool is_below(const std::array<int, 3>& cell, const CellBox& box) {
  return cell[0] < box.first[0] || cell[1] < box.first[1] || cell[2] < box.first[2];
}
bool is_in_last_layer(const std::array<int, 3>& cell, const CellBox& box) {
  return cell[0] == box.last[0] - 1 || cell[1] == box.last[1] - 1 || cell[2] == box.last[2] - 1;
}

TileMesh make_tile_mesh(const DualField& field, const CellBox& box, DualContour* contour) {
  contour->contour(field, box);
  TileMesh out;
  const std::vector<DualContour::Vertex>& vertices = contour->vertices();
  std::vector<std::uint8_t> is_used(vertices.size(), 0);
  for (const DualContour::Quad& quad : contour->quads()) {
    for (const std::uint32_t vertex : quad.vertices) is_used[vertex] = 1;
  }
  // Own vertices all count: other tiles may use those that this one does not.
  std::vector<std::uint32_t> number(vertices.size());
  TriangleMesh& mesh = out.part.mesh;
  for (const bool want_own : {true, false}) {
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      const std::array<int, 3> cell = contour->cell_of(vertices[n]);
      const bool is_own = !is_below(cell, box);
      if (is_own != want_own || (!is_own && is_used[n] == 0)) continue;
      number[n] = static_cast<std::uint32_t>(mesh.positions_mm.size());
      mesh.positions_mm.push_back(field.place_mm(cell, vertices[n].offset_mm));
      const bool is_border = is_own && is_in_last_layer(cell, box);
      out.part.is_locked.push_back(!is_own || is_border ? 1 : 0);
      if (!is_own) out.foreign.push_back({cell, vertices[n].piece});
      if (is_border) out.border.push_back({{cell, vertices[n].piece}, number[n]});
    }
    if (want_own) out.own = static_cast<std::uint32_t>(mesh.positions_mm.size());
  }
  const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
  std::sort(out.border.begin(), out.border.end(), by_name);
  mesh.triangles.reserve(2 * contour->quads().size());
  for (const DualContour::Quad& quad : contour->quads()) {
    std::array<std::uint32_t, 4> v;
    for (std::size_t n = 0; n < 4; ++n) v[n] = number[quad.vertices[n]];
    mesh.triangles.push_back({v[0], v[1], v[2]});
    mesh.triangles.push_back({v[0], v[2], v[3]});
  }
  return out;
}

/// All vertices that only other tiles hold are locked, so they are still there.
void simplify_tile(double tolerance_mm, TileMesh* tile) {
  tile->part.error_mm.assign(tile->part.mesh.triangles.size(), 0.0f);
  const std::vector<std::uint32_t> number = simplify(&tile->part, tolerance_mm);
  for (TileMesh::Border& border : tile->border) border.vertex = number[border.vertex];
  tile->own =
      static_cast<std::uint32_t>(tile->part.mesh.positions_mm.size() - tile->foreign.size());
}

/// Calls work(n, thread) for n below `count`, from several threads.
template <class Work>
void for_each(WorkerPool* pool, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  pool->run([&](int thread) {
    for (std::size_t n = next++; n < count; n = next++) work(n, thread);
  });
}

int floor_divide(int value, int by) { return (value >= 0 ? value : value - by + 1) / by; }

class Welder {
 public:
  Welder(const DualTiles& tiles, std::vector<TileMesh> parts)
      : per_side_(tiles.cells_per_side), parts_(std::move(parts)) {
    for (std::size_t n = 0; n < parts_.size(); ++n) tile_at_[tiles.tiles[n]] = n;
    vertex_begin_.push_back(0);
    triangle_begin_.push_back(0);
    for (const TileMesh& part : parts_) {
      vertex_begin_.push_back(vertex_begin_.back() + part.own);
      triangle_begin_.push_back(triangle_begin_.back() + part.part.mesh.triangles.size());
    }
  }

  SimplifiedMesh weld(bool is_simplified, WorkerPool* pool) {
    SimplifiedMesh out;
    out.mesh.positions_mm.resize(vertex_begin_.back());
    out.mesh.triangles.resize(triangle_begin_.back());
    if (is_simplified) {
      out.error_mm.resize(triangle_begin_.back());
      out.is_locked.assign(vertex_begin_.back(), 0);
    }
    for_each(pool, parts_.size(), [&](std::size_t n, int) { move_in(n, &out); });
    return out;
  }

 private:
  /// Takes the part apart: memory for both meshes at once is the most that is ever needed.
  void move_in(std::size_t number, SimplifiedMesh* out) {
    TileMesh& part = parts_[number];
    const TriangleMesh& mesh = part.part.mesh;
    std::copy_n(
        mesh.positions_mm.begin(), part.own,
        out->mesh.positions_mm.begin() + static_cast<std::ptrdiff_t>(vertex_begin_[number]));
    std::vector<std::uint32_t> foreign;
    foreign.reserve(part.foreign.size());
    for (const VertexName& name : part.foreign) foreign.push_back(find(name));
    const auto first = static_cast<std::uint32_t>(vertex_begin_[number]);
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
      std::array<std::uint32_t, 3> triangle = mesh.triangles[n];
      for (std::uint32_t& v : triangle) v = v < part.own ? first + v : foreign[v - part.own];
      out->mesh.triangles[triangle_begin_[number] + n] = triangle;
    }
    std::copy(part.part.error_mm.begin(), part.part.error_mm.end(),
              out->error_mm.begin() +
                  static_cast<std::ptrdiff_t>(out->error_mm.empty() ? 0 : triangle_begin_[number]));
    part.part = {};
  }
  std::uint32_t find(const VertexName& name) const {
    std::array<int, 3> tile;
    for (std::size_t axis = 0; axis < 3; ++axis)
      tile[axis] = floor_divide(name.cell[axis], per_side_);
    const auto place = tile_at_.find(tile);
    assert(place != tile_at_.end());
    const std::vector<TileMesh::Border>& border = parts_[place->second].border;
    const auto found =
        std::lower_bound(border.begin(), border.end(), name,
                         [](const TileMesh::Border& entry, const VertexName& wanted) {
                           return entry.name < wanted;
                         });
    assert(found != border.end() && found->name == name);
    return static_cast<std::uint32_t>(vertex_begin_[place->second]) + found->vertex;
  }

  int per_side_;
  std::vector<TileMesh> parts_;
  std::map<std::array<int, 3>, std::size_t> tile_at_;
  std::vector<std::size_t> vertex_begin_, triangle_begin_;
};

}  // namespace

CellBox DualTiles::box(const std::array<int, 3>& tile) const {
  CellBox out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.first[axis] = tile[axis] * cells_per_side;
    out.last[axis] = out.first[axis] + cells_per_side;
  }
  return out;
}

TriangleMesh mesh_dual_field(const DualField& field, const DualTiles& tiles, double tolerance_mm,
                             int threads) {
  WorkerPool pool(threads);
  std::vector<DualContour> contours(static_cast<std::size_t>(pool.threads()));
  std::vector<TileMesh> parts(tiles.tiles.size());
  for_each(&pool, parts.size(), [&](std::size_t n, int thread) {
    DualContour& contour = contours[static_cast<std::size_t>(thread)];
    parts[n] = make_tile_mesh(field, tiles.box(tiles.tiles[n]), &contour);
    if (tolerance_mm > 0.0) simplify_tile(tolerance_mm, &parts[n]);
  });
  SimplifiedMesh whole = Welder(tiles, std::move(parts)).weld(tolerance_mm > 0.0, &pool);
  if (tolerance_mm > 0.0) simplify(&whole, tolerance_mm);
  return std::move(whole.mesh);
}

}  // namespace kerf
