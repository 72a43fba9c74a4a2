#include "stock/sheet/pieces.h"

#include <algorithm>
#include <numeric>

namespace kerf::sheet {
namespace {

double box_area(const Rect& box) { return width_mm(box) * height_mm(box); }

/// Reaches one of the sides of the outer box.
bool reaches_out(const Rect& inner, const Rect& outer) {
  return inner.min_x <= outer.min_x || inner.min_y <= outer.min_y || inner.max_x >= outer.max_x ||
         inner.max_y >= outer.max_y;
}

/// Numbers by key, in one piece of memory.
class FlatTable {
 public:
  /// The number that the key has; `fresh` if it had none so far.
  std::uint32_t find_or_add(std::uint64_t key, std::uint32_t fresh, bool& is_new) {
    if (2 * (count_ + 1) > entries_.size()) grow();
    Entry& entry = entries_[place(key)];
    is_new = entry.key == kFree;
    if (is_new) {
      entry = {key, fresh};
      ++count_;
    }
    return entry.number;
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Entry {
    std::uint64_t key = kFree;
    std::uint32_t number = 0;
  };

  std::size_t place(std::uint64_t key) const {
    const std::size_t mask = entries_.size() - 1;
    // Keys are pairs of small numbers: multiplied they spread over the upper half.
    std::size_t at = (key * 0x9e37'79b9'7f4a'7c15u) >> 32 & mask;
    while (entries_[at].key != kFree && entries_[at].key != key) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Entry> former(std::max<std::size_t>(64, 2 * entries_.size()));
    former.swap(entries_);
    for (const Entry& entry : former) {
      if (entry.key != kFree) entries_[place(entry.key)] = entry;
    }
  }

  std::vector<Entry> entries_;
  std::size_t count_ = 0;
};

}  // namespace

/// Several groups of nodes that grow until they meet or are complete.
class PieceLabels::Search {
 public:
  Search(const SheetGrid& grid, std::span<const Suspect> suspects) : grid_(grid) {
    for (const Suspect& suspect : suspects) {
      const auto group = static_cast<std::uint32_t>(groups_.size());
      bool is_new = false;
      group_of_.find_or_add(key(suspect.node), group, is_new);
      if (is_new) groups_.push_back({group, {suspect.node}, 0});
    }
    open_ = groups_.size();
  }

  /// The complete groups: all but one of them, if the last one was not walked to its end.
  std::vector<std::vector<Node>> run() {
    std::vector<std::vector<Node>> complete;
    std::vector<std::uint32_t> growing(groups_.size());
    std::iota(growing.begin(), growing.end(), 0u);
    while (open_ > 1) {
      for (std::size_t i = 0; i < growing.size() && open_ > 1; ++i) {
        Group& group = groups_[growing[i]];
        if (group.parent != growing[i]) continue;
        if (group.next == group.nodes.size()) {
          group.done = true;
          --open_;
          complete.push_back(std::move(group.nodes));
        } else {
          expand(growing[i]);
        }
      }
      std::erase_if(growing,
                    [this](std::uint32_t g) { return groups_[g].parent != g || groups_[g].done; });
    }
    return complete;
  }

 private:
  struct Group {
    std::uint32_t parent;
    std::vector<Node> nodes;  // from `next` on not expanded yet
    std::size_t next;
    bool done = false;
  };
  static std::uint64_t key(const Node& node) {
    return static_cast<std::uint64_t>(node.tile) << 32 | node.ring;
  }
  std::uint32_t root(std::uint32_t g) const {
    while (groups_[g].parent != g) g = groups_[g].parent;
    return g;
  }

  void expand(std::uint32_t g) {
    const Node node = groups_[g].nodes[groups_[g].next++];
    neighbours_.clear();
    append_neighbours(grid_, node.tile, grid_.tile(node.tile), node.ring, neighbours_);
    for (const Node& other : neighbours_) {
      bool is_new = false;
      const std::uint32_t group = group_of_.find_or_add(key(other), g, is_new);
      if (is_new) {
        groups_[root(g)].nodes.push_back(other);
      } else {
        join(root(g), root(group));
      }
    }
  }

  /// What is expanded comes first, so that one index divides the nodes.
  void join(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    if (groups_[a].nodes.size() < groups_[b].nodes.size()) std::swap(a, b);
    Group &to = groups_[a], &from = groups_[b];
    to.nodes.insert(to.nodes.end(), from.nodes.begin() + static_cast<std::ptrdiff_t>(from.next),
                    from.nodes.end());
    to.nodes.insert(to.nodes.begin() + static_cast<std::ptrdiff_t>(to.next), from.nodes.begin(),
                    from.nodes.begin() + static_cast<std::ptrdiff_t>(from.next));
    to.next += from.next;
    from.parent = a;
    from.nodes.clear();
    --open_;
  }

  const SheetGrid& grid_;
  std::vector<Group> groups_;
  FlatTable group_of_;
  std::vector<Node> neighbours_;
  std::size_t open_ = 0;
};

PieceLabels::PieceLabels(SheetGrid& grid) {
  std::vector<std::vector<std::uint32_t>> pieces(grid.tile_count());
  for (std::size_t t = 0; t < pieces.size(); ++t)
    pieces[t].assign(grid.tile(t).rings.size(), kNoPiece);
  std::vector<Node> stack, neighbours;
  for (std::uint32_t t = 0; t < pieces.size(); ++t) {
    for (std::uint32_t ring = 0; ring < pieces[t].size(); ++ring) {
      if (pieces[t][ring] != kNoPiece || !grid.tile(t).rings[ring]->is_outer()) continue;
      const auto piece = static_cast<std::uint32_t>(records_.size());
      PieceRecord& record = records_.emplace_back();
      record.number = piece;
      pieces[t][ring] = piece;
      stack.push_back({t, ring});
      while (!stack.empty()) {
        const Node node = stack.back();
        stack.pop_back();
        record.box.extend(grid.tile(node.tile).rings[node.ring]->box);
        neighbours.clear();
        append_neighbours(grid, node.tile, grid.tile(node.tile), node.ring, neighbours);
        for (const Node& other : neighbours) {
          if (pieces[other.tile][other.ring] != kNoPiece) continue;
          pieces[other.tile][other.ring] = piece;
          stack.push_back(other);
        }
      }
    }
  }
  for (std::size_t t = 0; t < pieces.size(); ++t) grid.pieces(t) = std::move(pieces[t]);
  blank_pieces_ = static_cast<std::uint32_t>(records_.size());
}

std::vector<PieceSeat> PieceLabels::seats(const SheetGrid& grid) const {
  std::vector<PieceSeat> seats(records_.size());
  for (std::uint32_t t = 0; t < grid.tile_count(); ++t) {
    const Tile& tile = grid.tile(t);
    for (std::uint32_t ring = 0; ring < tile.rings.size(); ++ring) {
      if (tile.pieces[ring] == kNoPiece) continue;
      const PieceRecord& record = records_[tile.pieces[ring]];
      PieceSeat& seat = seats[record.number];
      if (seat.tile == kNoPiece) seat = {t, ring, record.box, record.freed_by.value_or(0)};
    }
  }
  return seats;
}

bool PieceLabels::restore(SheetGrid& grid, std::span<const PieceSeat> seats,
                          std::uint32_t blank_pieces) {
  if (blank_pieces > seats.size()) return false;
  std::vector<PieceRecord> records(seats.size());
  std::vector<std::uint32_t> number_of(records_.size(), kNoPiece);
  for (std::uint32_t number = 0; number < seats.size(); ++number) {
    const PieceSeat& seat = seats[number];
    records[number] = {number, std::nullopt, seat.box};
    if (number >= blank_pieces) records[number].freed_by = seat.freed_by;
    if (seat.tile == kNoPiece) continue;
    if (seat.tile >= grid.tile_count() || seat.ring >= grid.tile(seat.tile).rings.size())
      return false;
    const std::uint32_t piece = grid.tile(seat.tile).pieces[seat.ring];
    if (piece == kNoPiece || number_of[piece] != kNoPiece) return false;
    const Rect& box = records_[piece].box;
    if (!seat.box.holds({box.min_x, box.min_y}) || !seat.box.holds({box.max_x, box.max_y}))
      return false;
    number_of[piece] = number;
  }
  if (std::find(number_of.begin(), number_of.end(), kNoPiece) != number_of.end()) return false;
  for (std::size_t t = 0; t < grid.tile_count(); ++t) {
    for (std::uint32_t& piece : grid.pieces(t)) {
      if (piece != kNoPiece) piece = number_of[piece];
    }
  }
  records_ = std::move(records);
  blank_pieces_ = blank_pieces;
  return true;
}

void PieceLabels::append_neighbours(const SheetGrid& grid, std::size_t index, const Tile& tile,
                                    std::uint32_t ring, std::vector<Node>& found) {
  const std::array<std::int64_t, 4> beyond = grid.neighbours(index);
  for (const BorderRun& run : tile.runs) {
    const std::int64_t next = beyond[run.side];
    if (run.ring != ring || next < 0) continue;
    const auto opposite = static_cast<BorderSide>((run.side + 2) % 4);
    const std::span<const BorderRun> others =
        runs_of(grid.tile(static_cast<std::size_t>(next)), opposite);
    for (const BorderRun& other : others) {
      if (other.low >= run.high) break;
      if (bridges(run, other)) found.push_back({static_cast<std::uint32_t>(next), other.ring});
    }
  }
}

void PieceLabels::update(SheetGrid& grid, std::span<const TileChange> changes,
                         std::uint64_t move_id) {
  suspects_.clear();
  std::vector<Node> neighbours;
  for (const TileChange& change : changes) {
    const Tile& before = *change.before;
    const Tile& after = grid.tile(change.tile);
    for (std::uint32_t ring = change.first_new; ring < after.rings.size(); ++ring) {
      if (after.rings[ring]->is_outer())
        suspects_.push_back({after.pieces[ring], {change.tile, ring}});
    }
    for (const std::uint32_t ring : change.gone) {
      if (!before.rings[ring]->is_outer()) continue;
      neighbours.clear();
      append_neighbours(grid, change.tile, before, ring, neighbours);
      for (const Node& node : neighbours) suspects_.push_back({before.pieces[ring], node});
    }
  }
  std::sort(suspects_.begin(), suspects_.end());
  suspects_.erase(std::unique(suspects_.begin(), suspects_.end()), suspects_.end());
  for (std::size_t begin = 0; begin < suspects_.size();) {
    std::size_t end = begin + 1;
    while (end < suspects_.size() && suspects_[end].piece == suspects_[begin].piece) ++end;
    check(grid, suspects_[begin].piece, std::span(suspects_).subspan(begin, end - begin), move_id);
    begin = end;
  }
}

void PieceLabels::check(SheetGrid& grid, std::uint32_t piece, std::span<const Suspect> suspects,
                        std::uint64_t move_id) {
  if (suspects.size() < 2) return;
  bool reaches = false;
  const std::size_t first = records_.size();
  for (const std::vector<Node>& nodes : Search(grid, suspects).run()) {
    const auto fresh = static_cast<std::uint32_t>(records_.size());
    records_.push_back({fresh, move_id, relabel(grid, nodes, fresh)});
    reaches |= reaches_out(records_.back().box, records_[piece].box);
  }
  if (!reaches) return;
  // What has the largest box goes on as the piece that it was: a frame round a part cut out of it,
  // as well as the larger half of a sheet that is cut in two.
  PieceRecord& rest = records_[piece];
  rest.box = box_of_piece(grid, piece, rest.box);
  PieceRecord* largest = &rest;
  for (std::size_t i = first; i < records_.size(); ++i) {
    if (box_area(records_[i].box) > box_area(largest->box)) largest = &records_[i];
  }
  std::swap(rest.freed_by, largest->freed_by);
  std::swap(rest.number, largest->number);
}

Rect PieceLabels::relabel(SheetGrid& grid, std::span<const Node> nodes, std::uint32_t piece) {
  Rect box;
  for (const Node& node : nodes) {
    grid.pieces(node.tile)[node.ring] = piece;
    box.extend(grid.tile(node.tile).rings[node.ring]->box);
  }
  return box;
}

/// From each side of `within` inward, up to the first row or column of tiles with some of it.
Rect PieceLabels::box_of_piece(const SheetGrid& grid, std::uint32_t piece, const Rect& within) {
  const SheetGrid::TileRange all = grid.tiles_meeting(within);
  Rect box;
  const auto add = [&](const SheetGrid::TileRange& range) {
    bool found = false;
    for (int row = range.first_row; row <= range.last_row; ++row) {
      for (int column = range.first_column; column <= range.last_column; ++column) {
        const Tile& tile = grid.tile(grid.index_of(column, row));
        for (std::size_t ring = 0; ring < tile.rings.size(); ++ring) {
          if (tile.pieces[ring] != piece) continue;
          box.extend(tile.rings[ring]->box);
          found = true;
        }
      }
    }
    return found;
  };
  const auto add_column = [&](int i) { return add({i, i, all.first_row, all.last_row}); };
  const auto add_row = [&](int i) { return add({all.first_column, all.last_column, i, i}); };
  for (int i = all.first_column; i <= all.last_column && !add_column(i);) ++i;
  for (int i = all.last_column; i >= all.first_column && !add_column(i);) --i;
  for (int i = all.first_row; i <= all.last_row && !add_row(i);) ++i;
  for (int i = all.last_row; i >= all.first_row && !add_row(i);) --i;
  return box;
}

}  // namespace kerf::sheet
