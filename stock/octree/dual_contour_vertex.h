// stock/octree/dual_contour_vertex.h - where in a cell the vertex of a piece of surface lies.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "stock/octree/dual_contour_tables.h"

namespace kerf {

/// A crossing of the piece with an edge of its cell.
struct DualSample {
  glm::vec3 at_mm;   ///< from the cell's lowest corner
  glm::vec3 normal;  ///< unit
};

/// The vertex, and the faces of the part that meet in it: up to four clusters of samples, whose
/// normals differ by more than kDualSharp allows. On a smooth surface there is one.
struct DualPlacement {
  static constexpr int kMaxClusters = 4;
  glm::vec3 at_mm;  ///< from the cell's lowest corner
  int clusters = 1;
  std::array<glm::vec3, kMaxClusters> normals;      ///< unit, one a cluster
  std::array<std::uint8_t, kDualEdges> cluster_of;  ///< by sample
};

/// Cosine of 28 degrees. Normals that differ by more belong to different faces of the part. Smaller
/// folds are taken for curvature, which moves the vertex by less than 0.08 cells; so does taking a
/// surface for folded whose radius is so small that the normal turns by more within a cell.
inline constexpr float kDualSharp = 0.8829476f;
/// Cosine of 14 degrees: no two normals that are as near as this to a third differ by 28.
inline constexpr float kDualHalfSharp = 0.9702957f;

/// For samples on one smooth face of the part, `normal` their mean of unit length.
///
///            x      tangents meet here     The mean of the crossings lies on one side of a curved
///         .  |  .                          surface by as much as the tangents, at the same place,
///      .---- o ----.     surface           do on the other: in the middle curvature cancels out.
///    p       |       p                     On a plane both are on it.
///            m      mean of the crossings
glm::vec3 place_on_smooth_face(std::span<const DualSample> samples, const glm::vec3& mean_at_mm,
                               const glm::vec3& normal, const glm::vec3& cell_mm);

/// For 3 .. 12 samples of any normals. On a fold the vertex lies where the faces meet: the least
/// sum of squared distances from the samples' planes, as near to the mean of the crossings as that
/// leaves free, in the cell. Planes of a curved face are turned halfway towards the face's mean
/// normal first, for the reason above. Where planes of three faces or two meet in the cell that is
/// exact to single precision. Some 0.5 us on a fold.
/// Source: quadratic error functions, Ju, Losasso, Schaefer, Warren, "Dual contouring of Hermite
/// data", SIGGRAPH 2002; truncation of small eigenvalues about the mass point, Lindstrom, 2000.
///
/// Where all planes meet in one point up to kDualReach beyond the cell, the vertex lies there: the
/// fold crosses a grid edge twice, which signs do not show, so that it seems to run through this
/// cell. Otherwise a vertex is in its cell.
DualPlacement place_dual_vertex(std::span<const DualSample> samples, const glm::vec3& cell_mm);
inline constexpr float kDualReach = 1.0f;  ///< cells
/// The same if there are but three planes, which always meet.
inline constexpr float kDualReachOfThree = 0.25f;

/// The least of |N (x - p)|^2 by the normal equations: `square` is N^T N as xx, xy, xz, yy, yz, zz,
/// `right` N^T N (p - about).
struct DualQuadric {
  std::array<double, 6> square{};
  glm::dvec3 right{0};
  void add(const glm::dvec3& normal, const glm::dvec3& from_about);

  /// Directions beyond the first `rank`, and those that the planes leave free, stay as in `about`.
  struct Least {
    glm::dvec3 at_mm;
    int rank;              ///< of the directions that the planes tell
    glm::dvec3 last_axis;  ///< the one that they tell least
  };
  Least least(const glm::dvec3& about_mm, int rank) const;
  /// That, or if it is outside of the box from 0 to `size_mm` the least inside of it.
  glm::dvec3 least_in_box(const Least& least, const glm::dvec3& about_mm,
                          const glm::dvec3& size_mm) const;
};

}  // namespace kerf
