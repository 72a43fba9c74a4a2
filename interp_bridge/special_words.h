// interp_bridge/special_words.h - a quick look for words that have to do with the machine's own
// coordinates or with offsets: most text has none.
#pragma once

#include <cstddef>
#include <string_view>

namespace kerf {

/// False: the line has no G10, G28, G30, G52, G53, G92 and no M6. About 1 ns a byte.
bool may_be_special(std::string_view line);

/// Where in `text`, of any number of lines, may_be_special() has to look: no line that ends before
/// there is special, the one that is there may be. npos: none is. 3 GB/s where moves by G0 to
/// G3 are all that there is.
std::size_t find_special(std::string_view text);

}  // namespace kerf
