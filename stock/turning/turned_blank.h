// stock/turning/turned_blank.h - blanks (stock/blank.h) as profiles that turn about Z.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "stock/blank.h"
#include "stock/plane/outline.h"
#include "stock/turning/turning_stock.h"

namespace kerf {

/// How near chords of a drawing's arcs keep to them.
inline constexpr double kProfileTolerance_mm = 9e-5;

/// What turns about the drawing's x axis, which is Z of the workpiece frame; y of the drawing is
/// the radius. Either the half above the axis is drawn or both halves, which must be equal within
/// kHalves_mm; holes are bores, and grooves from inside. DXF: contours may stay open towards the
/// axis, and centre lines may be there (OutlineClosing::kAlongAxis). SVG: the axis is the picture's
/// lower edge. Error: what read_outline_file() finds, halves that differ, nothing above the axis,
/// more than one piece, farther out than TurnedPart holds.
Result<TurnedProfile> read_profile(const std::string& path);
/// The same of a drawing that has been read; `name` for messages.
Result<TurnedProfile> profile_of_outline(const PlaneOutline& outline, const std::string& name);
inline constexpr double kHalves_mm = 0.001;

/// Bodies that turn about X0 Y0 along Z, united, the profile of a drawing, or of a mesh
/// that turns (mesh_profile.h; its sections are equal as halves of a drawing are). Error: a box, a
/// body beside the axis or across it, bodies that lie apart, a bar of flats together with something
/// that reaches beyond its flats, a saved workpiece, a sheet, beyond what TurnedPart holds; with
/// the body and what would do.
Result<TurnedProfile> turned_profile_of(const Blank& blank);

/// The blank as a model. Error: the same.
Result<std::unique_ptr<TurningStock>> turning_stock_of(const Blank& blank,
                                                       ChuckSide chuck = ChuckSide::kLowZ);

}  // namespace kerf
