// twin/batch/work_list.h - which programs a batch runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace kerf {

/// A name that ends as those of programs do: .ngc .nc .gcode .gc .tap .cnc .canon, in any case.
bool is_program_name(std::string_view path);

/// The programs that `what` names, in its order, each once. Each of `what` is
///   - a program (is_program_name());
///   - a folder: all programs in it and below it, in the order of their paths; hidden folders and
///     files are passed over;
///   - a pattern, as a shell's, of which programs and folders come;
///   - any other file, or "-" (standard input): a list, one of the above a line. Files in it are
///     programs, whatever their names. Paths are relative to the list's folder. Empty lines, and
///     those that begin with #, say nothing.
/// Faults, all of them, with list and line: what is not there, what holds no program.
std::vector<std::string> programs_of(const std::vector<std::string>& what,
                                     Diagnostics& diagnostics);

}  // namespace kerf
