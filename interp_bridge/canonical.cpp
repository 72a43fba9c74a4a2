#include "interp_bridge/canonical.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// What may stand in the parentheses, a letter an argument: n number, c coordinate, i integer, u
/// length unit, p plane, m motion control mode with its optional tolerance, s quoted string, r raw
/// text, ? all that follows may be missing, * anything.
struct CommandSpec {
  std::string_view spelling;
  const char* arguments;
};

/// In the order of CanonicalName.
constexpr std::array<CommandSpec, kCanonicalNameCount> kSpecs = {{
    {"STRAIGHT_FEED", "cccccc"},
    {"STRAIGHT_TRAVERSE", "cccccc"},
    {"ARC_FEED", "ccccicccc"},
    {"SET_FEED_RATE", "n"},
    {"STRAIGHT_PROBE", "cccccc"},
    {"RIGID_TAP", "ccc"},
    {"NURBS_FEED", "i*"},
    {"USE_LENGTH_UNITS", "u"},
    {"SET_G5X_OFFSET", "icccccc"},
    {"SET_G92_OFFSET", "cccccc"},
    {"SET_XY_ROTATION", "n"},
    {"SET_FEED_REFERENCE", "*"},
    {"SELECT_PLANE", "p"},
    {"SET_FEED_MODE", "ii"},
    {"START_SPEED_FEED_SYNC", "?ni"},
    {"STOP_SPEED_FEED_SYNCH", ""},
    {"SET_MOTION_CONTROL_MODE", "m"},
    {"SET_NAIVECAM_TOLERANCE", "n"},
    {"SET_PLANNER_MODE", "*"},
    {"DWELL", "n"},
    {"SET_SPINDLE_MODE", "in"},
    {"SET_SPINDLE_SPEED", "in"},
    {"START_SPINDLE_CLOCKWISE", "i"},
    {"START_SPINDLE_COUNTERCLOCKWISE", "i"},
    {"STOP_SPINDLE_TURNING", "i"},
    {"ORIENT_SPINDLE", "ini"},
    {"SPINDLE.0.WAIT_ORIENT_COMPLETE", "n"},
    {"SPINDLE_RETRACT", "*"},
    {"SPINDLE_RETRACT_TRAVERSE", "*"},
    {"USE_NO_SPINDLE_FORCE", "*"},
    {"SELECT_TOOL", "i"},
    {"START_CHANGE", ""},
    {"CHANGE_TOOL", "?i"},
    {"CHANGE_TOOL_NUMBER", "i"},
    {"SET_TOOL_TABLE_ENTRY", "iinnnnnnnnnnni"},
    {"RELOAD_TOOLDATA", ""},
    {"USE_TOOL_LENGTH_OFFSET", "ccccccccc"},
    {"SET_CUTTER_RADIUS_COMPENSATION", "*"},
    {"START_CUTTER_RADIUS_COMPENSATION", "*"},
    {"STOP_CUTTER_RADIUS_COMPENSATION", "*"},
    {"SET_TRAVERSE_RATE", "n"},
    {"COMMENT", "s"},
    {"MESSAGE", "s"},
    {"LOG", "s"},
    {"LOGOPEN", "s"},
    {"LOGAPPEND", "s"},
    {"LOGCLOSE", ""},
    {"MIST_ON", ""},
    {"MIST_OFF", ""},
    {"FLOOD_ON", ""},
    {"FLOOD_OFF", ""},
    {"ENABLE_FEED_OVERRIDE", ""},
    {"DISABLE_FEED_OVERRIDE", ""},
    {"ENABLE_ADAPTIVE_FEED", ""},
    {"DISABLE_ADAPTIVE_FEED", ""},
    {"ENABLE_FEED_HOLD", ""},
    {"DISABLE_FEED_HOLD", ""},
    {"ENABLE_SPEED_OVERRIDE", "i"},
    {"DISABLE_SPEED_OVERRIDE", "i"},
    {"SET_MOTION_OUTPUT_BIT", "i"},
    {"CLEAR_MOTION_OUTPUT_BIT", "i"},
    {"SET_AUX_OUTPUT_BIT", "i"},
    {"CLEAR_AUX_OUTPUT_BIT", "i"},
    {"SET_MOTION_OUTPUT_VALUE", "in"},
    {"SET_AUX_OUTPUT_VALUE", "in"},
    {"TURN_PROBE_ON", ""},
    {"TURN_PROBE_OFF", ""},
    {"CLAMP_AXIS", "*"},
    {"UNCLAMP_AXIS", "*"},
    {"PROGRAM_STOP", ""},
    {"OPTIONAL_PROGRAM_STOP", ""},
    {"PALLET_SHUTTLE", ""},
    {"PROGRAM_END", ""},
    {"FINISH", ""},
    {"ON_RESET", ""},
    {"CANON_ERROR", "r"},
}};

/// 2.10 prints the splines under other names; the meaning for us is the same.
constexpr std::array<std::string_view, 3> kNurbsSpellings = {"NURBS_FEED", "NURBS_G5_FEED",
                                                             "NURBS_G6_FEED_"};

constexpr std::array<double, 19> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                 1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                 1e14, 1e15, 1e16, 1e17, 1e18};

/// Nobody means a point farther off, and products of such numbers stay finite.
constexpr double kLargestCoordinate = 1e15;
/// X Y Z A B C of a straight move.
constexpr std::size_t kStraightCoordinates = 6;

bool is_name_start(char c) { return (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_part(char c) { return is_name_start(c) || is_digit(c) || c == '.'; }

struct Cursor {
  const char* at;
  const char* end;

  void skip_blanks() {
    while (at != end && is_blank(*at)) ++at;
  }
  bool done() const { return at == end; }
};

/// Anything that the fast reader does not hold exactly: long numbers, exponents.
bool parse_number_slowly(Cursor& cursor, const char* begin, double& value) {
  const bool plus = *begin == '+';
  const auto [end, error] = std::from_chars(begin + (plus ? 1 : 0), cursor.end, value);
  if (error != std::errc() || !std::isfinite(value)) return false;
  cursor.at = end;
  return true;
}

/// A fixed-point number, correctly rounded: up to 2^53 the digits and the power of ten are exact
/// doubles, so that one division rounds once; all else goes through from_chars.
bool parse_number(Cursor& cursor, double& value) {
  const char* const begin = cursor.at;
  const char* p = begin;
  const char* const end = cursor.end;
  bool negative = false;
  if (p != end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  std::uint64_t digits = 0;
  const char* const whole = p;
  while (p != end && is_digit(*p)) digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
  std::ptrdiff_t count = p - whole;
  std::ptrdiff_t decimals = 0;
  if (p != end && *p == '.') {
    const char* const fraction = ++p;
    while (p != end && is_digit(*p)) digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
    decimals = p - fraction;
    count += decimals;
  }
  if (count == 0) return false;
  const bool exponent = p != end && (*p == 'e' || *p == 'E');
  constexpr std::uint64_t kExactLimit = std::uint64_t{1} << 53;
  if (count > 18 || digits > kExactLimit || exponent) {
    return parse_number_slowly(cursor, begin, value);
  }
  const double magnitude =
      static_cast<double>(digits) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  value = negative ? -magnitude : magnitude;
  cursor.at = p;
  return true;
}

bool parse_integer(Cursor& cursor, double& value) {
  const char* p = cursor.at;
  bool negative = false;
  if (p != cursor.end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  const char* const first = p;
  std::int64_t number = 0;
  while (p != cursor.end && is_digit(*p) && p - first < 10) number = number * 10 + (*p++ - '0');
  if (p == first || (p != cursor.end && is_digit(*p)) || number > 2'147'483'647) return false;
  value = static_cast<double>(negative ? -number : number);
  cursor.at = p;
  return true;
}

std::string_view parse_word(Cursor& cursor) {
  const char* const begin = cursor.at;
  while (!cursor.done() && is_name_part(*cursor.at)) ++cursor.at;
  return {begin, static_cast<std::size_t>(cursor.at - begin)};
}

bool parse_units(Cursor& cursor, double& value) {
  const std::string_view word = parse_word(cursor);
  CanonicalUnits units = CanonicalUnits::kMm;
  if (word == "CANON_UNITS_INCHES") {
    units = CanonicalUnits::kInches;
  } else if (word == "CANON_UNITS_CM") {
    units = CanonicalUnits::kCm;
  } else if (word != "CANON_UNITS_MM") {
    return false;
  }
  value = static_cast<double>(units);
  return true;
}

bool parse_plane(Cursor& cursor, double& value) {
  const std::string_view word = parse_word(cursor);
  constexpr std::string_view kPrefix = "CANON_PLANE_";
  if (word.substr(0, kPrefix.size()) != kPrefix) return false;
  const std::string_view name = word.substr(kPrefix.size());
  CanonicalPlane plane = CanonicalPlane::kUnknown;  // UV, VW, UW: rs274 prints UNKNOWN
  if (name == "XY") plane = CanonicalPlane::kXy;
  if (name == "YZ") plane = CanonicalPlane::kYz;
  if (name == "XZ") plane = CanonicalPlane::kXz;
  value = static_cast<double>(plane);
  return !name.empty();
}

/// CANON_EXACT_STOP, CANON_EXACT_PATH, or CANON_CONTINUOUS with its tolerance.
bool parse_control_mode(Cursor& cursor, CanonicalCommand& command) {
  constexpr std::array<std::string_view, 3> kModes = {"CANON_EXACT_STOP", "CANON_EXACT_PATH",
                                                      "CANON_CONTINUOUS"};
  const auto mode = std::find(kModes.begin(), kModes.end(), parse_word(cursor));
  if (mode == kModes.end()) return false;
  command.arguments[command.argument_count++] =
      static_cast<double>(std::distance(kModes.begin(), mode));
  cursor.skip_blanks();
  if (cursor.done()) return true;
  if (*cursor.at++ != ',') return false;
  cursor.skip_blanks();
  return parse_number(cursor, command.arguments[command.argument_count++]);
}

/// Separators differ from call to call: ", " or "," or " ".
bool skip_separator(Cursor& cursor) {
  const char* const begin = cursor.at;
  cursor.skip_blanks();
  if (!cursor.done() && *cursor.at == ',') ++cursor.at;
  cursor.skip_blanks();
  return cursor.at != begin;
}

const char* parse_string(Cursor& cursor, CanonicalCommand& command) {
  const char* last = cursor.end;
  while (last != cursor.at && is_blank(last[-1])) --last;
  if (last - cursor.at < 2 || *cursor.at != '"' || last[-1] != '"') {
    return tr("expected a text in double quotes");
  }
  command.text = {cursor.at + 1, static_cast<std::size_t>(last - cursor.at - 2)};
  cursor.at = cursor.end;
  return nullptr;
}

/// Null if the argument that `letter` asks for was read; otherwise what was expected at the cursor.
const char* parse_argument(char letter, Cursor& cursor, CanonicalCommand& command) {
  double& slot = command.arguments[command.argument_count];
  switch (letter) {
    case 'n':
      if (!parse_number(cursor, slot)) return tr("expected a number");
      break;
    case 'c':
      if (!parse_number(cursor, slot)) return tr("expected a number");
      if (std::abs(slot) > kLargestCoordinate) return tr("a coordinate beyond 1e15 is not allowed");
      break;
    case 'i':
      if (!parse_integer(cursor, slot)) return tr("expected a whole number");
      break;
    case 'u':
      if (!parse_units(cursor, slot)) return tr("expected CANON_UNITS_INCHES or CANON_UNITS_MM");
      break;
    case 'p':
      if (!parse_plane(cursor, slot)) return tr("expected CANON_PLANE_XY, _YZ or _XZ");
      break;
    case 'm':
      if (parse_control_mode(cursor, command)) return nullptr;
      return tr("expected CANON_EXACT_STOP, CANON_EXACT_PATH or CANON_CONTINUOUS with a tolerance");
    case 's':
      return parse_string(cursor, command);
    default:  // r
      command.text = {cursor.at, static_cast<std::size_t>(cursor.end - cursor.at)};
      cursor.at = cursor.end;
      return nullptr;
  }
  ++command.argument_count;
  return nullptr;
}

/// Null, or why not; the cursor then stands at the fault.
const char* parse_arguments(const char* spec, Cursor& cursor, CanonicalCommand& command) {
  command.argument_count = 0;
  bool optional = false;
  for (bool first = true; *spec != '\0'; ++spec) {
    if (*spec == '?') {
      optional = true;
      continue;
    }
    if (*spec == '*') return nullptr;
    if (first) {
      if (*spec != 'r') cursor.skip_blanks();
      if (optional && cursor.done()) return nullptr;
    } else if (!skip_separator(cursor)) {
      return cursor.done() ? tr("an argument is missing") : tr("expected a comma or a blank");
    }
    first = false;
    const char* const begin = cursor.at;
    if (const char* fault = parse_argument(*spec, cursor, command)) {
      cursor.at = begin;
      return cursor.done() ? tr("an argument is missing") : fault;
    }
  }
  cursor.skip_blanks();
  return cursor.done() ? nullptr : tr("more arguments than the command has");
}

/// Most records are such moves.
bool is_straight_of_coordinates(const CanonicalCommand& command) {
  const bool straight = command.name == CanonicalName::kStraightFeed ||
                        command.name == CanonicalName::kStraightTraverse;
  if (!straight || command.argument_count < kStraightCoordinates) return false;
  bool fits = true;
  for (std::size_t i = 0; i < command.argument_count; ++i) {
    fits &= std::abs(command.arguments[i]) <= kLargestCoordinate;
  }
  return fits;
}

bool argument_fits(char letter, double value) {
  const bool whole = value == std::floor(value);
  switch (letter) {
    case 'c':
      return std::abs(value) <= kLargestCoordinate;
    case 'i':
      return whole && std::abs(value) <= std::numeric_limits<std::int32_t>::max();
    case 'u':
      return whole && value >= 0 && value <= static_cast<double>(CanonicalUnits::kCm);
    case 'p':
      return whole && value >= 0 && value <= static_cast<double>(CanonicalPlane::kUnknown);
    case 'm':
      return whole && value >= 0 && value <= static_cast<double>(CanonicalControlMode::kContinuous);
    default:
      return std::isfinite(value);
  }
}

/// Names sorted by spelling, for the ones that are not frequent.
const std::vector<std::pair<std::string_view, CanonicalName>>& sorted_names() {
  static const auto names = [] {
    std::vector<std::pair<std::string_view, CanonicalName>> sorted;
    for (std::size_t i = 0; i < kSpecs.size(); ++i) {
      sorted.emplace_back(kSpecs[i].spelling, static_cast<CanonicalName>(i));
    }
    for (const std::string_view spelling : kNurbsSpellings) {
      sorted.emplace_back(spelling, CanonicalName::kNurbsFeed);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }();
  return names;
}

bool is_wait_orient_complete(std::string_view name) {
  constexpr std::string_view kHead = "SPINDLE.";
  constexpr std::string_view kTail = ".WAIT_ORIENT_COMPLETE";
  if (name.size() <= kHead.size() + kTail.size() || name.substr(0, kHead.size()) != kHead ||
      name.substr(name.size() - kTail.size()) != kTail) {
    return false;
  }
  const std::string_view number =
      name.substr(kHead.size(), name.size() - kHead.size() - kTail.size());
  return std::all_of(number.begin(), number.end(), is_digit);
}

bool find_name(std::string_view name, CanonicalName& out) {
  for (const CanonicalName frequent :
       {CanonicalName::kStraightFeed, CanonicalName::kStraightTraverse, CanonicalName::kArcFeed,
        CanonicalName::kSetFeedRate}) {
    if (name == kSpecs[static_cast<std::size_t>(frequent)].spelling) {
      out = frequent;
      return true;
    }
  }
  const auto& names = sorted_names();
  const auto found = std::lower_bound(
      names.begin(), names.end(), name,
      [](const auto& entry, std::string_view wanted) { return entry.first < wanted; });
  if (found != names.end() && found->first == name) {
    out = found->second;
    return true;
  }
  out = CanonicalName::kWaitOrientComplete;
  return is_wait_orient_complete(name);
}

/// Reads all digits. False if the number has more than 18 of them and is thus not held.
bool parse_counter(Cursor& cursor, std::uint64_t& value) {
  const char* const begin = cursor.at;
  value = 0;
  while (!cursor.done() && is_digit(*cursor.at)) {
    value = value * 10 + static_cast<std::uint64_t>(*cursor.at++ - '0');
  }
  return cursor.at - begin <= 18;
}

/// Sequence number and N column; the cursor ends at the name. False: the line is not canonical.
bool parse_head(Cursor& cursor, CanonicalCommand& command) {
  cursor.skip_blanks();
  command.sequence = 0;
  const bool has_sequence = !cursor.done() && is_digit(*cursor.at);
  if (has_sequence) {
    if (!parse_counter(cursor, command.sequence)) return false;
    if (cursor.done() || *cursor.at != ' ') return false;
    cursor.skip_blanks();
  }
  if (cursor.done() || *cursor.at != 'N') return false;
  ++cursor.at;
  command.has_n = false;
  if (!cursor.done() && is_digit(*cursor.at)) {
    command.has_n = parse_counter(cursor, command.n);
    cursor.skip_blanks();
    return has_sequence;
  }
  constexpr std::string_view kDots = ".....";
  const auto left = static_cast<std::size_t>(cursor.end - cursor.at);
  if (left > kDots.size() && std::string_view(cursor.at, kDots.size()) == kDots) {
    cursor.at += kDots.size();
  }
  const char* const before = cursor.at;
  cursor.skip_blanks();
  if (cursor.at == before) return false;
  // 2.10 prints its G6 splines with this word and without the sequence number.
  constexpr std::string_view kDrift = "saicanon ";
  if (std::string_view(cursor.at, static_cast<std::size_t>(cursor.end - cursor.at))
          .substr(0, kDrift.size()) == kDrift) {
    cursor.at += kDrift.size();
    return true;
  }
  return has_sequence;
}

/// Head, name and the opening parenthesis, which the cursor is left behind.
bool parse_call_head(Cursor& cursor, CanonicalCommand& command) {
  if (!parse_head(cursor, command)) return false;
  if (cursor.done() || !is_name_start(*cursor.at)) return false;
  command.spelling = parse_word(cursor);
  if (cursor.done() || *cursor.at != '(') return false;
  ++cursor.at;
  return true;
}

}  // namespace

void parse_canonical_line(std::string_view line, CanonicalLine& out) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  Cursor cursor{line.data(), line.data() + line.size()};
  CanonicalCommand& command = out.command;
  if (!parse_call_head(cursor, command)) {
    out.kind = CanonicalLineKind::kForeign;
    return;
  }
  const bool known = find_name(command.spelling, command.name);
  command.text = {};
  const char* last = cursor.end;
  while (last != cursor.at && is_blank(last[-1])) --last;
  if (last != cursor.at && last[-1] == ')') {
    cursor.end = last - 1;
  } else if (command.name != CanonicalName::kCanonError || !known) {
    // A CANON_ERROR may go on in the next line; any other call ends in its line.
    out.kind = CanonicalLineKind::kMalformed;
    out.column = static_cast<int>(line.size()) + 1;
    out.message = tr("the closing parenthesis is missing; the listing may have been cut off");
    return;
  }
  if (!known) {
    out.kind = CanonicalLineKind::kUnknown;
    return;
  }
  const char* const spec = kSpecs[static_cast<std::size_t>(command.name)].arguments;
  if (const char* fault = parse_arguments(spec, cursor, command)) {
    out.kind = CanonicalLineKind::kMalformed;
    out.column = static_cast<int>(cursor.at - line.data()) + 1;
    out.message = fault;
    return;
  }
  out.kind = CanonicalLineKind::kCommand;
}

std::string_view canonical_spelling(CanonicalName name) {
  return kSpecs[static_cast<std::size_t>(name)].spelling;
}

bool canonical_arguments_fit(const CanonicalCommand& command) {
  if (is_straight_of_coordinates(command)) return true;
  const double* const values = command.arguments.data();
  std::size_t at = 0;
  bool optional = false;
  for (const char* spec = kSpecs[static_cast<std::size_t>(command.name)].arguments; *spec != 0;
       ++spec) {
    if (*spec == '*') break;
    optional |= *spec == '?';
    if (*spec == '?' || *spec == 's' || *spec == 'r') continue;
    if (at == command.argument_count) return optional;
    if (!argument_fits(*spec, values[at++])) return false;
  }
  return std::all_of(values + at, values + command.argument_count,
                     [](double value) { return std::abs(value) <= kLargestCoordinate; });
}

bool looks_canonical(std::string_view line) {
  Cursor cursor{line.data(), line.data() + line.size()};
  CanonicalCommand command;
  return parse_call_head(cursor, command) && command.sequence != 0;
}

}  // namespace kerf
