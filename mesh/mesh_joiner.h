// mesh/mesh_joiner.h - triangles of mesh files, joined where their corners are equal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <unordered_map>

#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// A mesh on its way from a file. Corners that are equal become one, so that it shades smooth and
/// can be told to be closed.
class MeshJoiner {
 public:
  /// More triangles than `most` are refused: before they are read, where the file announces them.
  explicit MeshJoiner(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  /// mm. A triangle with two equal corners is counted as flat and left out. Errors name the file:
  ///     a.stl: triangle 7: a corner is no number, or farther away than 100 m
  ///     a.stl: has 10000000 triangles; must be from 1 to 2000000
  Done add(const std::array<glm::vec3, 3>& corners, const std::string& path);
  /// What a file says that it has.
  Done announce(std::size_t triangles, const std::string& path) const;

  std::size_t most() const { return most_; }
  std::size_t flat() const { return flat_; }
  /// Error: it has no triangles.
  Result<TriangleMesh> take(const std::string& path);

 private:
  struct Hash {
    std::size_t operator()(const glm::vec3& p) const;
  };
  std::uint32_t index_of(const glm::vec3& p);

  std::size_t most_;
  std::size_t seen_ = 0, flat_ = 0;
  TriangleMesh mesh_;
  std::unordered_map<glm::vec3, std::uint32_t, Hash> places_;
};

}  // namespace kerf
