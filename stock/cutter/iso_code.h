// stock/cutter/iso_code.h - what an indexable insert is called: "CNMG120408", "DCMT 11 T3 04",
// "CNMG432".
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace kerf {

/// What counts of a designation where inserts are seen from above.
struct IsoCode {
  std::string text;  ///< "CNMG120408": upper case, no blanks, nothing of what follows the radius
  char shape = 'C';  ///< a letter of iso_shapes()
  double circle_mm = 0;  ///< inscribed; of R the disc's diameter
  double radius_mm = 0;  ///< of the corners; of R half its diameter
};

/// ISO 1832: shape, clearance, tolerance and type as letters, then size, thickness and corner
/// radius (in tenths of a millimetre), two figures each; a thickness may begin with T. The size is
/// the length of the cutting edge (iso_circle_mm()); of R with M0 in place of the radius it is the
/// diameter in mm.
///
/// With three numbers of one figure (and perhaps a decimal) it is ANSI B212.4: the circle in
/// eighths of an inch, the thickness in sixteenths, the radius in 64ths. These are the same
/// inserts, so the radius is ISO's: 0.4 mm each 64th.
///
/// Blanks count for nothing. What makers add behind (-PM, EN) is passed over, if it does not begin
/// with a figure. Error: which part is wrong, what was found, what is allowed.
Result<IsoCode> parse_iso_code(std::string_view text);

}  // namespace kerf
