#include "twin/mcp/mcp_tools.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <system_error>
#include <utility>

#include "base/suggest.h"
#include "base/translate.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMostText_bytes = 4096, kMostPieces = 128, kMostItems = 200;
/// A picture becomes text in a message.
constexpr unsigned kMostPixels = 2000;

#define KERF_OF_PART                                                                     \
  "stock|model|cell|tool|tools|tool_table|ini|work_offset|fixture|clearance|below|"      \
  "as_mill|chuck|tailstock|spindle_max|kerf|beam|pierce|turret|materials|path|material|" \
  "block_delete|additive|no_guess"
#define KERF_OF_CHECKS "|from_line|until_line|engagement|max_deflection|climb|spindle_power"

constexpr std::array kMcpTools{
    McpTool{"run",
            tr_noop("Dry-run an NC program: cut it out of a model of the blank. Tells times, what "
                    "each tool removes, which blank and tools were taken, how many findings."),
            kRun, "program", KERF_OF_PART KERF_OF_CHECKS},
    McpTool{"findings",
            tr_noop("Dry-run an NC program and list what would go wrong at the machine: rapids "
                    "into the part, holders in the way; each with its line, place and depth."),
            kRun, "program", KERF_OF_PART KERF_OF_CHECKS},
    McpTool{"canon",
            tr_noop("What an NC program commands, as LinuxCNC's interpreter has it: the first 200 "
                    "motions of a span of its lines, with times; mm, mm/min, s, degrees."),
            kCanon, "program", "ini|tool_table|work_offset|block_delete|first_line|last_line"},
    McpTool{"picture",
            tr_noop("Dry-run an NC program and see the part, at the end or at a line, as PNG."),
            kView, "program", KERF_OF_PART "|until_line|at_line|view|color|color_on|section|size"},
    McpTool{"compare",
            tr_noop("Dry-run an NC program and hold the part against its design: what is gone too "
                    "far (gouge), what is left over (excess), and where."),
            kRun, "program|compare",
            KERF_OF_PART "|until_line|tolerance|compare_at|compare_unit|compare_fit|rest"},
};

/// Of canon, and no option.
constexpr Setting kSpan{.type = KeyType::kWhole,
                        .help = tr_noop("of the span of lines whose motions are shown")};

std::string option_of(std::string_view argument) {
  if (argument == "program") return "PROGRAM";
  std::string option = "--" + std::string(argument);
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

const Setting& row_of(const std::string& argument, const McpTool& tool) {
  const bool is_span = argument == "first_line" || argument == "last_line";
  return is_span ? kSpan : setting_of(option_of(argument), tool.command);
}

/// Several programs are several calls.
bool is_list(const Setting& row) { return row.repeatable && !row.is_positional(); }

const char* type_of(const Setting& row) {
  if (row.type == KeyType::kNumber) return "number";
  if (row.type == KeyType::kWhole) return "integer";
  return row.type == KeyType::kYesNo ? "boolean" : "string";
}

McpJson schema_of(const Setting& row) {
  McpJson schema = {{"type", type_of(row)}};
  if (row.type == KeyType::kWord) schema["enum"] = parts_of(row.words);
  if (is_list(row)) schema = {{"type", "array"}, {"items", schema}};
  std::string help =
      row.is_positional() ? tr("NC file, or a saved canonical listing (.canon)") : help_of(row);
  if (*row.unit != 0) help += std::string(" [") + row.unit + "]";
  if (row.option == "--tool") help += "\n" + shape_help();
  schema["description"] = std::move(help);
  return schema;
}

/// Takes one value into the request; what is wrong with it, or nothing. Kerf looks at the rest.
std::string read_value(const std::string& name, const Json& value, const fs::path& folder,
                       McpRequest& request) {
  const Setting& row = row_of(name, *request.tool);
  const bool is_flag = row.type == KeyType::kYesNo, is_span = &row == &kSpan;
  if (value.is_structured() || value.is_null() || value.is_boolean() != is_flag ||
      (is_span && !value.is_number_unsigned()) || (row.is_positional() && !value.is_string())) {
    return trf("{} is not allowed; must be of type {}", value.dump().substr(0, 40), type_of(row));
  }
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  const auto is_sign = [](unsigned char c) { return c < ' ' || c == 127; };
  if (text.empty()) return tr("must not be empty");
  if (std::any_of(text.begin(), text.end(), is_sign)) return tr("must have no control characters");
  unsigned width = 0, height = 0;
  if (name == "size" && std::sscanf(text.c_str(), "%ux%u", &width, &height) == 2 &&
      std::max(width, height) > kMostPixels) {
    return trf("must be at most {0}x{0}", kMostPixels);
  }
  if (names_outside(text, folder)) {
    return trf("'{}' leads out of {}; kerf mcp --folder says what may be read", text,
               folder.string());
  }
  if (is_span) {
    (name == "first_line" ? request.first_line : request.last_line) = value.get<std::uint64_t>();
  } else if (row.is_positional()) {
    request.words.push_back(text.front() == '-' ? "./" + text : text);  // a file in any case
  } else if (!is_flag || value.get<bool>()) {
    request.words.push_back(option_of(name) + (is_flag ? "" : "=" + text));
  }
  return {};
}

}  // namespace

std::span<const McpTool> mcp_tools() { return kMcpTools; }

McpJson mcp_tool_list() {
  McpJson tools = McpJson::array();
  for (const McpTool& tool : kMcpTools) {
    McpJson schema = {{"type", "object"},
                      {"properties", McpJson::object()},
                      {"required", parts_of(tool.required)},
                      {"additionalProperties", false}};
    for (const std::string_view names : {tool.required, tool.optional}) {
      for (const std::string& name : parts_of(names)) {
        schema["properties"][name] = schema_of(row_of(name, tool));
      }
    }
    tools.push_back({{"name", tool.name},
                     {"description", tr(tool.purpose)},
                     {"inputSchema", std::move(schema)},
                     {"annotations", {{"readOnlyHint", true}, {"openWorldHint", false}}}});
  }
  return {{"tools", std::move(tools)}};
}

bool names_outside(std::string_view text, const fs::path& folder) {
  constexpr std::string_view kBesideFiles = ":=+, ";
  std::vector<std::size_t> begins{0};
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (kBesideFiles.find(text[at]) != kBesideFiles.npos) begins.push_back(at + 1);
  }
  begins.push_back(text.size() + 1);
  if (text.size() > kMostText_bytes || begins.size() > kMostPieces) return true;
  for (auto begin = begins.begin(); begin != begins.end(); ++begin) {
    for (auto end = begin + 1; end < begins.end(); ++end) {
      const std::string_view part = text.substr(*begin, *end - 1 - *begin);
      std::error_code failed;
      // Most are no files at all.
      const bool is_word = part != ".." && part.find('/') == part.npos;
      if (is_word && !fs::exists(fs::symlink_status(folder / part, failed))) continue;
      const fs::path path = fs::weakly_canonical(folder / part, failed);
      if (failed == std::errc::filename_too_long) continue;  // nobody can open that
      const auto met = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
      if (failed || met.first != folder.end()) return true;
    }
  }
  return false;
}

Result<McpRequest> understand_mcp_call(const McpTool& tool, const Json& arguments,
                                       const fs::path& folder) {
  McpRequest request{.tool = &tool,
                     .words = {name_of(tool.command), "--quiet", "--interp-cache=off"}};
  std::string faults;
  const auto fault = [&](const std::string& name, const std::string& message) {
    if (!message.empty()) faults += name + ": " + message + "\n";
  };
  std::vector<std::string> known = parts_of(tool.required);
  for (const std::string& name : known) {
    if (!arguments.contains(name)) fault(name, tr("is required"));
  }
  for (std::string& name : parts_of(tool.optional)) known.push_back(std::move(name));
  for (const auto& item : arguments.items()) {
    const std::string& name = item.key();
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_word(name, known);
      const std::string guess = near.empty() ? "" : trf("; did you mean {}?", near);
      fault(name, trf("{} has no such argument", tool.name) + guess);
      continue;
    }
    const bool has_list = is_list(row_of(name, tool));
    const Json values = has_list ? item.value() : Json::array({item.value()});
    if (!values.is_array() || values.size() > kMostItems) {
      fault(name, trf("must be a list of at most {} texts", kMostItems));
      continue;
    }
    for (const Json& value : values) fault(name, read_value(name, value, folder, request));
  }
  if (!faults.empty()) return Error{std::move(faults)};
  return request;
}

}  // namespace kerf
