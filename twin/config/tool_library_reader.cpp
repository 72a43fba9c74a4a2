#include "twin/config/tool_library_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/zip_file.h"
#include "twin/config/live_config.h"
#include "twin/config/tool_list_reader.h"
#include "twin/tool_library/freecad_library.h"
#include "twin/tool_library/fusion_library.h"
#include "twin/tool_library/zip_member.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBit_bytes = std::size_t{1} << 20U;

Diagnostic about(const std::string& path, std::string message, std::string hint = {}) {
  Diagnostic d;
  d.file = path;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

std::string what_is_read() {
  return tr(
      "read are FreeCAD's .fctb and .fctl, Fusion's .json and .tools, and YAML with a list "
      "tools:");
}

/// As FreeCAD has its folders: Library beside Bit.
Result<std::string> read_bit(const fs::path& library, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path folder = library.parent_path(), bit(name);
  std::vector<fs::path> places{folder / bit};
  if (bit.is_relative()) {
    for (const char* const beside : {"../Bit", "Bit", "."}) {
      places.push_back(folder / beside / bit);
      places.push_back(folder / beside / bit.filename());
    }
  }
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (fs::exists(place, ignored)) return read_small_file(place.string(), kMaxBit_bytes);
  }
  return Error{
      trf("its tool bit {} is neither in ../Bit nor in Bit nor beside the library", shown(name))};
}

/// LinuxCNC's: "T1 P1 D6.0 ;6 mm".
bool is_tool_table(std::string_view text) {
  while (!text.empty()) {
    const std::vector<std::string_view> words = words_of(take_line(text));
    if (words.empty() || words[0].front() == ';') continue;
    const std::string_view first = words[0];
    return first.size() > 1 && to_lower(first[0]) == 't' && is_digit(first[1]);
  }
  return false;
}

std::optional<ToolLibrary> of_json(std::string_view text, const std::string& path,
                                   Diagnostics& diagnostics) {
  const std::optional<Json> root = parse_json(text, path, diagnostics);
  if (!root) return std::nullopt;
  ToolLibrary library{path, "", {}};
  if (is_freecad_library(*root)) {
    library.format = "FreeCAD";
    library.tools = freecad_tools(
        *root, [&path](const std::string& bit) { return read_bit(fs::path(path), bit); });
  } else if (is_freecad_bit(*root)) {
    library.format = "FreeCAD";
    library.tools.push_back(freecad_tool(*root));
  } else if (is_fusion_library(*root)) {
    library.format = "Fusion";
    library.tools = fusion_tools(*root);
  } else {
    diagnostics.push_back(about(path, tr("is JSON, but no tool library"), what_is_read()));
    return std::nullopt;
  }
  for (LibraryTool& tool : library.tools) tool.path = path;
  return library;
}

std::optional<ToolLibrary> of_zip(std::string_view bytes, const std::string& path,
                                  Diagnostics& diagnostics) {
  const Result<std::string> json = json_of_zip(bytes, kMaxToolLibrary_bytes);
  if (json) return of_json(*json, path, diagnostics);
  diagnostics.push_back(about(path, json.error(), what_is_read()));
  return std::nullopt;
}

/// JSON may be ours as well: it is YAML.
bool is_own_json(std::string_view text) {
  const Json root = Json::parse(text, nullptr, false);
  const Json* const tools = root.is_discarded() ? nullptr : member(root, "tools");
  return tools != nullptr && tools->is_array() && !is_freecad_library(root);
}

}  // namespace

std::optional<ToolLibrary> parse_tool_library(std::string_view bytes, const std::string& path,
                                              Diagnostics& diagnostics) {
  if (is_zip(bytes)) return of_zip(bytes, path, diagnostics);
  take_prefix(bytes, "\xEF\xBB\xBF");
  const std::string_view text = trim(bytes);
  const auto refuse = [&](std::string message, std::string hint) {
    diagnostics.push_back(about(path, std::move(message), std::move(hint)));
    return std::nullopt;
  };
  if (text.empty()) return refuse(tr("is empty"), what_is_read());
  if (text.front() == '<') return refuse(tr("is XML, which is not read"), what_is_read());
  if (is_tool_table(text)) {
    return refuse(tr("is a tool table of LinuxCNC, not a tool library"),
                  tr("--tool-table FILE gives it"));
  }
  const bool is_json = text.front() == '{' || text.front() == '[';
  if (is_json && !is_own_json(bytes)) return of_json(bytes, path, diagnostics);
  if (!contains(text, "tools")) return refuse(tr("is no tool library"), what_is_read());
  if (bytes.size() > kMaxConfig_bytes) {
    return refuse(trf("larger than {} bytes, which no list of tools is", kMaxConfig_bytes),
                  what_is_read());
  }
  return parse_tool_list(bytes, path, diagnostics);
}

std::optional<ToolLibrary> read_tool_library(const std::string& path, Diagnostics& diagnostics) {
  const Result<std::string> bytes = read_small_file(path, kMaxToolLibrary_bytes);
  if (bytes) return parse_tool_library(*bytes, path, diagnostics);
  diagnostics.push_back(about("", bytes.error()));
  return std::nullopt;
}

std::vector<ToolLibrary> read_tool_libraries(const std::vector<std::string>& arguments,
                                             Diagnostics& diagnostics) {
  std::vector<ToolLibrary> libraries;
  for (const std::string& argument : arguments) {
    const std::size_t equals = argument.find('=');
    int number = 0;
    std::error_code ignored;
    const bool has_number = equals != argument.npos && !fs::exists(argument, ignored) &&
                            read_number(std::string_view(argument).substr(0, equals), number);
    std::optional<ToolLibrary> library =
        read_tool_library(has_number ? argument.substr(equals + 1) : argument, diagnostics);
    if (!library) continue;
    if (has_number && (number < 1 || number > kMaxToolNumber)) {
      diagnostics.push_back(about("", trf("--tools {}: {} is not allowed; tool numbers are 1 to {}",
                                          shown(argument), number, kMaxToolNumber)));
    } else if (has_number && library->tools.size() != 1) {
      diagnostics.push_back(about(
          library->path,
          trf("holds {} tools; N=FILE is for a file with a single one", library->tools.size())));
    } else if (has_number) {
      library->tools.front().number = number;
    }
    libraries.push_back(std::move(*library));
  }
  return libraries;
}

}  // namespace kerf
