#include "twin/job/fixtures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/suggest.h"
#include "base/translate.h"
#include "mesh/mesh_reader.h"
#include "stock/cutter/scan.h"
#include "twin/collision/mesh_depth.h"
#include "twin/collision/sweep.h"
#include "twin/job/blank_mesh.h"

namespace kerf {
namespace {

constexpr double kMost_mm = 1e5;
constexpr double kLeast_mm = 0.001;
/// A vise is no wider, nor is what stands on a table: what is, was drawn in other units.
constexpr double kLargeMesh_mm = 2000;
/// What is smaller holds nothing: it may be in inches.
constexpr double kSmallMesh_mm = 10;
/// Of a jaw's width: how thick it is.
constexpr double kJawThickness = 0.25;

constexpr std::array<std::string_view, 10> kShapes{"box", "cylinder", "tube", "stl",   "obj",
                                                   "3mf", "step",     "vise", "clamp", "screw"};
struct MeshShape {
  std::string_view word;
  MeshFormat format;
  const char* form;
};
constexpr std::array kMeshes{MeshShape{"stl", MeshFormat::kStl, "stl:FILE[:inch]"},
                             MeshShape{"obj", MeshFormat::kObj, "obj:FILE[:inch]"},
                             MeshShape{"3mf", MeshFormat::k3mf, "3mf:FILE"},
                             MeshShape{"step", MeshFormat::kStep, "step:FILE"}};
constexpr std::array<std::string_view, 5> kOptions{"at", "turn", "in-blank", "on", "inch"};
constexpr const char* kForms = tr_noop(
    "box:x0,y0,z0:x1,y1,z1, cylinder:x,y,z0:z1:d[:axis], tube:x,y,z0:z1:d:inner[:axis], several "
    "of these joined by +, stl:FILE[:inch], obj:FILE[:inch], 3mf:FILE, "
    "step:FILE, vise:JAW_WIDTH:OPENING:HEIGHT, "
    "clamp:LENGTH:WIDTH:HEIGHT, screw:D:LENGTH[:HEAD_D:HEAD_H]; each with [:at=x,y,z][:turn=DEG]"
    "[:in-blank][:on=LINK]");

BlankBody box(const Vec3& low, const Vec3& high) {
  BlankBody body;
  body.bounds_mm = {low, high};
  body.center_mm = (low + high) / 2.0;
  return body;
}

BlankBody rod(double diameter, double low, double high) {
  BlankBody body;
  body.kind = BlankBody::Kind::kCylinder;
  body.diameter_mm = diameter;
  body.bounds_mm = {{-diameter / 2, -diameter / 2, low}, {diameter / 2, diameter / 2, high}};
  return body;
}

/// The fields behind a shape's name as lengths; an error says the form.
Result<std::vector<double>> lengths_of(std::span<const std::string_view> fields,
                                       std::span<const char* const> names, std::size_t least,
                                       const char* form, LengthUnit unit) {
  if (fields.size() < least || fields.size() > names.size())
    return Error{trf("the form is {}", form)};
  std::vector<double> out;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Result<double> value = parse_length(names[i], trim(fields[i]), kLeast_mm, kMost_mm, unit);
    if (!value) return Error{value.error()};
    out.push_back(*value);
  }
  return out;
}

Done parse_vise(std::span<const std::string_view> fields, LengthUnit unit, FixtureSpec& out) {
  constexpr std::array kNames{"JAW_WIDTH", "OPENING", "HEIGHT"};
  const auto values = lengths_of(fields, kNames, 3, "vise:JAW_WIDTH:OPENING:HEIGHT", unit);
  if (!values) return Error{values.error()};
  const double half = (*values)[0] / 2, gap = (*values)[1] / 2, high = (*values)[2];
  const double thick = kJawThickness * (*values)[0];
  out.bodies = {box({-half, gap, 0}, {half, gap + thick, high}),
                box({-half, -gap - thick, 0}, {half, -gap, high}),
                box({-half, -gap - thick, -thick}, {half, gap + thick, 0})};
  return Done{std::monostate{}};
}

Done parse_clamp(std::span<const std::string_view> fields, LengthUnit unit, FixtureSpec& out) {
  constexpr std::array kNames{"LENGTH", "WIDTH", "HEIGHT"};
  const auto values = lengths_of(fields, kNames, 3, "clamp:LENGTH:WIDTH:HEIGHT", unit);
  if (!values) return Error{values.error()};
  const double width = (*values)[1] / 2;
  out.bodies = {box({0, -width, 0}, {(*values)[0], width, (*values)[2]})};
  return Done{std::monostate{}};
}

Done parse_screw(std::span<const std::string_view> fields, LengthUnit unit, FixtureSpec& out) {
  constexpr std::array kNames{"D", "LENGTH", "HEAD_D", "HEAD_H"};
  const auto values = lengths_of(fields, kNames, 2, "screw:D:LENGTH[:HEAD_D:HEAD_H]", unit);
  if (!values) return Error{values.error()};
  const double d = (*values)[0];
  const double head_d = values->size() > 2 ? (*values)[2] : 2 * d;
  const double head_h = values->size() > 3 ? (*values)[3] : d;
  out.bodies = {rod(d, -(*values)[1], 0), rod(head_d, 0, head_h)};
  out.in_blank = true;
  return Done{std::monostate{}};
}

Done parse_at(std::string_view text, LengthUnit unit, Vec3& out) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) {
    return Error{trf("at: '{}' is not allowed; must be three numbers, x,y,z", shown(text))};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Result<double> value = parse_length(fmt::format("at {}", "XYZ"[axis]), trim(parts[axis]),
                                              -kMost_mm, kMost_mm, unit);
    if (!value) return Error{value.error()};
    out[static_cast<int>(axis)] = *value;
  }
  return Done{std::monostate{}};
}

/// at=, turn=, in-blank, on=, inch from the end of the fields. What stays is the shape's.
Done take_options(std::vector<std::string_view>& fields, LengthUnit unit, FixtureSpec& out) {
  bool inch = false;
  while (fields.size() > 1) {
    const std::string_view field = trim(fields.back());
    const std::size_t equals = field.find('=');
    const std::string name = to_lower(trim(field.substr(0, equals)));
    const bool word = equals == std::string_view::npos;
    const std::string_view value = word ? std::string_view() : trim(field.substr(equals + 1));
    if (word && name == "in-blank") {
      out.in_blank = true;
    } else if (word && name == "inch") {
      inch = true;
    } else if (!word && name == "at") {
      if (const Done at = parse_at(value, unit, out.at_mm); !at) return at;
    } else if (!word && name == "turn") {
      const Result<double> turn = parse_within("turn", value, -360, 360, tr("degrees"));
      if (!turn) return Error{turn.error()};
      out.turn_deg = *turn;
    } else if (!word && name == "on") {
      out.on = std::string(value);
      if (out.on.empty()) return Error{tr("on: the name of a link of the machine is missing")};
    } else if (word) {
      break;
    } else {
      return Error{
          trf("unknown option '{}'{} Options: at=x,y,z, turn=DEG, in-blank, on=LINK, inch (of stl "
              "and obj)",
              shown(name), did_you_mean(name, kOptions))};
    }
    fields.pop_back();
  }
  if (!inch) return Done{std::monostate{}};
  const std::string shape = to_lower(trim(fields[0]));
  if (shape == "3mf") return Error{tr("a 3MF file says its unit itself")};
  if (shape == "step") return Error{tr("a STEP file says its unit itself")};
  if (shape != "stl" && shape != "obj")
    return Error{tr("inch is of stl:FILE and obj:FILE; all other numbers are in --units")};
  out.mm_per_unit = kMmPerInch;
  return Done{std::monostate{}};
}

Done parse_mesh_fields(const std::vector<std::string_view>& fields, MeshFormat format,
                       const char* form, FixtureSpec& out) {
  out.mesh_format = format;
  if (fields.size() > 1) {
    // A file's name may hold a colon.
    const char* const begin = fields[1].data();
    const auto length =
        static_cast<std::size_t>(fields.back().data() + fields.back().size() - begin);
    out.mesh_path = std::string(trim({begin, length}));
  }
  if (out.mesh_path.empty()) return Error{trf("the form is {}", form)};
  return Done{std::monostate{}};
}

Done parse_shape_fields(const std::vector<std::string_view>& fields, LengthUnit unit,
                        FixtureSpec& out) {
  const std::string shape = to_lower(trim(fields[0]));
  const std::span<const std::string_view> rest = std::span(fields).subspan(1);
  if (shape == "vise") return parse_vise(rest, unit, out);
  if (shape == "clamp") return parse_clamp(rest, unit, out);
  if (shape == "screw") return parse_screw(rest, unit, out);
  for (const auto& [word, format, form] : kMeshes)
    if (shape == word) return parse_mesh_fields(fields, format, form, out);
  if (shape == "box" || shape == "cylinder" || shape == "tube") {
    const char* const begin = fields[0].data();
    const auto length =
        static_cast<std::size_t>(fields.back().data() + fields.back().size() - begin);
    Result<Blank> bodies = parse_blank({begin, length}, unit);
    if (!bodies) return Error{bodies.error()};
    if (const std::string need = need_to_turn(*bodies); !need.empty())
      return Error{trf("{}; fixtures are boxes, cylinders and tubes", need)};
    if (bodies->bodies.empty())
      return Error{trf("'{}' is no fixture; forms: {}", shown(fields[0]), tr(kForms))};
    out.bodies = std::move(bodies->bodies);
    return Done{std::monostate{}};
  }
  if (shape.empty()) return Error{trf("no fixture is given; forms: {}", tr(kForms))};
  return Error{trf("unknown fixture '{}'{} Forms: {}", shown(shape), did_you_mean(shape, kShapes),
                   tr(kForms))};
}

void tell(Diagnostics& diagnostics, Severity severity, std::string message, std::string hint = {}) {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostics.push_back(std::move(diagnostic));
}

/// Null with an error.
SolidPointer load_mesh(const FixtureSpec& spec, Diagnostics& diagnostics) {
  const Result<MeshFromFile> read =
      read_mesh(spec.mesh_path, spec.mesh_format, spec.mm_per_unit, kMostTriangles);
  if (!read) {
    tell(diagnostics, Severity::kError, trf("fixture '{}': {}", spec.name, read.error()));
    return nullptr;
  }
  if (read->flat > 0) {
    tell(diagnostics, Severity::kNote,
         trf("fixture '{}': {} has triangles without area; they are left out: {}", spec.name,
             spec.mesh_path, read->flat));
  }
  SolidPointer solid = Solid::of_mesh(read->mesh);
  if (!solid->is_closed()) {
    tell(diagnostics, Severity::kNote,
         trf("fixture '{}': the surface in {} has holes; what is inside of it counts as air, its "
             "surface is held against the tool",
             spec.name, spec.mesh_path));
  }
  const Vec3 size = solid->box_mm().size();
  const double largest = std::max({size.x, size.y, size.z});
  if (largest > kLargeMesh_mm) {
    tell(diagnostics, Severity::kNote,
         trf("fixture '{}': {} is {:.0f} mm large; is it drawn in other units?", spec.name,
             spec.mesh_path, largest));
  } else if (spec.mesh_format != MeshFormat::k3mf && spec.mesh_format != MeshFormat::kStep &&
             spec.mm_per_unit == 1 && largest < kSmallMesh_mm) {
    tell(diagnostics, Severity::kNote,
         trf("fixture '{}': {} is {:.1f} mm large; in inches?", spec.name, spec.mesh_path, largest),
         tr(":inch behind the file takes its numbers for inches"));
  }
  return solid;
}

/// At rest.
class NoWay final : public RigidWay {
 public:
  explicit NoWay(const Pose& pose) : pose_(pose) {}
  Pose pose(double) const override { return pose_; }
  double slack_mm(double, double, double) const override { return 0; }
  double turning_mm(double, double, double) const override { return 0; }
  double travel_mm(double, double, double) const override { return 0; }

 private:
  Pose pose_;
};

/// How deep the pieces of one are in the other.
double overlap_mm(const Solid& moving, const Pose& pose, const Solid& still) {
  double deepest = 0;
  Vec3 guess{0};
  const NoWay way(pose);
  for (const Convex& piece : moving.pieces()) {
    if (piece.kind == Convex::Kind::kHull) continue;
    if (!first_touch(piece, way, still, guess)) continue;
    deepest = std::max(deepest, touch_depth_mm(piece, way, still));
  }
  return deepest;
}

bool is_mesh(const Solid& solid) {
  return !solid.pieces().empty() && solid.pieces().front().kind == Convex::Kind::kHull;
}

}  // namespace

Result<FixtureSpec> parse_fixture(std::string_view text, LengthUnit unit) {
  FixtureSpec out;
  text = trim(text);
  const std::size_t equals = text.find('=');
  if (equals != std::string_view::npos && equals < text.find(':')) {
    out.name = std::string(trim(text.substr(0, equals)));
    text = trim(text.substr(equals + 1));
    if (out.name.empty()) return Error{tr("the name before '=' is missing")};
  }
  out.text = std::string(text);
  std::vector<std::string_view> fields = split(text, ':');
  if (const Done options = take_options(fields, unit, out); !options)
    return Error{fmt::format("{}: {}", shown(text), options.error())};
  if (const Done shape = parse_shape_fields(fields, unit, out); !shape)
    return Error{fmt::format("{}: {}", shown(text), shape.error())};
  return out;
}

void name_fixtures(std::span<FixtureSpec> specs) {
  std::map<std::string, int> of_shape;
  for (FixtureSpec& spec : specs) {
    if (!spec.name.empty()) continue;
    const std::string shape =
        to_lower(trim(std::string_view(spec.text).substr(0, spec.text.find(':'))));
    const int count = ++of_shape[shape];
    spec.name = count == 1 ? shape : fmt::format("{} {}", shape, count);
  }
}

FixtureList load_fixtures(std::span<const FixtureSpec> specs, Diagnostics& diagnostics) {
  auto out = std::make_shared<std::vector<Fixture>>();
  std::vector<FixtureSpec> named(specs.begin(), specs.end());
  name_fixtures(named);
  bool complete = true;
  for (const FixtureSpec& spec : named) {
    const bool twice =
        std::ranges::any_of(*out, [&](const Fixture& other) { return other.name == spec.name; });
    if (twice) {
      tell(diagnostics, Severity::kError, trf("there are two fixtures '{}'", spec.name),
           tr("NAME=SHAPE gives a name"));
      complete = false;
      continue;
    }
    Fixture fixture;
    fixture.name = spec.name;
    fixture.solid =
        spec.mesh_path.empty() ? Solid::of_bodies(spec.bodies) : load_mesh(spec, diagnostics);
    complete = complete && fixture.solid;
    fixture.workpiece_from_fixture = turn({0, 0, 1}, spec.turn_deg);
    fixture.workpiece_from_fixture.origin_mm = spec.at_mm;
    fixture.fixture_from_workpiece = fixture.workpiece_from_fixture.inverse();
    fixture.in_blank = spec.in_blank;
    fixture.clearance_mm = spec.clearance_mm;
    fixture.on = spec.on;
    out->push_back(std::move(fixture));
  }
  if (!complete) return nullptr;
  return out;
}

double depth_in_blank_mm(const Solid& fixture, const Pose& workpiece_from_fixture,
                         const Solid& blank) {
  const double depth = std::max(overlap_mm(blank, workpiece_from_fixture.inverse(), fixture),
                                overlap_mm(fixture, workpiece_from_fixture, blank));
  const bool are_meshes = is_mesh(fixture) && is_mesh(blank);
  return are_meshes ? std::max(depth, mesh_depth_at_mm(fixture, workpiece_from_fixture, blank))
                    : depth;
}

bool check_fixtures_beside(const std::vector<Fixture>& fixtures, const Blank& blank,
                           Diagnostics& diagnostics) {
  if (blank.sheet && !fixtures.empty()) {
    tell(diagnostics, Severity::kError,
         tr("--fixture: a sheet is cut by a beam or punched; fixtures are held against mills"));
    return false;
  }
  if (fixtures.empty()) return true;
  const SolidPointer solid = solid_of(blank);
  return !solid || check_fixtures_beside(fixtures, *solid, diagnostics);
}

bool check_fixtures_beside(const std::vector<Fixture>& fixtures, const Solid& blank,
                           Diagnostics& diagnostics) {
  bool beside = true;
  for (const Fixture& fixture : fixtures) {
    if (fixture.in_blank || !fixture.on.empty()) continue;
    const double depth = depth_in_blank_mm(*fixture.solid, fixture.workpiece_from_fixture, blank);
    if (depth <= kTouching_mm) continue;
    tell(diagnostics, Severity::kError,
         trf("fixture '{}' stands in the blank, {:.2f} mm deep", fixture.name, depth),
         tr("fixtures and blank are placed in the program's coordinates; what is meant to stand in "
            "it (a screw, a mandrel) has :in-blank"));
    beside = false;
  }
  return beside;
}

}  // namespace kerf
