#include "mesh/mesh_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "mesh/surface_sides.h"

namespace kerf {
namespace {

std::string place_text(const Vec3& p) {
  return fmt::format("X{:.3f} Y{:.3f} Z{:.3f}", p.x, p.y, p.z);
}

std::string places_text(const std::vector<Vec3>& places) {
  std::string text;
  for (const Vec3& p : places) text += (text.empty() ? "" : ", ") + place_text(p);
  return text;
}

/// How many parts share no corner.
std::size_t count_parts(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions_mm.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&parent](std::uint32_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (const auto& triangle : mesh.triangles) {
    parent[root(triangle[1])] = root(triangle[0]);
    parent[root(triangle[2])] = root(triangle[0]);
  }
  std::vector<bool> seen(parent.size());
  std::size_t parts = 0;
  for (const auto& triangle : mesh.triangles) {
    const std::uint32_t n = root(triangle[0]);
    if (!seen[n]) ++parts;
    seen[n] = true;
  }
  return parts;
}

void find_overhang(MeshBody& body) {
  const double floor = body.box_mm.min.z;
  double largest = 0;
  for (const auto& triangle : body.mesh.triangles) {
    const Vec3 a(body.mesh.positions_mm[triangle[0]]), b(body.mesh.positions_mm[triangle[1]]),
        c(body.mesh.positions_mm[triangle[2]]);
    const double seen = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    const double high = std::max({a.z, b.z, c.z});
    if (seen >= 0 || high <= floor + kUpright_mm) continue;
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    if (-seen <= kUpright_mm * longest) continue;
    body.overhang_mm2 -= seen;
    if (-seen <= largest) continue;
    largest = -seen;
    body.overhang_z_mm = std::min({a.z, b.z, c.z});
  }
}

}  // namespace

Result<MeshBody> mesh_body(TriangleMesh mesh, const std::string& name) {
  if (mesh.triangles.empty()) return Error{trf("{}: has no triangles", name)};
  const MeshFacts facts = surface_sides(mesh).facts;
  if (!facts.is_closed()) {
    return Error{
        trf("{}: is not closed: {} of {} edges belong to one triangle only, at {} (mm); a "
            "blank must enclose its material",
            name, facts.open_edges, facts.edges, places_text(facts.first_open_mm))};
  }
  if (facts.turned_edges > 0) {
    return Error{
        trf("{}: at {} of {} edges the triangles disagree on which side is outside, at {} "
            "(mm)",
            name, facts.turned_edges, facts.edges, places_text(facts.first_turned_mm))};
  }
  MeshBody body;
  body.volume_mm3 = facts.volume_mm3;
  if (facts.volume_mm3 < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    body.was_turned = true;
    body.volume_mm3 = -facts.volume_mm3;
  }
  for (const glm::vec3& p : mesh.positions_mm) body.box_mm.extend(Vec3(p));
  const Vec3 size = body.box_mm.size();
  // Positions are single precision: a volume less than what they round by is none.
  if (std::min({size.x, size.y, size.z}) < kUpright_mm ||
      body.volume_mm3 <= 1e-6 * size.x * size.y * size.z * kUpright_mm) {
    return Error{
        trf("{}: encloses nothing: it is {:g} x {:g} x {:g} mm", name, size.x, size.y, size.z)};
  }
  body.mesh = std::move(mesh);
  find_overhang(body);
  body.parts = count_parts(body.mesh);
  return body;
}

}  // namespace kerf
