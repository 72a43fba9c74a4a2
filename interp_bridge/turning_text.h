// interp_bridge/turning_text.h - what a program's text says that only a lathe does.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

namespace kerf {

/// The first lines that hold what their names say; 0: none does. Of the program's own file, without
/// comments, and without the lines that begin with `/`.
struct TurningWords {
  std::uint32_t diameter_mode = 0;  ///< G7: X is a diameter
  std::uint32_t threading = 0;      ///< G76 behind a G18, the only plane in which it runs
  std::uint32_t contour_cycle = 0;  ///< G70, G71 or G72 with a Q (without: no cycle of LinuxCNC)
  std::uint32_t surface_speed = 0;  ///< G96
  std::uint32_t radius_mode = 0;    ///< G8: X is a radius, as it is anyway
  std::uint32_t feed_per_turn = 0;  ///< G95
  std::uint32_t thread = 0;         ///< G33 behind a G18
  std::uint32_t compensation = 0;   ///< G41, G42 behind a G18
  std::uint32_t plane_xz = 0;       ///< G18
  bool other_plane = false;         ///< G17, G19
  bool moves_y = false;             ///< a word Y
  bool whole = true;                ///< the text was looked through to its end
  std::set<int> tools;              ///< of T words that are numbers
  /// Nothing but X and Z is written, in the plane of a lathe.
  bool only_xz() const { return plane_xz != 0 && !other_plane && !moves_y && whole; }
};

/// Whether the line has X as a diameter from there on (G7) or as a radius (G8); none: it says
/// neither. Of lines that begin with `/` or `o` nothing.
std::optional<bool> diameter_word(std::string_view line);

/// Looks through text that comes in pieces of whole lines, as far as kMaxLines: a lathe's program
/// says early what it is.
class TurningScanner {
 public:
  static constexpr std::uint32_t kMaxLines = 20'000;

  /// Any bytes are accepted.
  void add(std::string_view text);
  TurningWords take() { return words_; }

 private:
  void add_line(std::string_view line);
  void note_code(int tenths, bool has_q);

  std::uint32_t line_ = 0;
  TurningWords words_;
};

}  // namespace kerf
