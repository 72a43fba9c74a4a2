#include "mesh/mesh_joiner.h"

#include <bit>
#include <cmath>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

/// Farther away a position has less than a hundredth of a millimetre.
constexpr float kFar_mm = 1e5f;

}  // namespace

std::size_t MeshJoiner::Hash::operator()(const glm::vec3& p) const {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29U;
  }
  return hash;
}

Done MeshJoiner::announce(std::size_t triangles, const std::string& path) const {
  if (triangles <= most_) return Done{std::monostate{}};
  return Error{trf("{}: has {} triangles or more; must be from 1 to {}", path, triangles, most_)};
}

Done MeshJoiner::add(const std::array<glm::vec3, 3>& corners, const std::string& path) {
  if (Done fits = announce(++seen_, path); !fits) return fits;
  std::array<std::uint32_t, 3> triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 p = corners[i] + glm::vec3(0.0f);  // -0 becomes 0: they are the same place
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) <= kFar_mm) continue;
      return Error{trf("{}: triangle {}: a corner is no number, or farther away than {} m", path,
                       seen_, kFar_mm / 1000)};
    }
    triangle[i] = index_of(p);
  }
  const bool flat =
      triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
  if (flat) {
    ++flat_;
  } else {
    mesh_.triangles.push_back(triangle);
  }
  return Done{std::monostate{}};
}

std::uint32_t MeshJoiner::index_of(const glm::vec3& p) {
  const auto next = static_cast<std::uint32_t>(mesh_.positions_mm.size());
  const auto [at, is_new] = places_.try_emplace(p, next);
  if (is_new) mesh_.positions_mm.push_back(p);
  return at->second;
}

Result<TriangleMesh> MeshJoiner::take(const std::string& path) {
  if (mesh_.triangles.empty()) return Error{trf("{}: has no triangles", path)};
  return std::move(mesh_);
}

}  // namespace kerf
