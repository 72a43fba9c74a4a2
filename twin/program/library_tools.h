// twin/program/library_tools.h - of tool libraries what a program asks for, and what is told of it.
#pragma once

#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/program.h"
#include "twin/job/tools.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// Adds the tools of the libraries that have a number, each number once: the first counts. Warns of
/// tools that the program's text names (without a program: of all) and that are not understood,
/// only in part, or described twice; and of libraries with tools that have no number. Tools that
/// `sources.arguments` describe are not told of.
void add_library_tools(const std::vector<ToolLibrary>& libraries, const Program* program,
                       ToolSources& sources, Diagnostics& diagnostics);

/// Warns where the tool table has another diameter than the library for a tool that it describes.
void compare_with_table(const ToolSources& sources, Diagnostics& diagnostics);

}  // namespace kerf
