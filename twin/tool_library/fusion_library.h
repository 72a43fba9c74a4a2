// twin/tool_library/fusion_library.h - tool libraries of Fusion and HSM (.json, and within .tools).
#pragma once

#include "twin/tool_library/json_fields.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// {"data": [{"type": "flat end mill", "geometry": {"DC": 6, ..}, ..}]}, or the list alone.
bool is_fusion_library(const Json& root);

/// Its tools; holders, which it lists among them, are none.
std::vector<LibraryTool> fusion_tools(const Json& root);

}  // namespace kerf
