// stock/pieces/piece_map.h - which parts of a workpiece hang together, kept up to date while it is
// cut.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/geometry.h"
#include "stock/column_runs.h"

namespace kerf {

/// Pieces of a model that is read in columns. Runs of neighbouring columns (by a side or an edge)
/// hang together where they are side by side at some height. A tile is read again when it has
/// changed, about 50 us; beside that update() costs some ns a tile and a run at its border. Keeps
/// about 16 bytes a run. A copy may go its own way. One thread.
class PieceMap {
 public:
  struct Piece {
    std::uint32_t id = 0;  ///< stays with the piece
    double mm3 = 0;
    Box box_mm;
    bool thick = false;  ///< somewhere 2 x 2 columns, and ColumnLayout::thick_mm
    Vec3 inside_mm{0};   ///< the middle of its longest run
    double longest_mm = 0;
  };
  /// What was one piece.
  struct Parting {
    std::uint32_t parent = 0;
    std::vector<std::uint32_t> pieces;  ///< new ids
  };

  /// Reads what has changed. Material must only have become less. Gives what has been parted since
  /// the last call; of the first one, nothing.
  std::vector<Parting> update(const ColumnSource& source);
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Null: it is no more.
  const Piece* find(std::uint32_t id) const;
  /// The piece that has this point; nothing: it is no material.
  std::optional<std::uint32_t> piece_at(const Vec3& point_mm) const;

 private:
  static constexpr std::uint32_t kNone = 0xffff'ffff;
  static constexpr std::size_t kSides = 5;  ///< +x, +y, +x +y, -x +y, +z
  struct Part {
    double mm3 = 0;
    Box box_mm;
    bool thick = false;
    Vec3 inside_mm{0};
    double longest_mm = 0;
    std::uint32_t piece = kNone;
  };
  struct Tile {
    std::uint64_t version = 0;
    ColumnRuns columns;
    std::vector<std::uint32_t> part_of;  ///< by run
    std::vector<Part> parts;
    std::array<std::vector<std::pair<std::uint32_t, std::uint32_t>>, kSides> joints;
  };
  void label(std::uint32_t number, Tile& tile) const;
  void mark_thick(Tile& tile) const;
  void inherit(const Tile& before, Tile& tile) const;
  std::optional<std::uint32_t> beside(std::uint32_t tile, std::size_t side, int sign) const;
  void join(std::uint32_t tile, std::size_t side);
  std::vector<Parting> gather();

  ColumnLayout layout_;
  std::vector<Tile> tiles_;
  std::vector<Piece> pieces_;  ///< by ascending id
  std::uint32_t next_id_ = 0;
};

}  // namespace kerf
