#include "twin/cli/cutting_options.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/turning_shape.h"
#include "twin/config/material_reader.h"

namespace kerf {
namespace {

/// NAME, or FILE:NAME.
std::optional<Material> read_material(const std::string& text, OptionReader& reader) {
  const std::size_t colon = text.rfind(':');
  const std::string name(trim(std::string_view(text).substr(colon + 1)));
  std::optional<std::vector<Material>> rows = known_materials();
  if (colon != std::string::npos)
    rows = read_materials(text.substr(0, colon), reader.diagnostics());
  if (!rows) return std::nullopt;
  const Result<const Material*> found = need_material(*rows, name);
  if (found) return **found;
  reader.fault("--material", found.error(), tr("docs/cutting-forces.md lists them"));
  return std::nullopt;
}

}  // namespace

bool has_tool_limits(const SessionOptions& session) {
  const auto is_limited = [](const Cutter& cutter) {
    const EdgeTraits& traits = cutter.edge_traits();
    if (insert_use_of(cutter).max_feed_mm) return true;
    return traits.most_chip_mm || traits.most_ramp_deg || !traits.cuts_centre;
  };
  for (const ToolShapeArgument& tool : session.tools) {
    if (is_limited(tool.cutter)) return true;
  }
  for (const ToolLibrary& library : session.libraries) {
    for (const LibraryTool& tool : library.tools) {
      if (tool.cutter && is_limited(*tool.cutter)) return true;
    }
  }
  return false;
}

CuttingWish understand_spindle_load(OptionReader& reader) {
  CuttingWish wish;
  const std::string text = reader.text("--material");
  if (!text.empty()) wish.material = read_material(text, reader);
  wish.spindle_power_kw = reader.number("--spindle-power");
  wish.spindle_torque_nm = reader.number("--spindle-torque");
  wish.spindle_current_a = reader.number("--spindle-current");
  if (!text.empty()) return wish;
  for (const char* option : {"--spindle-power", "--spindle-torque", "--spindle-current"}) {
    if (reader.choose(option).from == ValueFrom::kCommandLine)
      reader.fault(option, tr("is held against forces: --material says of what"));
  }
  return wish;
}

CuttingWish understand_cutting(OptionReader& reader) {
  CuttingWish wish;
  const std::string text = reader.text("--material");
  if (!text.empty()) wish.material = read_material(text, reader);
  wish.spindle_power_kw = reader.number("--spindle-power");
  wish.spindle_torque_nm = reader.number("--spindle-torque");
  wish.most_bend_mm = reader.length_mm("--max-deflection");
  wish.wants_climb = reader.is_yes("--climb");
  if (!text.empty()) return wish;
  for (const char* option : {"--spindle-power", "--spindle-torque", "--max-deflection"}) {
    if (reader.choose(option).from == ValueFrom::kCommandLine)
      reader.fault(option, tr("is held against forces: --material says of what"));
  }
  return wish;
}

}  // namespace kerf
