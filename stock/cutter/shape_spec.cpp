#include "stock/cutter/shape_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/mill_forms.h"
#include "stock/cutter/profile_file.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_fields.h"
#include "stock/cutter/shape_options.h"
#include "stock/cutter/tool_parts.h"
#include "stock/cutter/turning_shape.h"

namespace kerf {
namespace {

/// Rounding allowance where two lengths that may be equal are compared.
constexpr double kLengthTolerance_mm = 1e-9;

constexpr std::array<std::string_view, 18> kShapeNames = {
    "flat", "ball",    "bull", "vee", "taper",  "drill", "lollipop",   "tslot",  "dovetail",
    "kerf", "profile", "turn", "iso", "groove", "part",  "facegroove", "thread", "bore"};

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
    "                     :live=x|z  of a lathe's driven tool: along which axis it lies\n"
    "                     :helix=DEG:rake=DEG  of its edges, for forces (--material)\n"
    "                     :chip=L:ramp=DEG:centre=no  what its maker allows: feed per tooth, "
    "angle\n"
    "                     of a ramp, no cutting straight down");

/// Adds flutes, shank and holder. Each begins where the one below ends. A shank without a length
/// below a holder counts as none: the holder then begins at the end of the flutes, the cautious
/// reading.
Result<Cutter> assemble(MillBody body, const ShapeOptions& options, std::string spec) {
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
  cutter->set_edge_traits(options.edges);
  std::vector<ToolSection> holder =
      sections_of(options.holder, options.stickout_mm.value_or(shank_top));
  cutter->set_holder(std::move(holder));
  return cutter;
}

/// The options of the file count unless the SHAPE text has its own.
Result<Cutter> make_profile(std::string_view file_name, const ShapeOptions& options) {
  if (file_name.empty()) return Error{tr("file name FILE is missing; the form is profile:FILE")};
  if (file_name.find('\0') != std::string_view::npos)
    return Error{tr("a file name cannot hold NUL")};
  const std::string path(file_name);
  Result<ProfileFile> file = read_profile_file(path);
  if (!file) return Error{file.error()};
  ShapeOptions merged = options;
  const auto merge = [&](std::string_view name, const std::optional<std::string>& text,
                         bool given) -> Done {
    if (!text || given) return std::monostate{};
    return parse_shape_option(name, *text, LengthUnit::kMm, merged);  // the file is in mm
  };
  for (const Done& done : {merge("flute", file->flute, options.flute_mm.has_value()),
                           merge("shank", file->shank, !options.shank.empty()),
                           merge("holder", file->holder, !options.holder.empty())}) {
    if (!done) return Error{fmt::format("{}: {}", shown(path), done.error())};
  }
  MillBody body;
  body.pieces = std::move(file->pieces);
  body.upper_pieces = std::move(file->upper_pieces);
  Result<Cutter> cutter =
      assemble(std::move(body), merged, fmt::format("profile:{}{}", path, options_text(options)));
  if (!cutter) return Error{fmt::format("{}: {}", shown(path), cutter.error())};
  return cutter;
}

/// Splits "name:values:options". A profile's file name may hold colons: only the known options end
/// it.
Result<Cutter> parse_known(const MillForm& form, std::string_view rest, LengthUnit unit) {
  std::vector<std::string_view> values =
      rest.data() ? shape_fields(rest, kShapeOptionNames) : std::vector<std::string_view>{};
  std::vector<std::string_view> option_texts;
  while (!values.empty()) {
    const std::string_view last = values.back();
    const std::size_t equals = last.find('=');
    if (equals == std::string_view::npos) break;
    // A file name may hold '=' too: there only what names an option is one.
    if (form.name == "profile" && !is_shape_option(last, kShapeOptionNames)) break;
    option_texts.push_back(last);
    values.pop_back();
  }
  ShapeOptions options;
  for (auto text = option_texts.rbegin(); text != option_texts.rend(); ++text) {
    const std::size_t equals = text->find('=');
    const Done done = parse_shape_option(to_lower(text->substr(0, equals)),
                                         text->substr(equals + 1), unit, options);
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
  Result<MillBody> body = make_mill_body(form, values, options, unit);
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
  for (const MillForm& form : kMillForms) {
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
  const auto form = std::find_if(kMillForms.begin(), kMillForms.end(), [&](const MillForm& known) {
    return known.name == spec.substr(0, colon);
  });
  if (unit == LengthUnit::kMm || form == kMillForms.end() || colon == spec.npos) {
    return std::string(spec);
  }
  const bool is_file = form->name == "profile";
  std::string out(form->name);
  std::size_t index = 0;
  for (const std::string_view field : shape_fields(spec.substr(colon + 1), kShapeOptionNames)) {
    const std::size_t equals = field.find('=');
    out += ':';
    if (is_holder_file(field)) {
      out += field;
    } else if (is_shape_option(field, kShapeOptionNames)) {
      const std::string_view name = field.substr(0, equals), value = field.substr(equals + 1);
      const bool is_length = is_length_option(name);
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
