// stock/turning/mesh_profile.h - the profile of a mesh that turns about Z.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "mesh/mesh_body.h"
#include "stock/plane/outline.h"

namespace kerf {

/// Sections of a body that turns about X0 Y0 along Z through its axis, some in different
/// directions, as a drawing has it: x is Z, y the radius, both halves. Corners are taken where the
/// mesh has them: facets stand for the round surface through their corners.
///
/// Error: a corner, an edge or a facet that is not of such a body: facets deeper than kFacet_mm
/// below the round (few sides, a flat, an arm), sections that cannot be closed. A mesh with an
/// allowance. `name` is the file's.
Result<std::vector<PlaneOutline>> sections_of(const MeshBody& body, const std::string& name);
inline constexpr double kFacet_mm = 0.05;

}  // namespace kerf
