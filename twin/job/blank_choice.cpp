#include "twin/job/blank_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/text_scan.h"
#include "stock/cutter/scan.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Cells that a blank gets at most by default: 16 MB of heights, cut and meshed well within a
/// second.
constexpr double kMostDefaultCells = 4.0e6;
/// Above 0.5 mm a cell says little about a part: large blanks get more cells before they get
/// coarser ones (256 MB of heights).
constexpr double kMostCoarseCells = 6.4e7;
constexpr double kSteps[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
/// A blank without thickness or width is no blank: the least size that a guess gives it.
constexpr double kLeastGuess_mm = 1.0;
/// Who goes to the next cut by rapids does so as often as he goes up and down within a cut, or
/// nearly; a post without rapids has one or two at a change of tools.
constexpr std::size_t kLinksARapid = 4;

/// What a block says outside its comments, as far as comments need it.
struct BlockWords {
  enum class Unit { kNone, kInch, kMm };
  Unit unit = Unit::kNone;  ///< the last G20 or G21
  int tool = -1;            ///< T
  bool changes = false;     ///< M6
  bool moves = false;       ///< an axis word
};

/// Without comments, blanks and what O-words and parameters compute; lower case.
std::string code_of(const std::string& line) {
  std::string code;
  int brackets = 0;
  bool in_comment = false;
  bool in_name = false;
  for (const char c : line) {
    if (c == ';' && !in_comment) break;
    if (in_comment) {
      in_comment = c != ')';
      continue;
    }
    if (c == '(') in_comment = true;
    if (c == '<') in_name = true;
    if (c == '[') ++brackets;
    const bool counts = !in_comment && !in_name && brackets == 0;
    if (counts && !is_space(c)) {
      code.push_back(to_lower(c));
    }
    if (c == ']' && brackets > 0 && --brackets == 0) code.push_back('#');
    if (c == '>') in_name = false;
  }
  return code;
}

/// The words of a block: a letter and a number. Of a saved listing its unit lines alone count.
BlockWords words_of_block(const std::string& line) {
  BlockWords found;
  if (line.find("USE_LENGTH_UNITS(CANON_UNITS_INCHES)") != std::string::npos) {
    found.unit = BlockWords::Unit::kInch;
  } else if (line.find("USE_LENGTH_UNITS(CANON_UNITS_MM)") != std::string::npos) {
    found.unit = BlockWords::Unit::kMm;
  }
  const std::string code = code_of(line);
  const std::size_t first = code.starts_with('/') ? 1 : 0;
  if (code.size() <= first || code[first] == 'o') return found;
  for (std::size_t at = first; at < code.size(); ++at) {
    const char letter = code[at];
    if (letter < 'a' || letter > 'z') continue;
    const std::size_t end = std::min(code.find_first_not_of("+-.0123456789", at + 1), code.size());
    const bool computed = end == at + 1 && end < code.size() && code[end] == '#';
    const std::optional<double> value =
        parse_decimal(std::string_view(code).substr(at + 1, end - at - 1));
    if (!value && !computed) continue;
    if (std::string_view("xyzabcuvwijkr").find(letter) != std::string_view::npos) {
      found.moves = true;
    }
    if (!value) continue;
    if (letter == 'g' && *value == 20) found.unit = BlockWords::Unit::kInch;
    if (letter == 'g' && *value == 21) found.unit = BlockWords::Unit::kMm;
    if (letter == 'm' && *value == 6) found.changes = true;
    if (letter == 't' && *value >= 0 && *value < 1e6) found.tool = static_cast<int>(*value);
    at = end - 1;
  }
  return found;
}

/// Reads a program for the sake of its comments.
class CommentPlaces {
 public:
  /// Up to `last_line`, and on to where nothing moves any more before the next change.
  CommentPlaces(const std::string& path, std::uint32_t last_line) {
    std::ifstream in(path);
    std::string line;
    // A unit word a little after the last comment still counts for it, if it is the first of the
    // program; so does a change that only now comes.
    while (std::getline(in, line)) {
      const bool beyond = lines_.size() >= last_line;
      const BlockWords words = words_of_block(line);
      if (words.changes) has_changes_ = true;
      if (beyond && gap_ended_ && has_changes_ && (seen_unit_ || lines_.size() >= kFarLines)) break;
      if (beyond && lines_.size() >= last_line + kFarLines) break;
      if (beyond && words.moves) gap_ended_ = true;
      add(words);
    }
    end_gap();
  }

  bool inches(std::uint32_t line) const { return known(line) && lines_[line - 1].inches; }
  int tool(std::uint32_t line) const { return known(line) ? lines_[line - 1].tool : -1; }
  /// Without an M6 all of the program belongs to one tool.
  bool at_change(std::uint32_t line) const {
    return !has_changes_ || (known(line) && lines_[line - 1].at_change);
  }

 private:
  static constexpr std::size_t kFarLines = 100000;
  struct Line {
    int tool = -1;
    bool inches = false;
    bool at_change = false;
  };

  bool known(std::uint32_t line) const { return line >= 1 && line <= lines_.size(); }

  void add(const BlockWords& words) {
    if (words.unit != BlockWords::Unit::kNone) {
      inches_ = words.unit == BlockWords::Unit::kInch;
      if (!seen_unit_) {
        for (Line& before : lines_) before.inches = inches_;
      }
      seen_unit_ = true;
    }
    // A block that changes and moves changes first.
    gap_changes_ = gap_changes_ || words.changes;
    lines_.push_back({words.tool, inches_, false});
    if (words.moves) end_gap();
  }

  /// The lines since the last motion stand at a change, or do not.
  void end_gap() {
    for (std::size_t i = gap_begin_; i < lines_.size(); ++i) lines_[i].at_change = gap_changes_;
    gap_begin_ = lines_.size();
    gap_changes_ = false;
  }

  std::vector<Line> lines_;
  std::size_t gap_begin_ = 0;
  bool gap_changes_ = false;
  bool gap_ended_ = false;
  bool has_changes_ = false;
  bool inches_ = false;
  bool seen_unit_ = false;
};

double outward(double value, bool up) {
  return (up ? std::ceil(value - 1e-6) : std::floor(value + 1e-6)) + 0.0;  // no -0
}

}  // namespace

std::vector<CommentText> comments_with_units(const Program& program, const std::string& path) {
  std::vector<CommentText> out;
  std::uint32_t last_line = 0;
  for (const ProgramComment& comment : program.comments()) {
    last_line = std::max(last_line, comment.source.line);
  }
  if (program.comments().empty()) return out;
  const CommentPlaces places(path, last_line);
  out.reserve(program.comments().size());
  for (const ProgramComment& comment : program.comments()) {
    CommentText text;
    text.line = comment.source.line;
    text.text = comment.text;
    text.inches = places.inches(text.line);
    text.block_tool = places.tool(text.line);
    text.at_change = places.at_change(text.line);
    out.push_back(std::move(text));
  }
  return out;
}

void BlankGuess::Sideways::add(double middle_mm, double high_mm, double length_mm) {
  (middle_mm > 0 ? above_zero_mm : below_zero_mm) += length_mm;
  highest_mm = any ? std::max(highest_mm, high_mm) : high_mm;
  any = true;
}

void BlankGuess::Sideways::add_level(double z_mm, double length_mm) {
  const auto level = levels_mm.find(z_mm);
  if (level != levels_mm.end()) {
    level->second += length_mm;
  } else if (levels_mm.size() < kMostLevels) {
    levels_mm.emplace(z_mm, length_mm);
  }
}

void BlankGuess::take(const FeedLinks::Ended& ended) {
  const auto& [z, level, is_link] = ended;
  if (is_link && (links_.size() < kMostLevels || links_.contains(z))) {
    links_[z].length_mm += level.length_mm;
    links_[z].way.extend(level.way);
    ++link_count_;
    return;
  }
  sideways_.add(z, z, level.length_mm);
  sideways_.add_level(z, level.length_mm);
  feeds_mm_.extend(level.way);
}

void BlankGuess::add(const Motion& m, double tool_radius_mm) {
  if (m.unknown_to != 0 || (m.kind != MotionKind::kTraverse && !is_feed(m))) return;
  all_mm_.extend(m.to_mm);
  const bool is_kept = watch_.keeps_back(m);
  if (!is_kept)
    if (const std::optional<FeedLinks::Ended> ended = watch_.end_before(m)) take(*ended);
  if (!is_feed(m)) {
    const bool level = m.start_known && m.from_mm.z == m.to_mm.z;
    if (!level || (m.from_mm.x == m.to_mm.x && m.from_mm.y == m.to_mm.y)) return;
    lowest_rapid_mm_ = rapid_count_ > 0 ? std::min(lowest_rapid_mm_, m.to_mm.z) : m.to_mm.z;
    ++rapid_count_;
    return;
  }
  // A plunge or retraction at feed starts in the air: its end alone says where there is material.
  const bool sideways = m.from_mm.x != m.to_mm.x || m.from_mm.y != m.to_mm.y ||
                        (m.kind == MotionKind::kArc && m.arc.sweep_rad != 0);
  Box way = bounds_of(m);
  lowest_feed_mm_ = has_feed_ ? std::min(lowest_feed_mm_, way.min.z) : way.min.z;
  has_feed_ = true;
  way.min -= Vec3(tool_radius_mm, tool_radius_mm, 0);
  way.max += Vec3(tool_radius_mm, tool_radius_mm, 0);
  const double length = path_length_mm(m);
  if (is_kept) return watch_.add_level(m, length, way);
  feeds_mm_.extend(way);
  if (!sideways || !m.start_known) return;
  sideways_.add(0.5 * (m.from_mm.z + m.to_mm.z), m.to_mm.z, length);
  if (m.from_mm.z == m.to_mm.z) sideways_.add_level(m.to_mm.z, length);
}

void BlankGuess::widen(const Box& feeds_mm, double tool_radius_mm) {
  if (feeds_mm.empty()) return;
  feeds_mm_.extend(feeds_mm.min - Vec3(tool_radius_mm, tool_radius_mm, 0));
  feeds_mm_.extend(feeds_mm.max + Vec3(tool_radius_mm, tool_radius_mm, 0));
}

void BlankGuess::add(const Motion& m, std::span<const CutMove> moves, double tool_radius_mm) {
  if (m.unknown_to != 0) return;
  Box way;
  for (const CutMove& move : moves) {
    way.extend(move.from_mm);
    way.extend(move.to_mm);
  }
  if (way.empty()) return;
  all_mm_.extend(way);
  if (const std::optional<FeedLinks::Ended> ended = watch_.end_before(m)) take(*ended);
  if (!is_feed(m)) return;
  lowest_feed_mm_ = has_feed_ ? std::min(lowest_feed_mm_, way.min.z) : way.min.z;
  has_feed_ = true;
  sideways_.add(way.max.z, way.max.z, way.max.z > 0 ? glm::length(way.size()) : 0);
  way.min -= Vec3(tool_radius_mm, tool_radius_mm, 0);
  way.max += Vec3(tool_radius_mm, tool_radius_mm, 0);
  feeds_mm_.extend(way);
}

BlankGuess BlankGuess::without_air() const {
  BlankGuess all = *this;
  if (const std::optional<FeedLinks::Ended> ended = watch_.kept_back()) all.take(*ended);
  const FeedLinks::Levels links = std::exchange(all.links_, {});
  // Over what stands in the middle of a part a program goes up and down, too.
  const auto air = all.sideways_.any ? links.upper_bound(all.sideways_.highest_mm) : links.begin();
  const bool goes_by_feed = all.link_count_ > kLinksARapid * rapid_count_ &&
                            std::distance(air, links.end()) <= kMostLinkLevels;
  for (auto link = links.begin(); link != (goes_by_feed ? air : links.end()); ++link)
    all.take({link->first, link->second, false});
  return all;
}

/// `lowest`: of the feeds. Whole mm, but for a skin.
BlankGuess::Top BlankGuess::top(double lowest) const {
  double top = 0;
  double above = std::numeric_limits<double>::infinity();  // how much more may be there
  if (rapid_count_ > 0) above = lowest_rapid_mm_;
  if (sideways_.above_zero_mm > sideways_.below_zero_mm) {
    top = sideways_.highest_mm;
    const std::map<double, double>& levels = sideways_.levels_mm;
    if (levels.size() >= 2 && levels.rbegin()->first == top) {
      const double step = top - std::next(levels.rbegin())->first;
      if (top + step <= above) top += step;
    }
  }
  if (!has_feed_ || !sideways_.any || lowest < top) return {outward(top, true), false};
  const double room = above > lowest ? 0.5 * (above - lowest) : kSkin_mm;
  return {lowest + std::min(kSkin_mm, room), true};
}

bool BlankGuess::is_skin() const {
  const BlankGuess cut = without_air();
  return cut.has_feed_ && cut.top(cut.lowest_feed_mm_).skin;
}

Blank BlankGuess::blank() const { return without_air().blank_of_feeds(); }

Blank BlankGuess::blank_of_feeds() const {
  Box box = has_feed_ ? feeds_mm_ : all_mm_;
  if (box.empty()) box.extend(Vec3(0));
  const double lowest = has_feed_ ? lowest_feed_mm_ : 0;
  const Top top = this->top(lowest);
  double floor = lowest - margin_mm_;
  if (lowest >= 0 && top.z_mm > 0 && !top.skin) floor = 0;
  box.min = Vec3(outward(box.min.x - margin_mm_, false), outward(box.min.y - margin_mm_, false),
                 outward(floor, false));
  box.max =
      Vec3(outward(box.max.x + margin_mm_, true), outward(box.max.y + margin_mm_, true), top.z_mm);
  for (int i = 0; i < 3; ++i) {
    if (box.max[i] - box.min[i] < kLeastGuess_mm) box.min[i] = box.max[i] - kLeastGuess_mm;
  }
  BlankBody body;
  body.kind = BlankBody::Kind::kBox;
  body.bounds_mm = box;
  Blank blank;
  blank.bodies.push_back(body);
  return blank;
}

double default_cell_mm(const Box& blank_mm) {
  const Vec3 size = blank_mm.size();
  for (const double cell : kSteps) {
    if (size.x / cell * (size.y / cell) <= kMostDefaultCells) {
      // A blank smaller than a few cells (a needle) gets cells that fit it.
      return std::min({cell, size.x, size.y});
    }
  }
  double cell = kSteps[std::size(kSteps) - 1];
  while (size.x / cell * (size.y / cell) > kMostCoarseCells) cell *= 2;
  return cell;
}

double half_width_mm(const Cutter& cutter, double depth_mm) {
  double inside = 0, outside = cutter.radius_mm();
  if (cutter.height_mm(outside) <= depth_mm) return outside;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + outside);
    (cutter.height_mm(middle) <= depth_mm ? inside : outside) = middle;
  }
  return inside;
}

double cell_no_larger_mm(double size_mm) {
  double cell = kSteps[0];
  for (const double step : kSteps)
    if (step <= size_mm * (1 + 1e-9)) cell = step;
  return cell;
}

double suited_cell_mm(const Box& blank_mm, double finest_mm) {
  const double usual = default_cell_mm(blank_mm);
  if (finest_mm <= 0 || usual <= finest_mm) return usual;
  const Vec3 size = blank_mm.size();
  for (const double cell : kSteps) {
    if (cell < cell_no_larger_mm(finest_mm) || cell >= usual) continue;
    if (size.x / cell * (size.y / cell) <= kMostCoarseCells) return cell;
  }
  return usual;
}

std::string stock_spec(const Blank& blank, LengthUnit unit) {
  // Not more digits than a person writes; -0 is 0.
  const auto number = [unit](double mm) {
    return unit == LengthUnit::kMm ? fmt::format("{:.10g}", mm + 0.0) : length_number(mm, unit);
  };
  if (blank.sheet && blank.sheet->file.empty()) {
    const BlankSheet& s = *blank.sheet;
    return fmt::format("sheet:{},{}:{},{}:{}", number(s.low_mm.x), number(s.low_mm.y),
                       number(s.high_mm.x), number(s.high_mm.y), number(s.thickness_mm));
  }
  if (!blank.state_file.empty() || blank.sheet || blank.bodies.size() != 1) return {};
  const BlankBody& body = blank.bodies[0];
  const Box& b = body.bounds_mm;
  if (body.kind == BlankBody::Kind::kCylinder && body.axis == 'x') {
    return fmt::format("cylinder:{},{},{}:{}:{}:x", number(b.min.x), number(body.center_mm.y),
                       number(body.center_mm.z), number(b.max.x), number(body.diameter_mm));
  }
  if (body.kind == BlankBody::Kind::kCylinder && body.axis == 'z') {
    return fmt::format("cylinder:{},{},{}:{}:{}", number(body.center_mm.x),
                       number(body.center_mm.y), number(b.min.z), number(b.max.z),
                       number(body.diameter_mm));
  }
  if (body.kind != BlankBody::Kind::kBox) return {};
  return fmt::format("box:{},{},{}:{},{},{}", number(b.min.x), number(b.min.y), number(b.min.z),
                     number(b.max.x), number(b.max.y), number(b.max.z));
}

}  // namespace kerf
