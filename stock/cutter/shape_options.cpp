#include "stock/cutter/shape_options.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_limits.h"

namespace kerf {
namespace {

Done parse_teeth(std::string_view value, ShapeOptions& options) {
  int teeth = 0;
  if (!read_number(value, teeth) || teeth < 1 || teeth > kMaxTeeth) {
    return Error{trf("teeth: '{}' is not allowed; must be a whole number from 1 to {}",
                     shown(value), kMaxTeeth)};
  }
  options.teeth = teeth;
  return std::monostate{};
}

Done parse_live(std::string_view value, ShapeOptions& options) {
  if (value != "x" && value != "X" && value != "z" && value != "Z") {
    return Error{
        trf("live: '{}' is not allowed; x and z are: the axis of a lathe along which the "
            "driven tool lies",
            shown(value))};
  }
  options.live = value == "x" || value == "X" ? LiveAxis::kX : LiveAxis::kZ;
  return std::monostate{};
}

struct AngleOption {
  std::string_view name;
  std::optional<double> EdgeTraits::*value;
  double least_deg = 0, most_deg = 0;
};
constexpr std::array kAngles{
    AngleOption{"helix", &EdgeTraits::helix_deg, 0, kMostHelix_deg},
    AngleOption{"rake", &EdgeTraits::rake_deg, -kMostRake_deg, kMostRake_deg},
    AngleOption{"ramp", &EdgeTraits::most_ramp_deg, 0, 90},
};

Done parse_angle(const AngleOption& angle, std::string_view value, EdgeTraits& edges) {
  if (edges.*angle.value) return Error{trf("{}= is given twice", angle.name)};
  const Result<double> degrees =
      parse_within(angle.name, value, angle.least_deg, angle.most_deg, tr("degrees"));
  if (!degrees) return Error{degrees.error()};
  edges.*angle.value = *degrees;
  return std::monostate{};
}

Done parse_centre(std::string_view value, ShapeOptions& options) {
  if (value != "no" && value != "yes") {
    return Error{trf("centre: '{}' is not allowed; no and yes are: whether it cuts at its centre",
                     shown(value))};
  }
  options.centre_said = true;
  options.edges.cuts_centre = value == "yes";
  return std::monostate{};
}

Done take_parts(Result<std::vector<ToolPart>> parsed, std::vector<ToolPart>& out) {
  if (!parsed) return Error{parsed.error()};
  out = std::move(parsed.value());
  return std::monostate{};
}

}  // namespace

Done parse_shape_option(std::string_view name, std::string_view value, LengthUnit unit,
                        ShapeOptions& options) {
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
  for (const AngleOption& angle : kAngles) {
    if (name == angle.name) return parse_angle(angle, value, options.edges);
  }
  if (name == "chip") {
    if (options.edges.most_chip_mm) return Error{tr("chip= is given twice")};
    const Result<double> chip =
        parse_length(tr("feed per tooth"), value, kMinChip_mm, kMaxChip_mm, unit);
    if (!chip) return Error{chip.error()};
    options.edges.most_chip_mm = *chip;
    return std::monostate{};
  }
  if (name == "centre") {
    if (options.centre_said) return Error{tr("centre= is given twice")};
    return parse_centre(value, options);
  }
  return Error{
      trf("unknown option '{}'{} Options: flute=L, shank=D[xL], holder=NAME|DxL[+DxL..], "
          "stickout=L, teeth=N, live=x|z, helix=DEG, rake=DEG, chip=L, ramp=DEG, centre=yes|no",
          shown(name), did_you_mean(name, kShapeOptionNames))};
}

std::string options_text(const ShapeOptions& options) {
  std::string text;
  if (options.flute_mm) text += fmt::format(":flute={}", number_text(*options.flute_mm));
  if (!options.shank.empty()) text += ":shank=" + parts_text(options.shank);
  if (!options.holder.empty()) text += ":holder=" + parts_text(options.holder);
  if (options.stickout_mm) text += fmt::format(":stickout={}", number_text(*options.stickout_mm));
  if (options.teeth) text += fmt::format(":teeth={}", *options.teeth);
  if (options.live) text += *options.live == LiveAxis::kX ? ":live=x" : ":live=z";
  for (const AngleOption& angle : {kAngles[0], kAngles[1]}) {
    if (const auto& value = options.edges.*angle.value)
      text += fmt::format(":{}={}", angle.name, number_text(*value));
  }
  if (options.edges.most_chip_mm)
    text += fmt::format(":chip={}", number_text(*options.edges.most_chip_mm));
  if (options.edges.most_ramp_deg)
    text += fmt::format(":ramp={}", number_text(*options.edges.most_ramp_deg));
  if (options.centre_said) text += options.edges.cuts_centre ? ":centre=yes" : ":centre=no";
  return text;
}

}  // namespace kerf
