// twin/process/carried_bodies.h - parts of a tool as rigid bodies on their way, whatever the tool:
// what turns about its own axis, and plates that keep as they stand.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "twin/collision/sweep.h"
#include "twin/collision/tool_bodies.h"

namespace kerf {

/// Convex pieces, and what keeps them. mm from the tip.
struct CarriedPieces {
  std::vector<Convex> pieces;
  Box box_mm;
  std::shared_ptr<const void> owner;
};

struct CarriedBody {
  ToolPart part = ToolPart::kCutter;
  CarriedPieces whole;
  CarriedPieces thin;    ///< less what a contact may be deep (kContactTolerance_mm)
  CarriedPieces bare;    ///< less what rounding may be (kContactRounding_mm)
  double width_mm = 0;   ///< for messages; 0: they do not say it
  double from_z_mm = 0;  ///< where it begins above the tip
  /// It keeps as it stands: its frame is turned as the workpiece's. Else its Z is the tool's axis.
  bool stands = false;
  /// How deep it goes on a way at most, if that is more than is known; else that.
  std::function<double(const RigidWay&, const Solid& still, double known_mm)> depth_mm;
};

/// Of a tool that turns, as tool_bodies() has it.
std::vector<CarriedBody> carried_bodies(std::span<const ToolBody> bodies);

/// A plate: convex polygons, counter-clockwise in (z, x), from -`half_width_mm` to `half_width_mm`
/// along Y.
CarriedPieces plates_of(std::span<const std::vector<Vec2>> polygons, double half_width_mm);

}  // namespace kerf
