// interp_bridge/source_text.h - reading program text: in pieces, one line of it, its comments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/program.h"
#include "interp_bridge/torch_setup.h"
#include "interp_bridge/turning_text.h"

namespace kerf {

/// A text file in pieces of whole lines, so that a program of any length needs 0.25 MB. A line
/// longer than that comes in parts.
class TextPieces {
 public:
  explicit TextPieces(const std::string& path);
  TextPieces(const TextPieces&) = delete;
  TextPieces& operator=(const TextPieces&) = delete;
  ~TextPieces();

  /// The next piece, valid until the next call. False at the end or on error.
  bool next(std::string_view& piece);
  /// Empty, or "cannot read part.ngc: Permission denied".
  const std::string& error() const { return error_; }

 private:
  void fill();

  std::string path_;
  int fd_;
  std::string buffer_;
  std::size_t filled_ = 0;
  std::size_t given_ = 0;  ///< bytes of buffer_ handed out by the last next()
  bool at_end_ = false;
  std::string error_;
};

/// Line `line` (1-based) of a file, without its newline and cut to 200 bytes; empty if there is
/// none.
std::string line_of_file(const std::string& path, std::uint32_t line);

/// What one look through the whole text tells.
struct TextSurvey {
  std::size_t lines = 0;
  std::size_t bytes = 0;
  bool blank = true;         ///< nothing but white space
  std::size_t nul_line = 0;  ///< first line with a NUL byte, 0 = none
  bool listing = false;      ///< canonical text rather than NC code
  std::vector<ProgramComment> comments;
  TorchText torch;       ///< NC code only
  TurningWords turning;  ///< likewise
};

/// Surveys text that comes in pieces of whole lines. Comments: (..) and ;.. of NC code,
/// COMMENT("..") of a listing; all of the first 2000 lines, and of the rest those in a line with an
/// M6 and those that speak of a tool, stock or workpiece (at most 1000, so that memory does not
/// grow with the program).
class TextSurveyor {
 public:
  /// `listing`: known to be one by its name.
  explicit TextSurveyor(bool listing = false) { survey_.listing = listing; }
  void add(std::string_view text);
  const TextSurvey& survey() const { return survey_; }
  TextSurvey take();

 private:
  void decide_kind(std::string_view text);
  void add_lines(std::string_view text);
  void add_later_lines(std::string_view text);
  void add_comments(std::string_view line, std::uint32_t number, bool only_hints);

  TextSurvey survey_;
  TorchTextScanner torch_;
  TurningScanner turning_;
  std::size_t nonblank_lines_ = 0;
  std::size_t later_comments_ = 0;
};

}  // namespace kerf
