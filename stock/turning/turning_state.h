// stock/turning/turning_state.h - a turned part on disk: kerf-state/1 (stock/state_bytes.h).
//
//   model turning
//   layout 1
//   chuck side             0: the chuck holds low z, 1: high z
//   blank z0 r0 z1 r1      units of 10 nm (grid.h), as all that follows but mm3 and mm
//   blank_mm3 volume       of the uncut blank
//   flats count radius_mm  of a bar; 0 0: it is round
//   data
// Then sections, each of four letters, its version, 32 bits, and the number of its bytes, 64 bits:
//   PART 1   the number of contours, 32 bits, and of each the number of its corners, 32 bits, and
//            these, z then r, 32 bits each, signed: the first contour round the material, the
//            others round holes in it
//   THRD 1   grooves that wind (thread_pass.h), where there are some: their number, 32 bits, and of
//            each its id, 64 bits, from z r, to z r, lead, turns, low and high r, doubles, and the
//            number of its corners, 32 bits, and these, doubles
//   FREE 1   what has come off, where something has: its number, 32 bits, and of each piece the id
//            of the move that set it free, 64 bits, and twice a number of bytes, 64 bits, and
//            these: as in PART, and as in THRD, of which there are none where no groove winds on it
// Which moves have made the surface is not kept (their numbers mean something in their run alone),
// nor where a tool stands.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "stock/turning/turned_part.h"

namespace kerf::turning {

/// What has come off.
struct SavedPiece {
  std::uint64_t freed_by = 0;
  std::vector<Contour> contours;
  std::vector<std::shared_ptr<const ThreadPass>> threads;
};

struct SavedPart {
  ChuckSide chuck = ChuckSide::kLowZ;
  Rect blank;
  double blank_mm3 = 0;
  std::optional<BarFlats> flats;
  std::vector<Contour> contours;
  std::vector<std::shared_ptr<const ThreadPass>> threads;
  std::vector<SavedPiece> pieces;
};

Done write_part(const std::string& path, const SavedPart& saved);
/// The whole file in memory.
std::string bytes_of_part(const SavedPart& saved);

/// From a file's bytes; `name` is used in messages. What comes back can be cut and meshed whatever
/// the bytes were: corners lie within the blank, there is one piece, holes lie within its box, and
/// there is no more than the blank had, with all that has come off. Errors say what is wrong; of a
/// section that a later version has written, which. Allocates in proportion to the bytes.
Result<SavedPart> parse_part(const std::string& bytes, const std::string& name);

}  // namespace kerf::turning
