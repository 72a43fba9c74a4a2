#include "stock/cutter/turning_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_fields.h"
#include "stock/cutter/turning_forms.h"
#include "stock/cutter/turning_holder.h"

namespace kerf {
namespace {

/// ISO 5609: f of boring bars by their diameter, 11 mm of 16, 17 of 25.
constexpr double kBarF = 0.68;
/// How far a bar's face is behind the cutting edge.
constexpr double kBehind_mm = 1;

constexpr TurningValue kIsLength = TurningValue::kLength, kIsAngle = TurningValue::kAngle;
constexpr std::array kTurningForms{
    TurningForm{"turn",
                "turn:R:ORIENT:FRONT:BACK[:EDGE]",
                2,
                {{{tr_noop("nose radius R"), kIsLength},
                  {tr_noop("orientation ORIENT")},
                  {tr_noop("front angle FRONT"), kIsAngle},
                  {tr_noop("back angle BACK"), kIsAngle},
                  {tr_noop("edge length EDGE"), kIsLength}}}},
    TurningForm{"iso",
                "iso:CODE[:HAND[:ANGLE]]",
                1,
                {{{tr_noop("designation CODE")},
                  {tr_noop("hand HAND")},
                  {tr_noop("angle of the edge ANGLE"), kIsAngle}}}},
    TurningForm{"groove",
                "groove:W[:R]",
                1,
                {{{tr_noop("blade width W"), kIsLength}, {tr_noop("corner radius R"), kIsLength}}}},
    TurningForm{"part",
                "part:W[:R]",
                1,
                {{{tr_noop("blade width W"), kIsLength}, {tr_noop("corner radius R"), kIsLength}}}},
    TurningForm{"facegroove",
                "facegroove:W[:R]",
                1,
                {{{tr_noop("blade width W"), kIsLength}, {tr_noop("corner radius R"), kIsLength}}}},
    TurningForm{"thread",
                "thread:ANGLE[:PITCH]",
                1,
                {{{tr_noop("thread angle ANGLE"), kIsAngle}, {tr_noop("pitch PITCH"), kIsLength}}}},
    TurningForm{"bore",
                "bore:R:BAR[:LENGTH[:FRONT:BACK]]",
                2,
                {{{tr_noop("nose radius R"), kIsLength},
                  {tr_noop("bar diameter BAR"), kIsLength},
                  {tr_noop("bar length LENGTH"), kIsLength},
                  {tr_noop("front angle FRONT"), kIsAngle},
                  {tr_noop("back angle BACK"), kIsAngle}}}}};

constexpr std::array<std::string_view, 8> kTurningOptions = {"orient", "edge",   "holder", "bar",
                                                             "f",      "max_ap", "max_f",  "path"};
constexpr std::array<std::string_view, 10> kMillOptions = {
    "flute", "shank", "stickout", "teeth", "live", "helix", "rake", "chip", "ramp", "centre"};

constexpr const char* kTurningHelp = tr_noop(
    "turn:R:ORIENT:FRONT:BACK[:EDGE]  turning tool: nose radius, LinuxCNC's orientation and "
    "angles\n"
    "iso:CODE[:HAND[:ANGLE]]  indexable insert, CNMG120408; HAND R, L, N; ANGLE of its edge, 95\n"
    "groove:W[:R]         grooving blade, corners of radius R\n"
    "part:W[:R]           parting blade\n"
    "facegroove:W[:R]     blade for grooves in faces\n"
    "thread:ANGLE[:PITCH]  threading tool: 60, 55, 30, 29; sharp without PITCH\n"
    "bore:R:BAR[:LENGTH[:FRONT:BACK]]  boring bar\n"
    "each of these may add  :orient=N:edge=L:holder=WxL|profile:FILE:bar=DxL:f=L:max_ap=L\n"
    "  :max_f=L:path=tool|contour");

Result<BarSize> parse_bar_size(std::string_view name, std::string_view text, LengthUnit unit) {
  const std::size_t x = text.find_first_of("xX");
  if (x == std::string_view::npos) {
    return Error{
        trf("{}: '{}' is not WIDTHxLENGTH; write for example 20x100, the length from the "
            "tip to its end",
            name, shown(text))};
  }
  const Result<double> width =
      parse_length(trf("{} width", name), text.substr(0, x), kLeastBar_mm, kMostBar_mm, unit);
  if (!width) return Error{width.error()};
  const Result<double> length = parse_length(trf("{} length", name), text.substr(x + 1),
                                             kLeastBar_mm, kMaxInsertReach_mm, unit);
  if (!length) return Error{length.error()};
  return BarSize{*width, *length};
}

template <class Value>
Done take_value(const Result<Value>& parsed, std::optional<Value>& out) {
  if (!parsed) return Error{parsed.error()};
  out = *parsed;
  return std::monostate{};
}

Done parse_turning_option(std::string_view name, std::string_view value, LengthUnit unit,
                          TurningOptions& options) {
  const auto twice = [&] { return Error{trf("{}= is given twice", name)}; };
  if (name == "orient") {
    if (options.orientation) return twice();
    return take_value(parse_orientation("orient", value), options.orientation);
  }
  if (name == "edge") {
    if (options.edge_mm) return twice();
    return take_value(parse_length("edge", value, kLeastEdge_mm, kMostEdge_mm, unit),
                      options.edge_mm);
  }
  if (name == "f") {
    if (options.f_mm) return twice();
    return take_value(parse_length("f", value, 0, kMostBar_mm, unit), options.f_mm);
  }
  if (name == "max_ap") {
    if (options.max_depth_mm) return twice();
    return take_value(parse_length("max_ap", value, kLeastEdge_mm, kMostEdge_mm, unit),
                      options.max_depth_mm);
  }
  if (name == "max_f") {
    if (options.max_feed_mm) return twice();
    return take_value(parse_length("max_f", value, kLeastTurnFeed_mm, kMostTurnFeed_mm, unit),
                      options.max_feed_mm);
  }
  if (name == "path") {
    if (options.goes_its_path) return twice();
    const std::string word = to_lower(trim(value));
    if (word != "tool" && word != "contour") {
      return Error{
          trf("path: '{}' is not allowed; must be tool (CAM has compensated the nose) or contour",
              shown(value))};
    }
    options.goes_its_path = word == "tool";
    return std::monostate{};
  }
  if (name == "bar") {
    if (options.bar) return twice();
    return take_value(parse_bar_size("bar", value, unit), options.bar);
  }
  if (name == "holder") {
    if (options.shank || !options.holder_file.empty()) return twice();
    constexpr std::string_view kFile = "profile:";
    if (to_lower(value.substr(0, kFile.size())) != kFile) {
      return take_value(parse_bar_size("holder", value, unit), options.shank);
    }
    options.holder_file = std::string(value.substr(kFile.size()));
    if (options.holder_file.empty() || options.holder_file.find('\0') != std::string::npos) {
      return Error{tr("holder: the file's name is missing; write holder=profile:FILE")};
    }
    return std::monostate{};
  }
  if (std::find(kMillOptions.begin(), kMillOptions.end(), name) != kMillOptions.end()) {
    return Error{
        trf("{}= is for tools that turn; a turning tool takes orient=N, edge=L, "
            "holder=WxL|profile:FILE, bar=DxL, f=L, max_ap=L, max_f=L, path=tool|contour",
            name)};
  }
  return Error{
      trf("unknown option '{}'{} Options: orient=N, edge=L, holder=WxL|profile:FILE, "
          "bar=DxL, f=L, max_ap=L, max_f=L, path=tool|contour",
          shown(name), did_you_mean(name, kTurningOptions))};
}

std::string turning_options_text(const TurningOptions& options) {
  std::string text;
  const auto size = [](const BarSize& bar) {
    return number_text(bar.width_mm) + "x" + number_text(bar.length_mm);
  };
  if (options.orientation) text += fmt::format(":orient={}", *options.orientation);
  if (options.edge_mm) text += ":edge=" + number_text(*options.edge_mm);
  if (options.shank) text += ":holder=" + size(*options.shank);
  if (!options.holder_file.empty()) text += ":holder=profile:" + options.holder_file;
  if (options.bar) text += ":bar=" + size(*options.bar);
  if (options.f_mm) text += ":f=" + number_text(*options.f_mm);
  if (options.max_depth_mm) text += ":max_ap=" + number_text(*options.max_depth_mm);
  if (options.max_feed_mm) text += ":max_f=" + number_text(*options.max_feed_mm);
  if (options.goes_its_path) text += *options.goes_its_path ? ":path=tool" : ":path=contour";
  return text;
}

Done add_holder(MadeInsert& made, const TurningOptions& options) {
  if (options.bar && (options.shank || !options.holder_file.empty())) {
    return Error{tr("holder= and bar= are two ways to hold it; write one of them")};
  }
  if (options.f_mm && !options.bar && !options.shank) {
    return Error{tr("f= needs a holder=WxL or a bar=DxL")};
  }
  if (!options.holder_file.empty()) {
    Result<std::vector<InsertPart>> parts = read_turning_holder(options.holder_file);
    if (!parts) return Error{parts.error()};
    for (InsertPart& part : *parts) made.outline.parts.push_back(std::move(part));
    return std::monostate{};
  }
  if (options.bar) {
    BoringBar bar;
    bar.diameter_mm = options.bar->width_mm;
    bar.length_mm = options.bar->length_mm;
    bar.f_mm = options.f_mm.value_or(kBarF * bar.diameter_mm);
    // Its face is behind the front flank over the whole of its thickness.
    bar.begin_z_mm = kBehind_mm + made.lean * (bar.f_mm + bar.diameter_mm / 2);
    if (nose_direction(made.tip.orientation).y == 0) {
      return Error{trf("bar= lies along Z beside a tip that points to X: orientation {} does not",
                       made.tip.orientation)};
    }
    const std::optional<InsertPart> part = boring_part(made.tip.orientation, bar);
    if (!part) {
      return Error{trf("the bar of {:g} mm ends before it begins, {:.4g} mm behind the tip",
                       bar.length_mm, bar.begin_z_mm)};
    }
    made.outline.parts.push_back(*part);
  } else if (options.shank) {
    ShankBar shank;
    shank.width_mm = options.shank->width_mm;
    shank.length_mm = options.shank->length_mm;
    shank.f_mm = options.f_mm.value_or(made.shank_f * shank.width_mm);
    const std::optional<InsertPart> part =
        shank_part(made.outline, made.shank_way, made.shank_side, shank);
    if (!part) {
      return Error{trf("holder: {:g} mm end within the insert, which is {:.4g} mm high",
                       shank.length_mm, insert_height_mm(made.outline, made.shank_way))};
    }
    made.outline.parts.push_back(*part);
  }
  if (outline_reach_mm(made.outline) > kMaxInsertReach_mm) return no_turning_outline();
  return std::monostate{};
}

}  // namespace

const TurningForm* turning_form(std::string_view name) {
  for (const TurningForm& form : kTurningForms)
    if (form.name == name) return &form;
  return nullptr;
}

bool is_turning_form(std::string_view name) { return turning_form(name) != nullptr; }

bool is_turning_shape(std::string_view shape) {
  return is_turning_form(shape.substr(0, shape.find(':')));
}

Result<Cutter> parse_turning_shape(std::string_view name, std::string_view rest, LengthUnit unit) {
  const TurningForm& form = *turning_form(name);
  std::vector<std::string_view> values, option_texts;
  const std::vector<std::string_view> fields =
      rest.data() ? shape_fields(rest, kTurningOptions) : std::vector<std::string_view>{};
  for (const std::string_view field : fields) {
    if (field.find('=') != std::string_view::npos) {
      option_texts.push_back(field);
    } else if (option_texts.empty()) {
      values.push_back(field);
    } else {
      return Error{trf("'{}' stands behind the options; the form is {}", shown(field), form.text)};
    }
  }
  TurningOptions options;
  for (const std::string_view text : option_texts) {
    const std::size_t equals = text.find('=');
    const Done done = parse_turning_option(to_lower(trim(text.substr(0, equals))),
                                           text.substr(equals + 1), unit, options);
    if (!done) return Error{done.error()};
  }
  for (std::size_t i = 0; i < form.required; ++i) {
    if (i < values.size() && !trim(values[i]).empty()) continue;
    return Error{trf("{} is missing; the form is {}", tr(form.parameters[i].name), form.text)};
  }
  const auto most = static_cast<std::size_t>(
      std::count_if(form.parameters.begin(), form.parameters.end(),
                    [](const TurningParameter& parameter) { return parameter.name != nullptr; }));
  if (values.size() > most) {
    return Error{trf("{} values are too many; the form is {}", values.size(), form.text)};
  }
  const TurningOptions written = options;
  Result<MadeInsert> made = make_turning_insert(form, values, unit, options);
  if (!made) return Error{made.error()};
  if (const Done held = add_holder(*made, options); !held) return Error{held.error()};
  // What a form has taken as its own value is in its text already.
  TurningOptions kept = written;
  if (form.name == "turn") kept.edge_mm.reset();
  return Cutter::from_insert(made->spec + turning_options_text(kept), std::move(made->outline),
                             made->tip);
}

InsertUse insert_use_of(const Cutter& cutter) {
  InsertUse use;
  if (!is_turning_shape(cutter.spec())) return use;
  // What no form has a value for stands in the text as it was understood.
  for (const std::string_view field : shape_fields(cutter.spec(), kTurningOptions)) {
    constexpr std::string_view kMost = "max_ap=";
    if (field.starts_with(kMost)) use.max_depth_mm = parse_decimal(field.substr(kMost.size()));
    constexpr std::string_view kFeed = "max_f=";
    if (field.starts_with(kFeed)) use.max_feed_mm = parse_decimal(field.substr(kFeed.size()));
    use.goes_its_path = use.goes_its_path || field == "path=tool";
  }
  return use;
}

std::string turning_shape_in(std::string_view spec, LengthUnit unit) {
  const std::size_t colon = spec.find(':');
  const TurningForm& form = *turning_form(spec.substr(0, colon));
  const auto length = [&](std::string_view text) {
    const std::optional<double> mm = parse_decimal(text);
    return mm ? length_number(*mm, unit) : std::string(text);
  };
  std::string out(form.name);
  std::size_t index = 0;
  for (const std::string_view field : shape_fields(spec.substr(colon + 1), kTurningOptions)) {
    out += ':';
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) {
      const bool is_length =
          index < form.parameters.size() && form.parameters[index].kind == kIsLength;
      out += is_length ? length(field) : std::string(field);
      ++index;
      continue;
    }
    const std::string_view name = field.substr(0, equals), value = field.substr(equals + 1);
    const std::size_t x = value.find('x');
    if (name == "orient" || name == "path" || is_holder_file(field)) {
      out += field;
    } else if (x == std::string_view::npos) {
      out += fmt::format("{}={}", name, length(value));
    } else {
      out += fmt::format("{}={}x{}", name, length(value.substr(0, x)), length(value.substr(x + 1)));
    }
  }
  return out;
}

std::string turning_shape_help() { return tr(kTurningHelp); }

}  // namespace kerf
