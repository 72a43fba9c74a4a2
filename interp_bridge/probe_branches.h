// interp_bridge/probe_branches.h - whether a program asks what a probe has met before it goes on.
#pragma once

#include <string>

namespace kerf {

/// The text has an O-word if, elseif, while or repeat with #5061 to #5069 in it, or with a
/// parameter that is worked out from them anywhere in the text; #5070, whether it has met anything,
/// does not count. More is taken for such a branch than is one: names are followed, not values, and
/// what a call is given may be any numbered parameter. Time as that of reading the text.
bool branches_on_probe(const std::string& text);
/// The same of a file; true where it cannot be read.
bool file_branches_on_probe(const std::string& path);

}  // namespace kerf
