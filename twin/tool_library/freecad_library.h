// twin/tool_library/freecad_library.h - FreeCAD's tool bits (.fctb) and libraries (.fctl).
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "twin/tool_library/json_fields.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// {"shape": "endmill.fcstd", "parameter": {"Diameter": "5 mm", ..}}
bool is_freecad_bit(const Json& root);
/// {"tools": [{"nr": 1, "path": "5mm_Endmill.fctb"}]}
bool is_freecad_library(const Json& root);

/// One tool. It has no number.
LibraryTool freecad_tool(const Json& bit);

/// Gives the text of a tool bit by the path that a library has for it.
using BitReader = std::function<Result<std::string>(const std::string& path)>;
/// The tools that it lists. A bit that cannot be read, or is none, is a tool with a `trouble`.
std::vector<LibraryTool> freecad_tools(const Json& library, const BitReader& read);

}  // namespace kerf
