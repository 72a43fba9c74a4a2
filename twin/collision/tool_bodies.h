// twin/collision/tool_bodies.h - what a spindle carries, as solids: cutter, shank, holder, nose.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stock/cutter/cutter.h"
#include "twin/collision/solid.h"

namespace kerf {

enum class ToolPart : std::uint8_t { kCutter, kShank, kHolder, kSpindle };
/// "cutter", ..: as reports have it, in no language.
const char* to_string(ToolPart part);
/// For sentences.
std::string name_of(ToolPart part);

struct ToolBody {
  ToolPart part = ToolPart::kCutter;
  SolidPointer solid;  ///< the tip is the origin, the axis Z
  double width_mm = 0;
  double from_z_mm = 0;  ///< its lowest place
};

/// From the tip upward, without gaps as far as something is known: the cutter to the end of its
/// flutes, the shank (as wide as the cutter, if nobody says it) from there to the holder, the
/// holder's sections, the spindle's sections above. Without a holder the tool ends four diameters
/// above its flutes' end or tip, as nobody knows what comes there. Profiles that are hollow are
/// taken by chords within 0.005 mm. `spindle`: sections from the nose upward, which is at
/// `nose_z_mm` above the tip or where the holder ends, whichever is higher; without both, no
/// spindle.
std::vector<ToolBody> tool_bodies(const Cutter& cutter, std::span<const ToolSection> spindle,
                                  double nose_z_mm);

}  // namespace kerf
