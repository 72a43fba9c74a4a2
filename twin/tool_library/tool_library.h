// twin/tool_library/tool_library.h - tools that a CAM program or a shop keeps in a file (--tools).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stock/cutter/cutter.h"

namespace kerf {

/// One tool of a library.
struct LibraryTool {
  std::optional<int> number;     ///< absent: it has none, and nobody can ask for it
  std::string name;              ///< "6 mm Endmill"; may be empty
  std::string kind;              ///< as the library calls it: "flat end mill"; empty: it does not
  std::optional<Cutter> cutter;  ///< absent: `trouble` says why
  std::string trouble;
  std::vector<std::string> remarks;  ///< what its cutter leaves out or takes for granted
  std::string path;                  ///< of the library
};

/// A library as it was understood: tools in the order of the file. Of two with one number the first
/// one counts.
struct ToolLibrary {
  std::string path;    ///< as the user wrote it
  std::string format;  ///< "FreeCAD", "Fusion", "kerf"
  std::vector<LibraryTool> tools;
};

inline constexpr int kMaxToolNumber = 99999;

/// "tool 7 (Thread mill)", "the tool 'Thread mill'", "a tool without a name": what messages call
/// it.
std::string title_of(const LibraryTool& tool);

}  // namespace kerf
