#include "twin/app/torch_options.h"

#include <fmt/format.h>

#include <utility>

#include "stock/cutter/scan.h"
#include "stock/sheet/sheet.h"
#include "twin/config/turret_reader.h"

namespace kerf {
namespace {

constexpr OptionRange kKerf{Sheet::kMinKerf_mm, 100, false, "mm"};
constexpr OptionRange kPierce{Sheet::kMinKerf_mm, 100, false, "mm"};
constexpr OptionRange kSlats{1, 10000, false, "mm"};
constexpr OptionRange kDensity{1, 30000, false, "kg/m3"};
constexpr double kFarthest = 1e12;

void read_choice(const std::string& text, OptionReader& reader, TorchOptions& torch) {
  if (text == "on") {
    torch.qtplasmac = QtPlasmacChoice::kOn;
  } else if (text == "off") {
    torch.qtplasmac = QtPlasmacChoice::kOff;
  } else if (!text.empty() && text != "auto") {
    reader.fault("--qtplasmac", fmt::format("'{}' is not allowed; must be auto, on or off", text));
  }
}

void read_pin(const std::string& text, OptionReader& reader, TorchOptions& torch) {
  const std::size_t equals = text.find('=');
  const std::string_view name = trim(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || name.empty()) {
    reader.fault("--hal", fmt::format("'{}' is not PIN=VALUE", text));
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

void complete_torch(const LiveConfig& whole, LengthUnit unit, TorchArguments& arguments) {
  const ConfigBeam& config = whole.beam;
  const auto text = [](std::string& given, const std::optional<std::string>& configured) {
    if (given.empty() && configured) given = *configured;
  };
  const auto length = [unit](std::string& given, const std::optional<double>& configured_mm) {
    if (given.empty() && configured_mm) given = fmt::format("{}", from_mm(*configured_mm, unit));
  };
  if (arguments.density.empty() && config.density_kg_per_m3) {
    arguments.density = fmt::format("{}", *config.density_kg_per_m3);
  }
  const bool burns = !arguments.beam.empty() || !arguments.kerf.empty() ||
                     !arguments.pierce.empty() || !arguments.slats.empty();
  if (!burns) text(arguments.turret, whole.turret);
  if (!arguments.turret.empty()) return;
  arguments.beam_is_mm = arguments.beam.empty();
  text(arguments.beam, config.trigger);
  length(arguments.kerf, config.kerf_mm);
  length(arguments.pierce, config.pierce_mm);
  length(arguments.slats, config.slats_mm);
  text(arguments.qtplasmac, config.qtplasmac);
  text(arguments.materials, config.materials);
}

BeamOptions understand_torch(const TorchArguments& a, OptionReader& reader, TorchOptions& torch) {
  BeamOptions beam;
  if (!a.beam.empty()) {
    const Result<BeamTrigger> trigger =
        BeamTrigger::parse(in_mm(a.beam, a.beam_is_mm ? LengthUnit::kMm : reader.unit()));
    if (trigger) {
      beam.trigger = *trigger;
    } else {
      reader.fault("--beam", trigger.error());
    }
  }
  beam.kerf_mm = reader.length_mm("--kerf", a.kerf, kKerf, 0);
  beam.pierce_mm = reader.length_mm("--pierce", a.pierce, kPierce, 0);
  beam.slats_mm = reader.length_mm("--slats", a.slats, kSlats, 0);
  beam.density_kg_per_m3 = reader.number("--density", a.density, kDensity, beam.density_kg_per_m3);
  read_choice(a.qtplasmac, reader, torch);
  torch.materials_path = a.materials;
  for (const std::string& pin : a.hal) read_pin(pin, reader, torch);
  return beam;
}

void check_outline_wishes(const std::optional<Blank>& blank, const OutputPaths& outputs,
                          OptionReader& reader) {
  if (blank && is_sheet(*blank)) return;
  for (const auto& [option, path] :
       {std::pair("--dxf", &outputs.dxf), std::pair("--svg", &outputs.svg)}) {
    if (path->empty()) continue;
    reader.fault(option, "only a sheet has outlines to write",
                 "--stock sheet:x0,y0:x1,y1:THICKNESS cuts from one");
  }
}

TurretPointer understand_turret(const TorchArguments& a, OptionReader& reader,
                                ProgramOptions& program) {
  if (a.turret.empty()) return nullptr;
  const std::pair<const char*, const std::string*> torches[] = {
      {"--beam", &a.beam}, {"--kerf", &a.kerf}, {"--pierce", &a.pierce}, {"--slats", &a.slats}};
  for (const auto& [option, text] : torches) {
    if (!text->empty()) reader.fault(option, "is for torches, lasers and jets; --turret punches");
  }
  TurretPointer turret = read_turret(a.turret, reader.diagnostics());
  if (turret) program.signals = {true, turret->user_codes()};
  return turret;
}

}  // namespace kerf
