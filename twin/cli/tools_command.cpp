#include "twin/cli/tools_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/exit_code.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/holder_library.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_spec.h"
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

// ---- libraries ----

std::string number_of(const LibraryTool& tool) {
  return tool.number ? fmt::format("{}", *tool.number) : "-";
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
    one["trouble"] = tool.trouble.empty() ? Json(nullptr) : Json(tool.trouble);
    one["remarks"] = tool.remarks;
    tools.push_back(std::move(one));
  }
  return {{"path", library.path}, {"format", library.format}, {"tools", std::move(tools)}};
}

void check_combination(const std::string& file, bool holders, bool json, OptionReader& reader) {
  if (holders && !file.empty()) {
    reader.fault("--holders", tr("lists the holders that have a name; it takes no file"));
  }
  if (json && !holders && file.empty()) {
    reader.fault("--json", tr("is for --holders or a tool library"), "kerf tools FILE --json");
  }
}

}  // namespace

int tools_command(const Arguments& arguments) {
  Diagnostics diagnostics;
  OptionReader reader(diagnostics, {arguments.command, &arguments.options, nullptr, {}});
  const std::string file = reader.text("FILE");
  const bool holders = reader.is_yes("--holders"), json = reader.is_yes("--json");
  check_combination(file, holders, json, reader);
  std::vector<ToolLibrary> libraries;
  if (!has_error(diagnostics) && !file.empty()) {
    libraries = read_tool_libraries({file}, diagnostics);
  }
  show_lengths_in(json ? LengthUnit::kMm : reader.unit());
  for (const Diagnostic& d : diagnostics) print_diagnostic(stderr, d);
  if (has_error(diagnostics)) return kExitUsage;
  if (holders) {
    json ? print_json(holders_json()) : list_holders(reader.unit());
  } else if (!libraries.empty()) {
    json ? print_json(library_json(libraries.front()))
         : list_library(libraries.front(), reader.unit());
  } else {
    kerf::print(stdout, "{}\n", shape_help(reader.unit()));
  }
  return kExitGood;
}

}  // namespace kerf
