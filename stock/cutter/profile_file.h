// stock/cutter/profile_file.h - a cutter's outline as a text file, for `profile:FILE`.
//
//     # Corner-rounding cutter      '#' starts a comment; blank lines are skipped
//     line 4 0                      straight to radius 4, height 0 (mm from the axis and the tip)
//     arc  7 3  3 cw                arc to radius 7, height 3 with radius 3
//     line 8 3
//     flute  12                     optional: flute length, mm above the tip
//     shank  10x25                  optional: shank diameter, or diameter x length
//     holder 32x20+40x25            optional: sections upward, diameter x length
//
//     upper                         optional: what follows is the upper side of a head, from its
//     line 3 4                      widest point in to the neck: the radius never rises
//
// The outline starts on the axis at R0 Z0 and runs outward: the radius never falls. `ccw` and `cw`
// are as seen with R to the right and Z up: a ball nose is `arc 5 5 5 ccw`, a hollow is cw. Of the
// two arcs the shorter one is meant. A first line `start 0 Z` begins the outline higher, for a
// hollow bottom; the lowest point must lie at Z0. Keywords in any letter case, numbers are plain
// decimals.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/holder_library.h"

namespace kerf {

struct ProfileFile {
  std::vector<ProfilePiece> pieces;
  std::vector<ProfilePiece> upper_pieces;           ///< Cutter::upper_profile()
  std::optional<std::string> flute, shank, holder;  ///< as written
};

/// Reads the text of a profile file. Error: "NAME:LINE: what was found and what is allowed".
Result<ProfileFile> parse_profile_text(std::string_view text, const std::string& name);

/// The same from a file of at most kMaxProfileBytes. Only regular files are read.
Result<ProfileFile> read_profile_file(const std::string& path);

/// The outline of a holder, from the middle of its nose up: `line R Z` alone, Z from the nose up
/// and never falling; the radius may rise and fall.
///     line 14 0                     the nose, 28 mm wide
///     line 14 20                    a cylinder
///     line 20 30                    a cone
Result<std::vector<HolderSection>> parse_holder_profile(std::string_view text,
                                                        const std::string& name);
Result<std::vector<HolderSection>> read_holder_profile(const std::string& path);

inline constexpr std::size_t kMaxProfileBytes = 1 << 20;
inline constexpr std::size_t kMaxProfilePieces = 1000;

}  // namespace kerf
