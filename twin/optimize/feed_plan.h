// twin/optimize/feed_plan.h - which feed each block of a program gets, and which words of its text
// say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "twin/optimize/feed_survey.h"
#include "twin/optimize/nc_text.h"

namespace kerf {

/// Why the feed of a block is left as it is.
enum class FeedLeft : std::uint8_t {
  kNone,
  kInverseTime,  ///< G93
  kPerTurn,      ///< G95
  kSynchronous,  ///< threads, tapping
  kProbe,
  kComputed,    ///< F#<f>, F[..]
  kMissing,     ///< no feed is in force
  kUnmeasured,  ///< how the tool is engaged is not known
  kOtherFile,   ///< a subroutine in a file of its own
  kTangled,     ///< other blocks, which stay, would run at its feed
};
inline constexpr std::size_t kFeedLeftCount = 10;
/// "inverse-time": the key of reports.
const char* key_of(FeedLeft reason);

/// A line of the program with all motions that come of it.
struct FeedBlock {
  std::size_t motions = 0;
  double least_feed = std::numeric_limits<double>::infinity(), most_feed = 0;  ///< mm/min, as it is
  /// What may be: of the slowest motion, and of the one that could be fastest.
  double least_limit = std::numeric_limits<double>::infinity(), most_limit = 0;
  double allowed = std::numeric_limits<double>::infinity();
  bool is_engaged = false;
  FeedLeft left = FeedLeft::kNone;
};

/// Of the program itself; `elsewhere`: motions in other files.
struct FeedBlocks {
  std::map<std::uint32_t, FeedBlock> by_line;
  std::size_t elsewhere = 0;
};
FeedBlocks feed_blocks(const NcText& text, std::span<const SurveyedMotion> motions);

/// More a block must not have, mm/min; infinity: nothing says it.
double most_feed(const FeedBlock& block, const FeedAims& aims);

/// The first block of a program, as it is now, that is faster than it may be, of those that are not
/// left as they are; line 0: there is none.
struct ExceededFeed {
  std::uint32_t line = 0;
  double feed_mm_per_min = 0, most_mm_per_min = 0;
};
ExceededFeed exceeded_feed(const FeedBlocks& blocks, const FeedAims& aims,
                           const std::map<std::uint32_t, FeedLeft>& left);

/// What reading the new text has taught.
struct FeedLessons {
  std::set<std::uint32_t> said;    ///< lines that need an F word of their own
  std::set<std::uint32_t> frozen;  ///< lines whose F words stay
  std::set<std::uint32_t> turned;  ///< lines in the other unit than the text's order has it
};

struct FeedPlan {
  std::map<std::uint32_t, NcEdit> edits;
  /// Of lines with feed moves: mm/min; nothing: each motion as it was.
  std::map<std::uint32_t, std::optional<double>> feeds;
  std::map<std::uint32_t, FeedLeft> left;
  std::size_t changed = 0;  ///< blocks that run at another feed
};

/// Changes of less than this part are left out where they are no must.
inline constexpr double kLeastChange = 0.1;

/// By the order of the text. Blocks without a limit keep their feeds; those that may be faster get
/// what they may, if that is kLeastChange more; those that are too fast what they may. A block
/// that may go on at the feed ahead of it, as it is now, gets no word.
FeedPlan plan_feeds(const NcText& text, const FeedBlocks& blocks, const FeedAims& aims,
                    const FeedLessons& lessons);

}  // namespace kerf
