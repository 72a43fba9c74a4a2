#include "mesh/smooth_skin.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <utility>

namespace kerf {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Six times the volume of a tetrahedron.
double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return glm::dot(b - a, glm::cross(c - a, d - a));
}

/// The prism between two triangles, split into tetrahedra as its walls are (the lower number's low
/// corner to the higher one's high corner), has none that is turned inside out.
bool is_unfolded(const TriangleMesh& mesh, const std::vector<glm::vec3>& outer_mm,
                 Corners corners) {
  double sense = 1;
  const auto order = [&](std::size_t a, std::size_t b) {
    if (corners[a] < corners[b]) return;
    std::swap(corners[a], corners[b]);
    sense = -sense;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  std::array<Vec3, 3> low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = Vec3(mesh.positions_mm[corners[k]]);
    high[k] = Vec3(outer_mm[corners[k]]);
  }
  return sense * six_volumes(low[0], low[1], low[2], high[2]) > 0 &&
         sense * six_volumes(low[0], low[1], high[2], high[1]) > 0 &&
         sense * six_volumes(low[0], high[0], high[1], high[2]) > 0;
}

}  // namespace

SmoothSkin smooth_skin(const TriangleMesh& mesh, std::span<const Vec3> normals,
                       std::span<const HalfEdge> halves, double allowance_mm, double rounding_mm) {
  const std::size_t positions = mesh.positions_mm.size(), faces = mesh.triangles.size();
  SmoothSkin skin;
  skin.faces.assign(faces, SmoothSkin::Face::kPieces);
  skin.outer_mm.assign(positions, glm::vec3(0));
  std::vector<Vec3> way(positions, Vec3(0));
  for (std::size_t t = 0; t < faces; ++t)
    for (const std::uint32_t corner : mesh.triangles[t]) way[corner] += normals[t];
  for (std::size_t n = 0; n < positions; ++n) {
    const double length = glm::length(way[n]);
    if (length > 0) way[n] /= length;
    skin.outer_mm[n] = glm::vec3(Vec3(mesh.positions_mm[n]) + allowance_mm * way[n]);
  }
  const double least_cosine = 1 - rounding_mm / allowance_mm;
  std::vector<bool> is_smooth(positions, true);
  for (std::size_t t = 0; t < faces; ++t)
    for (const std::uint32_t corner : mesh.triangles[t])
      if (glm::dot(way[corner], normals[t]) < least_cosine) is_smooth[corner] = false;
  // Walls are shared by two triangles, or they are not shared.
  for (std::size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
    for (end = begin; end < halves.size() && halves[end].ends == halves[begin].ends; ++end) {
    }
    if (end - begin == 2 && halves[begin].is_rising != halves[begin + 1].is_rising) continue;
    const Corners& c = mesh.triangles[halves[begin].number / 3];
    is_smooth[c[halves[begin].number % 3]] = false;
    is_smooth[c[(halves[begin].number + 1) % 3]] = false;
  }
  std::vector<bool> has_pieces(positions, false);
  for (std::size_t t = 0; t < faces; ++t) {
    const Corners& c = mesh.triangles[t];
    const bool has_prism = std::ranges::all_of(c, [&](std::uint32_t n) { return is_smooth[n]; }) &&
                           is_unfolded(mesh, skin.outer_mm, c);
    if (has_prism) {
      skin.faces[t] = SmoothSkin::Face::kSkin;
    } else {
      for (const std::uint32_t corner : c) has_pieces[corner] = true;
    }
  }
  for (std::size_t t = 0; t < faces; ++t) {
    const Corners& c = mesh.triangles[t];
    if (skin.has_prism(t) && std::ranges::any_of(c, [&](std::uint32_t n) { return has_pieces[n]; }))
      skin.faces[t] = SmoothSkin::Face::kBoth;
  }
  return skin;
}

}  // namespace kerf
