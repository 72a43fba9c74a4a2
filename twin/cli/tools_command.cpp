#include "twin/cli/tools_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/exit_code.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/cutter/holder_library.h"
#include "stock/cutter/insert_shape.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/turning_flanks.h"
#include "twin/cli/console.h"
#include "twin/cli/option_reader.h"
#include "twin/config/tool_library_reader.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

void print_json(const Json& json) {
  kerf::print(stdout, "{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

// ---- holders ----

std::string section_text(const HolderSection& section, LengthUnit unit) {
  std::string text = length_number(section.lower_mm, unit);
  if (section.upper_mm != section.lower_mm) text += '-' + length_number(section.upper_mm, unit);
  return fmt::format("{}x{}", text, length_number(section.length_mm, unit));
}

void list_holders(LengthUnit unit) {
  for (const NamedHolder& holder : named_holders()) {
    kerf::print(stdout, "{:<9} {:<14} {}\n", holder.name, section_text(holder.section, unit),
                tr(holder.source));
  }
  kerf::print(stdout, "{}",
              trf("diameter x length, from the nose up ({}); names may be stacked: er20+bt30\n",
                  name_of(unit)));
}

Json holders_json() {
  Json holders = Json::array();
  for (const NamedHolder& holder : named_holders()) {
    const Json section = {{"lower_mm", holder.section.lower_mm},
                          {"upper_mm", holder.section.upper_mm},
                          {"length_mm", holder.section.length_mm}};
    holders.push_back(
        {{"name", holder.name}, {"sections", Json::array({section})}, {"source", holder.source}});
  }
  return {{"holders", std::move(holders)}};
}

// ---- inserts ----

/// "06 6.35, 09 9.525": size and inscribed circle.
std::string sizes_of(char shape, LengthUnit unit) {
  std::string text;
  for (const IsoSize& size : iso_sizes(shape)) {
    text += fmt::format("{}{:02} {}", text.empty() ? "" : ", ", size.size,
                        length_number(size.circle_mm, unit));
  }
  return text;
}

void list_inserts(LengthUnit unit) {
  for (const IsoShape& shape : iso_shapes()) {
    const std::optional<double> angle = iso_angle_deg(shape.letter);
    kerf::print(stdout, "{}  {:>3}  {:>2}  {}\n", shape.letter,
                shape.corners == 0 ? "-" : number_text(std::round(shape.nose_rad / kRadPerDeg)),
                angle ? number_text(*angle) : "-", sizes_of(shape.letter, unit));
  }
  kerf::print(stdout, "{}",
              trf("shape, corner (degrees), angle of the usual holder, size with its inscribed "
                  "circle ({}); ISO 1832, holders by ISO 5608\n"
                  "--tool N=iso:CNMG120408: shape C, size 12, corner radius 0.8 mm; or in inches "
                  "as ANSI B212.4 has it, CNMG432; round ones also in mm: RCMT10T3M0\n",
                  name_of(unit)));
}

Json inserts_json() {
  Json inserts = Json::array();
  for (const IsoShape& shape : iso_shapes()) {
    const std::optional<double> angle = iso_angle_deg(shape.letter);
    Json sizes = Json::array();
    for (const IsoSize& size : iso_sizes(shape.letter)) {
      sizes.push_back({{"size", fmt::format("{:02}", size.size)}, {"circle_mm", size.circle_mm}});
    }
    inserts.push_back(
        {{"shape", std::string(1, shape.letter)},
         {"corner_deg",
          shape.corners == 0 ? Json(nullptr) : Json(std::round(shape.nose_rad / kRadPerDeg))},
         {"holder_angle_deg", angle ? Json(*angle) : Json(nullptr)},
         {"sizes", std::move(sizes)},
         {"source", "ISO 1832, ISO 5608"}});
  }
  return {{"inserts", std::move(inserts)}};
}

// ---- libraries ----

std::string number_of(const LibraryTool& tool) {
  return tool.number ? fmt::format("{}", *tool.number) : "-";
}

/// As LinuxCNC's tool table would have it.
std::string tip_text(const Cutter& cutter) {
  const InsertTip& tip = cutter.insert_tip();
  std::string text =
      trf("orientation {}, nose radius {:.4g} mm", tip.orientation, tip.nose_radius_mm);
  if (tip.front_deg && tip.back_deg) {
    text += trf(", front angle {:.4g}, back angle {:.4g}", *tip.front_deg, *tip.back_deg);
  }
  return text;
}

void list_library(const ToolLibrary& library, LengthUnit unit) {
  std::size_t width = 1;
  std::size_t understood = 0;
  for (const LibraryTool& tool : library.tools) {
    width = std::max(width, number_of(tool).size());
    understood += tool.cutter ? 1 : 0;
  }
  for (const LibraryTool& tool : library.tools) {
    const std::string shape = tool.cutter ? shape_in(tool.cutter->spec(), unit) : "?";
    kerf::print(stdout, "{:>{}}  {}{}{}\n", number_of(tool), width, shape,
                tool.name.empty() ? "" : "  # ", shown(tool.name));
    std::vector<std::string> notes = tool.remarks;
    if (tool.cutter && tool.cutter->insert()) notes.insert(notes.begin(), tip_text(*tool.cutter));
    if (!tool.trouble.empty()) notes.insert(notes.begin(), trf("left out: {}", tool.trouble));
    if (!tool.number && tool.trouble.empty()) notes.push_back(tr("left out: it has no number"));
    for (const std::string& note : notes) {
      print_lengths(stdout, fmt::format("{:>{}}  {}\n", "", width, note));
    }
  }
  kerf::print(stdout, "{}",
              trf("{}: {}, {} of {} tools understood\n", library.path, library.format, understood,
                  library.tools.size()));
}

Json library_json(const ToolLibrary& library) {
  Json tools = Json::array();
  for (const LibraryTool& tool : library.tools) {
    Json one;
    one["number"] = tool.number ? Json(*tool.number) : Json(nullptr);
    one["name"] = tool.name;
    one["kind"] = tool.kind.empty() ? Json(nullptr) : Json(tool.kind);
    one["shape"] = tool.cutter ? Json(tool.cutter->spec()) : Json(nullptr);
    if (tool.cutter && tool.cutter->teeth()) one["teeth"] = *tool.cutter->teeth();
    if (tool.cutter && tool.cutter->insert()) {
      const InsertTip& tip = tool.cutter->insert_tip();
      one["orientation"] = tip.orientation;
      one["nose_radius_mm"] = tip.nose_radius_mm;
      one["front_deg"] = tip.front_deg ? Json(*tip.front_deg) : Json(nullptr);
      one["back_deg"] = tip.back_deg ? Json(*tip.back_deg) : Json(nullptr);
    }
    one["trouble"] = tool.trouble.empty() ? Json(nullptr) : Json(tool.trouble);
    one["remarks"] = tool.remarks;
    tools.push_back(std::move(one));
  }
  return {{"path", library.path}, {"format", library.format}, {"tools", std::move(tools)}};
}

void check_combination(const std::string& file, bool holders, bool inserts, bool json,
                       OptionReader& reader) {
  if (holders && !file.empty()) {
    reader.fault("--holders", tr("lists the holders that have a name; it takes no file"));
  }
  if (inserts && (holders || !file.empty())) {
    reader.fault("--inserts", tr("lists indexable inserts; it takes no file and no --holders"));
  }
  if (json && !holders && !inserts && file.empty()) {
    reader.fault("--json", tr("is for --holders, --inserts or a tool library"),
                 "kerf tools FILE --json");
  }
}

}  // namespace

int tools_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, {arguments.command, &arguments.options, nullptr, {}});
  const std::string file = reader.text("FILE");
  const bool holders = reader.is_yes("--holders"), inserts = reader.is_yes("--inserts");
  const bool json = reader.is_yes("--json");
  check_combination(file, holders, inserts, json, reader);
  std::vector<ToolLibrary> libraries;
  if (!has_error(diagnostics) && !file.empty()) {
    libraries = read_tool_libraries({file}, diagnostics);
  }
  show_lengths_in(json ? LengthUnit::kMm : reader.unit());
  for (const Diagnostic& d : diagnostics) print_diagnostic(stderr, d);
  if (has_error(diagnostics)) return kExitUsage;
  if (holders) {
    json ? print_json(holders_json()) : list_holders(reader.unit());
  } else if (inserts) {
    json ? print_json(inserts_json()) : list_inserts(reader.unit());
  } else if (!libraries.empty()) {
    json ? print_json(library_json(libraries.front()))
         : list_library(libraries.front(), reader.unit());
  } else {
    kerf::print(stdout, "{}\n", shape_help(reader.unit()));
  }
  return kExitGood;
}

}  // namespace kerf
