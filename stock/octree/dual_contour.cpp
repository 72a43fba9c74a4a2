#include "stock/octree/dual_contour.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

#include "base/mesh_patch.h"

namespace kerf {
namespace {

/// Cells: what tells two diagonals apart. Below it rounding decides, and the better shape counts.
constexpr float kSameHeight = 1e-4f;

constexpr std::size_t at(int index) { return static_cast<std::size_t>(index); }
constexpr int kAxes = 3;

/// Not all corners empty, nor all solid.
bool has_surface(std::uint8_t signs) { return static_cast<std::uint8_t>(signs + 1) > 1; }

/// Whether any of eight cells may: false if all are empty or all solid.
bool have_surface_8(const std::uint8_t* signs) {
  std::uint64_t all;
  std::memcpy(&all, signs, sizeof(all));
  return all + 1 > 1;
}

float cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

/// The four vertices about an edge, counter-clockwise seen against its direction, from the edge's
/// lower node. The edge is the axis from (0, 0) upwards.
struct EdgeRing {
  std::array<glm::vec2, 4> flat_mm;
  std::array<float, 4> height_mm;

  /// Twice the area of a triangle as it is seen along the edge.
  float area(std::size_t a, std::size_t b, std::size_t c) const {
    return cross(flat_mm[b] - flat_mm[a], flat_mm[c] - flat_mm[a]);
  }
  /// Where the edge meets the triangle.
  float height_in(std::size_t a, std::size_t b, std::size_t c, float otherwise_mm) const {
    const float of_a = cross(flat_mm[b], flat_mm[c]), of_b = cross(flat_mm[c], flat_mm[a]),
                of_c = cross(flat_mm[a], flat_mm[b]);
    const float sum = of_a + of_b + of_c;
    if (!(sum > 0.0f)) return otherwise_mm;
    return (of_a * height_mm[a] + of_b * height_mm[b] + of_c * height_mm[c]) / sum;
  }
  /// How far the edge's crossing is from the quad if it is cut from corner n to the opposite one.
  float miss_mm(std::size_t n, float crossing_mm) const {
    const std::size_t next = (n + 1) % 4, far = (n + 2) % 4, last = (n + 3) % 4;
    const bool is_left = cross(flat_mm[far] - flat_mm[n], -flat_mm[n]) > 0.0f;
    const float height =
        is_left ? height_in(n, far, last, crossing_mm) : height_in(n, next, far, crossing_mm);
    return std::abs(height - crossing_mm);
  }
};

/// Whether the quad is better cut from corner 1 to 3 than from 0 to 2. Seen along the edge each
/// vertex is in a quadrant of its own, so one diagonal at least lies in the quad and turns no
/// triangle over. Of two such ones that counts which passes nearer to the crossing, where the
/// surface is known: it follows the folds.
bool is_better_from_1_to_3(const EdgeRing& ring, float crossing_mm, float same_mm) {
  const float from_0 = std::min(ring.area(0, 1, 2), ring.area(0, 2, 3));
  const float from_1 = std::min(ring.area(0, 1, 3), ring.area(1, 2, 3));
  if ((from_0 > 0.0f) != (from_1 > 0.0f)) return from_1 > 0.0f;
  const float miss_0 = ring.miss_mm(0, crossing_mm), miss_1 = ring.miss_mm(1, crossing_mm);
  if (std::abs(miss_0 - miss_1) > same_mm) return miss_1 < miss_0;
  return from_1 > from_0;
}

}  // namespace

void DualContour::contour(const DualField& field, const CellBox& box) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    assert(box.last[axis] > box.first[axis]);
    first_node_[axis] = box.first[axis] - kLayersBelow;
    nodes_[axis] = box.last[axis] + kLayersAbove + 1 - first_node_[axis];
  }
  field.gather(first_node_, nodes_, &grid_);
  stride_ = {1u, static_cast<std::uint32_t>(nodes_[0]),
             static_cast<std::uint32_t>(nodes_[0] * nodes_[1])};
  cell_mm_ = glm::vec3(field.cell_mm);
  for (int edge = 0; edge < kDualEdges; ++edge) {
    const int corner = dual_edge_corner(edge);
    const glm::uvec3 low(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    node_of_edge_[at(edge)] = low.x * stride_[0] + low.y * stride_[1] + low.z * stride_[2];
    edge_at_mm_[at(edge)] = glm::vec3(low) * cell_mm_;
  }
  find_signs();
  make_vertices();
  make_quads();
}

void DualContour::find_signs() {
  const std::size_t count = grid_.solid.size();
  assert(count == at(nodes_[0]) * at(nodes_[1]) * at(nodes_[2]));
  signs_.resize(count);
  cells_.resize(count);
  const std::size_t row = stride_[1], slab = stride_[2];
  // Rows run on into the next one: what that makes of the last cell of a row is not used.
  const std::size_t end = count - slab - row - 1;
  const std::uint8_t* solid = grid_.solid.data();
  std::uint8_t* signs = signs_.data();
  for (std::size_t n = 0; n < end; ++n) {
    const std::uint8_t* s = solid + n;
    const int low = s[0] | s[1] << 1 | s[row] << 2 | s[row + 1] << 3;
    const int high = s[slab] | s[slab + 1] << 1 | s[slab + row] << 2 | s[slab + row + 1] << 3;
    signs[n] = static_cast<std::uint8_t>(low | high << 4);
  }
}

void DualContour::make_vertices() {
  vertices_.clear();
  facets_.clear();
  quad_cells_.clear();
  const auto last = [&](std::size_t axis) { return nodes_[axis] - 1 - kLayersAbove; };
  for (int k = kLayersBelow - 1; k < last(2); ++k) {
    for (int j = kLayersBelow - 1; j < last(1); ++j) {
      const std::uint32_t row =
          static_cast<std::uint32_t>(k) * stride_[2] + static_cast<std::uint32_t>(j) * stride_[1];
      const bool is_row_of_box = j >= kLayersBelow && k >= kLayersBelow;
      for (int i = kLayersBelow - 1; i < last(0); ++i) {
        const std::uint32_t cell = row + static_cast<std::uint32_t>(i);
        if (i + 8 <= last(0) && !have_surface_8(&signs_[cell])) {
          i += 7;
          continue;
        }
        if (!has_surface(signs_[cell])) continue;
        make_cell(cell);
        if (is_row_of_box && i >= kLayersBelow) quad_cells_.push_back(cell);
      }
    }
  }
}

void DualContour::make_cell(std::uint32_t cell) {
  const std::uint8_t signs = signs_[cell];
  std::uint32_t number = signs;
  const std::uint8_t lone = kDualTables.lone_face[signs];
  if (lone != DualTables::kNoFace) {
    const bool is_upper = lone % 2 == 1;
    const std::uint32_t stride = stride_[lone / 2];
    const std::uint8_t beyond = signs_[is_upper ? cell + stride : cell - stride];
    if (kDualTables.lone_face[beyond] == (lone ^ 1)) {
      const bool wants_other = is_face_solid(is_upper ? cell + stride : cell, lone / 2);
      const std::size_t wanted = wants_other ? DualTables::kOtherWay : 0;
      const bool is_refused =
          kDualTables.is_joined[signs + wanted] != 0 && kDualTables.is_joined[beyond + wanted] != 0;
      if (wants_other != is_refused) number += DualTables::kOtherWay;
    }
  }
  cells_[cell] = {static_cast<std::uint32_t>(vertices_.size()), number};
  const DualLoops& loops = kDualTables.loops[number];
  for (int piece = 0; piece < loops.count; ++piece) make_vertex(cell, loops, piece);
}

/// Whether there is material in the middle of the face across `axis` whose lowest corner is `node`:
/// whether it is on the inner side of the tangents at the four crossings, on the whole. Takes the
/// crossings in the same order for both cells at the face, so that they find the same.
bool DualContour::is_face_solid(std::uint32_t node, int axis) const {
  const int b = (axis + 1) % kAxes, c = (axis + 2) % kAxes;
  float outside_mm = 0.0f;
  const auto add = [&](int along, int across, std::uint32_t from, float side) {
    const std::int32_t number = grid_.edges[at(along)][from];
    const HermiteCrossing& crossing = grid_.crossings[static_cast<std::size_t>(number)];
    outside_mm += crossing.normal[along] * (0.5f - crossing.t) * cell_mm_[along] +
                  crossing.normal[across] * side * cell_mm_[across];
  };
  add(b, c, node, 0.5f);
  add(b, c, node + stride_[at(c)], -0.5f);
  add(c, b, node, 0.5f);
  add(c, b, node + stride_[at(b)], -0.5f);
  return outside_mm < 0.0f;
}

void DualContour::make_vertex(std::uint32_t cell, const DualLoops& loops, int piece) {
  const std::span<const std::uint8_t> edges =
      std::span(loops.edges)
          .subspan(loops.begin[at(piece)], loops.begin[at(piece + 1)] - loops.begin[at(piece)]);
  std::array<DualSample, kDualEdges> samples;
  std::array<const HermiteCrossing*, kDualEdges> crossings;
  glm::vec3 at_sum(0), normal_sum(0);
  for (std::size_t n = 0; n < edges.size(); ++n) {
    const int edge = edges[n], axis = dual_edge_axis(edge);
    const std::int32_t number = grid_.edges[at(axis)][cell + node_of_edge_[at(edge)]];
    const HermiteCrossing& crossing = grid_.crossings[static_cast<std::size_t>(number)];
    crossings[n] = &crossing;
    glm::vec3 place = edge_at_mm_[at(edge)];
    place[axis] = crossing.t * cell_mm_[axis];
    samples[n] = {place, crossing.normal};
    at_sum += place;
    normal_sum += crossing.normal;
  }
  const std::span<const DualSample> used(samples.data(), edges.size());
  const float length = glm::length(normal_sum);
  float nearness = 2.0f * length;
  for (const DualSample& sample : used) {
    nearness = std::min(nearness, glm::dot(sample.normal, normal_sum));
  }
  DualPlacement placement;
  if (nearness > kDualHalfSharp * length) {
    placement.normals[0] = normal_sum / length;
    placement.at_mm = place_on_smooth_face(used, at_sum / static_cast<float>(edges.size()),
                                           placement.normals[0], cell_mm_);
  } else {
    placement = place_dual_vertex(used, cell_mm_);
  }
  Vertex& vertex = vertices_.emplace_back();
  vertex = {placement.at_mm,
            cell,
            static_cast<std::uint32_t>(facets_.size()),
            0,
            static_cast<std::uint8_t>(piece),
            static_cast<std::uint8_t>(placement.clusters)};
  make_facets(crossings, edges, placement, &vertex);
}

void DualContour::make_facets(const std::array<const HermiteCrossing*, kDualEdges>& crossings,
                              std::span<const std::uint8_t> edges, const DualPlacement& placement,
                              Vertex* vertex) {
  const std::size_t first = facets_.size();
  for (int n = 0; n < placement.clusters; ++n) {
    facets_.push_back({placement.normals[at(n)], MeshPatch::kNotCut});
  }
  for (std::size_t n = 0; n < edges.size(); ++n) {
    const std::uint32_t cluster = placement.clusters == 1 ? 0u : placement.cluster_of[n];
    vertex->facet_of_edges |= cluster << 2 * edges[n];
    // One more makes kNotCut the least.
    std::uint32_t& cut_by = facets_[first + cluster].cut_by;
    cut_by = std::max(cut_by + 1, crossings[n]->cut_by + 1) - 1;
  }
}

void DualContour::make_quads() {
  quads_.clear();
  for (const std::uint32_t cell : quad_cells_) {
    const unsigned signs = signs_[cell];
    // Where the lowest corner differs from its three neighbours.
    const unsigned changes = (signs & 1u) != 0 ? ~signs : signs;
    if ((changes & 2u) != 0) make_quad(cell, 0);
    if ((changes & 4u) != 0) make_quad(cell, 1);
    if ((changes & 16u) != 0) make_quad(cell, 2);
  }
}

void DualContour::make_quad(std::uint32_t cell, int axis) {
  const int b = (axis + 1) % kAxes, c = (axis + 2) % kAxes;
  // Round the edge: the cells' distance from `cell` along b and c, downwards.
  constexpr std::array<std::array<std::uint32_t, 2>, 4> kRound{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  EdgeRing ring;
  Quad quad;
  for (std::size_t n = 0; n < 4; ++n) {
    const auto& [down_b, down_c] = kRound[n];
    const std::uint32_t other = cell - down_b * stride_[at(b)] - down_c * stride_[at(c)];
    const std::uint32_t edge = 4 * static_cast<std::uint32_t>(axis) + down_b + 2 * down_c;
    const std::uint32_t number =
        cells_[other].first_vertex + kDualTables.loops[cells_[other].loops].loop_of[edge];
    const Vertex& vertex = vertices_[number];
    quad.vertices[n] = number;
    quad.facets[n] = vertex.first_facet + (vertex.facet_of_edges >> 2 * edge & 3u);
    ring.flat_mm[n] = {vertex.offset_mm[b] - static_cast<float>(down_b) * cell_mm_[b],
                       vertex.offset_mm[c] - static_cast<float>(down_c) * cell_mm_[c]};
    ring.height_mm[n] = vertex.offset_mm[axis];
  }
  const std::int32_t crossing = grid_.edges[at(axis)][cell];
  const float crossing_mm = grid_.crossings[static_cast<std::size_t>(crossing)].t * cell_mm_[axis];
  std::size_t from = is_better_from_1_to_3(ring, crossing_mm, kSameHeight * cell_mm_[axis]) ? 1 : 0;
  const std::size_t step = (signs_[cell] & 1u) != 0 ? 1 : 3;  // the other way round below material
  Quad& out = quads_.emplace_back();
  for (std::size_t n = 0; n < 4; ++n, from = (from + step) % 4) {
    out.vertices[n] = quad.vertices[from];
    out.facets[n] = quad.facets[from];
  }
}

}  // namespace kerf
