// base/mesh_file.h - triangle meshes as files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/triangle_mesh.h"

namespace kerf {

/// Binary STL (80-byte head "kerf ...", little endian, unit mm; facet normals computed, 0 0 0 for a
/// triangle without area; 50 bytes a triangle) or binary little-endian PLY with shared vertices.
/// Written to a temporary name in the same folder and renamed only when all bytes are written
/// (atomic_file.h): on error (disk full, no such folder) nothing is left and an existing file is
/// untouched. The message names the file and the system's reason: "writing part.stl: No space left
/// on device". "-" writes to stdout. Every corner must be the index of a position.
Done write_stl(const std::string& path, const TriangleMesh& mesh);
Done write_ply(const std::string& path, const TriangleMesh& mesh);

/// Of each position of a mesh.
struct VertexMarks {
  std::vector<std::array<std::uint8_t, 3>> rgb;
  std::vector<float> values;
  std::string name;  ///< of the values, as the PLY's property: "deviation_mm"
};
/// With red, green, blue and the value at each vertex.
Done write_ply(const std::string& path, const TriangleMesh& mesh, const VertexMarks& marks);

}  // namespace kerf
