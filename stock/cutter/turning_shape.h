// stock/cutter/turning_shape.h - SHAPE texts of turning tools: "iso:CNMG120408:R:95:holder=20x100".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/length_unit.h"
#include "base/result.h"
#include "stock/cutter/cutter.h"

namespace kerf {

/// Orientations and angles are LinuxCNC's (insert_shape.h), angles in degrees:
///     turn:R:ORIENT:FRONT:BACK[:EDGE]  nose radius R, flanks along FRONT and BACK, each EDGE long
///                         (10); turn:R:9 is a disc
///     iso:CODE[:HAND[:ANGLE]]  an indexable insert (iso_code.h). HAND: R cuts towards -z (and so
///                         stands at orientation 2), L towards +z (1), N is even-handed (6). ANGLE
///                         is that of its holder, ISO 5608's kappa: between the cutting edge and
///                         the way along z (default: iso_angle_deg()). None for R inserts
///     groove:W[:R]        a blade W wide with corners of R, square to the axis (orientation 2: its
///                         corner at the chuck's side; 6: its middle), EDGE long (12)
///     part:W[:R]          the same to part off with, EDGE long (30)
///     facegroove:W[:R]    a blade along the axis; its corner nearer to the axis (2), or its
///                         middle (7)
///     thread:ANGLE[:PITCH]  a thread's profile, pointing to -x (6) or +x (8), EDGE deep (2, or
///                         PITCH). PITCH: the tip is as a thread of that pitch has it, flat by ISO
///                         68-1 and ASME B1.1 (60: P/8), ASME B1.5 (29: 0.3707 P), ISO 2901 (30:
///                         0.366 P), round by ISO 228 (55: 0.1373 P). Else it is sharp
///     bore:R:BAR[:LENGTH[:FRONT:BACK]]  a boring bar BAR thick and LENGTH long (5 BAR), its tip at
///                         orientation 3, flanks as of an insert C at 95 degrees (275, 355)
/// Each may add, in any order, divided by colons:
///     orient=N            where the controlled point is; what it points to goes with it: tools on
///                         the other side of the axis, and in bores, point to +x (3, 4, 8)
///     edge=L              EDGE
///     holder=WxL          a square shank W wide, ending L from the tip; or profile:FILE
///                         (turning_holder.h)
///     bar=DxL             a boring bar along +z instead; the orientation is then 3, 4 or 8 unless
///                         orient= says so
///     f=L                 ISO 5610's f of either: from the tip to the shank's far side (by
///                         default 1.25 W), or to the bar's axis (0.68 D)
///     max_ap=L            the depth of cut that it takes
///     max_f=L             the feed a turn that it takes
///     path=tool           programs have the tool's path, which CAM has compensated for the nose;
///                         path=contour: they have the contour (so it is without)
/// Not those of tools that turn: flute=, shank=, stickout=, teeth=, live=.
bool is_turning_form(std::string_view name);
/// What a SHAPE text begins with.
bool is_turning_shape(std::string_view shape);

/// Of `name` and what follows its colon; no data: there is none. Ranges are told in the errors.
Result<Cutter> parse_turning_shape(std::string_view name, std::string_view rest, LengthUnit unit);

/// How such a tool is used, as its spec() has it.
struct InsertUse {
  std::optional<double> max_depth_mm;  ///< of cut, that it takes
  std::optional<double> max_feed_mm;   ///< a turn, that it takes
  bool goes_its_path = false;          ///< programs have its path, not the contour
};
InsertUse insert_use_of(const Cutter& cutter);

/// A spec() of such a tool with its lengths in `unit`.
std::string turning_shape_in(std::string_view spec, LengthUnit unit);

/// One form a line, without a line end.
std::string turning_shape_help();

}  // namespace kerf
