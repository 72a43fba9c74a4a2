// twin/compare/rest.h - what a program has left for further machining, and which tools would reach
// it: values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// A tool that rest material is held against.
struct RestTool {
  int number = 0;
  std::string shape;       ///< SHAPE text
  bool guessed = false;    ///< the shape is a guess
  bool used = false;       ///< by the program; false: it was only described
  std::string left_out;    ///< not empty: it was not looked at, and why
  double takes_mm3 = 0;    ///< of all regions
  std::size_t clears = 0;  ///< regions in which it leaves no more than the thickness
};

/// What one tool would do in a region.
struct RestReach {
  std::size_t tool = 0;  ///< index of Rest::tools
  double takes_mm3 = 0;
  double leaves_mm = 0;  ///< the greatest thickness that then stands there
};

/// What hangs together, seen from above, and is thicker than Rest::thickness_mm.
struct RestRegion {
  Box box_mm;                      ///< z from the design to the top of the material
  double area_mm2 = 0;             ///< seen from above
  double volume_mm3 = 0;           ///< above the design
  double thickness_mm = 0;         ///< greatest
  Vec3 at_mm{0};                   ///< there, on the workpiece
  std::vector<RestReach> by_tool;  ///< by all that were looked at, in their order
};

/// A picture of it from above.
struct RestMap {
  Box bounds_mm;
  int nx = 0, ny = 0;
  /// Of each cell, row by row from low x, y: one of the below, or kByTool plus the index of a tool
  /// that leaves no more than the thickness there (the widest one).
  static constexpr std::uint8_t kNothing = 0, kDone = 1, kByNone = 2, kByTool = 3;
  std::vector<std::uint8_t> cells;
};

struct Rest {
  double thickness_mm = 0;
  double cell_mm = 0;
  double volume_mm3 = 0, area_mm2 = 0;  ///< of all regions
  std::size_t regions_in_all = 0;
  std::vector<RestRegion> regions;  ///< the greatest by volume, kMostRegions at most
  std::vector<RestTool> tools;
  double by_none_mm3 = 0;  ///< what none of the tools takes
  RestMap map;
  double seconds = 0;
  static constexpr std::size_t kMostRegions = 100;
};

}  // namespace kerf
