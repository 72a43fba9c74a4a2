#include "stock/cutter/shape_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/geometry.h"
#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/profile_file.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_fields.h"
#include "stock/cutter/shape_limits.h"
#include "stock/cutter/tool_parts.h"
#include "stock/cutter/turning_shape.h"

namespace kerf {
namespace {

/// Corner radii and tip diameters: 0 or at least this.
constexpr double kMinDetail_mm = 0.0001;
constexpr double kMinAngle_deg = 1;
constexpr double kMaxIncludedAngle_deg = 179;
constexpr double kFlatDrillAngle_deg = 180;
constexpr double kMaxHalfAngle_deg = 80;
constexpr double kMaxDovetailAngle_deg = 89;
/// Height of a tapered cutter's cone where the flute length is not given.
constexpr double kTaperHeightPerTip = 3;
/// Rounding allowance where two lengths that may be equal are compared.
constexpr double kLengthTolerance_mm = 1e-9;

struct Form {
  std::string_view name;
  std::string_view text;
  std::size_t required;
  std::size_t optional;
  std::array<const char*, 3> parameters;
};

constexpr std::array<Form, 11> kForms = {{
    {"flat", "flat:D", 1, 0, {tr_noop("diameter D")}},
    {"ball", "ball:D", 1, 0, {tr_noop("diameter D")}},
    {"bull", "bull:D:R", 2, 0, {tr_noop("diameter D"), tr_noop("corner radius R")}},
    {"vee",
     "vee:D:ANGLE[:TIP]",
     2,
     1,
     {tr_noop("diameter D"), tr_noop("included angle ANGLE"), tr_noop("tip diameter TIP")}},
    {"taper",
     "taper:D:ANGLE[:R]",
     2,
     1,
     {tr_noop("tip diameter D"), tr_noop("half angle ANGLE"), tr_noop("corner radius R")}},
    {"drill", "drill:D:ANGLE", 2, 0, {tr_noop("diameter D"), tr_noop("point angle ANGLE")}},
    {"lollipop",
     "lollipop:D:SHAFT",
     2,
     0,
     {tr_noop("diameter D"), tr_noop("shaft diameter SHAFT")}},
    {"tslot",
     "tslot:D:T:SHAFT",
     3,
     0,
     {tr_noop("diameter D"), tr_noop("thickness T"), tr_noop("shaft diameter SHAFT")}},
    {"dovetail",
     "dovetail:D:ANGLE:SHAFT",
     3,
     0,
     {tr_noop("diameter D"), tr_noop("side angle ANGLE"), tr_noop("shaft diameter SHAFT")}},
    {"kerf", "kerf:W", 1, 0, {tr_noop("kerf width W")}},
    {"profile", "profile:FILE", 1, 0, {tr_noop("file name FILE")}},
}};

constexpr std::array<std::string_view, 18> kShapeNames = {
    "flat", "ball",    "bull", "vee", "taper",  "drill", "lollipop",   "tslot",  "dovetail",
    "kerf", "profile", "turn", "iso", "groove", "part",  "facegroove", "thread", "bore"};
constexpr std::array<std::string_view, 6> kOptionNames = {"flute",    "shank", "holder",
                                                          "stickout", "teeth", "live"};

constexpr const char* kHelp = tr_noop(
    "flat:D               end mill\n"
    "ball:D               ball nose\n"
    "bull:D:R             corner radius R, up to D/2\n"
    "vee:D:ANGLE[:TIP]    V-bit, chamfer mill: included angle, largest diameter D, flat tip TIP\n"
    "taper:D:ANGLE[:R]    tapered mill: tip diameter D, angle of one side, corner or ball radius "
    "R\n"
    "drill:D:ANGLE        point angle ANGLE\n"
    "lollipop:D:SHAFT     ball of diameter D on a shaft\n"
    "tslot:D:T:SHAFT      disc of thickness T on a shaft\n"
    "dovetail:D:ANGLE:SHAFT  cone widest at its bottom, on a shaft: ANGLE of its side to the "
    "bottom\n"
    "kerf:W               torch, laser or jet: width of what it takes out of a sheet\n"
    "profile:FILE         outline from a file\n"
    "each of these may add  :flute=L:shank=D[xL]:holder=NAME|DxL[+DxL..]:stickout=L:teeth=N\n"
    "                     :live=x|z  of a lathe's driven tool: along which axis it lies");

ProfilePiece line_piece(double r0, double z0, double r1, double z1) {
  ProfilePiece piece;
  piece.r0 = r0;
  piece.z0 = z0;
  piece.r1 = r1;
  piece.z1 = z1;
  return piece;
}

/// Lower right part of a circle, from its lowest point to the given end.
ProfilePiece corner_piece(double center_r, double radius, double r1, double z1) {
  ProfilePiece piece = line_piece(center_r, 0, r1, z1);
  piece.kind = ProfilePiece::Kind::kArc;
  piece.center_r = center_r;
  piece.center_z = radius;
  piece.radius = radius;
  piece.convex = true;
  return piece;
}

struct Options {
  std::optional<double> flute_mm;
  std::vector<ToolPart> shank;  ///< the last may have no length
  std::vector<ToolPart> holder;
  std::optional<double> stickout_mm;
  std::optional<int> teeth;
  std::optional<LiveAxis> live;
};

/// What a form makes before the options are added.
struct Body {
  std::vector<ProfilePiece> pieces;
  std::vector<ProfilePiece> upper_pieces;  ///< of a head with a neck
  std::string spec;
  std::optional<double> flute_mm;  ///< where the flutes end unless flute= says so
  std::optional<double> shank_mm;  ///< diameter above it unless shank= says so
};

// ---- options ----

Done parse_teeth(std::string_view value, Options& options) {
  int teeth = 0;
  if (!read_number(value, teeth) || teeth < 1 || teeth > kMaxTeeth) {
    return Error{trf("teeth: '{}' is not allowed; must be a whole number from 1 to {}",
                     shown(value), kMaxTeeth)};
  }
  options.teeth = teeth;
  return std::monostate{};
}

Done parse_live(std::string_view value, Options& options) {
  if (value != "x" && value != "X" && value != "z" && value != "Z") {
    return Error{
        trf("live: '{}' is not allowed; x and z are: the axis of a lathe along which the "
            "driven tool lies",
            shown(value))};
  }
  options.live = value == "x" || value == "X" ? LiveAxis::kX : LiveAxis::kZ;
  return std::monostate{};
}

Done take_parts(Result<std::vector<ToolPart>> parsed, std::vector<ToolPart>& out) {
  if (!parsed) return Error{parsed.error()};
  out = std::move(parsed.value());
  return std::monostate{};
}

Done parse_option(std::string_view name, std::string_view value, LengthUnit unit,
                  Options& options) {
  if (name == "flute") {
    if (options.flute_mm) return Error{tr("flute= is given twice")};
    const Result<double> flute =
        parse_length(tr("flute length"), value, kMinLength_mm, kMaxLength_mm, unit);
    if (!flute) return Error{flute.error()};
    options.flute_mm = *flute;
    return std::monostate{};
  }
  if (name == "shank") {
    if (!options.shank.empty()) return Error{tr("shank= is given twice")};
    return take_parts(parse_shank(value, unit), options.shank);
  }
  if (name == "holder") {
    if (!options.holder.empty()) return Error{tr("holder= is given twice")};
    return take_parts(parse_holder(value, unit), options.holder);
  }
  if (name == "teeth") {
    if (options.teeth) return Error{tr("teeth= is given twice")};
    return parse_teeth(value, options);
  }
  if (name == "live") {
    if (options.live) return Error{tr("live= is given twice")};
    return parse_live(value, options);
  }
  if (name == "stickout") {
    if (options.stickout_mm) return Error{tr("stickout= is given twice")};
    const Result<double> stickout =
        parse_length(tr("stick-out"), value, kMinLength_mm, kMaxLength_mm, unit);
    if (!stickout) return Error{stickout.error()};
    options.stickout_mm = *stickout;
    return std::monostate{};
  }
  return Error{
      trf("unknown option '{}'{} Options: flute=L, shank=D[xL], holder=NAME|DxL[+DxL..], "
          "stickout=L, teeth=N, live=x|z",
          shown(name), did_you_mean(name, kOptionNames))};
}

std::string options_text(const Options& options) {
  std::string text;
  if (options.flute_mm) text += fmt::format(":flute={}", number_text(*options.flute_mm));
  if (!options.shank.empty()) text += ":shank=" + parts_text(options.shank);
  if (!options.holder.empty()) text += ":holder=" + parts_text(options.holder);
  if (options.stickout_mm) text += fmt::format(":stickout={}", number_text(*options.stickout_mm));
  if (options.teeth) text += fmt::format(":teeth={}", *options.teeth);
  if (options.live) text += *options.live == LiveAxis::kX ? ":live=x" : ":live=z";
  return text;
}

// ---- forms ----

/// Reads parameter `index` of a form.
class Values {
 public:
  Values(const Form& form, std::span<const std::string_view> texts, LengthUnit unit)
      : form_(form), texts_(texts), unit_(unit) {}
  std::size_t count() const { return texts_.size(); }
  Result<double> diameter(std::size_t index, double low = kMinDiameter_mm,
                          double high = kMaxDiameter_mm) const {
    return parse_length(tr(form_.parameters[index]), texts_[index], low, high, unit_);
  }
  Result<double> angle(std::size_t index, double high) const {
    return parse_within(tr(form_.parameters[index]), texts_[index], kMinAngle_deg, high,
                        tr("degrees"));
  }
  /// A diameter that must stay clearly below D, given before it.
  Result<double> below(std::size_t index, double limit, double low) const {
    const Result<double> value = detail(index, low, kMaxDiameter_mm);
    if (value && *value > limit - kMinDetail_mm) {
      return Error{trf("{}: {} is not allowed; must be less than diameter D, {} ({})",
                       tr(form_.parameters[index]), length_number(*value, unit_),
                       length_number(limit, unit_), name_of(unit_))};
    }
    return value;
  }
  /// A corner radius: 0 to half the diameter.
  Result<double> corner(std::size_t index, double diameter_mm) const {
    return detail(index, 0, diameter_mm / 2);
  }

 private:
  /// 0 (if `low` allows it) or at least kMinDetail_mm: less would be a step that no model can see.
  Result<double> detail(std::size_t index, double low, double high) const {
    const Result<double> value = diameter(index, low, high);
    if (value && *value > 0 && *value < kMinDetail_mm) {
      return Error{trf("{}: {} is not allowed; must be 0 or at least {} ({})",
                       tr(form_.parameters[index]), length_number(*value, unit_),
                       length_number(kMinDetail_mm, unit_), name_of(unit_))};
    }
    return value;
  }

  const Form& form_;
  std::span<const std::string_view> texts_;
  LengthUnit unit_;
};

/// Radius of the flat bottom inside a corner arc; a flat that no model can see is none.
double flat_radius(double radius, double corner) {
  return radius - corner < kMinDetail_mm ? 0 : radius - corner;
}

/// Flat bottom, corner arc up to the cylinder.
void add_bull(Body& body, double radius, double corner) {
  const double center_r = flat_radius(radius, corner);
  corner = corner > 0 ? radius - center_r : 0;
  if (center_r > 0) body.pieces.push_back(line_piece(0, 0, center_r, 0));
  if (corner > 0) body.pieces.push_back(corner_piece(center_r, corner, radius, corner));
}

/// Flat tip, cone up to `radius`.
void add_cone(Body& body, double tip_radius, double radius, double half_angle_deg) {
  if (tip_radius > 0) body.pieces.push_back(line_piece(0, 0, tip_radius, 0));
  const double height = (radius - tip_radius) / std::tan(half_angle_deg * kRadPerDeg);
  body.pieces.push_back(line_piece(tip_radius, 0, radius, height));
}

Result<Body> make_round(std::string_view kind, const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  Body body;
  body.spec = fmt::format("{}:{}", kind, number_text(*d));
  double corner = kind == "ball" ? *d / 2 : 0;
  if (kind == "bull") {
    const Result<double> r = values.corner(1, *d);
    if (!r) return Error{r.error()};
    corner = *r;
    body.spec += fmt::format(":{}", number_text(corner));
  }
  add_bull(body, *d / 2, corner);
  return body;
}

Result<Body> make_vee(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxIncludedAngle_deg);
  if (!angle) return Error{angle.error()};
  Body body;
  body.spec = fmt::format("vee:{}:{}", number_text(*d), number_text(*angle));
  double tip = 0;
  if (values.count() > 2) {
    const Result<double> value = values.below(2, *d, 0);
    if (!value) return Error{value.error()};
    tip = *value;
    if (tip > 0) body.spec += fmt::format(":{}", number_text(tip));
  }
  add_cone(body, tip / 2, *d / 2, *angle / 2);
  return body;
}

Result<Body> make_drill(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kFlatDrillAngle_deg);
  if (!angle) return Error{angle.error()};
  Body body;
  body.spec = fmt::format("drill:{}:{}", number_text(*d), number_text(*angle));
  if (*angle == kFlatDrillAngle_deg) {
    add_bull(body, *d / 2, 0);
  } else {
    add_cone(body, 0, *d / 2, *angle / 2);
  }
  return body;
}

//                  /  cone at ANGLE from the axis
//                 /
//        c       /   the corner circle (centre c, radius R) meets it where its normal is square to
//        the cone:
//        .-_   .'    r = c.r + R cos(ANGLE), z = R - R sin(ANGLE)
//  ________ `-'
//  |  D/2 - R |
Result<Body> make_taper(const Values& values, const Options& options) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxHalfAngle_deg);
  if (!angle) return Error{angle.error()};
  Body body;
  body.spec = fmt::format("taper:{}:{}", number_text(*d), number_text(*angle));
  double corner = 0;
  if (values.count() > 2) {
    const Result<double> value = values.corner(2, *d);
    if (!value) return Error{value.error()};
    corner = *value;
    if (corner > 0) body.spec += fmt::format(":{}", number_text(corner));
  }
  const double center_r = flat_radius(*d / 2, corner);
  if (corner > 0) corner = *d / 2 - center_r;
  const double r = center_r + corner * std::cos(*angle * kRadPerDeg);
  const double z = corner * (1 - std::sin(*angle * kRadPerDeg));
  const double top = options.flute_mm.value_or(kTaperHeightPerTip * *d);
  if (top < z + kMinLength_mm) {
    return Error{trf("flute={} ends below the cone, which begins {:.4g} mm above the tip",
                     number_text(top), z)};
  }
  const double top_r = r + (top - z) * std::tan(*angle * kRadPerDeg);
  if (2 * top_r > kMaxDiameter_mm) {
    return Error{trf("the cone is {:.4g} mm wide at its top, {} mm above the tip; at most {} mm",
                     2 * top_r, number_text(top), number_text(kMaxDiameter_mm))};
  }
  if (center_r > 0) body.pieces.push_back(line_piece(0, 0, center_r, 0));
  if (corner > 0) body.pieces.push_back(corner_piece(center_r, corner, r, z));
  body.pieces.push_back(line_piece(r, z, top_r, top));
  body.flute_mm = top;
  return body;
}

Result<Body> make_lollipop(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> shaft = values.below(1, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  Body body;
  body.spec = fmt::format("lollipop:{}:{}", number_text(*d), number_text(*shaft));
  const double radius = *d / 2;
  const double neck = *shaft / 2;
  add_bull(body, radius, radius);
  body.flute_mm = radius + std::sqrt((radius - neck) * (radius + neck));
  ProfilePiece upper = line_piece(radius, radius, neck, *body.flute_mm);
  upper.kind = ProfilePiece::Kind::kArc;
  upper.center_z = radius;
  upper.radius = radius;
  body.upper_pieces.push_back(upper);
  body.shank_mm = *shaft;
  return body;
}

Result<Body> make_tslot(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> thickness = values.diameter(1, kMinLength_mm, kMaxLength_mm);
  if (!thickness) return Error{thickness.error()};
  const Result<double> shaft = values.below(2, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  Body body;
  body.spec =
      fmt::format("tslot:{}:{}:{}", number_text(*d), number_text(*thickness), number_text(*shaft));
  add_bull(body, *d / 2, 0);
  body.upper_pieces.push_back(line_piece(*d / 2, 0, *d / 2, *thickness));
  body.upper_pieces.push_back(line_piece(*d / 2, *thickness, *shaft / 2, *thickness));
  body.flute_mm = *thickness;
  body.shank_mm = *shaft;
  return body;
}

Result<Body> make_dovetail(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxDovetailAngle_deg);
  if (!angle) return Error{angle.error()};
  const Result<double> shaft = values.below(2, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  Body body;
  body.spec =
      fmt::format("dovetail:{}:{}:{}", number_text(*d), number_text(*angle), number_text(*shaft));
  const double height = (*d - *shaft) / 2 * std::tan(*angle * kRadPerDeg);
  if (height < kMinLength_mm || height > kMaxLength_mm) {
    return Error{trf("the head is {:.4g} mm high; must be from {} to {} (mm)", height,
                     kMinLength_mm, kMaxLength_mm)};
  }
  add_bull(body, *d / 2, 0);
  body.upper_pieces.push_back(line_piece(*d / 2, 0, *shaft / 2, height));
  body.flute_mm = height;
  body.shank_mm = *shaft;
  return body;
}

Result<Body> make_body(const Form& form, std::span<const std::string_view> texts,
                       const Options& options, LengthUnit unit) {
  const Values values(form, texts, unit);
  if (form.name == "vee") return make_vee(values);
  if (form.name == "drill") return make_drill(values);
  if (form.name == "taper") return make_taper(values, options);
  if (form.name == "lollipop") return make_lollipop(values);
  if (form.name == "tslot") return make_tslot(values);
  if (form.name == "dovetail") return make_dovetail(values);
  return make_round(form.name, values);
}

// ---- assembly ----

/// Adds flutes, shank and holder. Each begins where the one below ends. A shank without a length
/// below a holder counts as none: the holder then begins at the end of the flutes, the cautious
/// reading.
Result<Cutter> assemble(Body body, const Options& options, std::string spec) {
  const double profile_top = body.upper_pieces.empty()
                                 ? (body.pieces.empty() ? 0 : body.pieces.back().z1)
                                 : body.upper_pieces.back().z1;
  const double top = body.flute_mm.value_or(profile_top);
  const std::optional<double> flute = options.flute_mm ? options.flute_mm : body.flute_mm;
  if (flute && *flute < top - kLengthTolerance_mm) {
    return Error{
        trf("flute={} is shorter than the cutting end, {:.4g} mm", number_text(*flute), top)};
  }
  if (!options.holder.empty() && !flute && !options.stickout_mm) {
    return Error{
        tr("holder= needs stickout=L, from the tip to the holder; or flute=L: the holder begins "
           "where flutes and shank end")};
  }
  const bool shank_ends =
      !options.shank.empty() && options.shank.back().sections.front().length_mm > 0;
  const std::vector<ToolSection> shank = sections_of(options.shank, flute.value_or(0));
  const double shank_top = shank.empty() ? flute.value_or(0) : shank.back().to_z_mm;
  if (options.stickout_mm) {
    if (options.holder.empty()) return Error{tr("stickout= needs a holder= above it")};
    if (shank_ends) {
      return Error{tr("stickout=L and shank=DxL both say where the holder begins; write shank=D")};
    }
    if (*options.stickout_mm < std::max(top, flute.value_or(0)) - kLengthTolerance_mm) {
      return Error{trf("stickout={} is shorter than the cutting part, {:.4g} mm",
                       number_text(*options.stickout_mm), std::max(top, flute.value_or(0)))};
    }
    if (*options.stickout_mm < shank_top - kLengthTolerance_mm) {
      return Error{
          trf("stickout={} ends below the shank's last section, which begins {:.4g} mm "
              "above the tip",
              number_text(*options.stickout_mm), shank_top)};
    }
  }
  if (options.shank.size() > 1 && !flute) {
    return Error{tr("shank= of several sections needs flute=L: they begin where the flutes end")};
  }
  if (shank_ends && options.holder.empty()) {
    return Error{tr("shank=DxL needs a holder= above it; without one write shank=D")};
  }
  Result<Cutter> cutter = Cutter::from_profile(std::move(spec), std::move(body.pieces));
  if (!cutter) return cutter;
  if (!body.upper_pieces.empty()) {
    const Done upper = cutter->set_upper_profile(std::move(body.upper_pieces));
    if (!upper) return Error{upper.error()};
  }
  // The head of a cutter with a neck ends where its shape does.
  if (options.flute_mm || (flute && body.shank_mm))
    cutter->set_flute_length_mm(*flute);
  else if (flute)
    cutter->assume_flute_length_mm(*flute);
  if (!shank.empty()) {
    cutter->set_shank_diameter_mm(shank.back().diameter_mm);
    cutter->set_neck({shank.begin(), shank.end() - 1});
  } else if (body.shank_mm) {
    cutter->set_shank_diameter_mm(*body.shank_mm);
  }
  if (options.teeth) cutter->set_teeth(*options.teeth);
  cutter->set_live(options.live);
  std::vector<ToolSection> holder =
      sections_of(options.holder, options.stickout_mm.value_or(shank_top));
  cutter->set_holder(std::move(holder));
  return cutter;
}

/// The options of the file count unless the SHAPE text has its own.
Result<Cutter> make_profile(std::string_view file_name, const Options& options) {
  if (file_name.empty()) return Error{tr("file name FILE is missing; the form is profile:FILE")};
  if (file_name.find('\0') != std::string_view::npos)
    return Error{tr("a file name cannot hold NUL")};
  const std::string path(file_name);
  Result<ProfileFile> file = read_profile_file(path);
  if (!file) return Error{file.error()};
  Options merged = options;
  const auto merge = [&](std::string_view name, const std::optional<std::string>& text,
                         bool given) -> Done {
    if (!text || given) return std::monostate{};
    return parse_option(name, *text, LengthUnit::kMm, merged);  // the file is in mm
  };
  for (const Done& done : {merge("flute", file->flute, options.flute_mm.has_value()),
                           merge("shank", file->shank, !options.shank.empty()),
                           merge("holder", file->holder, !options.holder.empty())}) {
    if (!done) return Error{fmt::format("{}: {}", shown(path), done.error())};
  }
  Body body;
  body.pieces = std::move(file->pieces);
  body.upper_pieces = std::move(file->upper_pieces);
  Result<Cutter> cutter =
      assemble(std::move(body), merged, fmt::format("profile:{}{}", path, options_text(options)));
  if (!cutter) return Error{fmt::format("{}: {}", shown(path), cutter.error())};
  return cutter;
}

/// Splits "name:values:options". A profile's file name may hold colons: only the known options end
/// it.
Result<Cutter> parse_known(const Form& form, std::string_view rest, LengthUnit unit) {
  std::vector<std::string_view> values =
      rest.data() ? shape_fields(rest, kOptionNames) : std::vector<std::string_view>{};
  std::vector<std::string_view> option_texts;
  while (!values.empty()) {
    const std::string_view last = values.back();
    const std::size_t equals = last.find('=');
    if (equals == std::string_view::npos) break;
    // A file name may hold '=' too: there only what names an option is one.
    if (form.name == "profile" && !is_shape_option(last, kOptionNames)) break;
    option_texts.push_back(last);
    values.pop_back();
  }
  Options options;
  for (auto text = option_texts.rbegin(); text != option_texts.rend(); ++text) {
    const std::size_t equals = text->find('=');
    const Done done =
        parse_option(to_lower(text->substr(0, equals)), text->substr(equals + 1), unit, options);
    if (!done) return Error{done.error()};
  }
  if (form.name == "profile") {
    const std::string_view file =
        values.empty()
            ? std::string_view{}
            : rest.substr(0, static_cast<std::size_t>(values.back().data() + values.back().size() -
                                                      rest.data()));
    return make_profile(file, options);
  }
  for (std::size_t i = 0; i < form.required; ++i) {
    if (i >= values.size() || values[i].empty()) {
      return Error{trf("{} is missing; the form is {}", tr(form.parameters[i]), form.text)};
    }
  }
  if (values.size() > form.required + form.optional) {
    return Error{trf("{} values are too many; the form is {}", values.size(), form.text)};
  }
  Result<Body> body = make_body(form, values, options, unit);
  if (!body) return Error{body.error()};
  std::string spec = body->spec + options_text(options);
  return assemble(std::move(*body), options, std::move(spec));
}

}  // namespace

Result<Cutter> parse_shape(std::string_view spec, LengthUnit unit) {
  spec = trim(spec);
  const std::size_t colon = spec.find(':');
  const std::string name = to_lower(spec.substr(0, colon));
  if (name.empty()) {
    return Error{
        tr("the shape is empty; write for example flat:6 (flat, ball, bull, vee, taper, drill, "
           "lollipop, tslot, dovetail, kerf, profile)")};
  }
  const std::string_view rest =
      colon == std::string_view::npos ? std::string_view{} : spec.substr(colon + 1);
  if (is_turning_form(name)) {
    Result<Cutter> cutter = parse_turning_shape(name, rest, unit);
    if (!cutter) return Error{fmt::format("{}: {}", shown(spec), cutter.error())};
    return cutter;
  }
  for (const Form& form : kForms) {
    if (form.name != name) continue;
    Result<Cutter> cutter = parse_known(form, rest, unit);
    if (!cutter) return Error{fmt::format("{}: {}", shown(spec), cutter.error())};
    return cutter;
  }
  return Error{
      trf("{}: unknown shape '{}'{} Shapes: flat, ball, bull, vee, taper, drill, "
          "lollipop, tslot, dovetail, kerf, profile; to turn with: turn, iso, groove, part, "
          "facegroove, thread, bore",
          shown(spec), shown(name), did_you_mean(name, kShapeNames))};
}

std::string shape_in(std::string_view spec, LengthUnit unit) {
  const std::size_t colon = spec.find(':');
  if (unit != LengthUnit::kMm && colon != spec.npos && is_turning_form(spec.substr(0, colon))) {
    return turning_shape_in(spec, unit);
  }
  const auto form = std::find_if(kForms.begin(), kForms.end(), [&](const Form& known) {
    return known.name == spec.substr(0, colon);
  });
  if (unit == LengthUnit::kMm || form == kForms.end() || colon == spec.npos) {
    return std::string(spec);
  }
  const bool is_file = form->name == "profile";
  std::string out(form->name);
  std::size_t index = 0;
  for (const std::string_view field : shape_fields(spec.substr(colon + 1), kOptionNames)) {
    const std::size_t equals = field.find('=');
    out += ':';
    if (is_holder_file(field)) {
      out += field;
    } else if (is_shape_option(field, kOptionNames)) {
      const std::string_view name = field.substr(0, equals), value = field.substr(equals + 1);
      const bool is_length = name != "teeth" && name != "live";
      out += fmt::format("{}={}", name, is_length ? parts_in(value, unit) : std::string(value));
    } else if (is_file || (index < form->parameters.size() &&
                           std::string_view(form->parameters[index]).find("angle") !=
                               std::string_view::npos)) {
      out += field;
    } else {
      out += parts_in(field, unit);
    }
    ++index;
  }
  return out;
}

Result<ToolShapeArgument> parse_tool_argument(std::string_view argument, LengthUnit unit) {
  const std::size_t equals = argument.find('=');
  const std::string_view number = trim(argument.substr(0, equals));
  int tool = 0;
  if (equals == std::string_view::npos || !read_number(number, tool) || tool < 0) {
    return Error{
        trf("{}: not N=SHAPE with a tool number N; write for example 3=ball:6", shown(argument))};
  }
  Result<Cutter> cutter = parse_shape(argument.substr(equals + 1), unit);
  if (!cutter) return Error{trf("tool {}: {}", tool, cutter.error())};
  return ToolShapeArgument{tool, std::move(*cutter)};
}

std::string shape_help(LengthUnit unit) {
  return trf("{}\n{}\n   ({}, degrees)\n", tr(kHelp), turning_shape_help(), name_of(unit));
}

}  // namespace kerf
