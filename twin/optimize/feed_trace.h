// twin/optimize/feed_trace.h - the motions of a program as the interpreter gives them: where each
// comes from, its feed, and all else of it as one number.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "base/diagnostic.h"
#include "twin/program/program_front.h"

namespace kerf {

struct TracedMotion {
  /// Of all that it is, bit for bit, but its feed and the line that it comes from.
  std::uint64_t print = 0;
  SourceRef source;
  MotionKind kind = MotionKind::kTraverse;
  double feed_mm_per_min = 0;  ///< of what moves at a feed
  Vec3 from_mm{0}, to_mm{0};
};

/// The same for equal motions.
std::uint64_t print_of(const Motion& motion);

struct FeedTrace {
  std::vector<TracedMotion> motions;
  bool is_whole = false;    ///< the program has been read to its end, without errors
  bool is_listing = false;  ///< it is no NC code
};

/// Reads the program once, without cutting it. 100 bytes a motion. Probing moves run to their
/// ends. Errors, and what else the interpreter has to say, are diagnostics.
FeedTrace read_trace(const SessionOptions& options, std::stop_token stop, Diagnostics& diagnostics);

}  // namespace kerf
