#include "interp_bridge/ini_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <unordered_set>
#include <utility>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "interp_bridge/ini_include.h"

namespace kerf {
namespace {

// The INI and what it includes. An entry takes a hundred times the bytes of its line.
constexpr std::size_t kMaxIniBytes = 1024 * 1024;
constexpr std::size_t kMaxIniLineBytes = 255;  // LINELEN of LinuxCNC's inifile
constexpr int kMaxContinuedLines = 20;         // its MAX_EXTEND_LINES
constexpr std::size_t kMaxDiagnostics =
    50;  // of the text; a file that is no INI has no end of them
constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::string_view kIncludeWord = "#INCLUDE";

/// Blank, or a comment.
bool passes_over(std::string_view line) {
  const std::string_view words = trim(line);
  return words.empty() || words[0] == '#' || words[0] == ';';
}

bool is_include_line(std::string_view line) {
  return line.starts_with(kIncludeWord) &&
         (line.size() == kIncludeWord.size() ||
          kBlanks.find(line[kIncludeWord.size()]) != kBlanks.npos);
}

/// What a diagnostic shows of a line.
std::string excerpt_of(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return std::string(line.substr(0, kMaxIniLineBytes));
}

}  // namespace

/// Text to entries.
class IniParser {
 public:
  IniParser(IniFile& ini, const IniIncludes& includes, Diagnostics& diagnostics)
      : ini_(ini), includes_(includes), diagnostics_(diagnostics) {}

  void add_ini(std::string_view text, const std::string& path);
  void finish();

 private:
  /// A line of the text that LinuxCNC reads.
  struct Physical {
    std::string_view text;
    std::string_view excerpt;                   ///< the line as it stands in the file
    const std::vector<int>* columns = nullptr;  ///< of every byte; null: they count up from 1
    bool has_columns = true;
    bool has_newline = true;
  };

  /// A line, or several that backslashes join.
  struct Logical {
    std::string text;
    std::vector<int> columns;  ///< of the bytes of `text` that stand in line `line`
    std::uint32_t file = 0;
    int line = 0;
    std::string excerpt;
    int parts = 0;
  };

  void add_lines(std::string_view text);
  void add_shell_lines(std::string_view text);
  void add_included(std::string_view text, const std::string& path, const std::string& name);
  void begin_file(std::string_view text, const std::string& path);
  void add_remark(const std::string& text);
  void add_physical(const Physical& line);
  void add_part(Physical part);
  void append_part(const Physical& part);
  bool starts_section(std::string_view line) const;
  void add_logical(const Logical& logical);
  void add_section(std::string_view text, const Logical& logical, std::size_t at);
  void add_entry(std::string_view text, const Logical& logical, std::size_t at);
  void include(const ShellLine& line);
  void report(Severity severity, std::size_t column, std::string_view line, std::string message,
              std::string hint = {});
  static int column_of(const Logical& logical, std::size_t at) {
    return at < logical.columns.size() ? logical.columns[at] : 0;
  }

  IniFile& ini_;
  const IniIncludes& includes_;
  Diagnostics& diagnostics_;
  std::uint32_t file_ = 0;
  int line_ = 0;
  int shell_line_ = 0;
  std::size_t included_bytes_ = 0;
  bool warned_of_line_ends_ = false;
  bool in_section_ = false;
  bool shadowed_ = false;
  std::string section_;
  std::unordered_set<std::string> sections_;
  Logical logical_;
  std::size_t unreported_ = 0;
  std::size_t reported_ = 0;
  Severity worst_unreported_ = Severity::kNote;
};

void IniParser::report(Severity severity, std::size_t column, std::string_view line,
                       std::string message, std::string hint) {
  if (++reported_ > kMaxDiagnostics) {
    ++unreported_;
    worst_unreported_ = std::max(worst_unreported_, severity);
    return;
  }
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = ini_.files_[file_];
  diagnostic.line = line_;
  diagnostic.column = static_cast<int>(column);
  diagnostic.message = std::move(message);
  diagnostic.excerpt = excerpt_of(line);
  diagnostic.hint = std::move(hint);
  diagnostics_.push_back(std::move(diagnostic));
}

void IniParser::finish() {
  if (logical_.parts > 0 && !passes_over(logical_.text)) {
    line_ = logical_.line;
    report(Severity::kWarning, 0, logical_.excerpt,
           tr("a backslash joins the last line to nothing; LinuxCNC passes over it"));
  }
  if (unreported_ == 0) return;
  const bool is_ini = !ini_.sections_.empty();
  Diagnostic diagnostic;
  diagnostic.severity = is_ini ? worst_unreported_ : Severity::kError;
  diagnostic.file = ini_.files_[0];
  diagnostic.message = trf("{} more remarks about its lines{}", unreported_,
                           is_ini ? "" : tr("; this is not an INI"));
  diagnostics_.push_back(std::move(diagnostic));
}

void IniParser::begin_file(std::string_view text, const std::string& path) {
  file_ = static_cast<std::uint32_t>(ini_.files_.size());
  line_ = 0;
  ini_.files_.push_back(path);
  if (!text.starts_with(kByteOrderMark)) return;
  line_ = 1;
  report(Severity::kWarning, 1, {},
         tr("the file begins with a byte order mark; LinuxCNC does not understand its first line"),
         tr("store it without one"));
  line_ = 0;
}

void IniParser::add_ini(std::string_view text, const std::string& path) {
  begin_file(text, path);
  const bool takes_includes = text.starts_with(kIncludeWord) ||
                              text.find(std::string("\n").append(kIncludeWord)) != text.npos;
  if (takes_includes) return add_shell_lines(text);
  add_lines(text);
  ini_.expanded_text_.clear();  // the INI itself will do
}

void IniParser::add_lines(std::string_view text) {
  while (!text.empty()) {
    ++line_;
    const bool has_newline = text.find('\n') != text.npos;
    const std::string_view line = take_line(text);
    const std::size_t word = std::min(line.find_first_not_of(" \t"), line.size());
    if (is_include_line(line.substr(word))) {
      report(Severity::kWarning, word + 1, line,
             file_ == 0
                 ? tr("no #INCLUDE stands at the start of a line; LinuxCNC takes this one for a "
                      "comment")
                 : "#INCLUDE within an included file; LinuxCNC goes one level deep and takes "
                   "it for a comment");
    }
    add_physical({.text = line, .excerpt = line, .has_newline = has_newline});
  }
}

void IniParser::add_shell_lines(std::string_view text) {
  bool dos_line_ends = false;
  while (!text.empty()) {
    ShellLine line = take_shell_line(text);
    const int last_line = line_ + line.lines;
    ++line_;
    ++shell_line_;
    if (!line.complete) {
      report(Severity::kWarning, 0, line.raw,
             tr("the last line has no newline; LinuxCNC passes over it in an INI with #INCLUDE"));
    } else if (line.word() == kIncludeWord) {
      include(line);
    } else {
      // A blank comes behind it, and LinuxCNC takes such a carriage return for a damaged line.
      if (line.word().ends_with('\r') && line.rest().empty()) {
        line.text[line.word_bytes - 1] = ' ';
        if (!std::exchange(dos_line_ends, true)) {
          report(Severity::kError, 0, {},
                 tr("the file has DOS line ends; LinuxCNC stops here in an INI with #INCLUDE"),
                 tr("store it with Unix line ends"));
        }
      }
      add_physical({.text = line.text, .excerpt = line.raw, .columns = &line.columns});
    }
    line_ = last_line;
  }
}

/// A line that LinuxCNC puts in.
void IniParser::add_remark(const std::string& text) {
  add_physical({.text = text, .excerpt = {}, .has_columns = false});
}

void IniParser::include(const ShellLine& line) {
  std::string named;
  const auto complain = [&](Severity severity, std::size_t byte, const std::string& message) {
    report(severity, static_cast<std::size_t>(line.columns[byte]), line.raw, "#INCLUDE" + message);
    // A backslash at the end of the name joins the next line to this one.
    add_remark(fmt::format("# handle_includes(): <{}> CANNOT READ {}", shell_line_, named));
  };
  if (line.rest().empty()) return complain(Severity::kWarning, 0, tr(" names no file"));
  const std::size_t at = line.word_bytes + 1;
  const Result<std::string> name = shell_file_name(line.rest());
  if (!name) return complain(Severity::kError, at, ": " + name.error());
  named = *name;
  if (named.empty()) return complain(Severity::kWarning, at, tr(" names no file"));
  const std::string folder = std::filesystem::path(ini_.files_[0]).parent_path().string();
  const std::string path = resolve_ini_path(named, folder);
  const Result<std::string> text = includes_(path);
  if (!text) {
    return complain(Severity::kWarning, at, trf(": {}; LinuxCNC goes on without it", text.error()));
  }
  if (text->size() > kMaxIniBytes - included_bytes_) {
    return complain(Severity::kError, at,
                    trf(": with {}, the included files are larger than {} MB", path,
                        kMaxIniBytes / (1024 * 1024)));
  }
  included_bytes_ += text->size();
  add_included(*text, path, named);
}

void IniParser::add_included(std::string_view text, const std::string& path,
                             const std::string& name) {
  const std::uint32_t outer_file = file_;
  const int outer_line = line_;
  const std::string end = "#*** End   #INCLUDE file: " + name;
  add_remark("");
  add_remark("#*** Begin #INCLUDE file: " + name);
  begin_file(text, path);
  const std::size_t last = text.rfind('\n') + 1;  // 0 without a newline
  add_lines(text.substr(0, last));
  const std::string_view unended = text.substr(last);
  if (!unended.empty()) {
    ++line_;
    report(Severity::kWarning, 0, unended,
           tr("an included file without a newline at its end; LinuxCNC adds a remark of its own to "
              "this line"));
    add_physical({.text = std::string(unended) + end, .excerpt = unended});
  } else {
    add_remark(end);
  }
  file_ = outer_file;
  line_ = outer_line;
}

void IniParser::add_physical(const Physical& line) {
  if (const std::size_t at = line.text.find('\0'); at != line.text.npos) {
    const int column = line.columns != nullptr ? (*line.columns)[at] : static_cast<int>(at) + 1;
    report(Severity::kError, static_cast<std::size_t>(column), line.excerpt,
           tr("a byte of value 0; this is not text"));
    return;
  }
  ini_.expanded_text_.append(line.text);
  if (line.has_newline) ini_.expanded_text_.push_back('\n');
  if (line.text.size() > kMaxIniLineBytes) {
    report(Severity::kWarning, kMaxIniLineBytes, line.excerpt,
           trf("a line of {} bytes; LinuxCNC takes what follows the first {} for another",
               line.text.size(), kMaxIniLineBytes));
  }
  Physical part = line;
  for (std::string_view left = line.text; left.size() >= kMaxIniLineBytes;) {
    part.text = left.substr(0, kMaxIniLineBytes);
    part.has_newline = false;
    add_part(part);
    left.remove_prefix(kMaxIniLineBytes);
    part = {.text = left,
            .excerpt = line.excerpt,
            .has_columns = false,
            .has_newline = line.has_newline};
  }
  if (part.has_newline || !part.text.empty()) add_part(part);
}

void IniParser::add_part(Physical part) {
  const std::size_t carriage_return = part.text.find('\r');
  if (carriage_return != part.text.npos && carriage_return + 1 < part.text.size()) {
    report(Severity::kError, 0, part.excerpt,
           tr("a carriage return within a line; LinuxCNC stops here"));
    return;
  }
  if (carriage_return != part.text.npos && !std::exchange(warned_of_line_ends_, true)) {
    report(Severity::kWarning, 0, {}, tr("the file has DOS line ends"),
           tr("store it with Unix line ends"));
  }
  const bool joined = logical_.parts > 0;
  const std::size_t bytes = part.text.size();
  if (!part.has_newline && bytes > 0 && (joined || (bytes > 1 && part.text[bytes - 2] == '\\'))) {
    report(Severity::kWarning, 0, part.excerpt,
           tr("no newline behind a line that a backslash joins to another; LinuxCNC loses its last "
              "byte"));
    part.text.remove_suffix(1);
    part.has_newline = true;
  }
  // LinuxCNC looks for a section line by line, and joins those behind it only.
  const bool is_section = starts_section(part.text);
  const bool continues = part.has_newline && part.text.ends_with('\\') && !is_section;
  if (continues) part.text.remove_suffix(1);
  append_part(part);
  if (continues && logical_.parts <= kMaxContinuedLines) return;
  if (continues) {
    report(
        Severity::kError, 0, part.excerpt,
        trf("more than {} lines joined by backslashes; LinuxCNC stops here", kMaxContinuedLines));
  } else {
    add_logical(logical_);
  }
  const bool was_header = trim(logical_.text).starts_with('[');
  logical_ = {};
  if (!joined || !is_section || was_header) return;
  report(Severity::kWarning, 0, part.excerpt,
         tr("a backslash joins this section to the line before; LinuxCNC finds it all the same"));
  append_part(part);
  add_logical(logical_);
  logical_ = {};
}

/// A section that a backslash joins to the line before is found if it is the first of its name.
bool IniParser::starts_section(std::string_view line) const {
  const std::string_view words = trim(line);
  if (!words.starts_with('[')) return false;
  const std::size_t end = words.find(']');
  return trim(logical_.text).empty() ||
         (end != words.npos && sections_.count(std::string(words.substr(1, end - 1))) == 0);
}

void IniParser::append_part(const Physical& part) {
  if (trim(logical_.text).empty()) {
    // Nothing so far but blanks: what counts stands here.
    logical_.file = file_;
    logical_.line = line_;
    logical_.excerpt = excerpt_of(part.excerpt);
    logical_.columns.assign(logical_.text.size(), 0);
    for (std::size_t at = 0; part.has_columns && at < part.text.size(); ++at) {
      const int counted = static_cast<int>(at) + 1;
      logical_.columns.push_back(part.columns != nullptr ? (*part.columns)[at] : counted);
    }
  }
  logical_.text += part.text;
  ++logical_.parts;
}

void IniParser::add_logical(const Logical& logical) {
  const std::string_view text = logical.text;
  const std::size_t at = text.find_first_not_of(kBlanks);
  if (passes_over(text)) return;
  const std::uint32_t last_file = std::exchange(file_, logical.file);
  const int last_line = std::exchange(line_, logical.line);
  if (text[at] == '[') {
    add_section(text, logical, at);
  } else {
    add_entry(text, logical, at);
  }
  file_ = last_file;
  line_ = last_line;
}

void IniParser::add_section(std::string_view text, const Logical& logical, std::size_t at) {
  const auto column = static_cast<std::size_t>(column_of(logical, at));
  in_section_ = true;
  shadowed_ = true;
  section_.clear();
  const std::size_t end = text.find(']', at);
  if (end == text.npos) {
    report(Severity::kWarning, column, logical.excerpt,
           tr("the ] of the section is missing; LinuxCNC finds no section of this name"));
    return;
  }
  section_ = std::string(text.substr(at + 1, end - at - 1));
  if (!sections_.insert(section_).second) {
    report(Severity::kWarning, column, logical.excerpt,
           trf("[{}] stands a second time; LinuxCNC reads the first only", section_));
    return;
  }
  shadowed_ = false;
  ini_.sections_.push_back(section_);
}

void IniParser::add_entry(std::string_view text, const Logical& logical, std::size_t at) {
  const auto column = static_cast<std::size_t>(column_of(logical, at));
  const std::size_t equals = text.find('=', at);
  const std::size_t key_end = text.find_first_of(" \t\r=", at);
  IniEntry entry;
  entry.key = std::string(text.substr(at, key_end - at));
  if (!in_section_ || (equals == text.npos && key_end == text.npos)) {
    if (logical.line == 1 && text.starts_with(kByteOrderMark)) return;  // warned of
    report(Severity::kWarning, column, logical.excerpt,
           equals == text.npos
               ? tr("neither [SECTION] nor KEY = value; LinuxCNC passes over it")
               : tr("a value before the first [SECTION]; LinuxCNC does not find it"));
    return;
  }
  if (equals == text.npos) {
    report(Severity::kWarning, column, logical.excerpt,
           trf("neither [SECTION] nor KEY = value; LinuxCNC looks for no {} behind it", entry.key));
  } else {
    entry.value = std::string(trim(text.substr(equals + 1)));
    const std::size_t value_at = text.find_first_not_of(kBlanks, equals + 1);
    entry.value_column = column_of(logical, value_at == text.npos ? equals : value_at);
  }
  entry.section = section_;
  entry.file = file_;
  entry.line = logical.line;
  entry.key_column = column_of(logical, at);
  entry.excerpt = logical.excerpt;
  entry.shadowed = shadowed_;
  entry.asked = equals == text.npos;
  ini_.entries_.push_back(std::move(entry));
}

IniFile IniFile::parse(std::string_view text, const std::string& path, const IniIncludes& includes,
                       Diagnostics& diagnostics) {
  IniFile ini;
  IniParser parser(ini, includes, diagnostics);
  parser.add_ini(text, path);
  parser.finish();
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

std::string resolve_ini_path(std::string_view path, const std::string& folder) {
  std::string expanded(path);
  if (path.starts_with("~/")) {
    if (const char* const home = std::getenv("HOME")) expanded = home + expanded.substr(1);
  }
  return (std::filesystem::path(folder) / expanded).lexically_normal().string();
}

}  // namespace kerf
