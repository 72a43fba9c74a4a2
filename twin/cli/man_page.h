// twin/cli/man_page.h - the manual page of kerf, from the setting table.
#pragma once

#include <string>

namespace kerf {

/// kerf(1) as troff, for man's macros, in the language in use.
std::string man_page();

}  // namespace kerf
