#include "stock/octree/dual_contour_patch.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

namespace kerf {
namespace {

constexpr std::uint32_t kNone = 0xffff'ffff;

/// Vertices of the patch as they come up. A site is a place of the surface; it has a vertex for
/// each face of the part that meets there.
class PatchBuilder {
 public:
  PatchBuilder(bool keeps_cut_ids, std::size_t facets)
      : keeps_cut_ids_(keeps_cut_ids), vertex_of_facet_(facets, kNone) {}

  std::uint32_t add_vertex(const glm::vec3& position_mm, const DualContour::Facet& facet) {
    const auto number = static_cast<std::uint32_t>(patch_.vertices.size());
    patch_.vertices.push_back({position_mm, pack_normal(facet.normal)});
    if (keeps_cut_ids_) patch_.cut_by.push_back(facet.cut_by);
    return number;
  }
  std::uint32_t& vertex_of_facet(std::uint32_t facet) { return vertex_of_facet_[facet]; }
  void merge(std::uint32_t vertex, const glm::vec3& normal, std::uint32_t cut_by) {
    patch_.vertices[vertex].normal = pack_normal(normal);
    if (!keeps_cut_ids_) return;
    patch_.cut_by[vertex] = std::max(patch_.cut_by[vertex] + 1, cut_by + 1) - 1;
  }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    patch_.indices.insert(patch_.indices.end(), {a, b, c});
  }
  MeshPatch take(int level) {
    patch_.level = level;
    patch_.skirt_begin = static_cast<std::uint32_t>(patch_.indices.size());
    return std::move(patch_);
  }

 private:
  bool keeps_cut_ids_;
  MeshPatch patch_;
  std::vector<std::uint32_t> vertex_of_facet_;
};

MeshPatch full_patch(const DualField& field, const DualContour& contour, bool keeps_cut_ids) {
  PatchBuilder builder(keeps_cut_ids, contour.facets().size());
  for (const DualContour::Quad& quad : contour.quads()) {
    std::array<std::uint32_t, 4> v;
    for (std::size_t n = 0; n < 4; ++n) {
      std::uint32_t& number = builder.vertex_of_facet(quad.facets[n]);
      if (number == kNone) {
        const DualContour::Vertex& vertex = contour.vertices()[quad.vertices[n]];
        number = builder.add_vertex(field.place_mm(contour.cell_of(vertex), vertex.offset_mm),
                                    contour.facets()[quad.facets[n]]);
      }
      v[n] = number;
    }
    builder.add_triangle(v[0], v[1], v[2]);
    builder.add_triangle(v[0], v[2], v[3]);
  }
  return builder.take(0);
}

/// Vertices joined to sites, level by groups of cells.
class CoarsePatch {
 public:
  CoarsePatch(const DualField& field, const CellBox& box, int level, const DualContour& contour)
      : field_(field), box_(box), level_(level), contour_(contour) {
    join();
    place_sites();
  }

  MeshPatch make(bool keeps_cut_ids) {
    PatchBuilder builder(keeps_cut_ids, contour_.facets().size());
    for (const DualContour::Quad& quad : contour_.quads()) {
      std::array<std::uint32_t, 4> sites;
      for (std::size_t n = 0; n < 4; ++n) sites[n] = site_of_[quad.vertices[n]];
      for (const std::array<std::size_t, 3>& corners :
           {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
        const auto& [a, b, c] = corners;
        if (sites[a] == sites[b] || sites[b] == sites[c] || sites[c] == sites[a]) continue;
        builder.add_triangle(vertex(quad, a, &builder), vertex(quad, b, &builder),
                             vertex(quad, c, &builder));
      }
    }
    return builder.take(level_);
  }

 private:
  struct Site {
    glm::vec3 position_mm{0};
    std::uint32_t first_face = kNone;
    std::uint32_t members = 0;
  };
  /// A vertex of the patch: facets of a site's members that face about the same way.
  struct Face {
    std::uint32_t vertex;
    std::uint32_t next;
    glm::vec3 first_normal, sum;
  };

  std::uint32_t root(std::uint32_t vertex) {
    while (site_of_[vertex] != vertex) {
      vertex = site_of_[vertex] = site_of_[site_of_[vertex]];
    }
    return vertex;
  }
  /// Number of the group of cells, or kNone in the outer layers.
  std::uint32_t group_of(const DualContour::Vertex& vertex) const {
    const std::array<int, 3> cell = contour_.cell_of(vertex);
    std::uint32_t group = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] < box_.first[axis] || cell[axis] == box_.last[axis] - 1) return kNone;
      const int groups = ((box_.last[axis] - box_.first[axis]) >> level_) + 1;
      group = group * static_cast<std::uint32_t>(groups) +
              static_cast<std::uint32_t>((cell[axis] - box_.first[axis]) >> level_);
    }
    return group;
  }
  void join();
  void place_sites();
  std::uint32_t vertex(const DualContour::Quad& quad, std::size_t corner, PatchBuilder* builder);

  const DualField& field_;
  const CellBox& box_;
  int level_;
  const DualContour& contour_;
  std::vector<std::uint32_t> site_of_;  ///< by vertex; a site has the number of one of its vertices
  std::vector<Site> sites_;
  std::vector<Face> faces_;
};

void CoarsePatch::join() {
  const std::vector<DualContour::Vertex>& vertices = contour_.vertices();
  std::vector<std::uint32_t> group(vertices.size());
  for (std::size_t n = 0; n < vertices.size(); ++n) group[n] = group_of(vertices[n]);
  site_of_.resize(vertices.size());
  std::iota(site_of_.begin(), site_of_.end(), 0u);
  for (const DualContour::Quad& quad : contour_.quads()) {
    for (std::size_t n = 0; n < 4; ++n) {
      const std::uint32_t one = quad.vertices[n], other = quad.vertices[(n + 1) % 4];
      if (group[one] == kNone || group[one] != group[other]) continue;
      const std::uint32_t a = root(one), b = root(other);
      site_of_[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t n = 0; n < site_of_.size(); ++n) site_of_[n] = root(n);
}

/// The least sum of squared distances from the planes of all members, in the group's box.
void CoarsePatch::place_sites() {
  const std::vector<DualContour::Vertex>& vertices = contour_.vertices();
  sites_.resize(vertices.size());
  std::vector<Vec3> sums(vertices.size(), Vec3(0));
  const auto place = [&](std::size_t n) {  // in cells' lengths from the box's first cell
    const std::array<int, 3> cell = contour_.cell_of(vertices[n]);
    return Vec3(cell[0] - box_.first[0], cell[1] - box_.first[1], cell[2] - box_.first[2]) *
               field_.cell_mm +
           Vec3(vertices[n].offset_mm);
  };
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    ++sites_[site_of_[n]].members;
    sums[site_of_[n]] += place(n);
  }
  std::vector<DualQuadric> quadrics(vertices.size());
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    const std::uint32_t site = site_of_[n];
    if (sites_[site].members < 2) continue;
    const Vec3 from_mean = place(n) - sums[site] / static_cast<double>(sites_[site].members);
    for (std::uint32_t f = 0; f < vertices[n].facets; ++f) {
      quadrics[site].add(Vec3(contour_.facets()[vertices[n].first_facet + f].normal), from_mean);
    }
  }
  const Vec3 size_mm = field_.cell_mm * static_cast<double>(1 << level_);
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    Site& site = sites_[n];
    if (site.members == 0) continue;
    const std::array<int, 3> cell = contour_.cell_of(vertices[n]);
    if (site.members == 1) {
      site.position_mm = field_.place_mm(cell, vertices[n].offset_mm);
      continue;
    }
    std::array<int, 3> first;
    Vec3 group_mm;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int in_box = (cell[axis] - box_.first[axis]) >> level_ << level_;
      first[axis] = box_.first[axis] + in_box;
      group_mm[static_cast<int>(axis)] = in_box * field_.cell_mm[static_cast<int>(axis)];
    }
    const Vec3 mean = sums[n] / static_cast<double>(site.members) - group_mm;
    const DualQuadric::Least least = quadrics[n].least(mean, 3);
    site.position_mm =
        field_.place_mm(first, glm::vec3(quadrics[n].least_in_box(least, mean, size_mm)));
  }
}

std::uint32_t CoarsePatch::vertex(const DualContour::Quad& quad, std::size_t corner,
                                  PatchBuilder* builder) {
  const std::uint32_t facet_number = quad.facets[corner];
  std::uint32_t& known = builder->vertex_of_facet(facet_number);
  if (known != kNone) return known;
  const DualContour::Facet& facet = contour_.facets()[facet_number];
  Site& site = sites_[site_of_[quad.vertices[corner]]];
  // Facets of one vertex stay apart, as in the neighbours' patches.
  std::uint32_t face = site.members > 1 ? site.first_face : kNone;
  while (face != kNone && glm::dot(faces_[face].first_normal, facet.normal) < kDualSharp) {
    face = faces_[face].next;
  }
  if (face != kNone) {
    faces_[face].sum += facet.normal;
    builder->merge(faces_[face].vertex, glm::normalize(faces_[face].sum), facet.cut_by);
    return known = faces_[face].vertex;
  }
  known = builder->add_vertex(site.position_mm, facet);
  faces_.push_back({known, site.first_face, facet.normal, facet.normal});
  site.first_face = static_cast<std::uint32_t>(faces_.size() - 1);
  return known;
}

}  // namespace

MeshPatch make_dual_patch(const DualField& field, const CellBox& box, int level, bool keeps_cut_ids,
                          DualContour* contour) {
  contour->contour(field, box);
  if (level == 0) return full_patch(field, *contour, keeps_cut_ids);
  return CoarsePatch(field, box, level, *contour).make(keeps_cut_ids);
}

}  // namespace kerf
