// tests/twin/tool_library/library_support.h - libraries from text, and what is said of them.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "twin/config/tool_library_reader.h"

namespace kerf {

struct ReadLibrary {
  Diagnostics diagnostics;
  std::optional<ToolLibrary> library;

  explicit ReadLibrary(std::string_view bytes, const std::string& path = "dir/shop")
      : library(parse_tool_library(bytes, path, diagnostics)) {}

  /// "3:5: message", one a line.
  std::string said() const {
    std::string out;
    for (const Diagnostic& one : diagnostics) {
      if (one.line > 0) out += fmt::format("{}:{}: ", one.line, one.column);
      out += one.message + "\n";
    }
    return out;
  }
};

/// "3: flat:6 | its remark", or "3: -: its trouble", or what is said of the whole.
inline std::string text_of(const LibraryTool& tool) {
  std::string out = tool.number ? fmt::format("{}: ", *tool.number) : "-: ";
  out += tool.cutter ? tool.cutter->spec() : "-: " + tool.trouble;
  for (const std::string& remark : tool.remarks) out += " | " + remark;
  return out;
}
inline std::string text_of(const ReadLibrary& read) {
  if (!read.library) return read.said();
  std::string out;
  for (const LibraryTool& tool : read.library->tools) out += text_of(tool) + "\n";
  return out;
}

}  // namespace kerf
