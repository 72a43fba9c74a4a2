// mesh/mesh_reader.h - a mesh from a file of any format that is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

enum class MeshFormat : std::uint8_t { kStl, kObj, k3mf, kStep };

/// As the ending of the name says, in any case; nothing: it is none of them.
std::optional<MeshFormat> mesh_format_of(const std::string& path);

struct MeshFromFile {
  TriangleMesh mesh;
  std::size_t flat = 0;  ///< triangles with two equal corners, which are left out
};

/// Reads STL (stl_mesh.h), OBJ (obj_mesh.h), 3MF (threemf_mesh.h) or STEP (step_file.h).
/// `mm_per_unit` scales; 3MF and STEP say their unit themselves. Files of more than kMaxStl_bytes,
/// and meshes of more than `most_triangles` are refused: of a binary STL before more than its head
/// is read. Errors name the file.
Result<MeshFromFile> read_mesh(const std::string& path, MeshFormat format, double mm_per_unit,
                               std::size_t most_triangles);

/// The same from the file's bytes, but of STEP; `path` names them. Any bytes are accepted.
Result<MeshFromFile> parse_mesh(std::string_view bytes, const std::string& path, MeshFormat format,
                                double mm_per_unit, std::size_t most_triangles);

}  // namespace kerf
