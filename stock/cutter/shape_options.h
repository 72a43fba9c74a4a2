// stock/cutter/shape_options.h - what may follow a cutter's shape: flutes, shank, holder, teeth.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/length_unit.h"
#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/tool_parts.h"

namespace kerf {

inline constexpr std::array<std::string_view, 11> kShapeOptionNames = {
    "flute", "shank", "holder", "stickout", "teeth", "live",
    "helix", "rake",  "chip",   "ramp",     "centre"};

struct ShapeOptions {
  std::optional<double> flute_mm;
  std::vector<ToolPart> shank;  ///< the last may have no length
  std::vector<ToolPart> holder;
  std::optional<double> stickout_mm;
  std::optional<int> teeth;
  std::optional<LiveAxis> live;
  EdgeTraits edges;
  bool centre_said = false;
};

/// Its values are lengths.
inline bool is_length_option(std::string_view name) {
  return name == "flute" || name == "shank" || name == "holder" || name == "stickout" ||
         name == "chip";
}

/// Of "name=value", `name` in small letters. Error: what was found and what is allowed; given
/// twice.
Done parse_shape_option(std::string_view name, std::string_view value, LengthUnit unit,
                        ShapeOptions& options);

/// ":flute=22:shank=10", mm, in the order of kShapeOptionNames.
std::string options_text(const ShapeOptions& options);

}  // namespace kerf
