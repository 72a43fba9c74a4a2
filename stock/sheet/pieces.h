// stock/sheet/pieces.h - which parts of the sheet hold together, and what freed each of them.
//
// The outer rings of all tiles are the nodes of a graph; two of neighbouring tiles are joined where
// their material meets along the border for kMinBridge or more. A piece is what is connected.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stock/sheet/sheet_grid.h"

namespace kerf::sheet {

struct PieceRecord {
  std::uint32_t number = 0;  ///< stays with the piece
  /// The move that parted it from a larger piece; none for what the blank consisted of.
  std::optional<std::uint64_t> freed_by;
  Rect box;  ///< of what it was when it became a piece of its own; cutting may have made it smaller
};

/// Where a piece is in a grid, to find it again in an equal one.
struct PieceSeat {
  std::uint32_t tile = kNoPiece, ring = 0;  ///< one of its outer rings; kNoPiece: nothing is left
  Rect box;                                 ///< PieceRecord::box
  std::uint64_t freed_by = 0;               ///< of no meaning for pieces of the blank
};

/// Keeps the pieces of a grid (Tile::pieces are indices into records()) while it is cut.
///
/// After each cut only the rings that it broke and their former neighbours are looked at. If these
/// still hang together directly nothing has changed. Otherwise the sheet is searched from each
/// group of them at once, ring by ring in turn, until groups meet - beside the end of the cut as a
/// rule - or one has no more rings: that is a piece. So a piece costs what it is in tiles, and the
/// rest of the sheet is not walked.
class PieceLabels {
 public:
  /// Labels every ring of the grid.
  explicit PieceLabels(SheetGrid& grid);

  /// To be called after each move with the tiles that it changed.
  void update(SheetGrid& grid, std::span<const TileChange> changes, std::uint64_t move_id);

  const std::vector<PieceRecord>& records() const { return records_; }
  /// Pieces of the blank have the numbers below.
  std::uint32_t blank_pieces() const { return blank_pieces_; }

  /// By number. O(rings).
  std::vector<PieceSeat> seats(const SheetGrid& grid) const;
  /// Numbers the pieces of `grid`, all of which are new, as they were when `seats` was made. False
  /// if these are of another grid: then it is left half done.
  bool restore(SheetGrid& grid, std::span<const PieceSeat> seats, std::uint32_t blank_pieces);

 private:
  struct Node {
    std::uint32_t tile = 0, ring = 0;
    bool operator==(const Node&) const = default;
    auto operator<=>(const Node&) const = default;
  };
  struct Suspect {
    std::uint32_t piece;
    Node node;
    bool operator==(const Suspect&) const = default;
    auto operator<=>(const Suspect&) const = default;
  };
  class Search;

  static void append_neighbours(const SheetGrid& grid, std::size_t index, const Tile& tile,
                                std::uint32_t ring, std::vector<Node>& found);
  void check(SheetGrid& grid, std::uint32_t piece, std::span<const Suspect> suspects,
             std::uint64_t move_id);
  static Rect relabel(SheetGrid& grid, std::span<const Node> nodes, std::uint32_t piece);
  static Rect box_of_piece(const SheetGrid& grid, std::uint32_t piece, const Rect& within);

  std::vector<PieceRecord> records_;
  std::uint32_t blank_pieces_ = 0;
  std::vector<Suspect> suspects_;  // kept for its memory
};

}  // namespace kerf::sheet
