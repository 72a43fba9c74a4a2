#include <array>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

void read_pins(const GroupReader& source, LogSettings& settings) {
  ConfigNode* const pins = source.find("pins");
  ConfigNode* const file = source.find("pins_file");
  ConfigNode* const channel = source.find("channel");
  if (pins != nullptr && file != nullptr) {
    source.faults().at_key(*file, tr("has no place beside pins; must be one of both"));
  } else if (file != nullptr) {
    int number = 0;
    source.number("channel", number);
    Diagnostics said;
    settings.pins = pins_from_hal_file(*source.path("pins_file"), number, said);
    // Without a diagnostic of its own the empty list would pass for no pins at all.
    if (settings.pins.empty() && !has_error(said)) {
      source.faults().at_value(*file, tr("no pins of a sampler are in this file"));
    }
    if (has_error(said)) file->faulty = true;
    for (Diagnostic& one : said) source.faults().diagnostics().push_back(std::move(one));
  }
  if (pins != nullptr) {
    for (const auto& pin : pins->children) settings.pins.push_back(pin->scalar);
    if (settings.pins.empty()) {
      source.faults().at_value(*pins,
                               tr("an empty list is not allowed; must be the pins of a sampler"));
    }
  }
  if (channel != nullptr && !source.has("pins_file")) {
    source.faults().at_key(*channel, tr("is for pins_file, and there is none"));
  }
}

/// A map of the load alone, by the name of its column, is none of frames.
void read_load_column(const GroupReader& map, LogSettings& settings) {
  if (!map.is_there() || map.node()->children.size() != 1) return;
  ConfigNode* const node = map.node()->child("load");
  if (node == nullptr || node->faulty || node->child("pin") == nullptr) return;
  const GroupReader item(node, map.faults());
  LogLoad& load = settings.load.emplace();
  load.column = item.text("pin").value_or("");
  load.unit = read_load_unit(item);
  item.number("scale", load.scale);
  item.number("offset", load.offset);
  for (const auto& key : node->children) {
    if (key->key == "pin" || key->key == "unit" || key->key == "scale" || key->key == "offset")
      continue;
    map.faults().at_key(*key, tr("has no place beside pin"));
  }
}

void refuse(const GroupReader& source, std::string_view key, const std::string& why) {
  if (ConfigNode* const node = source.find(key)) source.faults().at_key(*node, why);
}

/// Keys that the format has no use for, unless a fault has been found about them already.
void refuse_idle_keys(const GroupReader& source, const LogSettings& settings) {
  const bool is_auto = settings.format == LogFormat::kAuto;
  if (settings.format != LogFormat::kHalsampler) {
    // Of what it is, auto tells only by the file; but halsampler is it with pins alone.
    refuse(source, "period_s", tr("is for halsampler, which needs pins or pins_file"));
  }
  if (settings.format != LogFormat::kCandump) {
    const std::string why =
        is_auto ? tr("is for candump, which needs a map") : tr("is for candump");
    refuse(source, "gather_ms", why);
    refuse(source, "interface", why);
    refuse(source, "dbc", why);
  }
}

}  // namespace

void read_log(const GroupReader& source, const MapReading& reading, LogSettings& settings) {
  source.missing("file", tr("the path of a log, or '-' for standard input"));
  settings.path = source.path("file").value_or("");
  constexpr std::array kFormats{LogFormat::kAuto, LogFormat::kRecording, LogFormat::kCsv,
                                LogFormat::kHalsampler, LogFormat::kCandump};
  if (const int word = source.word("format"); word >= 0) {
    settings.format = kFormats[static_cast<std::size_t>(word)];
  }
  const bool has_pins = source.has("pins") || source.has("pins_file");
  read_load_column(source.group("map"), settings);
  const bool has_map = source.has("map") && !settings.load;
  if (settings.format == LogFormat::kAuto && has_pins) settings.format = LogFormat::kHalsampler;
  if (settings.format == LogFormat::kAuto && has_map) settings.format = LogFormat::kCandump;
  read_pins(source, settings);
  source.number("period_s", settings.period_s);
  if (has_map) read_can_map(source, reading, settings.can_map.emplace());
  settings.can_interface = source.text("interface").value_or("");
  // A map is in mm already.
  if (reading.inch && settings.format != LogFormat::kCandump) settings.unit = LogUnit::kInch;
  refuse_idle_keys(source, settings);
  report_faults(validate(settings), source, reading);
}

}  // namespace kerf
