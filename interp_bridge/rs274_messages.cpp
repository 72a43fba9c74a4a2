#include "interp_bridge/rs274_messages.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/program_prepare.h"
#include "interp_bridge/source_text.h"
#include "interp_bridge/word_scanner.h"

namespace kerf {
namespace {

/// Said on every run, or of the var file that we keep from being written.
bool is_routine(std::string_view line) {
  return line == "executing" || line.substr(0, 29) == "link (updating variable file)";
}

/// The number that LineNumberer put in front of the line.
std::optional<std::uint64_t> number_of(std::string_view echo) {
  if (!echo.empty() && echo.front() == '/') echo.remove_prefix(1);
  if (echo.size() < 2 || echo.front() != 'N' || !is_digit(echo[1])) return std::nullopt;
  std::uint64_t n = 0;
  std::from_chars(echo.data() + 1, echo.data() + echo.size(), n);
  return n;
}

/// Messages quote lines ('N38o999 if [1]'); the number in the quote is ours.
std::string without_our_numbers(std::string message) {
  for (std::size_t quote = message.find('\''); quote != message.npos;
       quote = message.find('\'', quote + 1)) {
    std::size_t at = quote + 1;
    if (at < message.size() && message[at] == '/') ++at;
    if (at + 1 >= message.size() || message[at] != 'N' || !is_digit(message[at + 1])) continue;
    std::size_t end = at + 1;
    while (end < message.size() && is_digit(message[end])) ++end;
    message.erase(at, end - at);
  }
  return message;
}

/// "EOF in file:part.ngc seeking o-word: o<nosuch> from line: 2" is the one message with a place of
/// its own.
std::optional<std::uint32_t> line_in(const std::string& message) {
  constexpr std::string_view kMark = " from line: ";
  const std::size_t mark = message.find(kMark);
  if (mark == message.npos) return std::nullopt;
  std::uint32_t line = 0;
  const char* const first = message.data() + mark + kMark.size();
  const auto [end, error] = std::from_chars(first, message.data() + message.size(), line);
  return error == std::errc() && line > 0 ? std::optional(line) : std::nullopt;
}

std::uint32_t file_in(const std::string& message, const std::vector<std::string>& files) {
  constexpr std::string_view kMark = "file:";
  const std::size_t mark = message.find(kMark);
  if (mark == message.npos) return 0;
  const std::string_view rest = std::string_view(message).substr(mark + kMark.size());
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    const std::string name = std::filesystem::path(files[i]).filename().string();
    const bool same = rest.substr(0, name.size()) == name;
    if (same && rest.substr(name.size(), 1) == " ") return i;
  }
  return 0;
}

/// A line as the interpreter takes it: in lower case, without blanks, comments and N word.
std::string bare_block(std::string_view line) {
  std::string block;
  bool in_comment = false;
  for (const char c : line) {
    if (c == ';' && !in_comment) break;
    if (c == '(' || c == ')') {
      in_comment = c == '(';
    } else if (!in_comment && !is_space(c)) {
      block += to_lower(c);
    }
  }
  if (!block.empty() && block[0] == 'n') {
    block.erase(0, std::min(block.find_first_not_of("0123456789", 1), block.size()));
  }
  return block;
}

/// What LinuxCNC has for codes of other controls: of one that it does not know, or knows as
/// something else.
struct ForeignCode {
  double code;
  const char* hint;
};
constexpr ForeignCode kForeignCodes[] = {
    {5.1, tr_noop("here G5.1 is a spline; what looks ahead elsewhere is G64 P: leave it out")},
    {31, tr_noop("here a probing move is G38.2")},
    {54.1, tr_noop("here work offsets are G54 to G59 and G59.1 to G59.3")},
    {65,
     tr_noop("here a macro is a subroutine: o<name> call [..], with its arguments in brackets")},
    {68, tr_noop("here a work offset turns: G10 L2 P1 R30")},
};

/// Of what other controls write, and LinuxCNC in another way.
std::string foreign_hint(std::string_view block) {
  const std::string bare = bare_block(block);
  constexpr std::array kMacroWords{"while[", "if[", "goto", "end", "do"};
  if (std::any_of(kMacroWords.begin(), kMacroWords.end(),
                  [&](const char* word) { return bare.starts_with(word); })) {
    return tr(
        "the macro language of another control; here it is o100 while [..] and o100 endwhile, "
        "o101 if [..] and o101 endif, and there is no GOTO");
  }
  if (bare.starts_with(':')) return tr("here a program has no number: leave the line out");
  if (bare.starts_with('$')) return tr("a command of GRBL, not of a program: leave it out");
  if (bare.find(",r") != bare.npos || bare.find(",c") != bare.npos)
    return tr("here no word rounds or breaks a corner: its arc or its chamfer is a block");
  WordScanner words(block);
  char letter = 0;
  std::optional<double> number;
  while (words.next(letter, number)) {
    if (letter != 'g' || !number) continue;
    for (const ForeignCode& foreign : kForeignCodes)
      if (std::abs(*number - foreign.code) < 1e-6) return tr(foreign.hint);
  }
  return {};
}

/// An arc as some write it, with all three words of its centre: G2 X10 Y0 I5 J0 K0.
bool has_idle_k(std::string_view block) {
  WordScanner words(block);
  char letter = 0;
  std::optional<double> number;
  bool idle = false, has_y = false, has_z = false;
  while (words.next(letter, number)) {
    if (letter == 'k') idle = number == 0;
    has_y = has_y || letter == 'y' || letter == 'j';
    has_z = has_z || letter == 'z';
  }
  return idle && (has_y || !has_z);
}

bool has_word(std::string_view block, char wanted, double value) {
  WordScanner words(block);
  char letter = 0;
  std::optional<double> number;
  while (words.next(letter, number)) {
    if (letter == wanted && number == value) return true;
  }
  return false;
}

/// "G0 G91 G28 Z0" has G28.
bool has_g_code(std::string_view block, int code) { return has_word(block, 'g', code); }

/// "start=(X-40.0000,Y50.0000) center=(X-80.0000,Y90.0000) end=(X-30.0000,Y40.0000)": with the
/// centre's words taken as a place (G90.1) both ends are as far from it.
bool fits_absolute_centre(const std::string& message) {
  const auto pair = [&](const char* name, std::array<double, 2>& out) {
    const std::size_t at = message.find(name);
    char first = 0, second = 0;
    return at != message.npos &&
           std::sscanf(message.c_str() + at + std::strlen(name), "%c%lf,%c%lf)", &first, &out[0],
                       &second, &out[1]) == 4;
  };
  std::array<double, 2> start{}, center{}, end{};
  if (!pair("start=(", start) || !pair("center=(", center) || !pair("end=(", end)) return false;
  const std::array<double, 2> place{center[0] - start[0], center[1] - start[1]};
  const auto distance = [&](const std::array<double, 2>& from) {
    const double x = from[0] - place[0], y = from[1] - place[1];
    return std::sqrt(x * x + y * y);
  };
  // As exact as LinuxCNC itself asks for.
  const double from_start = distance(start);
  return std::abs(from_start - distance(end)) < 0.001 * from_start + 0.0005;
}

std::string hint_for(const std::string& message, std::string_view block) {
  const auto has = [&](const char* part) { return message.find(part) != message.npos; };
  if (has("seeking o-word")) {
    return tr("a subroutine that the program calls must be in it, or in NAME.ngc beside it");
  }
  if (has("Bad character '\\357'")) return tr("store the program without a byte order mark");
  const bool may_be_foreign = has("Unknown word") || has("Unknown g code used") ||
                              has("Bad character") || has("All axes missing");
  if (may_be_foreign)
    if (std::string hint = foreign_hint(block); !hint.empty()) return hint;
  if (has("Bad character 'u'") || has("Bad character 'v'") || has("Bad character 'w'")) {
    return tr("rs274 knows the axes X Y Z A B C only");
  }
  if (has("#<_hal[") && has("not defined")) {
    return tr(
        "a dry run has no HAL; of its pins kerf-interp (--interp bridge) knows those of "
        "QtPlasmaC, and those that --hal PIN=VALUE names; rs274 none");
  }
  if (has("Unknown m code used: M190")) {
    return tr("kerf-interp (--interp bridge) takes it as QtPlasmaC's change of material");
  }
  if (has("Unknown m code used") || has("Unknown g code used") || has("M-code greater than 199")) {
    return tr("LinuxCNC has no such code and stops here, too, but where an INI remaps it (--ini)");
  }
  if (has("Start point too close to probe point")) {
    return tr(
        "where the machine stands then (G28, G30, G53, or at the start) is not known; an INI "
        "says it (--ini)");
  }
  if (has("Cannot use two g codes that both use axis values") &&
      (has_g_code(block, 28) || has_g_code(block, 30)) &&
      (has_g_code(block, 0) || has_g_code(block, 1))) {
    return tr("G28 and G30 traverse by themselves: no G0 or G1 in their block");
  }
  if (has("Radius to end of arc differs") && fits_absolute_centre(message)) {
    return tr("as a place, and not from the arc's start, the centre fits: G90.1 says so");
  }
  if (has("K word given for arc in xy plane")) {
    return has_idle_k(block)
               ? tr("an arc of X and Y has no K, not even one of 0: leave the word out")
               : tr("an arc of X and Z lies in G18");
  }
  if (has("P word with no") && (has_g_code(block, 73) || has_g_code(block, 81) ||
                                has_g_code(block, 83) || has_g_code(block, 85))) {
    return tr("LinuxCNC dwells at the bottom of G82, G86, G88 and G89 only: no P here");
  }
  if (has("Nested comment found")) return tr("a comment ends at its first ): no ( lies within it");
  if (has("Unclosed comment found")) return tr("a comment ends in its own line");
  if (has("with zero feed rate") && has_word(block, 'f', 0)) return tr("the block itself says F0");
  if (has("not found in the tool table")) return tr("give the machine's table with --tool-table");
  return {};
}

}  // namespace

std::uint32_t find_line(const std::string& path, const std::string& text, std::uint32_t after) {
  if (text.empty()) return after;
  TextPieces pieces(path);
  std::string_view piece;
  std::uint32_t line = 0;
  while (pieces.next(piece)) {
    while (!piece.empty()) {
      const std::string_view candidate = piece.substr(0, piece.find('\n'));
      ++line;
      // rs274 echoes no more than it could hold of an over-long line.
      const bool starts = candidate.substr(0, text.size()) == text;
      if (line >= after && starts) return line;
      piece.remove_prefix(std::min(piece.size(), candidate.size() + 1));
    }
  }
  return after;
}

namespace {

std::vector<std::string_view> telling_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (!is_routine(line)) lines.push_back(line);
  }
  return lines;
}

std::string joined(const std::vector<std::string_view>& lines) {
  std::string text;
  for (std::string_view line : lines) {
    line = trim(line, is_space);
    if (line.empty()) continue;
    if (!text.empty()) text += "; ";
    text += line;
  }
  return text;
}

}  // namespace

std::string one_line(std::string_view text) { return joined(telling_lines(text)); }

InterpreterMessage parse_interpreter_message(std::string_view stderr_text) {
  std::vector<std::string_view> lines = telling_lines(stderr_text);
  InterpreterMessage result;
  if (lines.size() > 1) {
    result.echo = std::string(lines.back());
    lines.pop_back();
  }
  result.message = joined(lines);
  return result;
}

namespace {

/// The subroutines of a file that has nothing beside them, "o<a>, o<b>"; empty: it has more.
std::string only_subroutines(const std::string& path) {
  constexpr std::size_t kNamed = 3;
  TextPieces pieces(path);
  std::string_view piece;
  std::string names;
  std::string open;
  std::size_t count = 0;
  while (pieces.next(piece)) {
    while (!piece.empty()) {
      const std::string block = bare_block(take_line(piece));
      if (!open.empty()) {
        if (block.starts_with(open + "endsub")) open.clear();
        continue;
      }
      if (block.empty()) continue;
      if (block[0] != 'o' || !block.ends_with("sub") || block.ends_with("endsub")) return {};
      open = block.substr(0, block.size() - 3);
      if (++count <= kNamed) names += (count > 1 ? ", " : "") + open;
    }
  }
  if (!open.empty()) return {};
  return count > kNamed ? names + ", .." : names;
}

}  // namespace

bool is_missing_end(std::string_view message) {
  return message.starts_with("File ended with no percent sign");
}

Diagnostic placed_diagnostic(const std::string& message, SourceRef place,
                             const std::vector<std::string>& files, std::size_t program_lines) {
  Diagnostic diagnostic;
  if (is_missing_end(message)) {
    diagnostic.severity = Severity::kWarning;
    diagnostic.file = files.empty() ? "" : files[0];
    diagnostic.line = static_cast<int>(program_lines);
    if (const std::string names = only_subroutines(diagnostic.file); !names.empty()) {
      diagnostic.severity = Severity::kNote;
      diagnostic.message =
          trf("the file only defines subroutines ({}) and calls none: nothing is run", names);
      diagnostic.hint = tr("a program that calls them is what to run; they need no end here");
      return diagnostic;
    }
    diagnostic.message = trf("the program has no end: {}", message);
    diagnostic.hint = tr("end it with M2 or M30, or put it between two lines of %");
    return diagnostic;
  }
  diagnostic.message = message.empty() ? tr("the interpreter stopped without a message") : message;
  if (const auto line = line_in(message)) place.line = *line;
  if (place.file < files.size()) {
    diagnostic.file = files[place.file];
    diagnostic.line = static_cast<int>(place.line);
    diagnostic.excerpt = line_of_file(diagnostic.file, place.line);
  }
  diagnostic.hint = hint_for(message, diagnostic.excerpt);
  return diagnostic;
}

Diagnostic interpreter_diagnostic(std::string_view stderr_text,
                                  const std::vector<std::string>& files, SourceRef last_source,
                                  std::size_t program_lines) {
  const InterpreterMessage said = parse_interpreter_message(stderr_text);
  SourceRef place = last_source;
  if (const auto line = line_in(said.message)) {
    place = {file_in(said.message, files), *line};
  } else if (const auto n = number_of(said.echo)) {
    place = source_of_n(*n);
  } else if (place.file < files.size()) {
    place.line = find_line(files[place.file], said.echo, place.line);
  }
  if (said.message.empty()) {
    return placed_diagnostic(tr("rs274 stopped without a message"), place, files, program_lines);
  }
  return placed_diagnostic(without_our_numbers(said.message), place, files, program_lines);
}

}  // namespace kerf
