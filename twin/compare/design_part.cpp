#include "twin/compare/design_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

/// Askew to all that is likely to be straight in a part.
const std::array<Vec3, 3> kRays{Vec3(0.3717, 0.2239, 0.9009), Vec3(-0.8213, 0.4391, 0.3641),
                                Vec3(0.1973, -0.9311, 0.3067)};

Diagnostic remark(Severity severity, const std::string& name, std::string message,
                  std::string hint) {
  Diagnostic d;
  d.severity = severity;
  d.file = name;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

}  // namespace

DesignPart::DesignPart(const TriangleMesh& mesh, const std::string& name, Diagnostics& diagnostics)
    : tree_(mesh) {
  const SurfaceSides sides = surface_sides(mesh);
  facts_ = sides.facts;
  edge_normals_.reserve(size());
  corner_normals_.reserve(size());
  for (std::uint32_t t = 0; t < size(); ++t) {
    const std::uint32_t number = tree_.number_in_mesh(t);
    const std::array<std::uint32_t, 3>& corners = mesh.triangles[number];
    edge_normals_.push_back(sides.edge_normals[number]);
    corner_normals_.push_back({sides.corner_normals[corners[0]], sides.corner_normals[corners[1]],
                               sides.corner_normals[corners[2]]});
  }
  trusts_normals_ = facts_.turned_edges == 0;
  if (facts_.turned_edges > 0) {
    diagnostics.push_back(
        remark(Severity::kWarning, name,
               trf("at {} of {} edges the triangles disagree on which side is outside; sides are "
                   "found by counting crossings instead",
                   facts_.turned_edges, facts_.edges),
               tr("the CAD program's mesh repair makes the normals uniform")));
  }
  if (!facts_.is_closed()) {
    diagnostics.push_back(
        remark(Severity::kWarning, name,
               trf("is not closed: {} of {} edges belong to one triangle only; near them "
                   "gouge and excess may be mistaken for each other",
                   facts_.open_edges, facts_.edges),
               tr("export the part as one solid, or repair the mesh")));
  } else if (trusts_normals_ && facts_.volume_mm3 < 0) {
    outward_ = -1;
    diagnostics.push_back(remark(
        Severity::kNote, name, tr("is inside out (all normals point inwards); it is turned"), {}));
  }
}

double DesignPart::distance_mm(const Vec3& p) const {
  std::uint32_t hint = 0;
  return distance_mm(p, hint);
}

double DesignPart::distance_mm(const Vec3& p, std::uint32_t& hint) const {
  const NearestPoint near = tree_.nearest(p, hint);
  hint = near.triangle;
  const double distance = std::sqrt(near.distance2_mm2);
  if (distance == 0) return 0;
  Vec3 normal(0);
  const auto feature = static_cast<std::size_t>(near.feature);
  constexpr auto kCorner = static_cast<std::size_t>(TriangleFeature::kCorner0);
  constexpr auto kEdge = static_cast<std::size_t>(TriangleFeature::kEdge0);
  if (near.feature == TriangleFeature::kFace) {
    const std::array<glm::vec3, 3>& c = tree_.corners(near.triangle);
    normal = glm::cross(Vec3(c[1]) - Vec3(c[0]), Vec3(c[2]) - Vec3(c[0]));
  } else if (feature >= kEdge) {
    normal = Vec3(edge_normals_[near.triangle][feature - kEdge]);
  } else {
    normal = Vec3(corner_normals_[near.triangle][feature - kCorner]);
  }
  const double side = outward_ * glm::dot(p - near.point_mm, normal);
  if (trusts_normals_ && side != 0) return side < 0 ? -distance : distance;
  return is_inside_by_rays(p) ? -distance : distance;
}

double DesignProbe::distance_mm(const Vec3& p, double reach_mm) {
  if (!(std::abs(known_mm_) - glm::distance(p, known_at_mm_) > reach_mm)) {
    known_mm_ = part_.distance_mm(p, hint_);
    known_at_mm_ = p;
  }
  // Or it is beyond the reach, on the side of the point before.
  return std::clamp(known_mm_, -reach_mm, reach_mm);
}

bool DesignPart::is_inside_by_rays(const Vec3& p) const {
  int inside = 0;
  for (const Vec3& ray : kRays) inside += tree_.crossings(p, ray) % 2 == 1 ? 1 : 0;
  return inside >= 2;
}

}  // namespace kerf
