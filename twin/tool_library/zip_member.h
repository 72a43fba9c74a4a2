// twin/tool_library/zip_member.h - the text within a zip file: .tools of Fusion.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"

namespace kerf {

/// Its first member whose name ends in ".json". At most `max_bytes` are unpacked, whatever the file
/// says of its size. Error: without the name of the file.
Result<std::string> json_of_zip(std::string_view bytes, std::size_t max_bytes);

}  // namespace kerf
