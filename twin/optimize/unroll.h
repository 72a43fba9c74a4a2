// twin/optimize/unroll.h - a program with its loops, conditions and subroutines written out, as it
// is run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "twin/optimize/nc_text.h"

namespace kerf {

struct UnrolledText {
  std::string text;
  /// Of each of its lines that of the program; 0: none (a remark).
  std::vector<std::uint32_t> line_before;
  std::size_t passes = 0;  ///< of loops
  std::size_t calls = 0;   ///< of subroutines
};

/// More lines are no program that anybody wants.
inline constexpr std::size_t kMostUnrolledLines = 500'000;

/// Blocks that are run stay byte for byte, but that each value which is worked out is written as a
/// number, and that what is set to parameters is left out. Each pass of a loop and each call has a
/// remark ahead of it that names its line. Error, with the line: what cannot be known from the
/// text (parameters that the machine sets, subroutines in other files, block delete of what
/// decides). Whether it goes the same way is for the interpreter to say.
Result<UnrolledText> unroll(const NcText& text, std::size_t most_lines = kMostUnrolledLines);

}  // namespace kerf
