// tests/twin/cli/stl_text.h - blocks as STL files, for commands.
#pragma once

#include <fmt/format.h>

#include <string>

#include "base/geometry.h"

namespace kerf {

/// A closed box as text.
inline std::string stl_box(const Vec3& low, const Vec3& high) {
  constexpr int kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  std::string text = "solid block\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) {
      text += fmt::format("vertex {} {} {}\n", (corner & 1) != 0 ? high.x : low.x,
                          (corner & 2) != 0 ? high.y : low.y, (corner & 4) != 0 ? high.z : low.z);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid block\n";
}

}  // namespace kerf
