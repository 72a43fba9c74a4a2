// stock/cutter/tool_parts.h - what a tool carries above its flutes, as SHAPE text has it: shank and
// holder as sections that stack upward.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/length_unit.h"
#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/holder_library.h"

namespace kerf {

/// One piece of a stack: a section, or a holder that has a name (then those of the library).
struct ToolPart {
  std::string name;                     ///< "er20", "profile:FILE"; empty: it is written out
  std::vector<HolderSection> sections;  ///< one where it is written out; length 0: not given
};

/// shank=: "D", "DxL", or several joined by '+', of which the last alone may lack its length.
/// A cone is "D-DxL", its lower diameter first. The error names what is wrong.
Result<std::vector<ToolPart>> parse_shank(std::string_view text, LengthUnit unit);
/// holder=: "DxL", "D-DxL" and names (holder_library.h), joined by '+'; or "profile:FILE", which is
/// read (profile_file.h).
Result<std::vector<ToolPart>> parse_holder(std::string_view text, LengthUnit unit);

/// As it parses to the same parts: mm, shortest numbers.
std::string parts_text(const std::vector<ToolPart>& parts);
/// A text of parts with its lengths in `unit`; names stay.
std::string parts_in(std::string_view text, LengthUnit unit);

/// Cylinders upward from `from_z_mm`. A cone becomes steps, each as wide as its widest place: they
/// never understate it, and overstate its radius by at most kConeStep_mm. A section without a
/// length has none and ends where it begins.
std::vector<ToolSection> sections_of(const std::vector<ToolPart>& parts, double from_z_mm);
inline constexpr double kConeStep_mm = 0.25;

}  // namespace kerf
