// twin/process/milling/way_spans.h - stretches of a move.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kerf {

/// Shares of the move's way.
struct WaySpan {
  double from = 0, to = 0;
};

/// In order, those that are nearer to each other than `gap` as one.
inline void merge_spans(std::vector<WaySpan>& spans, double gap) {
  std::sort(spans.begin(), spans.end(),
            [](const WaySpan& a, const WaySpan& b) { return a.from < b.from; });
  std::size_t kept = 0;
  for (const WaySpan& span : spans) {
    if (kept > 0 && span.from - spans[kept - 1].to < gap) {
      spans[kept - 1].to = std::max(spans[kept - 1].to, span.to);
    } else {
      spans[kept++] = span;
    }
  }
  spans.resize(kept);
}

/// What of them is between two places.
inline void clip_spans(std::vector<WaySpan>& spans, double from, double to) {
  for (WaySpan& span : spans) {
    span.from = std::clamp(span.from, from, to);
    span.to = std::clamp(span.to, from, to);
  }
  std::erase_if(spans, [](const WaySpan& span) { return span.to <= span.from; });
}

}  // namespace kerf
