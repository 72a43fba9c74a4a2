// viewer/section.h - where a workpiece is cut open to be looked into.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "base/geometry.h"
#include "viewer/standing.h"

namespace kerf {

/// Cuts the workpiece open: what lies on the side that `normal` points to, dot(normal, p) >
/// offset_mm, is not drawn, and the cut is closed with a flat hatched face. Path, outlines, tool
/// and machine stay whole.
struct SectionPlane {
  Vec3 normal{0.0, -1.0, 0.0};  ///< Need not be of unit length, but not 0: offset_mm is for it.
  double offset_mm = 0.0;
  bool operator==(const SectionPlane&) const = default;
};

/// With both planes only what lies beyond the two of them is taken away.
struct Section {
  SectionPlane plane;
  std::optional<SectionPlane> beside;
};

enum class SectionKind : std::uint8_t {
  kNone,
  kHalf,     ///< the half before the middle is taken away, as a front view sees it
  kQuarter,  ///< the upper quarter of it; of what lies on a table the one at the right
};

/// Through the middle of the bounds. None of kNone and where there are no bounds.
std::optional<Section> usual_section(SectionKind kind, const Box& bounds_mm, Standing standing);

/// The plane in the frame of the workpiece, of unit normal: dot(plane, (p, 1)) >= 0 is kept. None
/// where there is no direction.
std::optional<glm::dvec4> kept_side(const SectionPlane& plane);

/// Of two planes in the frame of clip space: where a pixel shows a point of the first one that the
/// second one keeps, dot(result, (x, y, 1)) > 0, x and y from -1 to 1. The first is not seen from
/// its edge.
glm::dvec3 kept_beside(const glm::dvec4& plane, const glm::dvec4& other);

}  // namespace kerf
