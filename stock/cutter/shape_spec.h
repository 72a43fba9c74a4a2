// stock/cutter/shape_spec.h - cutters from SHAPE text
// ("bull:10:2:flute=22:shank=10:holder=32x20+40x25").
#pragma once

#include <string>
#include <string_view>

#include "base/length_unit.h"
#include "base/result.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// SHAPE, in `unit` and degrees; letter case does not matter:
///     flat:D             end mill
///     ball:D             hemisphere of diameter D
///     bull:D:R           corner radius R from 0 to D/2 (D/2 is a ball)
///     vee:D:ANGLE[:TIP]  included angle ANGLE, largest diameter D, flat tip of diameter TIP
///     taper:D:ANGLE[:R]  tip diameter D; ANGLE of one side to the axis; R rounds the tip (below)
///     drill:D:ANGLE      point angle (included); 180 is a flat drill
///     lollipop:D:SHAFT   sphere on a shaft: a head with a neck (Cutter::undercuts)
///     tslot:D:T:SHAFT    disc of thickness T on a shaft: flat, with a neck
///     dovetail:D:ANGLE:SHAFT  cone that widens downward: D at its flat bottom, SHAFT at its top;
///                        ANGLE between its side and its bottom
///     kerf:W             torch, laser or jet: the width of its kerf. To other models than that of
///                        a sheet it is a flat end mill
///     profile:FILE       outline from a file (profile_file.h)
/// Each may add, in any order, divided by colons:
///     flute=L            the cutting part ends L above the tip, at least as high as the shape
///     shank=D[xL]        cylinder from the end of the flutes up; L only below a holder. Several
///                        that stack upward: DxL+..+D[xL]; a cone is D-DxL, its lower end first
///     holder=DxL[+..]    sections that stack upward from the end of the shank, or from stickout=;
///                        each DxL, a cone D-DxL, or a NAME (holder_library.h); or profile:FILE,
///                        an outline (profile_file.h). Needs flute= or stickout=. A shank without L
///                        counts as hidden in the holder, which then begins at the end of the
///                        flutes: the cautious reading
///     stickout=L         from the tip to the holder, instead of the shank's length
///     teeth=N            1 to 99
///     helix=DEG          0 to 70, of its flutes; rake=DEG: -45 to 45, of its edges
///     chip=L             feed per tooth that its maker allows
///     ramp=DEG           the steepest way down into material that its maker allows, 0 to 90
///     centre=no          it does not cut at its centre
///     live=x, live=z     on a lathe: it is driven itself, and mills while the workpiece stands or
///                        is an axis; along X (its tip towards the axis) or along Z
///
/// taper: the circle of radius R has its centre at radius D/2 - R and meets the cone tangentially;
/// R = D/2 is a tapered ball nose. The cone ends at the flute length, or three tip diameters above
/// the tip. lollipop, tslot, dovetail: the flutes are as high as the shape and the shank has
/// diameter SHAFT unless the options say otherwise. profile: options in the file count unless the
/// text has them.
///
/// Ranges: diameters 0.001 to 1000 mm, lengths to 2000 mm. spec() of the result is the canonical
/// text: mm, shortest numbers, options in the order above; it parses to the same cutter. The error
/// names the part that is wrong, what was found and what is allowed. Reads a file only for
/// profile:.
Result<Cutter> parse_shape(std::string_view spec, LengthUnit unit = LengthUnit::kMm);

/// A spec() with its lengths in `unit` (length_number()); what is no spec() stays as it is.
std::string shape_in(std::string_view spec, LengthUnit unit);

/// A `N=SHAPE` argument of --tool.
struct ToolShapeArgument {
  int tool = 0;
  Cutter cutter;
};
Result<ToolShapeArgument> parse_tool_argument(std::string_view argument,
                                              LengthUnit unit = LengthUnit::kMm);

/// The SHAPE forms for --help and error messages, one a line.
std::string shape_help(LengthUnit unit = LengthUnit::kMm);

}  // namespace kerf
