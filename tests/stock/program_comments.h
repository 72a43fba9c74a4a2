// tests/stock/program_comments.h - the comments of an NC program with the units in force, for tests
// of the hint readers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stock/cutter/tool_hints.h"

namespace kerf {

/// "(...)" and ";..." comments of a program. The units before the first G20/G21 are that word's.
std::vector<CommentText> comments_of(std::string_view program);

}  // namespace kerf
