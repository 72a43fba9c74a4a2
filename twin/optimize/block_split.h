// twin/optimize/block_split.h - straight blocks in pieces, where the tool is engaged in different
// ways along them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "twin/optimize/feed_survey.h"
#include "twin/optimize/feed_trace.h"
#include "twin/optimize/nc_text.h"

namespace kerf {

struct SplitText {
  std::string text;
  std::size_t blocks = 0;  ///< that have been divided
  std::size_t pieces = 0;  ///< that have come of them
  /// Of each line of the new text, the line that it was, or was a part of; [0] is line 1.
  std::vector<std::uint32_t> line_before;
};

/// Pieces are at least so long: this part of the tool's diameter, and so many mm.
inline constexpr double kLeastPieceOfDiameter = 0.25, kLeastPiece_mm = 1;
/// Where feeds are wanted that differ by less than this part a block is not divided.
inline constexpr double kLeastStep = 0.25;

/// Divides blocks that are plain lines (NcLine::is_plain_line), make one straight motion, and are
/// run once. Their pieces end on the line, to the last digit written (1e-4 mm, 1e-5 in); the last
/// piece is the block itself with all its text. No feed is changed.
SplitText split_blocks(const NcText& text, std::span<const SurveyedMotion> motions,
                       std::span<const SurveyedPart> parts, const FeedAims& aims);

/// Ends of pieces may be so far beside the way of their block.
inline constexpr double kSplitTolerance_mm = 2e-4;

/// Empty: the program goes the same way as before, but for pieces that are one motion together.
/// Else the line (of the program as it was) and what is different.
std::string way_difference(const FeedTrace& before, const FeedTrace& after, const SplitText& split);

}  // namespace kerf
