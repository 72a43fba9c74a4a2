#include "twin/cli/version.h"

// Written at each build (cmake/kerf_version.cmake), so that a commit compiles this file alone.
#include <kerf_git_version.inc>

namespace kerf {

std::string version_text() {
  const std::string git = KERF_GIT_VERSION;
  return git.empty() ? KERF_VERSION : KERF_VERSION " (git " + git + ")";
}

}  // namespace kerf
