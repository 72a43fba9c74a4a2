// mesh/stl_mesh.h - meshes of links from STL files, as vismach users have them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/triangle_mesh.h"
#include "mesh/mesh_joiner.h"

namespace kerf {

/// Larger ones are refused before they are read: no link of a machine needs that.
inline constexpr std::size_t kMaxStl_bytes = std::size_t{512} << 20U;

/// Of a binary STL: a text, and how many triangles follow, 50 bytes each.
inline constexpr std::size_t kStlHead_bytes = 84;
/// As the head of a file of `size` bytes says; 0: it is no binary STL.
std::size_t triangles_of_stl(std::string_view head, std::size_t size);

/// Binary or ASCII STL (told apart by size: a binary file is 84 bytes and 50 a triangle, whatever
/// its head says). Corners that are equal become one, so that the mesh shades smooth; normals of
/// the file are not used. `mm_per_unit` scales. Errors name the file, what is wrong and where:
///     cannot read head.stl: No such file or directory
///     head.stl: cut off: 1000 triangles announced, which take 50084 bytes, but 20000 bytes found
///     head.stl:14: 'vertx' found where 'vertex' is due
///     head.stl: triangle 7: a corner is no number
Result<TriangleMesh> read_stl(const std::string& path, double mm_per_unit);

/// The same from the file's bytes; `path` names them. Any bytes are accepted.
Result<TriangleMesh> parse_stl(std::string_view bytes, const std::string& path, double mm_per_unit);
Done parse_stl(std::string_view bytes, const std::string& path, double mm_per_unit,
               MeshJoiner& joiner);

}  // namespace kerf
