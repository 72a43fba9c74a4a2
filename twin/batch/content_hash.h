// twin/batch/content_hash.h - whether a program has been run as it would be now.
#pragma once

#include <string>
#include <vector>

namespace kerf {

/// 128 bits, as 32 hexadecimal digits, of all that a run depends on and that can be known before
/// it:
///   - `kerf` itself (the contents of the executable), and `words` as they are;
///   - the program, and the subroutines that it and they call by name (called_files.h): in its
///     folder, where kerf is started, and where an INI among the files below has them looked for;
///   - each file that a word of `words` names, as its value or behind the last of its ':' and '=':
///     configuration, INI, tool table, saved workpiece, mesh;
///   - each file that a line of a configuration or an INI among them names: tool tables,
///     parameters, an INI and what that names, what it includes, what its remaps call.
/// A file that cannot be read counts as missing. Costs a reading of those files; the executable is
/// read once a process.
std::string content_hash(const std::string& program, const std::vector<std::string>& words);

}  // namespace kerf
