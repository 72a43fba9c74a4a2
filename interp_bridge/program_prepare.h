// interp_bridge/program_prepare.h - a copy of an NC program in which every line says its own
// number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// rs274 does not say which line a motion comes from, but it prints the N word of the line it has
/// read last. So the program is run from a copy with `N<line>` in place of the N words it had; a
/// called file's lines are numbered file * kLinesPerFile + line. The canonical listing stays the
/// same but for that column.
inline constexpr std::uint64_t kLinesPerFile = 100'000'000;

/// 2.9's rs274 accepts this many bytes before the newline; a line that would grow past it keeps its
/// text.
inline constexpr std::size_t kMaxLineBytes = 252;

SourceRef source_of_n(std::uint64_t n);

/// What the copy says ahead of a block that keeps something for later, of which rs274 prints
/// nothing (stores()). In its line or, where that has a comment, in one of its own with its number.
inline constexpr std::string_view kStoreComment = "kerf: stores";

/// Tools that a program asks for, by T, H and M61 Q words. A few more than it truly uses do no
/// harm.
struct NamedTools {
  std::set<int> numbers;
  bool computed = false;  ///< T#1, T[..]: any number may come
};

/// M66 words of a program's text, comments left out. Whether their blocks are run is not known.
struct InputWaits {
  SourceRef first;  ///< line 0: none
  std::size_t count = 0;
};

/// Numbers the lines of one file. Feed it the text in pieces that end at line ends (the last may
/// lack its newline).
class LineNumberer {
 public:
  explicit LineNumberer(std::uint32_t file);

  /// Appends the numbered text of `text` to `out`. Any bytes are accepted. About 30 ns a line.
  void append(std::string_view text, std::string& out);

  std::uint32_t lines() const { return line_ - 1; }
  /// Lines that could not be numbered (too long, or a number would change their meaning), in order.
  const std::vector<std::uint32_t>& unnumbered() const { return unnumbered_; }
  /// Lines of the copy that the text has not: each with a kStoreComment, and the number of the line
  /// behind it.
  std::uint32_t added() const { return added_; }
  /// Lower-case names of the subroutines that the file calls (o<name> call, M98 P) but does not
  /// define.
  std::set<std::string> missing_subroutines() const;
  const NamedTools& tools() const { return tools_; }
  const InputWaits& waits() const { return waits_; }

 private:
  bool number_line(std::string_view line, char*& out);
  void note_store(std::string_view line, std::string& out, std::size_t& used);
  void note_o_word(std::string_view after_o);
  void note_words(std::string_view text);
  void note_wait(std::string_view text, std::size_t at);
  void advance();

  std::uint32_t line_ = 1;
  std::uint32_t added_ = 0;
  std::string
      counter_;  ///< "N" and the number of the line, in text: counting up is cheaper than printing
  std::vector<std::uint32_t> unnumbered_;
  std::set<std::string> called_;
  std::set<std::string> defined_;
  NamedTools tools_;
  InputWaits waits_;
};

/// What the interpreter is given, and how to read its answers.
struct PreparedProgram {
  std::vector<std::string>
      files;              ///< [0] the program, then the files of called subroutines, as found
  std::string main_name;  ///< of the copy, in the folder
  std::size_t lines = 0;  ///< of files[0]
  std::vector<SourceRef> unnumbered;  ///< sorted by file and line
  NamedTools tools;
  InputWaits waits;
};

/// Writes numbered copies of `path` and of every file that it calls, directly or not (NAME.ngc
/// beside the program, else in the current folder; rs274 looks in its working folder), into
/// `folder`. Streams; 31 MB take about 0.07 s. Error: "cannot read part.ngc: ..." or "writing
/// /tmp/kerf-x/part.ngc: No space left on device".
Result<PreparedProgram> prepare_program(const std::string& path, const std::string& folder);

}  // namespace kerf
