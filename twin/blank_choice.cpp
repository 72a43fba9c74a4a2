#include "twin/blank_choice.h"

#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>

#include "twin/motion_geometry.h"

namespace kerf {
namespace {

/// Cells that a blank gets at most by default: 16 MB of heights, cut and meshed well within a
/// second.
constexpr double kMostDefaultCells = 4.0e6;
/// Above 0.5 mm a cell says little about a part: large blanks get more cells before they get
/// coarser ones (256 MB of heights).
constexpr double kMostCoarseCells = 6.4e7;
/// A blank without thickness or width is no blank: the least size that a guess gives it.
constexpr double kLeastGuess_mm = 1.0;

enum class UnitWord { kNone, kInch, kMm };

/// The last G20 or G21 of a block, outside comments; of a saved listing, its USE_LENGTH_UNITS line.
UnitWord unit_word(const std::string& line) {
  if (line.find("USE_LENGTH_UNITS(CANON_UNITS_INCHES)") != std::string::npos)
    return UnitWord::kInch;
  if (line.find("USE_LENGTH_UNITS(CANON_UNITS_MM)") != std::string::npos) return UnitWord::kMm;
  std::string code;  // without comments and blanks, as LinuxCNC reads a block
  bool in_comment = false;
  for (const char c : line) {
    if (c == ';' && !in_comment) break;
    if (c == '(') in_comment = true;
    if (!in_comment && !std::isspace(static_cast<unsigned char>(c))) {
      code.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    }
    if (c == ')') in_comment = false;
  }
  UnitWord found = UnitWord::kNone;
  for (std::size_t at = code.find('g'); at != std::string::npos; at = code.find('g', at + 1)) {
    std::size_t digit = at + 1;
    while (digit < code.size() && code[digit] == '0') ++digit;
    const bool ends =
        digit + 2 >= code.size() ||
        (code[digit + 2] != '.' && !std::isdigit(static_cast<unsigned char>(code[digit + 2])));
    if (!ends) continue;
    if (code.compare(digit, 2, "20") == 0) found = UnitWord::kInch;
    if (code.compare(digit, 2, "21") == 0) found = UnitWord::kMm;
  }
  return found;
}

/// Units in force at each line up to `last_line`; lines before the first word take that word.
std::vector<bool> inches_by_line(const std::string& path, std::uint32_t last_line) {
  std::vector<bool> inches;
  std::ifstream in(path);
  std::string line;
  bool now_inches = false;
  bool seen = false;
  // A unit word a little after the last comment still counts for it, if it is the first of the
  // program.
  while (std::getline(in, line) &&
         (inches.size() < last_line || (!seen && inches.size() < 100000))) {
    const UnitWord word = unit_word(line);
    if (word != UnitWord::kNone) {
      now_inches = word == UnitWord::kInch;
      if (!seen) inches.assign(inches.size(), now_inches);
      seen = true;
    }
    inches.push_back(now_inches);
  }
  return inches;
}

double outward(double value, bool up) {
  return up ? std::ceil(value - 1e-6) : std::floor(value + 1e-6);
}

}  // namespace

std::vector<CommentText> comments_with_units(const Program& program, const std::string& path) {
  std::vector<CommentText> out;
  std::uint32_t last_line = 0;
  for (const ProgramComment& comment : program.comments()) {
    last_line = std::max(last_line, comment.source.line);
  }
  if (program.comments().empty()) return out;
  const std::vector<bool> inches = inches_by_line(path, last_line);
  out.reserve(program.comments().size());
  for (const ProgramComment& comment : program.comments()) {
    CommentText text;
    text.line = comment.source.line;
    text.text = comment.text;
    text.inches = text.line >= 1 && text.line <= inches.size() && inches[text.line - 1];
    out.push_back(std::move(text));
  }
  return out;
}

void BlankGuess::add(const Motion& m, double tool_radius_mm) {
  if (m.unknown_to != 0 || (m.kind != MotionKind::kTraverse && !is_feed(m))) return;
  all_mm_.extend(m.to_mm);
  if (!is_feed(m)) return;
  // A plunge or retraction at feed starts in the air: its end alone says where there is material.
  const bool sideways = m.from_mm.x != m.to_mm.x || m.from_mm.y != m.to_mm.y ||
                        (m.kind == MotionKind::kArc && m.arc.sweep_rad != 0);
  Box way = bounds_of(m);
  lowest_feed_mm_ = has_feed_ ? std::min(lowest_feed_mm_, way.min.z) : way.min.z;
  has_feed_ = true;
  way.min -= Vec3(tool_radius_mm, tool_radius_mm, 0);
  way.max += Vec3(tool_radius_mm, tool_radius_mm, 0);
  feeds_mm_.extend(way);
  if (!sideways || !m.start_known) return;
  const double length = path_length_mm(m);
  const double middle = 0.5 * (m.from_mm.z + m.to_mm.z);
  (middle > 0 ? sideways_above_zero_mm_ : sideways_below_zero_mm_) += length;
  highest_sideways_mm_ = has_sideways_ ? std::max(highest_sideways_mm_, m.to_mm.z) : m.to_mm.z;
  has_sideways_ = true;
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
  if (!is_feed(m)) return;
  lowest_feed_mm_ = has_feed_ ? std::min(lowest_feed_mm_, way.min.z) : way.min.z;
  highest_sideways_mm_ = has_sideways_ ? std::max(highest_sideways_mm_, way.max.z) : way.max.z;
  has_feed_ = has_sideways_ = true;
  sideways_above_zero_mm_ += way.max.z > 0 ? glm::length(way.size()) : 0;
  way.min -= Vec3(tool_radius_mm, tool_radius_mm, 0);
  way.max += Vec3(tool_radius_mm, tool_radius_mm, 0);
  feeds_mm_.extend(way);
}

Blank BlankGuess::blank() const {
  Box box = has_feed_ ? feeds_mm_ : all_mm_;
  if (box.empty()) box.extend(Vec3(0));
  const double lowest = has_feed_ ? lowest_feed_mm_ : 0;
  double top = 0;
  if (sideways_above_zero_mm_ > sideways_below_zero_mm_) top = highest_sideways_mm_;
  double floor = lowest - margin_mm_;
  if (lowest >= 0 && top > 0) floor = 0;
  box.min = Vec3(outward(box.min.x - margin_mm_, false), outward(box.min.y - margin_mm_, false),
                 outward(floor, false));
  box.max = Vec3(outward(box.max.x + margin_mm_, true), outward(box.max.y + margin_mm_, true),
                 outward(top, true));
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
  constexpr double kSteps[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
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

}  // namespace kerf
