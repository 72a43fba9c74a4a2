// twin/tool_library/tool_geometry.h - what libraries say of a tool, made a cutter. All mm, degrees.
//
//        |        |  <- holder: sections upward from stickout_mm
//        |________|
//          |    |    <- shank_mm: diameter from the neck's end (else the flutes') up
//          |_  _|
//            ||      <- neck_mm: diameter from the flutes up to neck_top_mm above the tip
//           |  |     <- flute_mm above the tip
//           |__|     <- shape
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/holder_library.h"

namespace kerf {

struct ToolGeometry {
  std::string shape;  ///< SHAPE text of what cuts: "flat:6"
  std::optional<double> flute_mm;
  std::optional<double> neck_mm, neck_top_mm;
  std::optional<double> shank_mm;
  std::vector<HolderSection> holder;
  std::optional<double> stickout_mm;
  std::optional<int> teeth;
};

/// The cutter, by SHAPE text. What does not fit together, and so is left out or stretched, is said
/// in `remarks`: flutes that end below the cutting shape, or within the holder; a holder that
/// nobody says the stick-out of. Error: no cutter can be made of it.
Result<Cutter> cutter_of(const ToolGeometry& tool, std::vector<std::string>& remarks);

/// "flat:6" of "flat" and its values; shortest numbers, to a millionth.
std::string shape_text(std::string_view name, std::initializer_list<double> values);

}  // namespace kerf
