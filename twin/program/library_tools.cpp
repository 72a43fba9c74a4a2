#include "twin/program/library_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/job/turning_row.h"

namespace kerf {
namespace {

/// Tables are written with a few decimals.
constexpr double kSameDiameter_mm = 0.01;

Diagnostic warning(const std::string& path, std::string message, std::string hint = {}) {
  Diagnostic d;
  d.severity = Severity::kWarning;
  d.file = path;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

bool has_argument(const ToolSources& sources, int tool) {
  return std::any_of(sources.arguments.begin(), sources.arguments.end(),
                     [tool](const ToolShapeArgument& given) { return given.tool == tool; });
}

bool is_known(const ToolSources& sources, int tool) {
  return std::any_of(sources.library.begin(), sources.library.end(),
                     [tool](const LibraryTool& known) { return known.number == tool; });
}

void tell_of(const LibraryTool& tool, Diagnostics& diagnostics) {
  if (!tool.trouble.empty()) {
    diagnostics.push_back(warning(tool.path,
                                  trf("{}: {}; it is left out", title_of(tool), tool.trouble),
                                  trf("--tool {}=SHAPE describes it", *tool.number)));
  }
  for (const std::string& remark : tool.remarks) {
    diagnostics.push_back(warning(tool.path, fmt::format("{}: {}", title_of(tool), remark)));
  }
}

/// Of a taper the tip's diameter may be meant, too.
bool has_diameter(const Cutter& cutter, double mm) {
  if (std::abs(table_diameter_mm(cutter) - mm) <= kSameDiameter_mm) return true;
  const std::vector<std::string_view> fields = split(cutter.spec(), ':');
  const auto tip = fields.size() > 1 ? parse_decimal(fields[1]) : std::nullopt;
  return fields[0] == "taper" && tip && std::abs(*tip - mm) <= kSameDiameter_mm;
}

}  // namespace

void add_library_tools(const std::vector<ToolLibrary>& libraries, const Program* program,
                       ToolSources& sources, Diagnostics& diagnostics) {
  for (const ToolLibrary& library : libraries) {
    unsigned long nameless = 0;
    for (const LibraryTool& tool : library.tools) {
      if (!tool.number) {
        ++nameless;
        continue;
      }
      const bool is_named =
          program == nullptr || program->turning_words().tools.count(*tool.number) != 0;
      const bool is_told = is_named && !has_argument(sources, *tool.number);
      if (is_known(sources, *tool.number)) {
        if (is_told) {
          diagnostics.push_back(
              warning(library.path, trf("{}: another tool has this number already; the first one "
                                        "counts",
                                        title_of(tool))));
        }
        continue;
      }
      if (is_told) tell_of(tool, diagnostics);
      sources.library.push_back(tool);
      if (is_named) sources.named_of_library.insert(*tool.number);
    }
    if (nameless == 0) continue;
    diagnostics.push_back(warning(library.path,
                                  trnf("{} tool has no number, and is left out",
                                       "{} tools have no number, and are "
                                       "left out",
                                       nameless),
                                  trf("kerf tools {} lists them", library.path)));
  }
}

void compare_with_table(const ToolSources& sources, Diagnostics& diagnostics) {
  for (const int number : sources.named_of_library) {
    if (has_argument(sources, number)) continue;
    const auto tool =
        std::find_if(sources.library.begin(), sources.library.end(),
                     [&](const LibraryTool& known) { return known.number == number; });
    const auto row = std::find_if(sources.table.begin(), sources.table.end(),
                                  [&](const ToolTableRow& known) { return known.tool == number; });
    if (tool == sources.library.end() || row == sources.table.end()) continue;
    if (!tool->cutter || !(row->diameter_mm > 0) || has_diameter(*tool->cutter, row->diameter_mm)) {
      continue;
    }
    diagnostics.push_back(warning(
        tool->path,
        trf("{}: the tool table (line {}) says {:.4g} mm, the library {:.4g} "
            "mm; the library counts",
            title_of(*tool), row->line, row->diameter_mm, table_diameter_mm(*tool->cutter))));
  }
}

}  // namespace kerf
