// stock/cutter/insert.h - the outline of a turning tool in the plane in which it moves.
//
//      x ^       ______ body          Points are (z, x) in mm from the controlled point: z along
//      the
//        |      /     /               lathe's axis, x away from it on the side of positive X. The
//        |     /back / front          tool does not turn; what it sweeps turns about the axis
//        |    (_____/                 (stock/turning/).
//        |    nose
//        +-------------> z
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/geometry.h"

namespace kerf {

/// What an edge of an outline is, so that who cuts can be told from who rubs.
enum class InsertSide : std::uint8_t {
  kNose,    ///< cuts: the nose's arc, the front edge of a groove insert, the point of a drill
  kFront,   ///< the flank along LinuxCNC's front angle, or towards -z
  kBack,    ///< the flank along its back angle, or towards +z
  kBody,    ///< cuts nothing: the rest of the insert, the shank of a drill
  kHolder,  ///< nor does this: the bar that holds the insert
};
inline constexpr std::size_t kInsertSides = 5;

/// From the end of the edge before it to `end_mm`: straight, or an arc about `center_mm`,
/// counter-clockwise by less than a full turn.
struct InsertEdge {
  Vec2 end_mm{0};  ///< (z, x)
  std::optional<Vec2> center_mm;
  InsertSide side = InsertSide::kBody;
};

/// A closed chain round a convex region, counter-clockwise with z to the right and x up: the first
/// edge begins where the last one ends. Edges have a length.
using InsertPart = std::vector<InsertEdge>;

/// The tool is where one of the parts is; they may overlap. A hollow outline is more than one part.
struct InsertOutline {
  std::vector<InsertPart> parts;
};

/// What LinuxCNC's tool table says of such a tool, and compensates by.
struct InsertTip {
  int orientation = 0;  ///< 1 .. 9 (insert_shape.h)
  double nose_radius_mm = 0;
  std::optional<double> front_deg, back_deg;  ///< of the flanks at the nose, where it has them
};

/// No outline reaches farther from the controlled point.
inline constexpr double kMaxInsertReach_mm = 300;
/// How far it reaches; an arc as far as its circle.
double outline_reach_mm(const InsertOutline& outline);

/// The same tool seen in a mirror: for the other side of the axis, and for the other hand. Front
/// and back stay what they are.
InsertOutline mirrored_in_x(const InsertOutline& outline);  ///< x becomes -x
InsertOutline mirrored_in_z(const InsertOutline& outline);

}  // namespace kerf
