// twin/optimize/nc_text.h - the text of an NC program, line by line: where its feed words are, and
// the same text with others in their place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace kerf {

/// What a line says that matters for its feed. Modes are those in force by the order of the text:
/// what loops and subroutines make of it is seen when it is run.
struct NcLine {
  std::string_view text;    ///< without its newline; a carriage return is in it
  bool is_control = false;  ///< begins with an O-word
  enum class Feed : std::uint8_t { kNone, kNumber, kComputed };
  Feed feed = Feed::kNone;                  ///< its F word
  double feed_number = 0;                   ///< in the unit of the line
  std::size_t feed_at = 0, feed_end = 0;    ///< bytes of that number
  std::size_t words_end = 0;                ///< behind its last word; 0: it has none
  bool is_spaced = true, is_lower = false;  ///< how words are written here
  bool is_inch = false;                     ///< G20
  bool inverse_time = false;                ///< G93
  bool per_turn = false;                    ///< G95
  bool is_synchronous = false;              ///< G33, G33.1, G74, G76, G84: the feed makes a thread
  /// Nothing but N, G1, X, Y, Z and F, plain numbers; G90, without G41 and G42: it can be divided.
  bool is_plain_line = false;
  bool names_g1 = false;
};

/// What becomes of a line.
struct NcEdit {
  std::string number;  ///< of its F word; empty: stays
  std::string before;  ///< whole lines ahead of it, each with its newline
};

class NcText {
 public:
  /// Error: "cannot read part.ngc: Permission denied". `inch`: the unit before any G20 or G21.
  static Result<NcText> read(const std::string& path, bool inch);
  /// Of text that is there already.
  NcText(std::string text, bool inch);
  NcText(const NcText&) = delete;
  NcText& operator=(const NcText&) = delete;
  NcText(NcText&&) = default;
  NcText& operator=(NcText&&) = default;

  std::span<const NcLine> lines() const { return lines_; }  ///< [0] is line 1
  const std::string& text() const { return *text_; }
  /// By the number of the line. Where it has an F word its number is changed, else one comes behind
  /// its last word, in the manner of the line. All else stays byte for byte.
  std::string with(const std::map<std::uint32_t, NcEdit>& edits) const;

 private:
  std::unique_ptr<const std::string> text_;  ///< lines_ point into it
  std::vector<NcLine> lines_;
};

/// At most so fast, as a person writes it: three digits, or whole ones where that is finer.
std::string feed_text(double feed);

}  // namespace kerf
