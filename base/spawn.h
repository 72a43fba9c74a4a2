// base/spawn.h - another program, begun with nothing to read and a file for what it says.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace kerf {

/// Starts words[0], looked for in PATH, with the others as its arguments: in a process group of its
/// own, so that it can be killed with all it starts; signals do what they do by default, whatever
/// this process ignores. Both its outputs go into the file `said`. -1 and errno: it was not
/// started. The caller waits for it.
pid_t spawn_apart(const std::vector<std::string>& words, const std::string& said);

}  // namespace kerf
