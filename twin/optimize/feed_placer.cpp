#include "twin/optimize/feed_placer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/translate.h"
#include "base/units.h"

namespace kerf {
namespace {

/// Readings at most. Each but the last settles what others have brought up.
constexpr int kMostReadings = 40;
constexpr double kSameFeed = 1e-9;

bool is_same_feed(double a, double b) { return std::abs(a - b) <= kSameFeed * std::max(a, b); }

/// What a motion of the program itself is to have.
double feed_wanted(const TracedMotion& was, const FeedPlan& plan) {
  // A cycle has traverses, too.
  if (was.source.file != 0 || was.feed_mm_per_min <= 0) return was.feed_mm_per_min;
  const auto found = plan.feeds.find(was.source.line);
  if (found == plan.feeds.end()) return was.feed_mm_per_min;
  return found->second.value_or(was.feed_mm_per_min);
}

class Lessons {
 public:
  Lessons(const FeedBlocks& blocks, const FeedPlan& plan, FeedLessons& lessons)
      : blocks_(blocks), plan_(plan), lessons_(lessons) {}

  /// Once a line and reading. A motion has another feed than it is to have; `last_said`: the line
  /// ahead of it, in the order of the run, that has been changed.
  void learn(const TracedMotion& was, double wanted, double found, std::uint32_t last_said) {
    const std::uint32_t line = was.source.line;
    if (!learned_.emplace(was.source.file, line).second) return;
    const bool is_ours = was.source.file == 0 && blocks_.by_line.contains(line);
    const bool has_word = plan_.edits.contains(line);
    if (is_ours && has_word && !lessons_.turned.contains(line) &&
        (is_same_feed(found, wanted * kMmPerInch) || is_same_feed(found * kMmPerInch, wanted))) {
      lessons_.turned.insert(line);
    } else if (is_ours && !has_word && !lessons_.said.contains(line)) {
      lessons_.said.insert(line);
    } else if (!has_word || !lessons_.frozen.insert(line).second) {
      freeze(line, last_said);
    }
  }

 private:
  void freeze(std::uint32_t line, std::uint32_t last_said) {
    if (last_said != 0 && lessons_.frozen.insert(last_said).second) return;
    // A word without a move of its own: the last one ahead in the text.
    auto ahead = plan_.edits.upper_bound(line);
    while (ahead != plan_.edits.begin()) {
      --ahead;
      if (lessons_.frozen.insert(ahead->first).second) return;
    }
    for (const auto& [other, edit] : plan_.edits) {
      if (lessons_.frozen.insert(other).second) return;
    }
  }

  const FeedBlocks& blocks_;
  const FeedPlan& plan_;
  FeedLessons& lessons_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> learned_;  ///< files and lines
};

/// True: each motion has the feed that it is to have.
bool hold_against(const FeedTrace& before, const FeedTrace& after, const NcText& text,
                  const FeedBlocks& blocks, const FeedPlan& plan, FeedLessons& lessons) {
  Lessons teacher(blocks, plan, lessons);
  // A wrong feed goes on to the blocks behind it, which are not to blame.
  bool is_right = true, goes_on = false;
  std::uint32_t last_said = 0;
  for (std::size_t i = 0; i < before.motions.size(); ++i) {
    const TracedMotion& was = before.motions[i];
    const double wanted = feed_wanted(was, plan), found = after.motions[i].feed_mm_per_min;
    const std::uint32_t line = was.source.file == 0 ? was.source.line : 0;
    const bool is_said = line > 0 && plan.edits.contains(line);
    const bool has_word = line > 0 && line <= text.lines().size() &&
                          text.lines()[line - 1].feed != NcLine::Feed::kNone;
    if (is_said || has_word) goes_on = false;
    if (!is_same_feed(wanted, found)) {
      is_right = false;
      if (!goes_on) teacher.learn(was, wanted, found, last_said);
      goes_on = true;
    }
    if (is_said) last_said = line;
  }
  return is_right;
}

/// Empty: they are the same but for their feeds.
std::string difference(const FeedTrace& before, const FeedTrace& after) {
  const std::size_t both = std::min(before.motions.size(), after.motions.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (before.motions[i].print == after.motions[i].print) continue;
    return trf(
        "with other feeds the motion of line {} is another one: does the program ask for "
        "its feed (#<_feed>)?",
        before.motions[i].source.line);
  }
  if (before.motions.size() == after.motions.size()) return {};
  return trf("with other feeds the program makes {} motions, not {}", after.motions.size(),
             before.motions.size());
}

}  // namespace

Result<PlacedFeeds> place_feeds(const NcText& text, const FeedBlocks& blocks, const FeedAims& aims,
                                const FeedTrace& before, const TraceText& read) {
  FeedLessons lessons;
  for (int reading = 0; reading < kMostReadings; ++reading) {
    FeedPlan plan = plan_feeds(text, blocks, aims, lessons);
    std::string changed = text.with(plan.edits);
    if (plan.edits.empty()) return PlacedFeeds{std::move(changed), std::move(plan)};
    const Result<FeedTrace> after = read(changed);
    if (!after) return Error{after.error()};
    if (std::string other = difference(before, *after); !other.empty()) return Error{other};
    if (hold_against(before, *after, text, blocks, plan, lessons))
      return PlacedFeeds{std::move(changed), std::move(plan)};
  }
  return Error{tr("its loops and subroutines hand feeds on in ways that cannot be followed")};
}

}  // namespace kerf
