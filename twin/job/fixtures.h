// twin/job/fixtures.h - what holds the workpiece and stands around it: vises, clamps, screws,
// boxes, meshes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "base/result.h"
#include "mesh/mesh_reader.h"
#include "stock/blank.h"
#include "twin/collision/solid.h"

namespace kerf {

/// A fixture as --fixture describes it; its mesh, if it has one, is not read yet. mm.
struct FixtureSpec {
  std::string name;               ///< "vise"; empty: name_fixtures() gives one
  std::string text;               ///< the SPEC, as it was given
  std::vector<BlankBody> bodies;  ///< in its own frame
  std::string mesh_path;          ///< a mesh file; empty: none
  MeshFormat mesh_format = MeshFormat::kStl;
  double mm_per_unit = 1;              ///< of it
  Vec3 at_mm{0};                       ///< of its frame's origin in the workpiece frame, or ..
  double turn_deg = 0;                 ///< of its frame about Z
  bool in_blank = false;               ///< it may stand in the blank: a screw, a mandrel
  std::optional<double> clearance_mm;  ///< of its own; else that of all
  std::string on;                      ///< a link of the machine; empty: the workpiece frame
};

/// [NAME=]SHAPE[:at=x,y,z][:turn=DEG][:in-blank][:on=LINK], where SHAPE is
///
///     box:.. | cylinder:.. | tube:..    as parse_blank() has them, several joined by +
///     stl:FILE[:inch], obj:FILE[:inch]  a mesh, in mm or inches
///     3mf:FILE, step:FILE               a mesh, in the unit that the file says
///     vise:JAW_WIDTH:OPENING:HEIGHT     two jaws along X, OPENING apart in Y, HEIGHT above the
///     bed;
///                                       0,0,0 lies on the bed, in the middle between them
///     clamp:LENGTH:WIDTH:HEIGHT         a strap from 0,0,0 along +X, WIDTH about Y0, HEIGHT up
///     screw:D:LENGTH[:HEAD_D:HEAD_H]    along Z, its head above Z0 (2 D wide and D high), LENGTH
///                                       below; stands in the blank
///
/// Numbers are in `unit`. Errors say what was found and what is allowed. Reads no file.
Result<FixtureSpec> parse_fixture(std::string_view text, LengthUnit unit = LengthUnit::kMm);

/// One that is there. Immutable.
struct Fixture {
  std::string name;
  SolidPointer solid;
  Pose workpiece_from_fixture;  ///< on a link: the link's frame is in the workpiece's place
  Pose fixture_from_workpiece;
  bool in_blank = false;
  std::optional<double> clearance_mm;
  std::string on;  ///< FixtureSpec::on
};
using FixtureList = std::shared_ptr<const std::vector<Fixture>>;

/// Names what has no name after its shape: "vise", "box 2".
void name_fixtures(std::span<FixtureSpec> specs);

/// Reads meshes, and name_fixtures(). Null with
/// diagnostics: two of one name, files that are missing or broken, meshes of more than
/// kMostTriangles. Notes: meshes that do not enclose a space, flat triangles, meshes larger than
/// a machine (in inches?).
FixtureList load_fixtures(std::span<const FixtureSpec> specs, Diagnostics& diagnostics);
inline constexpr std::size_t kMostTriangles = 2'000'000;

/// How deep fixture and blank are in each other; no more than kTouching_mm is side by side.
double depth_in_blank_mm(const Solid& fixture, const Pose& workpiece_from_fixture,
                         const Solid& blank);
/// What stands so deep in the blank touches it.
inline constexpr double kTouching_mm = 0.01;

/// False with an error for each fixture that stands in the blank, and how deep, unless it may; or
/// if the blank is a sheet, beside which nothing looks for them.
/// Those on links are not looked at.
bool check_fixtures_beside(const std::vector<Fixture>& fixtures, const Blank& blank,
                           Diagnostics& diagnostics);
/// The same of a blank of any shape.
bool check_fixtures_beside(const std::vector<Fixture>& fixtures, const Solid& blank,
                           Diagnostics& diagnostics);

}  // namespace kerf
