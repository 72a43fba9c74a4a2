// stock/turning/wound_surface.h - surfaces of parts that have threads.
//
//      a row of places round the axis, each with     The contour of one section and that of the
//      the section that the part has there:          next one are joined corner by corner, always
//                                                    by the shorter diagonal. So crests, roots and
//        __   __   __                                flanks run on as the helices that they are,
//       |  \_/  \_/  |       at angle 0              and where a groove begins or ends it does so
//       |_\_/  \_/  _|       a little farther        within one step of the angle.
//
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/turning/bar_flats.h"
#include "stock/turning/thread_set.h"

namespace kerf::turning {

/// What is there at angles that divide the turn evenly, from 0 on: also where a bar has flats.
using WoundSections = std::vector<std::vector<Contour>>;
/// O(angles times turns of all passes).
WoundSections wound_sections(std::span<const Contour> region, const ThreadSet& threads,
                             int segments, const std::optional<BarFlats>& flats);
/// Takes off what a flat cuts off at an angle.
void cut_flat(const BarFlats& flats, double angle_rad, ConvexCut& cut,
              std::vector<Contour>& region);

/// As revolve(): closed, within the tolerance but for what a groove moves along its way within one
/// step of the angle, where it begins or ends. A contour that is another number of rings at other
/// angles (a groove that cuts through a wall, or into a neck) is shown as the ring that it is
/// without threads.
TriangleMesh wind(std::span<const Contour> region, const ThreadSet& threads, double tolerance_mm,
                  const std::optional<BarFlats>& flats);

/// As revolve_band(), of sections at kPatchSegments angles: neighbours fit together, with threads
/// or without.
MeshPatch wind_band(const WoundSections& sections, std::span<const Contour> region, Unit low_z,
                    Unit high_z, bool has_high_face, double tolerance_mm,
                    const std::optional<BarFlats>& flats);

}  // namespace kerf::turning
