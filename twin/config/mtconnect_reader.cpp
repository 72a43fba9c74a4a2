#include "base/translate.h"
#include "base/units.h"
#include "twin/config/config_reader.h"

namespace kerf {
namespace {

ChosenItem read_chosen(const MapItem& item) {
  ChosenItem out;
  item.group.missing("item", tr("the id or the name of a data item"), tr("as /probe has them"));
  out.item = item.group.text("item").value_or("");
  item.group.number("scale", out.scale);
  item.group.number("offset", out.offset);
  return out;
}

void read_item(const MapItem& item, MtconnectSettings& settings) {
  std::optional<ChosenItem>* to = nullptr;
  if (item.position) to = &settings.axes[*item.position];
  if (item.name == "tool") to = &settings.tool;
  if (item.name == "line") to = &settings.line;
  if (item.name == "spindle") to = &settings.spindle;
  if (item.name == "tool_offset_z") to = &settings.tool_offset_z;
  if (item.name == "load") {
    to = &settings.load;
    settings.load_unit = read_load_unit(item.group);
  }
  if (to == nullptr) {
    item.group.faults().at_key(*item.group.node(), trf("no agent tells a {}", item.name),
                               tr("X to W, tool, line, spindle, tool_offset_z and load are chosen "
                                  "here"));
    return;
  }
  *to = read_chosen(item);
}

}  // namespace

void read_mtconnect(const GroupReader& source, const ConfigSourceCommon& common,
                    const MapReading& reading, MtconnectSettings& settings) {
  source.missing("url", tr("the agent's address"), tr("as in http://192.168.1.7:5000"));
  settings.url = source.text("url").value_or("");
  settings.device = source.text("device").value_or("");
  settings.commanded = source.word("position") == 1;
  settings.workpiece = common.frame == CoordinateFrame::kWorkpiece;
  source.number("interval_ms", settings.interval_ms);
  source.number("heartbeat_ms", settings.heartbeat_ms);
  source.number("gather_ms", settings.gather_ms);
  if (common.coordinates == CoordinateKind::kJoints) {
    source.faults().at_value(*source.find("coordinates"),
                             tr("joints is not allowed; must be axes: that is what agents have"));
    return;
  }
  if (reading.inch) {
    source.faults().at_value(*source.find("units"),
                             tr("inch is not allowed; must be mm: /probe says the units"));
  }
  if (settings.heartbeat_ms >= 1000 * common.stale_after_s) {
    ConfigNode* const given = source.find("heartbeat_ms");
    ConfigNode* const other = given != nullptr ? given : source.find("stale_after_ms");
    if (other != nullptr) {
      source.faults().at_value(
          *other, trf("a machine that stands would be stale: heartbeat_ms, {}, must be "
                      "below stale_after_ms, {:g}",
                      settings.heartbeat_ms, 1000 * common.stale_after_s));
    }
  }
  for (const MapItem& item : items_of(source.group("map"), reading)) read_item(item, settings);
  if (!settings.url.empty()) report_faults(validate(settings), source, reading);
}

}  // namespace kerf
