// stock/cutter/turning_text.h - turning tools as people name them in tool tables and comments:
// "CNMG 120408", "groove 3mm", "thread 60", "boring bar 12 mm", "Abstechstahl 2 mm".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stock/cutter/free_text.h"

namespace kerf {

/// What a row of the tool table says beside its remark; 0: nothing.
struct TurningFacts {
  double nose_diameter_mm = 0;         ///< D
  int orientation = 0;                 ///< Q
  double front_deg = 0, back_deg = 0;  ///< I, J; both 0: they are missing
  bool has_flanks() const { return front_deg != 0 || back_deg != 0; }
};

/// A SHAPE of a turning tool, or of one that stands on the axis, that the text names for certain: a
/// SHAPE itself, a designation by ISO 1832 or ANSI B212.4, a groove, parting or threading tool, a
/// boring bar, a drill. What the text leaves out comes from the facts; what these leave out, too,
/// is guessed and said (a width, a thread's angle, the size of an insert). None: words that are no
/// such tool, or only say what it does ("face", "turn"): then the row is all there is.
///
/// A SHAPE that is wrong comes back as it is written: who parses it says what is wrong. Reads
/// English and German. Numbers without a unit are in `inches` or mm.
std::optional<ShapeText> turning_shape_in_text(std::string_view text, bool inches,
                                               const TurningFacts& facts = {});

}  // namespace kerf
