// stock/sheet/piece_origin.h - what freed a piece of a sheet, in a run before.
#pragma once

#include <cstdint>
#include <string>

namespace kerf {

/// A line of a program.
struct PieceOrigin {
  std::string file;
  std::uint32_t line = 0;  ///< 0: not known
  bool operator==(const PieceOrigin&) const = default;
};

}  // namespace kerf
