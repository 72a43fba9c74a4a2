// twin/config/tool_library_reader.h - tool libraries from files, whatever wrote them (--tools).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// Reads the file and tells by its contents what it is:
///     a tool bit of FreeCAD (.fctb), its library (.fctl) with the bits that it names, from
///     ../Bit, Bit or its own folder;
///     a library of Fusion or HSM: JSON with `data`, or a zip file with such a one (.tools);
///     YAML of kerf's own:
///         tools:
///           - {number: 3, shape: "flat:6:flute=20:holder=er20:stickout=40", name: 6 mm}
/// Nothing, with diagnostics, where the file as a whole cannot be understood, or a tool of YAML has
/// a fault: then all of them, each at its place. A single tool of another program's file that is
/// not understood is in the library, and says why (LibraryTool::trouble).
std::optional<ToolLibrary> read_tool_library(const std::string& path, Diagnostics& diagnostics);

/// The same from its bytes; any are accepted. `path` is its name in diagnostics; the files that it
/// names are looked for beside it.
std::optional<ToolLibrary> parse_tool_library(std::string_view bytes, const std::string& path,
                                              Diagnostics& diagnostics);

/// The files of --tools. One with a single tool may be N=FILE: that is the tool's number then.
std::vector<ToolLibrary> read_tool_libraries(const std::vector<std::string>& arguments,
                                             Diagnostics& diagnostics);

/// Of a file, and of what a zip file holds.
inline constexpr std::size_t kMaxToolLibrary_bytes = std::size_t{64} << 20U;

}  // namespace kerf
