// stock/turning/revolve.h - contours as surfaces of revolution.
//
// The point (z, r) of a contour at the angle a is (r cos a, r sin a, z) of the workpiece frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/mesh_patch.h"
#include "base/triangle_mesh.h"
#include "stock/turning/bar_flats.h"
#include "stock/turning/contour.h"

namespace kerf::turning {

/// Corners of a chain so that it keeps within `tolerance_mm` of what it was: first and last stay,
/// of a closed one (whose last corner is its first once more) those that lie farthest apart.
///
/// Source: D. Douglas, T. Peucker, "Algorithms for the reduction of the number of points required
/// to represent a digitized line or its caricature", 1973.
std::vector<Vec2> simplified(std::span<const Vec2> chain_zr_mm, double tolerance_mm);

/// How often a circle is divided so that its sides keep within this of it.
int segments_for(double radius_mm, double tolerance_mm);

/// That or more: whole edges of a bar, and the middles of its flats, lie on directions.
int segments_with(int segments, const std::optional<BarFlats>& flats);

/// A closed surface for each contour, within the tolerance of it: half of that is for the contour,
/// half for the angle. With 0 no corner is left out, and the angle is divided as for kFinest_mm.
/// Walls thinner than the tolerance may pass through each other. What lies beyond flats is not
/// there: where a surface that rises meets a flat, it is off by at most half the tolerance more.
TriangleMesh revolve(std::span<const Contour> contours, double tolerance_mm,
                     const std::optional<BarFlats>& flats = std::nullopt);
inline constexpr double kFinest_mm = 0.002;

/// What of the surface lies in low_z .. high_z. Chains end on these, at points that are the same
/// for both neighbours, and whatever the tolerance; a face on `low_z` belongs to it, one on
/// `high_z` where `has_high_face` says so. Round the axis there are kPatchSegments at such ends and
/// along flats, elsewhere fewer, as long as facets keep within twice the tolerance. Of marked
/// contours MeshPatch::cut_by are the marks.
MeshPatch revolve_band(std::span<const Contour> contours, Unit low_z, Unit high_z,
                       bool has_high_face, double tolerance_mm,
                       const std::optional<BarFlats>& flats = std::nullopt);
inline constexpr int kPatchSegments = 120;

/// A part of a contour within a band, and the mark of each edge; closed where it never leaves.
struct BandChain {
  std::vector<Vec2> points;
  std::vector<std::uint32_t> marks;
};
/// The chains that revolve_band() is made of, in the contour's direction.
std::vector<BandChain> band_chains(const Contour& contour, Unit low_z, Unit high_z,
                                   bool has_high_face);
/// Simplified between corners where another mark begins. Runs of a mark that are shorter than
/// kMarkTolerances times the tolerance are one with those after them, and have the mark of the
/// longest: at a quarter of a pixel, such that nobody can point at.
inline constexpr double kMarkTolerances = 4;
BandChain simplified_by_marks(const BandChain& chain, double tolerance_mm);

}  // namespace kerf::turning
