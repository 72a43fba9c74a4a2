// twin/batch/called_files.h - which subroutines of other files a program calls, by their names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// Names of files, without ".ngc", that the text may call: `O<name> CALL`, `O100 CALL` and
/// `M98 P100`, also where the subroutine stands in the text itself. In small letters as LinuxCNC
/// takes them, and as they are spelled ([RS274NGC]FEATURES can have that). What a number calculated
/// while it runs calls (`O[#1] CALL`) is not known.
std::vector<std::string> called_names(std::string_view text);

/// Where an INI has LinuxCNC look for subroutines, and which it calls by itself.
struct SubroutinePlaces {
  std::vector<std::string> folders;  ///< SUBROUTINE_PATH, PROGRAM_PREFIX, WIZARD_ROOT
  std::vector<std::string> names;    ///< REMAP=.. ngc=name, ON_ABORT_COMMAND
  /// What it is made of: the INI itself, its includes, and each file that a value names.
  std::vector<std::string> files;
};
/// An INI that cannot be read has nothing but itself.
SubroutinePlaces subroutine_places(const std::string& ini_path);

}  // namespace kerf
