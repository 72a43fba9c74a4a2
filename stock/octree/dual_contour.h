// stock/octree/dual_contour.h - the surface of a box of cells: vertices and quads.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "base/geometry.h"
#include "stock/octree/dual_contour_tables.h"
#include "stock/octree/dual_contour_vertex.h"
#include "stock/octree/hermite_grid.h"

namespace kerf {

/// Cells `first` up to `last`, without those.
struct CellBox {
  std::array<int, 3> first{};
  std::array<int, 3> last{};
};

/// A closed surface on a grid without ends, in pieces as they are asked for. Node (i, j, k) lies at
/// origin_mm + (i, j, k) * cell_mm; the cell (i, j, k) has it as its lowest corner.
struct DualField {
  Vec3 origin_mm{0};
  Vec3 cell_mm{1.0};
  /// Fills `grid` with the nodes from `first` on, `nodes` of them along each axis; what it holds is
  /// what the last such call left, so that its memory can be used again. Of `edges` only those are
  /// read that are crossed. Beyond what the field is about nodes are not solid. To be called from
  /// several threads at once, each with its own grid.
  std::function<void(const std::array<int, 3>& first, const std::array<int, 3>& nodes,
                     HermiteGrid* grid)>
      gather;

  /// Place of a vertex, the same bits whichever window it was found in.
  glm::vec3 place_mm(const std::array<int, 3>& cell, const glm::vec3& offset_mm) const {
    return glm::vec3(origin_mm + cell_mm * Vec3(cell[0], cell[1], cell[2]) + Vec3(offset_mm));
  }
};

/// The surface of a box of cells by dual contouring: a vertex for each piece of surface in a cell,
/// a quad for each crossed edge, between the vertices of the four cells about it. Over a whole
/// field the quads make closed oriented 2-manifolds, whatever its signs (dual_contour_tables.h):
/// each edge is in two triangles, once in each direction, and the triangles at a vertex are one
/// ring. Vertices lie in their cells, or on a fold up to a cell beside (dual_contour_vertex.h).
/// Bodies bounded by planes come out exact to single precision if their walls and gaps are 1.6
/// cells thick. Thinner ones may come apart or close up, and triangles near them overlap.
///
/// The quad of the edge from node (i, j, k) upwards belongs to the box that holds the cell (i, j,
/// k). So boxes that share no cell share no quad, and vertices are needed of one more layer of
/// cells below the box. The same vertex comes out in the same bits from every box, as it depends
/// on its cell's data, and the signs of its neighbours, alone.
///
///     cell   2 3 | 4 5 6 7 | 8       The box of cells [4, 8): # its cells, o vertices but no
///            . o | # # # # | .       quads of its own, . only signs. The window of nodes is that
///                                    of all of these, 2 .. 9.
///
/// Allocates only until its buffers are as large as the largest box so far. About 0.2 us for each
/// cell with surface in boxes of 32 cells (tests/bench/bench_dual_contour.cpp).
class DualContour {
 public:
  /// Layers of nodes beyond the lowest and the highest node of the box's cells. The outer ones tell
  /// what the neighbours of the outer cells make of an ambiguous face.
  static constexpr int kLayersBelow = 2, kLayersAbove = 1;

  struct Vertex {
    glm::vec3 offset_mm;           ///< from the lowest corner of its cell
    std::uint32_t cell;            ///< number of that corner in the window
    std::uint32_t first_facet;     ///< in facets()
    std::uint32_t facet_of_edges;  ///< two bits an edge of the cell: facet, from first_facet on
    std::uint8_t piece;            ///< number of the piece of surface in the cell, from 0
    std::uint8_t facets;           ///< how many
  };
  /// A face of the part at a vertex: on smooth surfaces one each, on edges two, in corners more.
  struct Facet {
    glm::vec3 normal;      ///< unit
    std::uint32_t cut_by;  ///< of its crossings the latest; MeshPatch::kNotCut if there is none
  };
  /// Counter-clockwise seen from outside; triangles (0, 1, 2) and (0, 2, 3).
  struct Quad {
    std::array<std::uint32_t, 4> vertices;
    std::array<std::uint32_t, 4> facets;  ///< of the vertices, those that the quad is part of
  };

  /// Finds the surface of `box`.
  void contour(const DualField& field, const CellBox& box);

  /// Of the box's cells and the layer below them, by cell and piece; x fastest.
  const std::vector<Vertex>& vertices() const { return vertices_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Quad>& quads() const { return quads_; }

  /// Cell (in the field) of a vertex.
  std::array<int, 3> cell_of(const Vertex& vertex) const {
    const auto number = static_cast<int>(vertex.cell);
    return {first_node_[0] + number % nodes_[0], first_node_[1] + number / nodes_[0] % nodes_[1],
            first_node_[2] + number / (nodes_[0] * nodes_[1])};
  }

 private:
  struct Cell {
    std::uint32_t first_vertex;
    std::uint32_t loops;  ///< number in DualTables::loops
  };
  void find_signs();
  void make_vertices();
  void make_cell(std::uint32_t cell);
  bool is_face_solid(std::uint32_t node, int axis) const;
  void make_vertex(std::uint32_t cell, const DualLoops& loops, int piece);
  void make_facets(const std::array<const HermiteCrossing*, kDualEdges>& crossings,
                   std::span<const std::uint8_t> edges, const DualPlacement& placement,
                   Vertex* vertex);
  void make_quads();
  void make_quad(std::uint32_t cell, int axis);

  HermiteGrid grid_;
  std::array<int, 3> first_node_{}, nodes_{};
  std::array<std::uint32_t, 3> stride_{};
  glm::vec3 cell_mm_{1};
  std::array<std::uint32_t, kDualEdges> node_of_edge_{};  ///< from the cell's number
  std::array<glm::vec3, kDualEdges> edge_at_mm_{};        ///< lower end of each edge in the cell
  std::vector<std::uint8_t> signs_;                       ///< by cell
  std::vector<Cell> cells_;                ///< by number; only those with surface are filled in
  std::vector<std::uint32_t> quad_cells_;  ///< with surface, and in the box itself
  std::vector<Vertex> vertices_;
  std::vector<Facet> facets_;
  std::vector<Quad> quads_;
};

}  // namespace kerf
