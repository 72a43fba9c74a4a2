// base/mesh_patch.h - one tile of a workpiece's surface as triangles, ready to be uploaded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace kerf {

/// Corner of a triangle: 16 bytes, as a vertex buffer takes them.
///   attribute 0: 3 x GL_FLOAT at offset 0, mm, workpiece frame
///   attribute 1: 4 x GL_INT_2_10_10_10_REV, normalised, at offset 12
struct MeshVertex {
  glm::vec3 position_mm;
  /// Unit normal out of the material: x in bits 0..9, y in 10..19, z in 20..29, each as a signed
  /// fraction of 511; bits 30 and 31 are 0. About 0.1 degrees fine.
  std::uint32_t normal;
};
static_assert(sizeof(MeshVertex) == 16);

/// `normal` need not be of unit length if each component is within -1..1.
inline std::uint32_t pack_normal(const glm::vec3& normal) {
  const auto bits = [](float value) {
    const int steps = static_cast<int>(std::lround(std::clamp(value, -1.0f, 1.0f) * 511.0f));
    return static_cast<std::uint32_t>(steps) & 0x3ffu;
  };
  return bits(normal.x) | bits(normal.y) << 10 | bits(normal.z) << 20;
}

/// Unit length again.
inline glm::vec3 unpack_normal(std::uint32_t packed) {
  const auto value = [packed](int shift) {
    const int steps = static_cast<int>(packed >> shift & 0x3ffu);
    return static_cast<float>(steps >= 512 ? steps - 1024 : steps) / 511.0f;
  };
  return glm::normalize(glm::vec3(value(0), value(10), value(20)));
}

/// The surface of one tile. Triangles counter-clockwise seen from outside.
///
///   indices[0 .. skirt_begin)    what is seen: top, walls, and the tile's share of the workpiece's
///                                sides and floor. Over all tiles of one level this is closed.
///   indices[skirt_begin .. end)  skirts: the tile's border carried down as far as a neighbour may
///                                lie lower that is drawn at another level. To be drawn as well
///                                where there is one; they are inside the material otherwise.
struct MeshPatch {
  std::uint32_t tile = 0;
  std::uint64_t version = 0;  ///< StockModel::patch_version() of what it was made from
  int level = 0;              ///< 0: every cell; n: one of 2^n x 2^n cells
  /// Tiles are counted row by row, so many in each; 0 where there are no skirts.
  std::uint32_t tiles_in_row = 0;
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::uint32_t skirt_begin = 0;       ///< a multiple of three
  /// One a vertex: number (CutMove::id) of the move that cut there last, kNotCut on what is left of
  /// the blank's surface. Where cells of several moves meet, that of the lowest; on a wall that of
  /// its lower side. Empty where the model does not keep it (StockModel::keep_cut_ids).
  std::vector<std::uint32_t> cut_by;
  /// One a vertex: distance from the design part's surface, positive where material is left over,
  /// negative where too much is gone. Empty without a design part.
  std::vector<float> deviation_mm;
  static constexpr std::uint32_t kNotCut = 0xffff'ffff;

  std::span<const std::uint32_t> surface_indices() const {
    return std::span(indices).first(skirt_begin);
  }
  std::span<const std::uint32_t> skirt_indices() const {
    return std::span(indices).subspan(skirt_begin);
  }
  std::size_t bytes() const {
    return vertices.size() * sizeof(MeshVertex) + indices.size() * sizeof(std::uint32_t) +
           cut_by.size() * sizeof(std::uint32_t) + deviation_mm.size() * sizeof(float);
  }
};

}  // namespace kerf
