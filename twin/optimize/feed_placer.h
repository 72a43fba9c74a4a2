// twin/optimize/feed_placer.h - the new text of a program: feeds where the plan wants them, held
// against what the interpreter makes of it.
#pragma once

#include <functional>
#include <string>

#include "base/result.h"
#include "twin/optimize/feed_plan.h"
#include "twin/optimize/feed_trace.h"

namespace kerf {

struct PlacedFeeds {
  std::string text;
  FeedPlan plan;
};

/// Reads a text as it would be read in the program's place.
using TraceText = std::function<Result<FeedTrace>(const std::string& text)>;

/// An F word counts until the next one, and what comes next is decided while the program runs: in
/// loops and subroutines. So the new text is read, and where a move has another feed than it is to
/// have its block gets a word of its own, or, where that cannot be, the words ahead of it are left
/// as they are; until each move has the feed that it is to have, and is the same as before in all
/// else. `before`: of the program as it is. Error: it cannot be read, a motion is another one.
Result<PlacedFeeds> place_feeds(const NcText& text, const FeedBlocks& blocks, const FeedAims& aims,
                                const FeedTrace& before, const TraceText& read);

}  // namespace kerf
