// stock/cutter/shape_spec.h - cutters from SHAPE text ("bull:10:2:flute=22:shank=10:holder=32x20+40x25").
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// SHAPE: flat:D  ball:D  bull:D:R  vee:D:ANGLE[:TIP]  taper:D:ANGLE[:R]  drill:D:ANGLE  lollipop:D:SHAFT
/// tslot:D:T:SHAFT  profile:FILE ; each may add :flute=L:shank=D:holder=DxL[+DxL..]. mm and degrees (vee, drill: included
/// angle; taper: half angle at the side, D at the tip). The error names the part that is wrong, what was found and what
/// is allowed. Reads a file only for profile:.
Result<Cutter> parse_shape(std::string_view spec);

/// A `N=SHAPE` argument of --tool.
struct ToolShapeArgument {
  int tool = 0;
  Cutter cutter;
};
Result<ToolShapeArgument> parse_tool_argument(std::string_view argument);

/// The SHAPE forms for --help and error messages, one a line.
std::string_view shape_help();

}  // namespace kerf
