// twin/page/surface_simplifier.h - a surface with fewer triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

namespace kerf {

/// Triangles counter-clockwise seen from outside; corners are shared.
struct PageSurface {
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::vector<std::uint16_t> groups;   ///< one a corner; empty: all are of one
};

struct SimplifyOptions {
  double most_mm = 0;  ///< no plane of a triangle that goes is farther from a corner that stays
  std::size_t least_triangles = 0;  ///< it is enough when there are no more
  bool keeps_rim = false;           ///< edges of one triangle stay as they are
};

/// Edges are drawn together, one corner onto the other, which stays where it is (M. Garland,
/// P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997, with the sum
/// of squared distances as a bound of the largest). Never where triangles would turn over, become
/// slivers, or leave a closed surface open, and not from one group onto another; where groups meet,
/// the border may move 20 times `most_mm`. A surface that is closed stays so. meshoptimizer 0.18
/// (Debian 12) folds what is flat. About 2 us a triangle of what comes in.
void simplify_surface(PageSurface& surface, const SimplifyOptions& options);

}  // namespace kerf
