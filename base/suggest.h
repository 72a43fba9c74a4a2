// base/suggest.h - "did you mean": the nearest of the allowed words.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The allowed word that takes the fewest changed, missing, extra or swapped letters, if these are
/// at most a third of its length (at least 1, so that short words still get an answer); empty if
/// none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& allowed);

/// "; did you mean 'flat'?" for the nearest word, upper and lower case being the same, and "." if
/// none is near: ends a sentence.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> allowed);

}  // namespace kerf
