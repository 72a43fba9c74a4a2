// interp_bridge/ini_include.h - the lines of an INI with #INCLUDEs, as the shell script that starts
// LinuxCNC passes them on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace kerf {

/// One line of such an INI. LinuxCNC's script reads it with `read word rest` and writes it with
/// `echo "$word $rest"`; in between
///  - a backslash goes and the byte behind it stays, also if it is a blank; at the end of a line it
///    joins the next one, any number of them
///  - blanks go at both ends, and become one behind the first word, of which one is left even where
///    there is no second
///  - a last line without a newline is lost
/// A carriage return is no blank. Tried with bash 5.2.
struct ShellLine {
  std::string text;          ///< what is written, without its newline
  std::vector<int> columns;  ///< of every byte of `text`: 1-based; 0 beyond the first joined line
  std::string_view raw;      ///< the first of the joined lines, as it stands in the file
  std::size_t word_bytes = 0;
  int lines = 0;          ///< lines of the file
  bool complete = false;  ///< ends with a newline

  std::string_view word() const { return std::string_view(text).substr(0, word_bytes); }
  std::string_view rest() const { return std::string_view(text).substr(word_bytes + 1); }
};

/// The first line of `text`, which is taken off it. O(bytes taken).
ShellLine take_shell_line(std::string_view& text);

/// The file that the words behind #INCLUDE name, as `eval echo` has it: quotes and backslashes go,
/// $NAME and ${NAME} become values of the environment (nothing where there is none), blanks become
/// one, '#' begins a comment. Error, for what only a shell works out (patterns, commands, an open
/// quote): "the shell gives '*' a meaning that is not followed here". A ~ is left alone.
Result<std::string> shell_file_name(std::string_view words);

}  // namespace kerf
