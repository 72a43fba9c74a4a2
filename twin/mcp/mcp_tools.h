// twin/mcp/mcp_tools.h - what a client of `kerf mcp` may ask for, and the command line that it
// comes to. Arguments are options of that command, by their names ("tool_table" is --tool-table),
// and those alone that are listed here: none writes, listens, or reads a machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "twin/config/setting_table.h"

namespace kerf {

using McpJson = nlohmann::ordered_json;

struct McpTool {
  std::string_view name;
  const char* purpose;  ///< tr() shows it
  Command command;
  std::string_view required;  ///< "program|compare"
  std::string_view optional;
};

std::span<const McpTool> mcp_tools();
/// The answer to tools/list: what they are for, with the schema of each argument.
McpJson mcp_tool_list();

/// A call that is understood.
struct McpRequest {
  const McpTool* tool = nullptr;
  std::vector<std::string> words;  ///< of kerf, without what it is to write
  std::uint64_t first_line = 0;    ///< of canon: the span of the program
  std::uint64_t last_line = ~0ULL;
};

/// Error: all that is wrong, a line each: unknown arguments, types, texts that lead out of the
/// folder, which is the current one. At values kerf looks itself.
Result<McpRequest> understand_mcp_call(const McpTool& tool, const nlohmann::json& arguments,
                                       const std::filesystem::path& folder);

/// Whether any file that the text may name, as a whole or between two signs that may stand beside
/// a file in a blank, tool or fixture, lies outside of the folder. Links are followed.
bool names_outside(std::string_view text, const std::filesystem::path& folder);

}  // namespace kerf
