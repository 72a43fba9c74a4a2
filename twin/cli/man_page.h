// twin/cli/man_page.h - the manual pages of kerf, from the setting table.
#pragma once

#include <string>

#include "twin/config/setting_table.h"

namespace kerf {

/// kerf(1) as troff, for man's macros, in the language in use: its commands, and what holds for all
/// of them: the configuration, exit codes.
std::string man_page();
/// "kerf-run".
std::string name_of_page(const CommandRow& command);
/// kerf-COMMAND(1): its options and examples.
std::string man_page_of(const CommandRow& command);

}  // namespace kerf
