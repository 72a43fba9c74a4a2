#include "interp_bridge/torch_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/ini_file.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{4} << 20;
constexpr std::size_t kSetupExcerptBytes = 200;
/// No torch pierces from so near, and none from so far: inches that are taken for mm, and the
/// reverse. Handbooks have 1.5 to 10 mm.
constexpr double kNearestPierce_mm = 0.5;
constexpr double kFarthestPierce_mm = 30;

/// Keys of the two files, in one table: `prefs` is that of [DEFAULT MATERIAL].
struct MaterialKey {
  std::string_view key;
  std::string_view prefs;
  double TorchMaterial::*value;
  bool is_length;
  bool mandatory;
};
constexpr std::array<MaterialKey, 12> kMaterialKeys = {{
    {"PIERCE_HEIGHT", "Pierce height", &TorchMaterial::pierce_height_mm, true, true},
    {"PIERCE_DELAY", "Pierce delay", &TorchMaterial::pierce_delay_s, false, true},
    {"CUT_HEIGHT", "Cut height", &TorchMaterial::cut_height_mm, true, true},
    {"CUT_SPEED", "Cut feed rate", &TorchMaterial::feed_mm_per_min, true, true},
    {"KERF_WIDTH", "Kerf width", &TorchMaterial::kerf_width_mm, true, false},
    {"PUDDLE_JUMP_HEIGHT", "Puddle jump height", &TorchMaterial::puddle_jump_height_mm, true,
     false},
    {"PUDDLE_JUMP_DELAY", "Puddle jump delay", &TorchMaterial::puddle_jump_delay_s, false, false},
    {"CUT_AMPS", "Cut amps", &TorchMaterial::cut_amps, false, false},
    {"CUT_VOLTS", "Cut volts", &TorchMaterial::cut_volts, false, false},
    {"PAUSE_AT_END", "Pause at end", &TorchMaterial::pause_at_end_s, false, false},
    {"GAS_PRESSURE", "Gas pressure", &TorchMaterial::gas_pressure, false, false},
    {"CUT_MODE", "Cut mode", &TorchMaterial::cut_mode, false, false},
}};

/// Pins that [PLASMA_PARAMETERS] sets, with what QtPlasmaC puts there first (mm).
struct ParameterPin {
  std::string_view prefs;
  std::string_view pin;
  double value;
  bool is_length;
};
constexpr std::array<ParameterPin, 15> kParameterPins = {{
    {"Float Switch Travel", "plasmac.float-switch-travel", 1.5, true},
    {"Height Per Volt", "plasmac.height-per-volt", 0.1, true},
    {"Ohmic Probe Offset", "plasmac.ohmic-probe-offset", 0, true},
    {"Probe Feed Rate", "plasmac.probe-feed-rate", 300, true},
    {"Probe Start Height", "plasmac.probe-start-height", 25, true},
    {"Safe Height", "plasmac.safe-height", 25, true},
    {"Skip IHS Distance", "plasmac.skip-ihs-distance", 0, true},
    {"Setup Feed Rate", "plasmac.setup-feed-rate", 0, true},
    {"Arc Fail Timeout", "plasmac.arc-fail-delay", 3, false},
    {"Arc Restart Delay", "plasmac.restart-delay", 1, false},
    {"Scribe Arming Delay", "plasmac.scribe-arm-delay", 0, false},
    {"Scribe On Delay", "plasmac.scribe-on-delay", 0, false},
    {"Spotting Threshold", "plasmac.spotting-threshold", 1, false},
    {"Spotting Time", "plasmac.spotting-time", 0, false},
    {"THC Delay", "plasmac.thc-delay", 0.5, false},
}};

/// Its screen or its filter is QtPlasmaC's.
bool is_qtplasmac_ini(const IniFile& ini) {
  const auto& entries = ini.entries();
  return std::any_of(entries.begin(), entries.end(), [](const IniEntry& entry) {
    return (entry.section == "DISPLAY" && entry.key == "DISPLAY" &&
            entry.value.find("qtplasmac") != std::string::npos) ||
           (entry.section == "FILTER" && entry.value.find("qtplasmac_gcode") != std::string::npos);
  });
}

/// A text with lines `[SECTION]` and `KEY = value`, as Python's programs read it.
class KeyLines {
 public:
  KeyLines(std::string_view text, const std::string& path, Diagnostics& diagnostics)
      : text_(text), path_(path), diagnostics_(diagnostics) {}

  /// The next line that is neither blank nor a comment; false at the end.
  bool next() {
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      line_ = text_.substr(0, end);
      text_.remove_prefix(std::min(text_.size(), end + 1));
      ++number_;
      const std::string_view line = trim(line_, is_line_blank);
      if (line.empty() || line.front() == '#' || line.front() == ';') continue;
      is_section_ = line.front() == '[' && line.back() == ']';
      const std::size_t equals = line.find('=');
      key_ = is_section_ ? line.substr(1, line.size() - 2)
                         : trim(line.substr(0, equals), is_line_blank);
      value_ =
          is_section_ || equals == line.npos ? "" : trim(line.substr(equals + 1), is_line_blank);
      return true;
    }
    return false;
  }
  bool is_section() const { return is_section_; }
  std::string_view key() const { return key_; }
  std::string_view value() const { return value_; }

  /// False: it is no number, which has been said.
  bool number(double& out) {
    if (read_material_number(value_, out)) return true;
    const auto at = static_cast<int>(value_.empty() ? line_.size() : value_.data() - line_.data());
    warn(trf("{}: '{}' is not a number", shown(key_), shown(value_)), at + 1);
    return false;
  }
  void warn(std::string message, int column = 0) {
    if (++warnings_ > kMaxWarnings) return;
    Diagnostic diagnostic;
    diagnostic.severity = Severity::kWarning;
    diagnostic.file = path_;
    diagnostic.line = number_;
    diagnostic.column = column;
    diagnostic.message = std::move(message);
    if (column > 0 && line_.size() < kSetupExcerptBytes) diagnostic.excerpt = std::string(line_);
    diagnostics_.push_back(std::move(diagnostic));
  }
  static std::string_view shown(std::string_view text) { return text.substr(0, 60); }

 private:
  static constexpr int kMaxWarnings = 50;
  std::string_view text_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  std::string_view line_, key_, value_;
  bool is_section_ = false;
  int number_ = 0;
  int warnings_ = 0;
};

/// One section of a material file.
class MaterialSection {
 public:
  /// `doubted`: it has been asked already whether the file's unit is the machine's.
  MaterialSection(int number, KeyLines& lines, bool& doubted) : lines_(lines), doubted_(doubted) {
    row_.number = number;
    row_.name.clear();
    for (const MaterialKey& key : kMaterialKeys) row_.*key.value = 0;
  }
  void take(double unit_mm) {
    if (lines_.key() == "NAME")
      row_.name = std::string(lines_.value().substr(0, kSetupExcerptBytes));
    for (std::size_t i = 0; i < kMaterialKeys.size(); ++i) {
      const MaterialKey& key = kMaterialKeys[i];
      if (lines_.key() != key.key) continue;
      has_[i] = true;
      double number = 0;
      if (lines_.value().empty() && !key.mandatory) continue;
      if (!lines_.number(number)) continue;
      row_.*key.value = key.is_length ? number * unit_mm : number;
      if (key.value == &TorchMaterial::pierce_height_mm) doubt_unit(unit_mm);
    }
  }
  void finish(std::vector<TorchMaterial>& rows) {
    for (std::size_t i = 0; i < kMaterialKeys.size(); ++i) {
      if (!kMaterialKeys[i].mandatory || has_[i]) continue;
      lines_.warn(trf("material {} has no {}; 0 is taken", row_.number, kMaterialKeys[i].key));
    }
    if (row_.number == 0) {
      rows[0] = std::move(row_);
    } else if (rows.size() < MaterialTable::kMaxRows / 2) {
      rows.push_back(std::move(row_));
    }
  }

 private:
  /// Once a file.
  void doubt_unit(double unit_mm) {
    const double height_mm = row_.pierce_height_mm;
    const bool is_inch = unit_mm != 1;
    const bool wrong =
        is_inch ? height_mm > kFarthestPierce_mm : height_mm > 0 && height_mm < kNearestPierce_mm;
    if (!wrong || std::exchange(doubted_, true)) return;
    lines_.warn(
        trf("material {} is pierced from {:.3g} mm: this looks like {} in a file that is "
            "read in {}, the unit of the machine ([TRAJ]LINEAR_UNITS of its INI; mm "
            "without one)",
            row_.number, height_mm, is_inch ? "mm" : tr("inches"), is_inch ? tr("inches") : "mm"),
        1);
  }

  KeyLines& lines_;
  bool& doubted_;
  TorchMaterial row_;
  std::array<bool, kMaterialKeys.size()> has_{};
};

bool read_named(const std::string& path, std::string& text, Diagnostics& diagnostics) {
  auto read = read_small_file(path, kMaxFileBytes);
  if (read) {
    text = std::move(*read);
    return true;
  }
  Diagnostic diagnostic;
  diagnostic.message = read.error();
  diagnostics.push_back(std::move(diagnostic));
  return false;
}

bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

void parse_material_file(std::string_view text, const std::string& path, double unit_mm,
                         std::vector<TorchMaterial>& rows, Diagnostics& diagnostics) {
  constexpr std::string_view kSection = "MATERIAL_NUMBER_";
  if (rows.empty()) rows.emplace_back();
  KeyLines lines(text, path, diagnostics);
  bool doubted = false;
  std::vector<MaterialSection> open;  // none, or the one that is being read
  const auto close = [&] {
    if (!open.empty()) open.front().finish(rows);
    open.clear();
  };
  while (lines.next()) {
    if (!lines.is_section()) {
      if (!open.empty()) open.front().take(unit_mm);
      continue;
    }
    close();
    double number = -1;
    const bool named = lines.key().substr(0, kSection.size()) == kSection &&
                       read_material_number(lines.key().substr(kSection.size()), number);
    if (named && number == std::floor(number) && number >= 0 &&
        number < MaterialTable::kFirstTemporary) {
      open.emplace_back(static_cast<int>(number), lines, doubted);
    } else {
      lines.warn(
          fmt::format("[{}] is passed over; a material is [MATERIAL_NUMBER_0] to "
                      "[MATERIAL_NUMBER_999999]",
                      KeyLines::shown(lines.key())));
    }
  }
  close();
}

void parse_plasma_prefs(std::string_view text, const std::string& path, double unit_mm,
                        TorchMaterial& material, std::map<std::string, double>& hal_values,
                        Diagnostics& diagnostics) {
  KeyLines lines(text, path, diagnostics);
  std::string_view section;
  while (lines.next()) {
    if (lines.is_section()) {
      section = lines.key();
      continue;
    }
    double number = 0;
    for (const MaterialKey& key : kMaterialKeys) {
      if (section != "DEFAULT MATERIAL" || lines.key() != key.prefs) continue;
      if (lines.number(number)) material.*key.value = key.is_length ? number * unit_mm : number;
    }
    for (const ParameterPin& pin : kParameterPins) {
      if (section != "PLASMA_PARAMETERS" || lines.key() != pin.prefs) continue;
      if (lines.number(number)) hal_values[std::string(pin.pin)] = number;
    }
  }
}

bool read_torch_sources(const TorchSources& sources, TorchRun& run, Diagnostics& diagnostics) {
  const double unit_mm = mm_of_unit(sources.inch_machine);
  run.inch_machine = sources.inch_machine;
  run.materials.assign(1, TorchMaterial{});
  for (const ParameterPin& pin : kParameterPins) {
    run.hal_values[std::string(pin.pin)] = pin.is_length ? pin.value / unit_mm : pin.value;
  }
  run.hal_values["plasmac.units-per-mm"] = 1 / unit_mm;
  run.hal_values["plasmac.max-offset"] = 5;
  std::string materials_path = sources.materials_path;
  std::string text;
  if (!sources.ini_path.empty()) {
    Diagnostics said_elsewhere;
    auto ini = IniFile::read(sources.ini_path, said_elsewhere);
    if (ini) run.qtplasmac |= is_qtplasmac_ini(*ini);
    const IniEntry* const machine = ini ? ini->find("EMC", "MACHINE") : nullptr;
    if (machine != nullptr && machine->value.find('/') == std::string::npos) {
      const std::filesystem::path folder = std::filesystem::path(sources.ini_path).parent_path();
      const std::string beside = (folder / machine->value).string();
      if (is_there(beside + ".prefs")) {
        if (!read_named(beside + ".prefs", text, diagnostics)) return false;
        parse_plasma_prefs(text, beside + ".prefs", unit_mm, run.materials[0], run.hal_values,
                           diagnostics);
        run.materials_known = text.find("[DEFAULT MATERIAL]") != std::string::npos;
      }
      if (materials_path.empty() && is_there(beside + "_material.cfg")) {
        materials_path = beside + "_material.cfg";
      }
    }
  }
  if (!materials_path.empty()) {
    if (!read_named(materials_path, text, diagnostics)) return false;
    parse_material_file(text, materials_path, unit_mm, run.materials, diagnostics);
    run.materials_known = true;
  }
  for (const auto& [name, value] : sources.hal_values) run.hal_values[name] = value;
  return true;
}

std::string torch_run_text(const TorchRun& run) {
  std::string text;
  const auto out = std::back_inserter(text);
  // In a filtered program the conversion of units is written down already.
  fmt::format_to(out, "convert {}\n", run.qtplasmac && !run.text.is_filtered ? 1 : 0);
  fmt::format_to(out, "qtplasmac {}\n", run.qtplasmac ? 1 : 0);
  for (const auto& [name, value] : run.hal_values) {
    // No other name could be asked for.
    const bool fits = !name.empty() && name.find_first_of(" \t\r\n") == name.npos;
    if (fits && std::isfinite(value)) fmt::format_to(out, "hal {} {}\n", name, value);
  }
  for (const TorchMaterial& row : run.materials) {
    fmt::format_to(out, "material {}", row.number);
    for (const MaterialKey& key : kMaterialKeys) fmt::format_to(out, " {}", row.*key.value);
    text += '\n';
  }
  return text;
}

}  // namespace kerf
