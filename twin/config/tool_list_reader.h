// twin/config/tool_list_reader.h - kerf's own tool libraries: YAML with a list of tools.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// All faults at once, each at its place, with what is allowed. Nothing if there is one:
///     shop.yaml:4:14: error: tools[1].number: 0 is not allowed; must be 1 to 99999
/// Files of shapes (profile:FILE) are relative to `path`.
std::optional<ToolLibrary> parse_tool_list(std::string_view text, const std::string& path,
                                           Diagnostics& diagnostics);

}  // namespace kerf
