#include "twin/optimize/block_split.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/word_scanner.h"

namespace kerf {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// A stretch of a block for which one feed is wanted.
struct Piece {
  double length_mm = 0;
  double feed_mm_per_min = 0;
};

void add(std::vector<Piece>& pieces, double length_mm, double feed) {
  if (length_mm <= 0) return;
  if (!pieces.empty() && pieces.back().feed_mm_per_min == feed) {
    pieces.back().length_mm += length_mm;
  } else {
    pieces.push_back({length_mm, feed});
  }
}

bool are_alike(double a, double b) { return std::max(a, b) < (1 + kLeastStep) * std::min(a, b); }

/// What each part of a motion may have.
std::vector<Piece> pieces_of(const SurveyedMotion& motion, std::span<const SurveyedPart> parts,
                             const FeedAims& aims) {
  const double most =
      std::min(motion.allowed_mm_per_min, aims.most_feed_mm_per_min.value_or(kUnlimited));
  std::vector<Piece> pieces;
  for (const SurveyedPart& part : parts) {
    if (!part.is_engaged) {
      const double air = aims.air_feed_mm_per_min.value_or(motion.feed_mm_per_min);
      add(pieces, part.length_mm, std::min(air, most));
      continue;
    }
    const double limit =
        part.limit_mm_per_min < kUnlimited ? part.limit_mm_per_min : motion.feed_mm_per_min;
    const double soft = std::min(FeedSurvey::kSoftShare * limit, most);
    const double front_mm = std::min(part.soft_front_mm, part.length_mm);
    const double back_mm = std::min(part.soft_back_mm, part.length_mm - front_mm);
    add(pieces, front_mm, soft);
    add(pieces, part.length_mm - front_mm - back_mm, std::min(limit, most));
    add(pieces, back_mm, soft);
  }
  return pieces;
}

/// The slower one of two counts for both.
void join(std::vector<Piece>& pieces, std::size_t first) {
  Piece& into = pieces[first];
  const Piece& next = pieces[first + 1];
  into.length_mm += next.length_mm;
  into.feed_mm_per_min = std::min(into.feed_mm_per_min, next.feed_mm_per_min);
  pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(first) + 1);
}

/// Neighbours that are alike, and what is too short.
void simplify(std::vector<Piece>& pieces, double least_mm) {
  const auto join_alike = [&pieces] {
    for (std::size_t i = 0; i + 1 < pieces.size();) {
      if (are_alike(pieces[i].feed_mm_per_min, pieces[i + 1].feed_mm_per_min))
        join(pieces, i);
      else
        ++i;
    }
  };
  join_alike();
  while (pieces.size() > 1) {
    const auto shortest =
        std::min_element(pieces.begin(), pieces.end(),
                         [](const Piece& a, const Piece& b) { return a.length_mm < b.length_mm; });
    if (shortest->length_mm >= least_mm) return;
    const auto at = static_cast<std::size_t>(shortest - pieces.begin());
    const bool has_before = at > 0, has_next = at + 1 < pieces.size();
    const auto step = [&](std::size_t other) {
      return std::abs(std::log(pieces[other].feed_mm_per_min / shortest->feed_mm_per_min));
    };
    const bool to_before = has_before && (!has_next || step(at - 1) <= step(at + 1));
    join(pieces, to_before ? at - 1 : at);
    join_alike();
  }
}

/// The block's words for a place on its way.
std::string block_to(const NcLine& line, const TracedMotion& motion, double share) {
  const double unit_mm = mm_of_unit(line.is_inch);
  const Vec3 back_mm = (1 - share) * (motion.to_mm - motion.from_mm);
  std::string out = line.names_g1 ? (line.is_lower ? "g1" : "G1") : "";
  WordScanner scanner(line.text);
  char letter = 0;
  std::optional<double> number;
  while (scanner.next(letter, number)) {
    if (letter < 'x' || letter > 'z' || !number) continue;
    const double place = *number - back_mm[letter - 'x'] / unit_mm;
    std::string text = fmt::format("{:.{}f}", place, line.is_inch ? 5 : 4);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    if (text == "-0") text = "0";
    if (!out.empty() && line.is_spaced) out += ' ';
    out += line.is_lower ? letter : to_upper(letter);
    out += text;
  }
  return out;
}

/// As the block has it.
std::string feed_word(const NcLine& line) {
  const std::string_view number = line.text.substr(line.feed_at, line.feed_end - line.feed_at);
  return fmt::format("{}{}{}", line.is_spaced ? " " : "", line.is_lower ? 'f' : 'F', number);
}

/// Words of axes that lead where the motion goes: no rotation, no offset of the axes' own.
bool names_all_ways(const NcLine& line, const TracedMotion& motion) {
  WordScanner scanner(line.text);
  char letter = 0;
  std::optional<double> number;
  Vec3 named{0};
  while (scanner.next(letter, number)) {
    if (letter >= 'x' && letter <= 'z') named[letter - 'x'] = 1;
  }
  const Vec3 way = motion.to_mm - motion.from_mm;
  for (int i = 0; i < 3; ++i) {
    if (named[i] == 0 && way[i] != 0) return false;
  }
  return true;
}

double distance_from_way_mm(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length2 = glm::dot(way, way);
  const double share =
      length2 > 0 ? std::clamp(glm::dot(point - from, way) / length2, 0.0, 1.0) : 0;
  return glm::length(point - from - share * way);
}

}  // namespace

SplitText split_blocks(const NcText& text, std::span<const SurveyedMotion> motions,
                       std::span<const SurveyedPart> parts, const FeedAims& aims) {
  const std::span<const NcLine> lines = text.lines();
  std::map<std::uint32_t, std::size_t> runs;
  for (const SurveyedMotion& motion : motions) {
    if (motion.source.file == 0) ++runs[motion.source.line];
  }
  SplitText out;
  std::map<std::uint32_t, NcEdit> edits;
  std::map<std::uint32_t, std::uint32_t> added;
  for (const SurveyedMotion& motion : motions) {
    const std::uint32_t number = motion.source.line;
    if (motion.source.file != 0 || number == 0 || number > lines.size()) continue;
    const NcLine& line = lines[number - 1];
    const bool is_fit = line.is_plain_line && runs[number] == 1 && motion.is_measured &&
                        motion.kind == MotionKind::kFeed && !motion.is_per_turn &&
                        !line.inverse_time && motion.parts > 0 && motion.feed_mm_per_min > 0;
    if (!is_fit) continue;
    const auto its = parts.subspan(motion.first_part, motion.parts);
    const TracedMotion way{0, motion.source, motion.kind, 0, motion.from_mm, motion.to_mm};
    if (!names_all_ways(line, way)) continue;
    std::vector<Piece> pieces = pieces_of(motion, its, aims);
    double whole_mm = 0;
    for (const Piece& piece : pieces) whole_mm += piece.length_mm;
    const double diameter_mm = static_cast<double>(its.front().diameter_mm);
    simplify(pieces, std::max(kLeastPieceOfDiameter * diameter_mm, kLeastPiece_mm));
    if (pieces.size() < 2) continue;
    std::string before;
    double done_mm = 0;
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      done_mm += pieces[i].length_mm;
      before += block_to(line, way, done_mm / whole_mm);
      // The feed that the block says counts from its beginning on.
      if (i == 0 && line.feed == NcLine::Feed::kNumber) before += feed_word(line);
      before += line.text.ends_with('\r') ? "\r\n" : "\n";
    }
    edits[number].before = std::move(before);
    added[number] = static_cast<std::uint32_t>(pieces.size() - 1);
    ++out.blocks;
    out.pieces += pieces.size();
  }
  out.text = text.with(edits);
  for (std::uint32_t number = 1; number <= lines.size(); ++number) {
    const auto more = added.find(number);
    out.line_before.insert(out.line_before.end(), 1 + (more != added.end() ? more->second : 0),
                           number);
  }
  return out;
}

std::string way_difference(const FeedTrace& before, const FeedTrace& after,
                           const SplitText& split) {
  std::size_t next = 0;
  const auto line_of = [&split](const TracedMotion& motion) {
    const std::uint32_t line = motion.source.line;
    const bool is_known = motion.source.file == 0 && line > 0 && line <= split.line_before.size();
    return is_known ? split.line_before[line - 1] : line;
  };
  for (const TracedMotion& was : before.motions) {
    if (next == after.motions.size()) return trf("nothing is there of line {}", was.source.line);
    const auto differs = [&was] { return trf("line {} goes another way", was.source.line); };
    if (after.motions[next].print == was.print) {
      ++next;
      continue;
    }
    Vec3 at = was.from_mm;
    bool is_there = false;
    while (!is_there) {
      if (next == after.motions.size()) return differs();
      const TracedMotion& piece = after.motions[next++];
      const bool is_its =
          piece.kind == MotionKind::kFeed && was.kind == MotionKind::kFeed &&
          line_of(piece) == was.source.line && piece.from_mm == at &&
          distance_from_way_mm(piece.to_mm, was.from_mm, was.to_mm) <= kSplitTolerance_mm;
      if (!is_its) return differs();
      at = piece.to_mm;
      is_there = at == was.to_mm;
    }
  }
  return next == after.motions.size() ? std::string() : tr("there are motions at its end");
}

}  // namespace kerf
