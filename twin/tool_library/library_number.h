// twin/tool_library/library_number.h - the number that a program calls a tool of a library by.
#pragma once

#include "twin/tool_library/json_fields.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// Of a whole number from 1 to kMaxToolNumber, as a number or as text. One that is there and is
/// none such is the tool's trouble, if it has no other yet; null and 0: it has none.
void take_number(const Json* value, LibraryTool& tool);

}  // namespace kerf
