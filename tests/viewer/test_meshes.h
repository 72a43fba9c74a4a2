// tests/viewer/test_meshes.h - meshes and PNG reading for the tests of viewer/.
#pragma once

#include <string>

#include "base/geometry.h"
#include "base/triangle_mesh.h"
#include "viewer/picture.h"

namespace kerf {

/// Twelve triangles, eight shared corners.
TriangleMesh box_mesh(const Box& box);

/// Upright prism around the Z axis with `sides` sides; both caps are fans around a corner in their
/// middle.
TriangleMesh prism_mesh(int sides, float radius_mm, float height_mm);

/// The top of a part on a grid of `cells` x `cells` over 0..100 mm: waves, a round pocket 20 mm
/// deep, a ridge.
TriangleMesh relief_mesh(int cells);

/// The same grid as plateaus, 0.4 mm one above the other and `period_mm` from one to the next, as
/// reliefs of plywood and maps are cut.
TriangleMesh terrace_mesh(int cells, double period_mm);

/// One patch, shaded by shade_mesh().
PartPatches part_of(const TriangleMesh& mesh);

/// Empty picture if the file is not a PNG.
Picture read_png(const std::string& path);

}  // namespace kerf
