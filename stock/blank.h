// stock/blank.h - the uncut workpiece as --stock describes it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/result.h"

namespace kerf {

/// One body of a blank, mm, workpiece frame.
struct BlankBody {
  enum class Kind { kBox, kCylinder, kTube };
  Kind kind = Kind::kBox;
  Box bounds_mm;      ///< of the body
  char axis = 'z';    ///< kCylinder, kTube: x, y or z
  Vec3 center_mm{0};  ///< a point on that axis
  double diameter_mm = 0;
  double inner_diameter_mm = 0;  ///< kTube
};

/// Several bodies add up (union). `state_file` set: the blank is a saved workpiece instead.
struct Blank {
  std::vector<BlankBody> bodies;
  std::string state_file;
  Box bounds_mm() const;
};

/// SPEC: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d[:axis] | tube:x,y,z0:z1:d:inner[:axis] |
/// state:FILE ; several joined by '+'. stl: and sheet: are named as not supported by this version.
/// Zero or negative sizes, reversed corners, non-numbers are errors that show what was found and
/// what is allowed.
Result<Blank> parse_blank(std::string_view spec);

/// "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0": for messages.
std::string describe(const Blank& blank);

}  // namespace kerf
