#include "twin/optimize/feed_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text_scan.h"
#include "base/units.h"

namespace kerf {
namespace {

constexpr double kOver = std::numeric_limits<double>::infinity();
/// Feeds that differ by no more are the same, after a change of units.
constexpr double kSame = 1e-9;

bool is_same(double a, double b) { return std::abs(a - b) <= kSame * std::max(a, b); }

FeedLeft left_of(const SurveyedMotion& motion, const NcLine& line) {
  if (line.is_synchronous) return FeedLeft::kSynchronous;
  if (line.inverse_time) return FeedLeft::kInverseTime;
  if (motion.is_per_turn || line.per_turn) return FeedLeft::kPerTurn;
  if (motion.kind == MotionKind::kThread) return FeedLeft::kSynchronous;
  if (motion.kind == MotionKind::kProbe) return FeedLeft::kProbe;
  if (line.feed == NcLine::Feed::kComputed) return FeedLeft::kComputed;
  if (motion.feed_mm_per_min <= 0) return FeedLeft::kMissing;
  return motion.is_measured ? FeedLeft::kNone : FeedLeft::kUnmeasured;
}

/// What a motion asks of its block: how fast at most. Nothing: it is in the air.
std::optional<double> limit_of(const SurveyedMotion& motion) {
  // What has removed something that no look has seen, and what drills, is not made faster.
  if (!motion.is_engaged && motion.removed_mm3 > 0) return motion.feed_mm_per_min;
  // Nor what goes down to where the blank should begin, and may begin earlier.
  if (!motion.is_engaged && motion.goes_down) return motion.feed_mm_per_min;
  if (!motion.is_engaged) return std::nullopt;
  return motion.goes_down ? std::min(motion.limit_mm_per_min, motion.feed_mm_per_min)
                          : motion.limit_mm_per_min;
}

void add(FeedBlock& block, const SurveyedMotion& motion, const NcLine& line) {
  ++block.motions;
  block.least_feed = std::min(block.least_feed, motion.feed_mm_per_min);
  block.most_feed = std::max(block.most_feed, motion.feed_mm_per_min);
  block.allowed = std::min(block.allowed, motion.allowed_mm_per_min);
  if (block.left == FeedLeft::kNone) block.left = left_of(motion, line);
  const std::optional<double> limit = limit_of(motion);
  if (!limit) return;
  block.is_engaged = true;
  block.least_limit = std::min(block.least_limit, *limit);
  block.most_limit = std::max(block.most_limit, *limit);
}

/// The number of an F word is what the interpreter makes of it; else the line is not what it seems.
bool is_told_by(const FeedBlock& block, const NcLine& line) {
  if (line.feed != NcLine::Feed::kNumber) return true;
  return is_same(block.least_feed, block.most_feed) &&
         (is_same(block.most_feed, line.feed_number) ||
          is_same(block.most_feed, line.feed_number * kMmPerInch));
}

class Planner {
 public:
  Planner(const NcText& text, const FeedBlocks& blocks, const FeedAims& aims,
          const FeedLessons& lessons)
      : lines_(text.lines()), blocks_(blocks), aims_(aims), lessons_(lessons) {
    find_followers();
  }

  FeedPlan plan() {
    for (std::size_t i = 0; i < lines_.size(); ++i) take(static_cast<std::uint32_t>(i + 1));
    return std::move(plan_);
  }

 private:
  const FeedBlock* block_at(std::uint32_t line) const {
    const auto found = blocks_.by_line.find(line);
    return found == blocks_.by_line.end() ? nullptr : &found->second;
  }

  /// Of F words without a move: the first block that has none of its own.
  void find_followers() {
    followers_.assign(lines_.size() + 1, 0);
    std::uint32_t next = 0;
    for (std::size_t i = lines_.size(); i-- > 0;) {
      followers_[i] = next;
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (lines_[i].feed != NcLine::Feed::kNone)
        next = 0;
      else if (block_at(number) != nullptr)
        next = number;
    }
  }

  double unit_mm(std::uint32_t number) const {
    const NcLine& line = lines_[number - 1];
    // What the interpreter has made of its number.
    const FeedBlock* const block = block_at(number);
    if (block != nullptr && line.feed == NcLine::Feed::kNumber) {
      if (is_same(block->most_feed, line.feed_number)) return 1;
      if (is_same(block->most_feed, line.feed_number * kMmPerInch)) return kMmPerInch;
    }
    return mm_of_unit(line.is_inch != lessons_.turned.contains(number));
  }

  double limit(const FeedBlock& block) const { return most_feed(block, aims_); }
  /// What it is to be; 0: nothing asks for another feed than it has.
  double target(const FeedBlock& block) const {
    const double asked =
        block.is_engaged ? block.least_limit : aims_.air_feed_mm_per_min.value_or(kOver);
    return asked < kOver ? std::min({asked, limit(block), block.allowed}) : 0;
  }
  bool suits(const FeedBlock& block, double feed) const {
    if (feed > limit(block) * (1 + kSame) || target(block) >= (1 + kLeastChange) * feed)
      return false;
    const bool in_air = !block.is_engaged && aims_.air_feed_mm_per_min.has_value();
    return !in_air || feed <= (1 + kLeastChange) * *aims_.air_feed_mm_per_min;
  }
  bool suits_as_it_is(const FeedBlock& block) const {
    return suits(block, block.least_feed) && suits(block, block.most_feed);
  }
  double wanted(const FeedBlock& block) const {
    const double faster = target(block);
    return faster > 0 ? faster : limit(block);
  }

  void say(std::uint32_t line, double mm_per_min) {
    const double unit = unit_mm(line);
    std::string text = feed_text(mm_per_min / unit);
    now_ = parse_decimal(text).value_or(0) * unit;
    plan_.edits[line].number = std::move(text);
  }
  void restore(std::uint32_t line, double mm_per_min) {
    plan_.edits[line].number = fmt::format("{:.12g}", mm_per_min / unit_mm(line));
    now_ = mm_per_min;
  }
  void settle(std::uint32_t line, const FeedBlock& block, std::optional<double> feed) {
    plan_.feeds[line] = feed;
    if (feed && !(is_same(*feed, block.least_feed) && is_same(*feed, block.most_feed)))
      ++plan_.changed;
  }

  void take(std::uint32_t number) {
    const NcLine& line = lines_[number - 1];
    const FeedBlock* const block = block_at(number);
    if (line.feed == NcLine::Feed::kComputed) {
      was_ = now_ = 0;
      is_computed_ = true;
      if (block != nullptr) leave(number, *block, block->left);
      return;
    }
    if (line.feed == NcLine::Feed::kNumber) {
      const double ahead = now_;
      is_computed_ = false;
      was_ = now_ = line.feed_number * unit_mm(number);
      take_word(number, block, ahead);
      return;
    }
    if (block != nullptr) take_plain(number, *block);
  }

  bool stays(std::uint32_t number, const FeedBlock& block) const {
    return block.left != FeedLeft::kNone || lessons_.frozen.contains(number);
  }
  void leave(std::uint32_t number, const FeedBlock& block, FeedLeft reason) {
    plan_.left[number] = reason != FeedLeft::kNone ? reason : FeedLeft::kTangled;
    settle(number, block, std::nullopt);
  }

  /// A line that says a feed; `ahead`: what has been in force.
  void take_word(std::uint32_t number, const FeedBlock* block, double ahead) {
    if (block == nullptr) {
      const std::uint32_t next = followers_[number - 1];
      const FeedBlock* const follower = next > 0 ? block_at(next) : nullptr;
      if (follower == nullptr || stays(next, *follower) || lessons_.frozen.contains(number)) return;
      if (!suits(*follower, now_)) say(number, wanted(*follower));
      return;
    }
    if (is_same(block->least_feed, block->most_feed)) was_ = now_ = block->most_feed;
    if (stays(number, *block)) {
      leave(number, *block, block->left);
    } else if (!is_told_by(*block, lines_[number - 1])) {
      leave(number, *block, FeedLeft::kTangled);
    } else if (suits(*block, block->most_feed)) {
      settle(number, *block, block->most_feed);
    } else if (ahead > 0 && suits(*block, ahead)) {
      restore(number, ahead);  // as the block ahead of it: every other feed is a step
      settle(number, *block, now_);
    } else {
      say(number, wanted(*block));
      settle(number, *block, now_);
    }
  }

  /// A line with moves at the feed that is in force.
  void take_plain(std::uint32_t number, const FeedBlock& block) {
    const NcLine& line = lines_[number - 1];
    // Nowhere for a word.
    if (line.is_control || line.words_end == 0) return leave(number, block, block.left);
    if (is_computed_ && block.left == FeedLeft::kNone)
      return leave(number, block, FeedLeft::kComputed);
    const bool is_one = is_same(block.least_feed, block.most_feed);
    const bool is_said = lessons_.said.contains(number);
    if (stays(number, block)) {
      leave(number, block, block.left);
      const bool counts = block.left != FeedLeft::kInverseTime &&
                          block.left != FeedLeft::kPerTurn && block.left != FeedLeft::kMissing;
      const bool differs = is_said || (now_ != was_ && !is_same(now_, block.most_feed));
      if (counts && is_one && differs && now_ > 0) restore(number, block.most_feed);
      return;
    }
    const bool is_as_before = now_ == was_ || now_ == 0;
    if (!is_said && is_as_before && suits_as_it_is(block)) {
      settle(number, block, std::nullopt);
    } else if (!is_said && !is_as_before && suits(block, now_)) {
      settle(number, block, now_);
    } else if (is_one && suits(block, block.most_feed)) {
      restore(number, block.most_feed);
      settle(number, block, now_);
    } else if (wanted(block) < kOver) {
      say(number, wanted(block));
      settle(number, block, now_);
    } else {
      leave(number, block, FeedLeft::kTangled);  // as fast as ever it is come by
    }
  }

  std::span<const NcLine> lines_;
  const FeedBlocks& blocks_;
  const FeedAims& aims_;
  const FeedLessons& lessons_;
  std::vector<std::uint32_t> followers_;
  FeedPlan plan_;
  bool is_computed_ = false;  ///< the feed in force, by the order of the text
  double was_ = 0, now_ = 0;  ///< in force, before and now; 0: not known
};

}  // namespace

const char* key_of(FeedLeft reason) {
  switch (reason) {
    case FeedLeft::kNone:
      return "none";
    case FeedLeft::kInverseTime:
      return "inverse-time";
    case FeedLeft::kPerTurn:
      return "per-turn";
    case FeedLeft::kSynchronous:
      return "synchronous";
    case FeedLeft::kProbe:
      return "probe";
    case FeedLeft::kComputed:
      return "computed";
    case FeedLeft::kMissing:
      return "missing";
    case FeedLeft::kUnmeasured:
      return "unmeasured";
    case FeedLeft::kOtherFile:
      return "other-file";
    case FeedLeft::kTangled:
      return "tangled";
  }
  return "";
}

FeedBlocks feed_blocks(const NcText& text, std::span<const SurveyedMotion> motions) {
  FeedBlocks blocks;
  const std::span<const NcLine> lines = text.lines();
  for (const SurveyedMotion& motion : motions) {
    const std::uint32_t line = motion.source.line;
    if (motion.source.file != 0 || line == 0 || line > lines.size()) {
      ++blocks.elsewhere;
    } else {
      add(blocks.by_line[line], motion, lines[line - 1]);
    }
  }
  return blocks;
}

double most_feed(const FeedBlock& block, const FeedAims& aims) {
  return std::min(block.is_engaged ? block.least_limit : kOver,
                  aims.most_feed_mm_per_min.value_or(kOver));
}

ExceededFeed exceeded_feed(const FeedBlocks& blocks, const FeedAims& aims,
                           const std::map<std::uint32_t, FeedLeft>& left) {
  for (const auto& [line, block] : blocks.by_line) {
    const double most = most_feed(block, aims);
    if (left.contains(line) || block.left != FeedLeft::kNone) continue;
    if (block.most_feed > most * (1 + kSame)) return {line, block.most_feed, most};
  }
  return {};
}

FeedPlan plan_feeds(const NcText& text, const FeedBlocks& blocks, const FeedAims& aims,
                    const FeedLessons& lessons) {
  return Planner(text, blocks, aims, lessons).plan();
}

}  // namespace kerf
