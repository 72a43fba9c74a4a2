// stock/cutter/turning_holder.h - what holds an insert: a square shank, a boring bar, or polygons
// of a file. Parts of its outline that cut nothing (InsertSide::kHolder).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "stock/cutter/insert.h"

namespace kerf {

/// A shank behind the insert, away from where the tip points. `f_mm` is ISO 5610's: from the tip to
/// the shank's far side.
///
///     |<---- f ---->|        x ^        It begins where the insert ends, and ends `length_mm` from
///         |<-- W -->|          |        the controlled point.
///         |         |          +-> z
///     ____|_________|
///     \\___/  insert
struct ShankBar {
  double width_mm = 20;
  double length_mm = 100;
  double f_mm = 25;
};
/// Which way the shank of an orientation goes: of 5 and 7 along z, of all others along x.
Vec2 shank_direction(int orientation);
/// `back` is along an axis. Across it, `side` is where the shank lies: 1 on the positive side, -1
/// on the other, 0 in the middle (f plays no part). None: it ends within the insert.
std::optional<InsertPart> shank_part(const InsertOutline& insert, const Vec2& back, int side,
                                     const ShankBar& bar);
/// How far the insert reaches that way.
double insert_height_mm(const InsertOutline& insert, const Vec2& back);

/// A bar along +z, as in a bore: from `begin_z_mm` to `length_mm`; its axis is `f_mm` from the
/// tip, away from where it points in x.
struct BoringBar {
  double diameter_mm = 16;
  double length_mm = 80;
  double f_mm = 11;
  double begin_z_mm = 1;
};
/// None of orientations that do not point along x: 5, 7, 9.
std::optional<InsertPart> boring_part(int orientation, const BoringBar& bar);

/// Convex polygons of a file, in the tool's own plane:
///     # holder of T1           '#' starts a comment; blank lines are skipped
///     part                     begins a polygon; a hollow outline is more than one
///     point 5 14               z, x in mm from the controlled point
///     point 25 14              three corners and more, either way round
/// Error: "NAME:LINE: what was found and what is allowed".
Result<std::vector<InsertPart>> parse_turning_holder(std::string_view text,
                                                     const std::string& name);
Result<std::vector<InsertPart>> read_turning_holder(const std::string& path);

}  // namespace kerf
