// base/small_file.h - files that fit memory, as a whole.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include "base/result.h"

namespace kerf {

/// The text of a regular file of at most `max_bytes`. Error: "cannot read NAME: REASON"; of a
/// larger one `larger` instead, if it is given.
Result<std::string> read_small_file(const std::string& path, std::size_t max_bytes,
                                    const std::string& larger = {});

/// The first `most` bytes of a stream, or as many as there are. Of a pipe, too. What went wrong is
/// in the state of the stream.
std::string read_up_to(std::istream& in, std::size_t most);

}  // namespace kerf
