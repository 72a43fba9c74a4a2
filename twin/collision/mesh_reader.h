// twin/collision/mesh_reader.h - a mesh from a file of any format that is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

enum class MeshFormat : std::uint8_t { kStl, kObj, k3mf };

struct MeshFromFile {
  TriangleMesh mesh;
  std::size_t flat = 0;  ///< triangles with two equal corners, which are left out
};

/// Reads STL (stl_mesh.h), OBJ (obj_mesh.h) or 3MF (threemf_mesh.h). `mm_per_unit` scales; a 3MF
/// says its unit itself. Files of more than kMaxStl_bytes, and meshes of more than `most_triangles`
/// are refused: of a binary STL before more than its head is read. Errors name the file.
Result<MeshFromFile> read_mesh(const std::string& path, MeshFormat format, double mm_per_unit,
                               std::size_t most_triangles);

/// The same from the file's bytes; `path` names them. Any bytes are accepted.
Result<MeshFromFile> parse_mesh(std::string_view bytes, const std::string& path, MeshFormat format,
                                double mm_per_unit, std::size_t most_triangles);

}  // namespace kerf
