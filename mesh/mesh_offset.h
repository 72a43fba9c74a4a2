// mesh/mesh_offset.h - a body grown by an allowance.
#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"
#include "mesh/mesh_body.h"

namespace kerf {

/// All that is no farther than `allowance_mm` from the body: flat faces move outward by it, edges
/// and corners that stand out become round, those that lie deep stay sharp. Nowhere more, and at
/// the round ones less by no more than kRounding_mm.
///
/// Where the surface is smooth its triangles move outward (smooth_skin.h): as many as there were.
/// Elsewhere there is a convex piece on each face, edge and corner, which overlap: some 30
/// triangles for each, some hundreds at a corner that stands out. What the body says of its volume
/// and of what leans over stays that of what was grown. Error, in the name of `name`: there would
/// be more than `kMostGrown` triangles.
Result<MeshBody> grown(const MeshBody& body, double allowance_mm, const std::string& name);
inline constexpr double kRounding_mm = 0.01;
inline constexpr std::size_t kMostGrown = 20'000'000;

}  // namespace kerf
