// mesh/threemf_mesh.h - meshes from 3MF files. The only user of expat.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "mesh/mesh_joiner.h"

namespace kerf {

/// What the file has built: the meshes of its items, components where they are placed (also those
/// that the production extension keeps in parts of their own), in mm by the file's unit. Materials
/// and colours are passed over. A file that requires any other extension is refused, since its
/// shape would not be that of its meshes. Reads 3D/3dmodel.model, else the only .model that there
/// is. Unpacks no more than `kMaxModel_bytes`. Any bytes are accepted. Errors name the file:
///     a.3mf: is no whole zip file
///     a.3mf: 3D/3dmodel.model:7: not well-formed (invalid token)
///     a.3mf: 3D/3dmodel.model:7: triangle with corner 12; 8 corners are there
Done parse_3mf(std::string_view bytes, const std::string& path, MeshJoiner& joiner);
inline constexpr std::size_t kMaxModel_bytes = std::size_t{1} << 30U;

}  // namespace kerf
