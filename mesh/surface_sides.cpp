#include "mesh/surface_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/geometry.h"
#include "base/portable_math.h"

namespace kerf {
namespace {

/// Which corners of triangles are joined around a position without leaving the surface. Where two
/// parts touch in a point there are several such groups.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t x, std::uint32_t y) { parent_[root(x)] = root(y); }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t next_corner(std::uint32_t number) {
  return number % 3 == 2 ? number - 2 : number + 1;
}

/// The middle of the edge that begins at this corner.
void note_place(const TriangleMesh& mesh, std::uint32_t number, std::vector<Vec3>& places) {
  if (places.size() >= kFewPlaces) return;
  const auto& triangle = mesh.triangles[number / 3];
  places.push_back(0.5 * (Vec3(mesh.positions_mm[triangle[number % 3]]) +
                          Vec3(mesh.positions_mm[triangle[(number + 1) % 3]])));
}

struct Faces {
  std::vector<Vec3> normals;  ///< unit length, or 0 without area
  std::vector<std::array<double, 3>> angles_rad;
};

Faces faces_of(const TriangleMesh& mesh, MeshFacts& facts) {
  Faces faces;
  faces.normals.reserve(mesh.triangles.size());
  faces.angles_rad.reserve(mesh.triangles.size());
  const Vec3 origin(mesh.positions_mm.front());  // near the part: volumes stay small
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3(mesh.positions_mm[triangle[k]]) - origin;
    const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(normal);
    faces.normals.push_back(length > 0 ? normal / length : Vec3(0));
    facts.volume_mm3 += glm::dot(p[0], normal) / 6;
    std::array<double, 3> angles{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
      angles[k] = portable::atan2(length, glm::dot(u, v));
    }
    faces.angles_rad.push_back(angles);
  }
  return faces;
}

}  // namespace

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      const std::uint64_t low = std::min(from, to), high = std::max(from, to);
      halves.push_back({low << 32U | high, static_cast<std::uint32_t>(3 * t + k), from < to});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return x.ends != y.ends ? x.ends < y.ends : x.number < y.number;
  });
  return halves;
}

SurfaceSides surface_sides(const TriangleMesh& mesh) {
  SurfaceSides sides;
  const Faces faces = faces_of(mesh, sides.facts);
  sides.edge_normals.assign(mesh.triangles.size(), {});
  sides.corner_normals.assign(mesh.positions_mm.size(), glm::vec3(0));
  const std::vector<HalfEdge> halves = sorted_half_edges(mesh);
  CornerGroups groups(halves.size());
  std::vector<bool> is_doubtful(mesh.positions_mm.size());
  for (std::size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
    std::size_t rising = 0;
    for (end = begin; end < halves.size() && halves[end].ends == halves[begin].ends; ++end) {
      rising += halves[end].is_rising ? 1 : 0;
    }
    ++sides.facts.edges;
    const std::uint32_t a = halves[begin].number;
    if (end - begin == 2 && rising == 1) {
      const std::uint32_t b = halves[begin + 1].number;
      const glm::vec3 normal(faces.normals[a / 3] + faces.normals[b / 3]);
      sides.edge_normals[a / 3][a % 3] = sides.edge_normals[b / 3][b % 3] = normal;
      groups.join(a, next_corner(b));
      groups.join(next_corner(a), b);
      continue;
    }
    if (end - begin == 1) {
      ++sides.facts.open_edges;
      note_place(mesh, a, sides.facts.first_open_mm);
    } else if (2 * rising != end - begin) {
      ++sides.facts.turned_edges;
      note_place(mesh, a, sides.facts.first_turned_mm);
    }
    is_doubtful[mesh.triangles[a / 3][a % 3]] = true;
    is_doubtful[mesh.triangles[a / 3][(a + 1) % 3]] = true;
  }
  std::vector<std::uint32_t> group_of(mesh.positions_mm.size(), UINT32_MAX);
  for (std::uint32_t corner = 0; corner < halves.size(); ++corner) {
    const std::size_t triangle = corner / 3, k = corner % 3;
    const std::uint32_t position = mesh.triangles[triangle][k];
    const std::uint32_t group = groups.root(corner);
    if (group_of[position] == UINT32_MAX) group_of[position] = group;
    if (group_of[position] != group) is_doubtful[position] = true;
    sides.corner_normals[position] +=
        glm::vec3(faces.normals[triangle] * faces.angles_rad[triangle][k]);
  }
  for (std::size_t n = 0; n < is_doubtful.size(); ++n) {
    if (is_doubtful[n]) sides.corner_normals[n] = glm::vec3(0);
  }
  return sides;
}

}  // namespace kerf
