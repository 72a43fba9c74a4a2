// stock/blank.h - the uncut workpiece as --stock describes it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/length_unit.h"
#include "base/result.h"

namespace kerf {

/// One body of a blank, mm, workpiece frame.
struct BlankBody {
  enum class Kind { kBox, kCylinder, kTube, kBar };
  Kind kind = Kind::kBox;
  Box bounds_mm;                 ///< of the body
  char axis = 'z';               ///< kCylinder, kTube: x, y or z; kBar: z
  Vec3 center_mm{0};             ///< a point on that axis
  double diameter_mm = 0;        ///< kBar: across flats
  double inner_diameter_mm = 0;  ///< kTube
  int flats = 0;                 ///< kBar: 4 or 6, the first one towards +X
};

/// Sheet metal, from which a torch, laser or jet cuts: its upper face is at Z0, as the posts of
/// these machines have it. A rectangle, or any outline from a drawing (outline_file.h).
struct BlankSheet {
  Vec2 low_mm{0}, high_mm{0};  ///< corners; of no meaning with a file
  double thickness_mm = 0;
  std::string file;  ///< the drawing, DXF or SVG by its name; empty: the rectangle
};

/// How a saved workpiece lies now: turned about by half a turn about X0 Z0 along X, then moved
/// along Z. Of workpieces that turn.
struct SavedPlace {
  bool is_turned_about = false;
  double at_z_mm = 0;
  bool is_as_saved() const { return !is_turned_about && at_z_mm == 0; }
};

/// Several bodies add up (union). `state_file` set: the blank is a saved workpiece instead; `sheet`
/// set: it is a sheet instead; `profile_file` set: what turns about the x axis of this drawing
/// (turned_blank.h).
struct Blank {
  std::vector<BlankBody> bodies;
  std::string state_file;
  SavedPlace saved_place;
  std::optional<BlankSheet> sheet;
  std::string profile_file;
  /// Empty for a saved workpiece and for what is in a drawing, which nobody has read yet.
  Box bounds_mm() const;
};

/// Why nothing but a lathe's model holds this blank ("the blank is a hexagonal bar"); empty: others
/// do. Of a saved workpiece nothing is known here.
std::string need_to_turn(const Blank& blank);

/// SPEC: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d[:axis] | tube:x,y,z0:z1:d:inner[:axis] |
/// hex:x,y,z0:z1:ACROSS_FLATS | square:x,y,z0:z1:ACROSS_FLATS ; several of these joined by '+'; or
/// state:FILE[:flip=x][:at=0,0,z] | sheet:x0,y0:x1,y1:THICKNESS | sheet:FILE.dxf:THICKNESS |
/// sheet:FILE.svg:THICKNESS | profile:FILE.dxf | profile:FILE.svg. stl: is named as not supported
/// by this version. Zero or negative sizes, reversed corners, non-numbers are errors that show what
/// was found and what is allowed. Its numbers are in `unit`. Reads no file.
Result<Blank> parse_blank(std::string_view spec, LengthUnit unit = LengthUnit::kMm);

/// "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0": for messages.
std::string describe(const Blank& blank);

}  // namespace kerf
