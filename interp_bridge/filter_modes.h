// interp_bridge/filter_modes.h - what a program tells QtPlasmaC's filter.
#pragma once

namespace kerf {

/// What QtPlasmaC's filter (qtplasmac_gcode) is told by lines such as `#<holes>=4`, from that line
/// on to the next such line in the text; jumps and loops do not count, as the filter reads the text
/// once. Lengths in the program's units at the place of the arc.
struct FilterModes {
  bool holes = false;     ///< #<holes> 1 to 4: full circles are cut slower
  bool arcs = false;      ///< 3, 4: arcs too
  bool overburn = false;  ///< 2, 4: full circles are run on with the torch out
  bool pierce_only = false;
  float largest_diameter = -1;  ///< #<h_diameter>; below 0: 32 mm or 1.26 in
  float velocity_percent = 60;  ///< #<h_velocity>
  float overburn_length = -1;   ///< #<oclength>; below 0: 4 mm or 0.157 in
  bool operator==(const FilterModes&) const = default;
};

}  // namespace kerf
