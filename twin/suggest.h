// twin/suggest.h - "did you mean": the nearest of the allowed words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The allowed word that takes the fewest changed, missing, extra or swapped letters, if these are
/// at most a third of its length (at least 1, so that short words still get an answer); empty if
/// none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& allowed);

}  // namespace kerf
