// tests/layering/include_rules.h - which file may include what. ARCHITECTURE.md says why.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// One #include of a source: the text between the quotes or angle brackets.
struct IncludeLine {
  int line = 0;  ///< 1-based
  bool quoted = false;
  std::string target;
};
std::vector<IncludeLine> find_includes(std::string_view source_text);

/// Checks the includes of one file. `path` is relative to the root of the project
/// ("stock/zmap/zmap.cpp"); `project_files` are all its headers, in the same form. One message a
/// violation: "path:line: what is wrong".
///
/// - A quoted include names a file of the project by its path from the root.
/// - Level 0 base; level 1 stock, interp_bridge, machine_io, viewer; level 2 twin. A folder
/// includes itself and lower levels. Between 0 and 1 lies surface, for stock, viewer and twin.
/// - The rooms of twin include what their rows say; no two of them each other (find_circles()).
/// - Within viewer: window includes all of it; csg and raycast neither each other nor window; what
///   lies in viewer itself includes none of the three.
/// - Only twin/cli/kerf_machine includes machine_io/simulator, which writes to devices.
/// - Within stock: a model (zmap, ...) includes no other model, cutter includes no model and not
/// their seam.
/// - A header of an outside library appears only in the folder that wraps this library.
/// - A file under tests/FOLDER has the rights of FOLDER (under tests/twin those of all of twin),
/// and may include headers of tests; no other file may. Tests of several folders (bench, fuzz, ...)
/// may include everything.
std::vector<std::string> check_includes(std::string_view path, std::string_view source_text,
                                        const std::set<std::string>& project_files);

/// Pairs of folders whose rules let them include each other, neither within the other.
std::vector<std::string> find_circles();

}  // namespace kerf
