#include "stock/blank.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/portable_math.h"
#include "base/suggest.h"
#include "base/translate.h"
#include "mesh/mesh_body.h"
#include "stock/cutter/scan.h"

namespace kerf {
namespace {

/// 100 m: beyond any machine; what lies outside is a slip of the pen.
constexpr double kMaxCoordinate_mm = 1e5;
constexpr double kMinSize_mm = 0.001;
constexpr std::size_t kMaxBodies = 1000;
/// What cuts straight through is no thicker, by far.
constexpr double kMaxThickness_mm = 1000;
/// Castings are not given more.
constexpr double kMostAllowance_mm = 100;

constexpr std::array<std::string_view, 12> kKinds = {"box",    "cylinder", "tube",  "hex",
                                                     "square", "state",    "stl",   "obj",
                                                     "3mf",    "step",     "sheet", "profile"};
constexpr std::array<std::string_view, 4> kMeshKinds = {"stl", "obj", "3mf", "step"};
constexpr const char* kForms = tr_noop(
    "box:x0,y0,z0:x1,y1,z1, cylinder:x,y,z0:z1:d[:axis], tube:x,y,z0:z1:d:inner[:axis], "
    "hex:x,y,z0:z1:ACROSS_FLATS, square:x,y,z0:z1:ACROSS_FLATS, state:FILE, stl:FILE, obj:FILE, "
    "3mf:FILE, step:FILE, profile:FILE.dxf, profile:FILE.svg, sheet:x0,y0:x1,y1:THICKNESS, "
    "sheet:FILE.dxf:THICKNESS, "
    "sheet:FILE.svg:THICKNESS");

/// `form`: x,y,z or x,y.
Result<Vec3> parse_point(std::string_view name, std::string_view text, LengthUnit unit,
                         std::string_view form = "x,y,z") {
  const std::vector<std::string_view> parts = split(text, ',');
  const std::size_t axes = form.size() / 2 + 1;
  if (parts.size() != axes) {
    return Error{trf("{}: '{}' has {} {}; must be {}", name, shown(text), parts.size(),
                     parts.size() == 1 ? tr("value") : tr("values"), form)};
  }
  Vec3 point(0);
  for (int axis = 0; axis < static_cast<int>(axes); ++axis) {
    const Result<double> value = parse_length(fmt::format("{} {}", name, "XYZ"[axis]),
                                              trim(parts[static_cast<std::size_t>(axis)]),
                                              -kMaxCoordinate_mm, kMaxCoordinate_mm, unit);
    if (!value) return Error{value.error()};
    point[axis] = *value;
  }
  return point;
}

/// "" if low < high by at least kMinSize_mm.
std::string order_fault(char axis, double low, double high, LengthUnit unit) {
  if (high - low >= kMinSize_mm) return "";
  return trf("{} runs from {} to {}; the second must be at least {} {} above the first", axis,
             length_number(low, unit), length_number(high, unit), length_number(kMinSize_mm, unit),
             name_of(unit));
}

Result<BlankBody> parse_box(const std::vector<std::string_view>& fields, LengthUnit unit) {
  if (fields.size() != 3) return Error{tr("the form is box:x0,y0,z0:x1,y1,z1")};
  const Result<Vec3> low = parse_point(tr("first corner"), fields[1], unit);
  if (!low) return Error{low.error()};
  const Result<Vec3> high = parse_point(tr("second corner"), fields[2], unit);
  if (!high) return Error{high.error()};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string fault = order_fault("XYZ"[axis], (*low)[axis], (*high)[axis], unit);
    if (!fault.empty()) return Error{fault};
  }
  BlankBody body;
  body.bounds_mm = Box{*low, *high};
  body.center_mm = (*low + *high) / 2.0;
  return body;
}

/// Index of x, y, z; nothing else is an axis.
std::optional<int> axis_index(std::string_view text) {
  const std::string lower = to_lower(trim(text));
  if (lower.size() != 1 || lower[0] < 'x' || lower[0] > 'z') return std::nullopt;
  return lower[0] - 'x';
}

/// A bar of flats along z, from the centre of its lower end.
Result<BlankBody> parse_bar(const std::vector<std::string_view>& fields, int flats,
                            LengthUnit unit) {
  if (fields.size() != 4) {
    return Error{flats == 6 ? tr("the form is hex:x,y,z0:z1:ACROSS_FLATS")
                            : tr("the form is square:x,y,z0:z1:ACROSS_FLATS")};
  }
  const Result<Vec3> center = parse_point(tr("centre"), fields[1], unit);
  if (!center) return Error{center.error()};
  const Result<double> end = parse_length(trf("end {}", 'Z'), trim(fields[2]), -kMaxCoordinate_mm,
                                          kMaxCoordinate_mm, unit);
  if (!end) return Error{end.error()};
  const std::string fault = order_fault('Z', center->z, *end, unit);
  if (!fault.empty()) return Error{fault};
  const Result<double> across =
      parse_length(tr("across flats"), trim(fields[3]), kMinSize_mm, kMaxCoordinate_mm, unit);
  if (!across) return Error{across.error()};
  BlankBody body;
  body.kind = BlankBody::Kind::kBar;
  body.center_mm = *center;
  body.diameter_mm = *across;
  body.flats = flats;
  const double half = *across / 2;
  // A flat towards +X: of six, corners towards +Y and -Y.
  const double high = flats == 6 ? half / portable::cos(kPi / 6) : half;
  body.bounds_mm = Box{*center - Vec3(half, high, 0), *center + Vec3(half, high, 0)};
  body.bounds_mm.max.z = *end;
  return body;
}

/// cylinder and tube: the point is the centre of the lower end, then the other end along the axis.
Result<BlankBody> parse_round(const std::vector<std::string_view>& fields, bool tube,
                              LengthUnit unit) {
  const std::size_t needed = tube ? 5 : 4;
  if (fields.size() != needed && fields.size() != needed + 1) {
    return Error{tube ? tr("the form is tube:x,y,z0:z1:d:inner[:axis]")
                      : tr("the form is cylinder:x,y,z0:z1:d[:axis]")};
  }
  int axis = 2;
  if (fields.size() > needed) {
    const std::optional<int> index = axis_index(fields.back());
    if (!index) {
      return Error{trf("axis: '{}' is not an axis; must be x, y or z", shown(fields.back()))};
    }
    axis = *index;
  }
  const Result<Vec3> center = parse_point(tr("centre"), fields[1], unit);
  if (!center) return Error{center.error()};
  const char letter = "XYZ"[axis];
  const Result<double> end = parse_length(trf("end {}", letter), trim(fields[2]),
                                          -kMaxCoordinate_mm, kMaxCoordinate_mm, unit);
  if (!end) return Error{end.error()};
  const std::string fault = order_fault(letter, (*center)[axis], *end, unit);
  if (!fault.empty()) return Error{fault};
  const Result<double> diameter =
      parse_length(tr("diameter"), trim(fields[3]), kMinSize_mm, kMaxCoordinate_mm, unit);
  if (!diameter) return Error{diameter.error()};
  BlankBody body;
  body.kind = tube ? BlankBody::Kind::kTube : BlankBody::Kind::kCylinder;
  body.axis = "xyz"[axis];
  body.center_mm = *center;
  body.diameter_mm = *diameter;
  if (tube) {
    const Result<double> inner =
        parse_length(tr("inner diameter"), trim(fields[4]), kMinSize_mm, kMaxCoordinate_mm, unit);
    if (!inner) return Error{inner.error()};
    if (*inner >= *diameter) {
      return Error{
          trf("inner diameter: {} is not allowed; must be less than the diameter, "
              "{} ({})",
              length_number(*inner, unit), length_number(*diameter, unit), name_of(unit))};
    }
    body.inner_diameter_mm = *inner;
  }
  body.bounds_mm = Box{*center - Vec3(*diameter / 2), *center + Vec3(*diameter / 2)};
  body.bounds_mm.min[axis] = (*center)[axis];
  body.bounds_mm.max[axis] = *end;
  return body;
}

Result<BlankBody> parse_body(std::string_view text, LengthUnit unit) {
  const std::vector<std::string_view> fields = split(text, ':');
  const std::string kind = to_lower(trim(fields[0]));
  if (kind == "box") return parse_box(fields, unit);
  if (kind == "cylinder") return parse_round(fields, false, unit);
  if (kind == "tube") return parse_round(fields, true, unit);
  if (kind == "hex" || kind == "square") return parse_bar(fields, kind == "hex" ? 6 : 4, unit);
  if (std::find(kMeshKinds.begin(), kMeshKinds.end(), kind) != kMeshKinds.end())
    return Error{trf("{}:FILE stands alone; it cannot be added to other bodies", kind)};
  if (kind == "state")
    return Error{tr("state:FILE stands alone; it cannot be added to other bodies")};
  if (kind == "sheet") return Error{tr("a sheet stands alone; it cannot be added to other bodies")};
  if (kind == "profile")
    return Error{tr("profile:FILE stands alone; it cannot be added to other bodies")};
  if (kind.empty()) return Error{trf("no stock is given; forms: {}", tr(kForms))};
  return Error{
      trf("unknown stock '{}'{} Forms: {}", shown(kind), did_you_mean(kind, kKinds), tr(kForms))};
}

/// Parts at each '+' that begins a new body: the '+' of a number is followed by a digit or a point.
std::vector<std::string_view> split_bodies(std::string_view text) {
  std::vector<std::string_view> bodies;
  std::size_t begin = 0;
  for (std::size_t at = text.find('+'); at != std::string_view::npos; at = text.find('+', at + 1)) {
    const std::size_t next = text.find_first_not_of(" \t", at + 1);
    const bool number = next != std::string_view::npos &&
                        std::string_view("0123456789.").find(text[next]) != std::string_view::npos;
    if (number) continue;
    bodies.push_back(trim(text.substr(begin, at - begin)));
    begin = at + 1;
  }
  bodies.push_back(trim(text.substr(begin)));
  return bodies;
}

constexpr const char* kSheetForms = tr_noop(
    "the form is sheet:x0,y0:x1,y1:THICKNESS, sheet:FILE.dxf:THICKNESS or "
    "sheet:FILE.svg:THICKNESS");

bool is_drawing(std::string_view file) {
  const std::string lower = to_lower(file);
  return lower.size() > 4 && (lower.ends_with(".dxf") || lower.ends_with(".svg"));
}

/// `text`: behind "state:".
Done parse_state(std::string_view text, LengthUnit unit, Blank& blank) {
  const Result<BlankPlace> place = take_place(text, unit);
  if (!place) return Error{place.error()};
  if (text.empty()) return Error{tr("state:: the file name is missing; the form is state:FILE")};
  blank.saved_place = *place;
  blank.state_file = std::string(text);
  return std::monostate{};
}

/// The kind that the ending of a name says; empty: none.
std::string_view mesh_kind_of(std::string_view file) {
  const std::string lower = to_lower(file);
  for (const std::string_view kind : kMeshKinds)
    if (lower.ends_with(fmt::format(".{}", kind))) return kind;
  return lower.ends_with(".stp") ? "step" : "";
}

/// `kind` empty: the name's ending says it. False: it is nothing of that kind.
Result<bool> parse_mesh(std::string_view kind, std::string_view text, LengthUnit unit,
                        Blank& blank) {
  BlankMesh mesh;
  std::string word;
  const Result<BlankPlace> place = take_place(text, unit, {"inch", "mm"}, &word);
  std::string_view file = text;
  const std::size_t plus = text.rfind('+');
  const std::string_view behind =
      plus == std::string_view::npos ? std::string_view() : trim(text.substr(plus + 1));
  const bool grows = !behind.empty() && parse_decimal(behind);
  if (grows) file = trim(text.substr(0, plus));
  const std::string_view ending = mesh_kind_of(file);
  if (kind.empty() && ending.empty()) return false;
  if (!place) return Error{place.error()};
  if (file.empty())
    return Error{trf("the file name is missing; the form is {}:FILE[+ALLOWANCE]", kind)};
  if (!kind.empty() && kind != ending) {
    return Error{trf("'{}' is not a name of that kind; the form is {}:FILE.{}[+ALLOWANCE]",
                     shown(file), kind, kind)};
  }
  if (ending == "3mf" && !word.empty()) return Error{tr("a 3MF file says its unit itself")};
  if (ending == "step" && !word.empty()) return Error{tr("a STEP file says its unit itself")};
  if (grows) {
    const Result<double> allowance =
        parse_length(tr("allowance"), behind, kMinSize_mm, kMostAllowance_mm, unit);
    if (!allowance) return Error{allowance.error()};
    mesh.allowance_mm = *allowance;
  }
  if (!word.empty()) mesh.unit = word == "inch" ? LengthUnit::kInch : LengthUnit::kMm;
  mesh.place = *place;
  mesh.file = std::string(file);
  blank.mesh = std::move(mesh);
  return true;
}

/// `text`: behind "profile:".
Result<std::string> parse_profile(std::string_view text) {
  const std::string_view file = trim(text);
  if (is_drawing(file)) return std::string(file);
  return Error{
      trf("'{}' is not a drawing; the form is profile:FILE.dxf or profile:FILE.svg", shown(file))};
}

/// `text`: behind "sheet:". A file name may hold any character, '+' and ':' too.
Result<BlankSheet> parse_sheet(std::string_view text, LengthUnit unit) {
  const std::size_t last = text.rfind(':');
  if (last == std::string_view::npos) return Error{tr(kSheetForms)};
  const std::string_view outline = trim(text.substr(0, last));
  BlankSheet sheet;
  if (is_drawing(outline)) {
    sheet.file = std::string(outline);
  } else {
    if (split_bodies(text).size() > 1) {
      return Error{tr("a sheet stands alone; it cannot be added to other bodies")};
    }
    const std::vector<std::string_view> corners = split(outline, ':');
    if (corners.size() != 2) return Error{tr(kSheetForms)};
    const Result<Vec3> low = parse_point(tr("first corner"), corners[0], unit, "x,y");
    if (!low) return Error{low.error()};
    const Result<Vec3> high = parse_point(tr("second corner"), corners[1], unit, "x,y");
    if (!high) return Error{high.error()};
    for (int axis = 0; axis < 2; ++axis) {
      const std::string fault = order_fault("XY"[axis], (*low)[axis], (*high)[axis], unit);
      if (!fault.empty()) return Error{fault};
    }
    sheet.low_mm = Vec2(*low);
    sheet.high_mm = Vec2(*high);
  }
  const Result<double> thickness = parse_length(tr("thickness"), trim(text.substr(last + 1)),
                                                kMinSize_mm, kMaxThickness_mm, unit);
  if (!thickness) return Error{thickness.error()};
  sheet.thickness_mm = *thickness;
  return sheet;
}

/// To 0.1 um, for messages.
std::string rounded(double value) { return number_text(std::round(value * 1e4) / 1e4); }

std::string describe(const BlankBody& body) {
  const Vec3 low = body.bounds_mm.min;
  const Vec3 high = body.bounds_mm.max;
  const auto range = [&](int axis) {
    return fmt::format("{}{}..{}", "XYZ"[axis], rounded(low[axis]), rounded(high[axis]));
  };
  if (body.kind == BlankBody::Kind::kBox) {
    const Vec3 size = body.bounds_mm.size();
    return trf("box {} x {} x {} mm, {} {} {}", rounded(size.x), rounded(size.y), rounded(size.z),
               range(0), range(1), range(2));
  }
  const int axis = body.axis - 'x';
  std::string center;
  for (int other = 0; other < 3; ++other) {
    if (other != axis) center += fmt::format("{}{} ", "XYZ"[other], rounded(body.center_mm[other]));
  }
  const std::string length = rounded(high[axis] - low[axis]);
  if (body.kind == BlankBody::Kind::kBar) {
    const std::string across = rounded(body.diameter_mm);
    return body.flats == 6
               ? trf("hexagonal bar {} x {} mm along Z, {}{}", across, length, center, range(2))
               : trf("square bar {} x {} mm along Z, {}{}", across, length, center, range(2));
  }
  if (body.kind == BlankBody::Kind::kTube) {
    return trf("tube diameter {} / {} x {} mm along {}, {}{}", rounded(body.diameter_mm),
               rounded(body.inner_diameter_mm), length, "XYZ"[axis], center, range(axis));
  }
  return trf("cylinder diameter {} x {} mm along {}, {}{}", rounded(body.diameter_mm), length,
             "XYZ"[axis], center, range(axis));
}

std::string describe(const BlankSheet& sheet) {
  const std::string thickness = rounded(sheet.thickness_mm);
  if (!sheet.file.empty()) {
    return trf("sheet {} mm thick, outline from {}, Z-{}..0", thickness, shown(sheet.file),
               thickness);
  }
  const Vec2 size = sheet.high_mm - sheet.low_mm;
  return trf("sheet {} x {} x {} mm, X{}..{} Y{}..{} Z-{}..0", rounded(size.x), rounded(size.y),
             thickness, rounded(sheet.low_mm.x), rounded(sheet.high_mm.x), rounded(sheet.low_mm.y),
             rounded(sheet.high_mm.y), thickness);
}

std::string describe(const BlankMesh& mesh) {
  std::string text = trf("mesh from {}", shown(mesh.file));
  if (mesh.allowance_mm > 0) text += trf(", grown by {} mm", rounded(mesh.allowance_mm));
  text += mesh.place.text();
  if (!mesh.body) return text;
  const Box& b = mesh.body->box_mm;
  if (mesh.allowance_mm == 0 && mesh.body->parts == 1)
    text += trf(", {} mm3", rounded(mesh.body->volume_mm3));
  return text + trf(", {} x {} x {} mm, X{}..{} Y{}..{} Z{}..{}", rounded(b.size().x),
                    rounded(b.size().y), rounded(b.size().z), rounded(b.min.x), rounded(b.max.x),
                    rounded(b.min.y), rounded(b.max.y), rounded(b.min.z), rounded(b.max.z));
}

}  // namespace

Box Blank::bounds_mm() const {
  Box bounds;
  if (sheet && sheet->file.empty()) {
    bounds.extend(Vec3(sheet->low_mm, -sheet->thickness_mm));
    bounds.extend(Vec3(sheet->high_mm, 0));
  }
  for (const BlankBody& body : bodies) bounds.extend(body.bounds_mm);
  if (mesh && mesh->body) bounds.extend(mesh->body->box_mm);
  return bounds;
}

std::string need_to_turn(const Blank& blank) {
  if (!blank.profile_file.empty()) return tr("the blank is a profile that turns");
  for (const BlankBody& body : blank.bodies) {
    if (body.kind != BlankBody::Kind::kBar) continue;
    return body.flats == 6 ? tr("the blank is a hexagonal bar") : tr("the blank is a square bar");
  }
  return {};
}

Result<Blank> parse_blank(std::string_view spec, LengthUnit unit) {
  spec = trim(spec);
  Blank blank;
  const std::size_t colon = spec.find(':');
  if (colon != std::string_view::npos && to_lower(trim(spec.substr(0, colon))) == "state") {
    const Done done = parse_state(spec.substr(colon + 1), unit, blank);
    if (!done) return Error{done.error()};
    return blank;
  }
  if (colon != std::string_view::npos && to_lower(trim(spec.substr(0, colon))) == "sheet") {
    Result<BlankSheet> sheet = parse_sheet(spec.substr(colon + 1), unit);
    if (!sheet) return Error{fmt::format("{}: {}", shown(spec), sheet.error())};
    blank.sheet = std::move(sheet.value());
    return blank;
  }
  if (colon != std::string_view::npos && to_lower(trim(spec.substr(0, colon))) == "profile") {
    Result<std::string> file = parse_profile(spec.substr(colon + 1));
    if (!file) return Error{fmt::format("{}: {}", shown(spec), file.error())};
    blank.profile_file = std::move(file.value());
    return blank;
  }
  const std::string word =
      colon == std::string_view::npos ? "" : to_lower(trim(spec.substr(0, colon)));
  const bool is_mesh = std::find(kMeshKinds.begin(), kMeshKinds.end(), word) != kMeshKinds.end();
  if (is_mesh || std::find(kKinds.begin(), kKinds.end(), word) == kKinds.end()) {
    const Result<bool> mesh = is_mesh ? parse_mesh(word, spec.substr(colon + 1), unit, blank)
                                      : parse_mesh({}, spec, unit, blank);
    if (!mesh) return Error{fmt::format("{}: {}", shown(spec), mesh.error())};
    if (*mesh) return blank;
  }
  const std::vector<std::string_view> texts = split_bodies(spec);
  if (texts.size() > kMaxBodies) {
    return Error{trf("{} bodies; at most {} are allowed", texts.size(), kMaxBodies)};
  }
  for (const std::string_view text : texts) {
    Result<BlankBody> body = parse_body(text, unit);
    if (!body) {
      return Error{text.empty() ? body.error() : fmt::format("{}: {}", shown(text), body.error())};
    }
    blank.bodies.push_back(*body);
  }
  return blank;
}

std::string describe(const Blank& blank) {
  if (!blank.state_file.empty()) {
    return trf("workpiece saved in {}", shown(blank.state_file)) + blank.saved_place.text();
  }
  if (blank.mesh) return describe(*blank.mesh);
  if (blank.sheet) return describe(*blank.sheet);
  if (!blank.profile_file.empty()) return trf("profile from {}", shown(blank.profile_file));
  std::string text;
  for (const BlankBody& body : blank.bodies) {
    if (!text.empty()) text += " + ";
    text += describe(body);
  }
  return text;
}

}  // namespace kerf
