// twin/cli/version.h - which kerf this is.
#pragma once

#include <string>

namespace kerf {

/// "0.1.0 (git v0.1.0-5-g1a2b3c4)": the project's version, which reports have, too; in brackets
/// what `git describe` said of the clone when it was built. Without a clone (a source package)
/// there are no brackets.
std::string version_text();

}  // namespace kerf
