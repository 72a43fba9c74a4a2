// stock/cutter/insert_shape.h - outlines of turning tools from what they are ordered by.
//
// All of them lie about LinuxCNC's controlled point: the centre of the nose, of radius r, is at
// r (dz, dx) from it, by orientation
//
//      x ^   (1) dx +1 dz -1   (6) dx +1 dz 0    (2) dx +1 dz +1
//        |   (5) dx  0 dz -1   (9) 0 0           (7) dx  0 dz +1
//        +-> (4) dx -1 dz -1   (8) dx -1 dz 0    (3) dx -1 dz +1       z to the right
//
// so that the nose touches lines through that point parallel to the axes. Angles are LinuxCNC's,
// in radians: 0 runs along +z, a quarter turn along +x.
//
// What has no outline, or reaches farther than kMaxInsertReach_mm, gives none; whoever reads such
// values from a user says which are allowed.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "stock/cutter/cutter.h"
#include "stock/cutter/insert.h"

namespace kerf {

inline constexpr int kOrientations = 9;
/// (dz, dx) of an orientation, 1 .. kOrientations.
Vec2 nose_direction(int orientation);

/// A row of LinuxCNC's tool table: a nose, and flanks that leave it along two angles.
struct NoseInsert {
  double radius_mm = 0;  ///< 0 and more: half the table's diameter
  int orientation = 2;   ///< 1 .. 9; with 9 the nose is a whole disc and there are no flanks
  double front_rad = 0, back_rad = 0;
  double edge_mm = 10;  ///< length of either flank; the table does not say it
};
/// None: a number out of range, flanks half a turn or more apart, or nothing between them (equal
/// angles of a sharp nose).
///
/// Source of the shape: LinuxCNC 2.9, what its screens draw of a tool table.
std::optional<InsertOutline> nose_insert(const NoseInsert& insert);

/// An indexable insert by its shape in ISO 1832, lying so that the flank at its nose runs along
/// `front_rad`.
struct IsoInsert {
  char shape = 'C';         ///< C D E K M P R S T V W
  double circle_mm = 12.7;  ///< inscribed; of K between the long sides; of R the disc's
  double radius_mm = 0.8;   ///< of every corner
  int orientation = 2;
  double front_rad = 0;
  bool back_is_ahead = false;  ///< the back flank is at front + corner angle; else at front - it
};
/// None: an unknown letter, corners that do not fit, a number out of range.
std::optional<InsertOutline> iso_insert(const IsoInsert& insert);

/// Of ISO 1832's letters, as the catalogues of insert makers print them.
struct IsoShape {
  char letter = 0;
  int corners = 0;          ///< 0: a disc
  double nose_rad = 0;      ///< angle at the corner that cuts
  double other_rad = 0;     ///< at the corners between; the two take turns
  bool equal_sides = true;  ///< else a long and a short side take turns: K
};
std::span<const IsoShape> iso_shapes();
/// Diameter of the inscribed circle for the two digits of the size, which are the length of the
/// cutting edge without what is behind the point (CNMG 12 04 08: 12.9 mm, of a circle of 12.7 mm).
/// None: there is no such insert in the series.
std::optional<double> iso_circle_mm(char shape, int size);
/// All of a shape's, rising.
struct IsoSize {
  int size = 0;
  double circle_mm = 0;
};
std::vector<IsoSize> iso_sizes(char shape);

/// Groove, part-off: a blade with a straight front edge. Across it the controlled point is at the
/// front's corner by orientation (1, 4: at the end of +z; 2, 3: at that of -z), or in its middle
/// (6, 8); for blades along the axis (`axial`, face grooves) 5 and 7 are the middle, and dx tells
/// which corner.
struct GrooveInsert {
  double width_mm = 3;
  double corner_mm = 0;   ///< radius of both corners; at most half the width
  double length_mm = 15;  ///< of the blade
  int orientation = 2;
  bool axial = false;
  double relief_rad = 0;  ///< each side runs back from above the front's corner by this angle
};
/// None: sizes that do not fit, an orientation that does not say where the blade is.
std::optional<InsertOutline> groove_insert(const GrooveInsert& insert);

/// A thread's profile: flat (or sharp) at the tip, flanks half the angle to either side of the
/// middle, which is the controlled point. Orientation 6 points to -x, 8 to +x.
struct ThreadInsert {
  double angle_rad = kPi / 3;
  double flat_mm = 0;
  double depth_mm = 2;  ///< of the profile
  int orientation = 6;
};
std::optional<InsertOutline> thread_insert(const ThreadInsert& insert);

/// A drill, reamer or tap that stands still along the axis, its tip the controlled point, its shank
/// towards +z. Its profile is the cutter's, on both sides; it is as long as `length_mm`, its flutes
/// as long as the cutter says. None: a profile with hollow arcs, or longer than it may be.
std::optional<InsertOutline> axial_outline(const Cutter& cutter, double length_mm);

}  // namespace kerf
