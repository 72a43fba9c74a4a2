// stock/blank.h - the uncut workpiece as --stock describes it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geometry.h"
#include "base/length_unit.h"
#include "base/result.h"
#include "stock/blank_place.h"

namespace kerf {

struct MeshBody;

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

/// What a mesh encloses: STL, OBJ, 3MF; STEP by way of one. parse_blank() reads no file: who reads
/// it (twin/job/blank_mesh.h) sets `body`.
struct BlankMesh {
  std::string file;
  double allowance_mm = 0;           ///< it is grown by this (mesh/mesh_offset.h)
  std::optional<LengthUnit> unit{};  ///< of its numbers, where that is said; else mm, or the file's
  BlankPlace place{};
  std::shared_ptr<const MeshBody> body{};  ///< as it lies, mm; null: not read yet
};

/// Several bodies add up (union). `state_file` set: the blank is a saved workpiece instead; `sheet`
/// set: it is a sheet instead; `profile_file` set: what turns about the x axis of this drawing
/// (turned_blank.h); `mesh` set: what that encloses.
struct Blank {
  std::vector<BlankBody> bodies;
  std::string state_file;
  BlankPlace saved_place;
  std::optional<BlankSheet> sheet;
  std::string profile_file;
  std::optional<BlankMesh> mesh;
  /// Empty for a saved workpiece and for what is in a file, which nobody has read yet.
  Box bounds_mm() const;
};

/// Why nothing but a lathe's model holds this blank ("the blank is a hexagonal bar"); empty: others
/// do. Of a saved workpiece nothing is known here.
std::string need_to_turn(const Blank& blank);

/// SPEC: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d[:axis] | tube:x,y,z0:z1:d:inner[:axis] |
/// hex:x,y,z0:z1:ACROSS_FLATS | square:x,y,z0:z1:ACROSS_FLATS ; several of these joined by '+'; or
/// state:FILE[PLACE] | sheet:x0,y0:x1,y1:THICKNESS | sheet:FILE.dxf:THICKNESS |
/// sheet:FILE.svg:THICKNESS | profile:FILE.dxf | profile:FILE.svg |
/// stl:FILE[+ALLOWANCE][:inch|:mm][PLACE] | obj: likewise | 3mf:, step: FILE[+ALLOWANCE][PLACE] |
/// of these alone the file, where its name ends so. PLACE: [:flip=x|y][:rotate=A,B,C][:at=x,y,z].
/// Zero or negative sizes, reversed corners, non-numbers are errors that show what was found and
/// what is allowed. Its numbers are in `unit`. Reads no file.
Result<Blank> parse_blank(std::string_view spec, LengthUnit unit = LengthUnit::kMm);

/// "box 100 x 60 x 20 mm, X0..100 Y0..60 Z-20..0": for messages.
std::string describe(const Blank& blank);

}  // namespace kerf
