// twin/process/sheet_checks.h - pieces of a sheet that have come free, for every process that cuts
// sheets.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/sheet/piece_origin.h"
#include "twin/machine/timeline.h"

namespace kerf {

class Sheet;

/// A piece that has been cut free, and what did it.
struct FreedPiece {
  std::uint32_t number = 0;  ///< SheetPiece::number
  SourceRef source;
  double time_s = 0;
  /// In its place, of a piece that was free already when the sheet was saved.
  std::optional<PieceOrigin> before;
};

/// Those of a sheet that has been loaded, by number from Sheet::blank_piece_numbers() on.
std::vector<FreedPiece> freed_before(const Sheet& sheet);
/// Appends what the motion has cut free. `uncut_pieces`: higher numbers have been cut free.
void note_freed(const Sheet& sheet, std::size_t uncut_pieces, const Motion& motion,
                const TimedStep& step, std::vector<FreedPiece>& freed);
/// "free since line 12", for messages; "free" where no line is known.
std::string free_since(const FreedPiece& piece);

}  // namespace kerf
