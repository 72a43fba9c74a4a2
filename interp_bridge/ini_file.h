// interp_bridge/ini_file.h - the text of a LinuxCNC INI: sections, keys and values with their
// places, read as LinuxCNC 2.9 reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/result.h"

namespace kerf {

/// One `KEY = value`.
struct IniEntry {
  std::string section;
  std::string key;
  std::string value;       ///< up to the end of the line: '#' and '"' are part of it
  std::uint32_t file = 0;  ///< indexes IniFile::files()
  int line = 0;            ///< 1-based; where its first byte stands, if lines are joined
  int key_column = 0;      ///< 1-based, in bytes
  int value_column = 0;    ///< 0 where the value stands in a line joined to it
  std::string excerpt;     ///< text of the line, for diagnostics
  /// In a section of which an earlier one has the name: LinuxCNC finds the first section only.
  bool shadowed = false;
  /// find() or find_all() came upon it, or a diagnostic tells of it already.
  bool asked = false;
};

/// The text of a file that an #INCLUDE names, or why there is none ("No such file or directory").
using IniIncludes = std::function<Result<std::string>(const std::string& path)>;

/// An INI, as a list of entries. What LinuxCNC 2.9 makes of the text (tried with its inivar):
///  - a comment is a line that begins with '#' or ';'; behind a value there are none
///  - names of sections and keys are case-sensitive; a key ends at a blank or '='
///  - quotation marks are part of the value; blanks at both of its ends are not
///  - a backslash as the last byte of a line (before a newline, and not before a carriage return)
///    joins the next one to it, 20 times at most, comments included; a section begins all the same
///  - of sections of one name the first counts, and of equal keys in it the first, where one value
///    is wanted; a key without a value, or without its '=', ends the search for it
///  - of a line 255 bytes are read; the next 255 are another line
///  - `#INCLUDE file` is replaced by the file, relative to the folder of the INI, if at least one
///    of them stands at the very start of a line; one level deep. The script that does so changes
///    the other lines of the INI as well: ini_include.h
/// What LinuxCNC passes over in silence (a line that is neither, a second section, an unreadable
/// include) is a warning here; what keeps it from reading on is an error, behind which the rest is
/// read all the same, for its own faults. So is an #INCLUDE that only a shell could follow.
class IniFile {
 public:
  /// Any bytes are accepted. The included files may have 1 MB in all. `path` names the text in
  /// diagnostics.
  static IniFile parse(std::string_view text, const std::string& path, const IniIncludes& includes,
                       Diagnostics& diagnostics);

  /// Error: "cannot read mill.ini: No such file or directory", "..: larger than 1 MB". Faults of
  /// the text are diagnostics.
  static Result<IniFile> read(const std::string& path, Diagnostics& diagnostics);

  /// What LinuxCNC takes for the key; null if there is none. Marks all entries of the key as asked
  /// for.
  const IniEntry* find(std::string_view section, std::string_view key);

  /// All entries of a key that may stand often (HALFILE, REMAP), in order.
  std::vector<const IniEntry*> find_all(std::string_view section, std::string_view key);

  bool has_section(std::string_view section) const;

  const std::vector<IniEntry>& entries() const { return entries_; }
  /// The INI itself, then what it includes.
  const std::vector<std::string>& files() const { return files_; }
  /// What LinuxCNC's own programs are given: the text with the includes in place. Empty where no
  /// #INCLUDE is followed; they are given the INI itself then.
  const std::string& expanded_text() const { return expanded_text_; }

 private:
  friend class IniParser;

  std::vector<IniEntry> entries_;
  std::vector<std::string> files_;
  std::vector<std::string> sections_;
  std::string expanded_text_;
};

/// `~/` becomes $HOME, as LinuxCNC expands the paths of its INI; a relative path becomes one in
/// `folder`. "." and ".." are worked out by text.
std::string resolve_ini_path(std::string_view path, const std::string& folder);

}  // namespace kerf
