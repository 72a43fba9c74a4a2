#include "stock/cutter/mill_forms.h"

#include <fmt/format.h>

#include <cmath>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/units.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_limits.h"

namespace kerf {

ProfilePiece line_piece(double r0, double z0, double r1, double z1) {
  ProfilePiece piece;
  piece.r0 = r0;
  piece.z0 = z0;
  piece.r1 = r1;
  piece.z1 = z1;
  return piece;
}

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

/// Reads parameter `index` of a form.
class Values {
 public:
  Values(const MillForm& form, std::span<const std::string_view> texts, LengthUnit unit)
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

  const MillForm& form_;
  std::span<const std::string_view> texts_;
  LengthUnit unit_;
};

/// Radius of the flat bottom inside a corner arc; a flat that no model can see is none.
double flat_radius(double radius, double corner) {
  return radius - corner < kMinDetail_mm ? 0 : radius - corner;
}

/// Flat bottom, corner arc up to the cylinder.
void add_bull(MillBody& body, double radius, double corner) {
  const double center_r = flat_radius(radius, corner);
  corner = corner > 0 ? radius - center_r : 0;
  if (center_r > 0) body.pieces.push_back(line_piece(0, 0, center_r, 0));
  if (corner > 0) body.pieces.push_back(corner_piece(center_r, corner, radius, corner));
}

/// Flat tip, cone up to `radius`.
void add_cone(MillBody& body, double tip_radius, double radius, double half_angle_deg) {
  if (tip_radius > 0) body.pieces.push_back(line_piece(0, 0, tip_radius, 0));
  const double height = (radius - tip_radius) / portable::tan(half_angle_deg * kRadPerDeg);
  body.pieces.push_back(line_piece(tip_radius, 0, radius, height));
}

Result<MillBody> make_round(std::string_view kind, const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  MillBody body;
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

Result<MillBody> make_vee(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxIncludedAngle_deg);
  if (!angle) return Error{angle.error()};
  MillBody body;
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

Result<MillBody> make_drill(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kFlatDrillAngle_deg);
  if (!angle) return Error{angle.error()};
  MillBody body;
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
Result<MillBody> make_taper(const Values& values, const ShapeOptions& options) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxHalfAngle_deg);
  if (!angle) return Error{angle.error()};
  MillBody body;
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
  const double r = center_r + corner * portable::cos(*angle * kRadPerDeg);
  const double z = corner * (1 - portable::sin(*angle * kRadPerDeg));
  const double top = options.flute_mm.value_or(kTaperHeightPerTip * *d);
  if (top < z + kMinLength_mm) {
    return Error{trf("flute={} ends below the cone, which begins {:.4g} mm above the tip",
                     number_text(top), z)};
  }
  const double top_r = r + (top - z) * portable::tan(*angle * kRadPerDeg);
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

Result<MillBody> make_lollipop(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> shaft = values.below(1, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  MillBody body;
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

Result<MillBody> make_tslot(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> thickness = values.diameter(1, kMinLength_mm, kMaxLength_mm);
  if (!thickness) return Error{thickness.error()};
  const Result<double> shaft = values.below(2, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  MillBody body;
  body.spec =
      fmt::format("tslot:{}:{}:{}", number_text(*d), number_text(*thickness), number_text(*shaft));
  add_bull(body, *d / 2, 0);
  body.upper_pieces.push_back(line_piece(*d / 2, 0, *d / 2, *thickness));
  body.upper_pieces.push_back(line_piece(*d / 2, *thickness, *shaft / 2, *thickness));
  body.flute_mm = *thickness;
  body.shank_mm = *shaft;
  return body;
}

Result<MillBody> make_dovetail(const Values& values) {
  const Result<double> d = values.diameter(0);
  if (!d) return Error{d.error()};
  const Result<double> angle = values.angle(1, kMaxDovetailAngle_deg);
  if (!angle) return Error{angle.error()};
  const Result<double> shaft = values.below(2, *d, kMinDiameter_mm);
  if (!shaft) return Error{shaft.error()};
  MillBody body;
  body.spec =
      fmt::format("dovetail:{}:{}:{}", number_text(*d), number_text(*angle), number_text(*shaft));
  const double height = (*d - *shaft) / 2 * portable::tan(*angle * kRadPerDeg);
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

}  // namespace

Result<MillBody> make_mill_body(const MillForm& form, std::span<const std::string_view> texts,
                                const ShapeOptions& options, LengthUnit unit) {
  const Values values(form, texts, unit);
  if (form.name == "vee") return make_vee(values);
  if (form.name == "drill") return make_drill(values);
  if (form.name == "taper") return make_taper(values, options);
  if (form.name == "lollipop") return make_lollipop(values);
  if (form.name == "tslot") return make_tslot(values);
  if (form.name == "dovetail") return make_dovetail(values);
  return make_round(form.name, values);
}

}  // namespace kerf
