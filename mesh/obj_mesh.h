// mesh/obj_mesh.h - meshes from Wavefront's OBJ files.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "mesh/mesh_joiner.h"

namespace kerf {

/// Corners (v) and faces (f) of all groups; faces of more than three corners become a fan. What
/// says how it looks is passed over. The file has no unit: `mm_per_unit` scales. Any bytes are
/// accepted. Errors name the file and the line:
///     a.obj:7: corner 12 is not there; 8 corners are before it
///     a.obj:7: 'x' found where a number is due
///     a.obj:7: a face that is not convex; triangles are understood
///     a.obj:7: 'surf': curved surfaces are not read; triangles are understood
Done parse_obj(std::string_view bytes, const std::string& path, double mm_per_unit,
               MeshJoiner& joiner);

}  // namespace kerf
