#include "twin/cli/torch_options.h"

#include <fmt/format.h>

#include <utility>

#include "base/translate.h"
#include "stock/cutter/scan.h"
#include "stock/sheet/sheet.h"
#include "twin/config/turret_reader.h"
#include "twin/job/stock_choice.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

constexpr double kFarthest = 1e12;

void read_pin(const std::string& text, OptionReader& reader, TorchOptions& torch) {
  const std::size_t equals = text.find('=');
  const std::string_view name = trim(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || name.empty()) {
    reader.fault("--hal", trf("'{}' is not PIN=VALUE", text));
    return;
  }
  const Result<double> value = parse_within(name, trim(std::string_view(text).substr(equals + 1)),
                                            -kFarthest, kFarthest, "");
  if (value) {
    torch.hal_values[to_lower(name)] = *value;
  } else {
    reader.fault("--hal", value.error());
  }
}

/// A trigger with the levels of its terms z<LEVEL as mm. What is no number stays, for a fault.
std::string in_mm(const std::string& trigger, LengthUnit unit) {
  if (unit == LengthUnit::kMm) return trigger;
  std::string out;
  for (const std::string_view term : split(trigger, '+')) {
    const std::size_t less = term.find('<');
    const auto level =
        less == term.npos ? std::nullopt : parse_decimal(trim(term.substr(less + 1)));
    out += out.empty() ? "" : "+";
    out += level ? fmt::format("{}{}", term.substr(0, less + 1), to_mm(*level, unit))
                 : std::string(term);
  }
  return out;
}

}  // namespace

BeamOptions understand_torch(OptionReader& reader, TorchOptions& torch) {
  BeamOptions beam;
  if (const ChosenValue written = reader.choose("--beam"); written.is_said()) {
    const Result<BeamTrigger> trigger =
        BeamTrigger::parse(in_mm(written.text, reader.unit_of(written)));
    if (trigger) {
      beam.trigger = *trigger;
    } else {
      reader.fault("--beam", trigger.error());
    }
  }
  beam.kerf_mm = reader.length_mm("--kerf");
  beam.pierce_mm = reader.length_mm("--pierce");
  beam.slats_mm = reader.length_mm("--slats");
  beam.density_kg_per_m3 = reader.number("--density", beam.density_kg_per_m3);
  reader.word("--qtplasmac", {QtPlasmacChoice::kAuto, QtPlasmacChoice::kOn, QtPlasmacChoice::kOff},
              torch.qtplasmac);
  torch.materials_path = reader.text("--materials");
  for (const std::string& pin : reader.texts("--hal")) read_pin(pin, reader, torch);
  return beam;
}

void check_outline_wishes(const std::optional<Blank>& blank, const OutputPaths& outputs,
                          OptionReader& reader) {
  // Whether a bar is turned or milled is seen when the program is read.
  if (!blank || is_sheet(*blank) || may_be_turned(*blank)) return;
  for (const auto& [option, path] :
       {std::pair("--dxf", &outputs.dxf), std::pair("--svg", &outputs.svg)}) {
    if (path->empty()) continue;
    reader.fault(option, tr("only a sheet or a turned part has outlines to write"),
                 tr("--stock sheet:x0,y0:x1,y1:THICKNESS cuts from one"));
  }
}

void check_sheet_options(const std::optional<Blank>& blank, const Arguments& written,
                         Diagnostics& diagnostics) {
  if (!blank || is_sheet(*blank)) return;
  const bool is_round =
      std::none_of(blank->bodies.begin(), blank->bodies.end(),
                   [](const BlankBody& body) { return body.kind == BlankBody::Kind::kBox; });
  for (const char* const option : {"--beam", "--kerf", "--pierce", "--slats", "--density"}) {
    if (!written.options.has(option)) continue;
    // What is parted off on a lathe has a weight as well.
    if (is_round && std::string_view(option) == "--density") continue;
    diagnostics.push_back(general_error(
        fmt::format("{}: {}", option, tr("is for sheets, and the blank is none; leave it out")),
        tr("--stock sheet:x0,y0:x1,y1:THICKNESS is one")));
  }
}

TurretPointer understand_turret(OptionReader& reader, ProgramOptions& program) {
  const std::string path = reader.text("--turret");
  if (path.empty()) return nullptr;
  for (const char* const option : {"--beam", "--kerf", "--pierce", "--slats"}) {
    if (reader.choose(option).is_said()) {
      reader.fault(option, tr("is for torches, lasers and jets; --turret punches"));
    }
  }
  TurretPointer turret = read_turret(path, reader.diagnostics());
  if (turret) program.signals = {true, turret->user_codes()};
  return turret;
}

}  // namespace kerf
