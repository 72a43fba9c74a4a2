#include "interp_bridge/ini_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "interp_bridge/source_text.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxIniBytes = 4 * 1024 * 1024;
constexpr std::size_t kMaxLineBytes = 255;  // LINELEN of LinuxCNC's inifile
constexpr int kMaxContinuedLines = 20;      // its MAX_EXTEND_LINES
constexpr std::size_t kMaxDiagnostics =
    50;  // of the text; a file that is no INI has no end of them
constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kIncludeWord = "#INCLUDE";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// `text` up to its first newline, which is taken off with it.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

bool is_name_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

/// What the shell makes of the name behind #INCLUDE: quotes go, $NAME and ${NAME} become values.
std::string shell_expanded(std::string_view text) {
  std::string name;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' || c == '\'') continue;
    if (c == '#' && at > 0 && kBlanks.find(text[at - 1]) != kBlanks.npos) break;
    if (c != '$') {
      name += c;
      continue;
    }
    const bool braces = at + 1 < text.size() && text[at + 1] == '{';
    std::size_t end = at + (braces ? 2 : 1);
    const std::size_t start = end;
    while (end < text.size() && is_name_character(text[end])) ++end;
    const std::string variable(text.substr(start, end - start));
    if (const char* const value = std::getenv(variable.c_str())) name += value;
    at = braces && end < text.size() && text[end] == '}' ? end : end - 1;
  }
  return std::string(trimmed(name));
}

}  // namespace

/// Text to entries.
class IniParser {
 public:
  IniParser(IniFile& ini, const IniIncludes& includes, Diagnostics& diagnostics)
      : ini_(ini), includes_(includes), diagnostics_(diagnostics) {}

  void add_file(std::string_view text, const std::string& path, bool included);
  void finish();

 private:
  /// A line, or several that backslashes join.
  struct Logical {
    std::string text;
    int line = 0;
    std::size_t first_part = 0;  ///< bytes of `text` that stand in line `line`
    std::string excerpt;
    int parts = 0;
  };

  void add_physical(std::string_view line, Logical& logical, bool included);
  void add_logical(const Logical& logical);
  void add_section(std::string_view text, const Logical& logical, std::size_t at);
  void add_entry(std::string_view text, const Logical& logical, std::size_t at);
  void include(std::string_view name, std::string_view line);
  void report(Severity severity, std::size_t column, std::string_view line, std::string message,
              std::string hint = {});
  static int column_of(const Logical& logical, std::size_t at) {
    return at < logical.first_part ? static_cast<int>(at) + 1 : 0;
  }

  IniFile& ini_;
  const IniIncludes& includes_;
  Diagnostics& diagnostics_;
  std::uint32_t file_ = 0;
  int line_ = 0;
  bool takes_includes_ = false;
  bool warned_of_line_ends_ = false;
  bool in_section_ = false;
  bool shadowed_ = false;
  std::string section_;
  std::size_t unreported_ = 0;
  std::size_t reported_ = 0;
};

void IniParser::report(Severity severity, std::size_t column, std::string_view line,
                       std::string message, std::string hint) {
  if (++reported_ > kMaxDiagnostics) {
    ++unreported_;
    return;
  }
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = ini_.files_[file_];
  diagnostic.line = line_;
  diagnostic.column = static_cast<int>(column);
  diagnostic.message = std::move(message);
  diagnostic.excerpt = std::string(line.substr(0, kMaxLineBytes));
  diagnostic.hint = std::move(hint);
  diagnostics_.push_back(std::move(diagnostic));
}

void IniParser::finish() {
  if (unreported_ == 0) return;
  Diagnostic diagnostic;
  diagnostic.severity = Severity::kError;
  diagnostic.file = ini_.files_[0];
  diagnostic.message =
      fmt::format("{} more remarks about its lines; this is not an INI", unreported_);
  diagnostics_.push_back(std::move(diagnostic));
}

void IniParser::add_file(std::string_view text, const std::string& path, bool included) {
  const std::uint32_t outer_file = file_;
  const int outer_line = line_;
  file_ = static_cast<std::uint32_t>(ini_.files_.size());
  line_ = 0;
  ini_.files_.push_back(path);
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
    line_ = 1;
    report(Severity::kWarning, 1, {},
           "the file begins with a byte order mark; LinuxCNC does not understand its first line");
    line_ = 0;
  }
  if (!included) {
    takes_includes_ = text.starts_with(kIncludeWord) ||
                      text.find(std::string("\n").append(kIncludeWord)) != text.npos;
  }
  Logical logical;
  while (!text.empty()) {
    ++line_;
    const bool last = text.find('\n') == text.npos;
    const std::string_view line = take_line(text);
    if (included && last && !trimmed(line).empty()) {
      report(Severity::kWarning, 0, line,
             "an included file without a newline at its end; LinuxCNC adds a remark of its own to "
             "this line");
    }
    add_physical(line, logical, included);
  }
  if (logical.parts > 0) add_logical(logical);
  file_ = outer_file;
  line_ = outer_line;
}

void IniParser::add_physical(std::string_view line, Logical& logical, bool included) {
  if (line.find('\0') != line.npos) {
    report(Severity::kError, line.find('\0') + 1, line, "a byte of value 0; this is not text");
    return;
  }
  const std::string_view words = trimmed(line);
  const bool is_include =
      words.starts_with(kIncludeWord) && (words.size() == kIncludeWord.size() ||
                                          kBlanks.find(words[kIncludeWord.size()]) != kBlanks.npos);
  if (is_include && included) {
    report(Severity::kWarning, 1, line,
           "#INCLUDE within an included file; LinuxCNC goes one level deep and takes it for a "
           "comment");
  } else if (is_include && takes_includes_ && logical.parts == 0) {
    include(trimmed(words.substr(kIncludeWord.size())), line);
    return;
  }
  ini_.expanded_text_.append(line).push_back('\n');
  if (line.size() > kMaxLineBytes) {
    report(
        Severity::kWarning, kMaxLineBytes, line,
        fmt::format("a line of {} bytes; LinuxCNC reads the first {}", line.size(), kMaxLineBytes));
    line = line.substr(0, kMaxLineBytes);
  }
  if (!line.empty() && line.back() == '\r') {
    line.remove_suffix(1);
    if (!std::exchange(warned_of_line_ends_, true)) {
      report(Severity::kWarning, 0, {}, "the file has DOS line ends",
             "store it with Unix line ends");
    }
  }
  if (const std::size_t at = line.find('\r'); at != line.npos) {
    report(Severity::kError, at + 1, line, "a carriage return within a line; LinuxCNC stops here");
    return;
  }
  const bool continues = line.size() > 0 && line.back() == '\\';
  if (continues) line.remove_suffix(1);
  if (logical.parts == 0) {
    logical = Logical{std::string(line), line_, line.size(), std::string(line), 1};
  } else {
    logical.text += line;
    ++logical.parts;
  }
  if (continues && logical.parts <= kMaxContinuedLines) return;
  if (continues) {
    report(Severity::kError, 0, line,
           fmt::format("more than {} lines joined by backslashes", kMaxContinuedLines));
  } else {
    add_logical(logical);
  }
  logical = {};
}

void IniParser::include(std::string_view name, std::string_view line) {
  if (name.empty()) {
    report(Severity::kWarning, 1, line, "#INCLUDE names no file");
    return;
  }
  const std::string folder = std::filesystem::path(ini_.files_[0]).parent_path().string();
  const std::string path = resolve_ini_path(shell_expanded(name), folder);
  const Result<std::string> text = includes_(path);
  if (!text) {
    const std::size_t column = static_cast<std::size_t>(name.data() - line.data()) + 1;
    report(Severity::kWarning, column, line,
           fmt::format("#INCLUDE: {}; LinuxCNC goes on without it", text.error()));
    return;
  }
  add_file(*text, path, true);
}

void IniParser::add_logical(const Logical& logical) {
  const std::string_view text = logical.text;
  const std::size_t at = text.find_first_not_of(kBlanks);
  if (at == text.npos || text[at] == '#' || text[at] == ';') return;
  const int last_line = std::exchange(line_, logical.line);
  if (text[at] == '[') {
    add_section(text, logical, at);
  } else {
    add_entry(text, logical, at);
  }
  line_ = last_line;
}

void IniParser::add_section(std::string_view text, const Logical& logical, std::size_t at) {
  in_section_ = true;
  shadowed_ = false;
  section_.clear();
  const std::size_t end = text.find(']', at);
  if (end == text.npos) {
    shadowed_ = true;
    report(Severity::kWarning, at + 1, logical.excerpt,
           "the ] of the section is missing; LinuxCNC finds no section of this name");
    return;
  }
  section_ = std::string(text.substr(at + 1, end - at - 1));
  if (ini_.has_section(section_)) {
    shadowed_ = true;
    report(Severity::kWarning, at + 1, logical.excerpt,
           fmt::format("[{}] stands a second time; LinuxCNC reads the first only", section_));
    return;
  }
  ini_.sections_.push_back(section_);
}

void IniParser::add_entry(std::string_view text, const Logical& logical, std::size_t at) {
  const std::size_t equals = text.find('=', at);
  if (equals == text.npos) {
    report(Severity::kWarning, at + 1, logical.excerpt,
           "neither [SECTION] nor KEY = value; LinuxCNC passes over it");
    return;
  }
  if (!in_section_) {
    report(Severity::kWarning, at + 1, logical.excerpt,
           "a value before the first [SECTION]; LinuxCNC does not find it");
    return;
  }
  IniEntry entry;
  entry.section = section_;
  entry.key = std::string(text.substr(at, text.find_first_of(" \t\r=", at) - at));
  entry.value = std::string(trimmed(text.substr(equals + 1)));
  entry.file = file_;
  entry.line = logical.line;
  entry.key_column = column_of(logical, at);
  const std::size_t value_at = text.find_first_not_of(kBlanks, equals + 1);
  entry.value_column = column_of(logical, value_at == text.npos ? equals : value_at);
  entry.excerpt = logical.excerpt;
  entry.shadowed = shadowed_;
  ini_.entries_.push_back(std::move(entry));
}

IniFile IniFile::parse(std::string_view text, const std::string& path, const IniIncludes& includes,
                       Diagnostics& diagnostics) {
  IniFile ini;
  IniParser parser(ini, includes, diagnostics);
  parser.add_file(text, path, false);
  parser.finish();
  if (ini.files_.size() == 1) ini.expanded_text_.clear();
  return ini;
}

Result<IniFile> IniFile::read(const std::string& path, Diagnostics& diagnostics) {
  const Result<std::string> text = read_small_file(path, kMaxIniBytes);
  if (!text) return Error{text.error()};
  const IniIncludes includes = [](const std::string& name) {
    return read_small_file(name, kMaxIniBytes);
  };
  return parse(*text, path, includes, diagnostics);
}

const IniEntry* IniFile::find(std::string_view section, std::string_view key) {
  const std::vector<const IniEntry*> all = find_all(section, key);
  return all.empty() ? nullptr : all.front();
}

std::vector<const IniEntry*> IniFile::find_all(std::string_view section, std::string_view key) {
  std::vector<const IniEntry*> found;
  bool ended = false;
  for (IniEntry& entry : entries_) {
    if (entry.section != section || entry.key != key) continue;
    entry.asked = true;
    if (entry.shadowed) continue;
    ended = ended || entry.value.empty();
    if (!ended) found.push_back(&entry);
  }
  return found;
}

bool IniFile::has_section(std::string_view section) const {
  return std::find(sections_.begin(), sections_.end(), section) != sections_.end();
}

Result<std::string> read_small_file(const std::string& path, std::size_t max_bytes) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return Error{fmt::format("cannot read {}: {}", path, std::strerror(errno))};
  }
  if (!S_ISREG(status.st_mode)) {
    return Error{fmt::format("cannot read {}: it is not a regular file", path)};
  }
  TextPieces pieces(path);
  std::string text;
  std::string_view piece;
  while (pieces.next(piece)) {
    text += piece;
    if (text.size() > max_bytes) {
      return Error{
          fmt::format("cannot read {}: larger than {} MB", path, max_bytes / (1024 * 1024))};
    }
  }
  if (!pieces.error().empty()) return Error{pieces.error()};
  return text;
}

std::string resolve_ini_path(std::string_view path, const std::string& folder) {
  std::string expanded(path);
  if (path.starts_with("~/")) {
    if (const char* const home = std::getenv("HOME")) expanded = home + expanded.substr(1);
  }
  return (std::filesystem::path(folder) / expanded).lexically_normal().string();
}

}  // namespace kerf
