#include "stock/zmap/mmap/gap_grid.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>

namespace kerf {

void GapTile::write(std::size_t cell, std::span<const Gap> gaps) {
  std::int32_t last = kNone;  // the nodes of the cell up to this one hold what they shall
  const auto link = [&]() -> std::int32_t& {
    return last == kNone ? first_[cell] : nodes_[index(last)].next;
  };
  for (const Gap& gap : gaps) {
    std::int32_t node = link();
    if (node == kNone) {
      node = free_;
      if (node == kNone) {
        node = static_cast<std::int32_t>(nodes_.size());
        nodes_.emplace_back();
      } else {
        free_ = nodes_[index(node)].next;
      }
      nodes_[index(node)].next = kNone;
      link() = node;
      ++count_;
    }
    nodes_[index(node)].gap = gap;
    below_mm_ = std::max(below_mm_, gap.high);
    last = node;
  }
  std::int32_t rest = link();
  link() = kNone;
  while (rest != kNone) {
    const std::int32_t next = nodes_[index(rest)].next;
    free_node(rest);
    rest = next;
  }
  set_top(cell);
}

Gap GapTile::pop(std::size_t cell) {
  const std::int32_t node = first_[cell];
  const Gap gap = nodes_[index(node)].gap;
  first_[cell] = nodes_[index(node)].next;
  free_node(node);
  set_top(cell);
  return gap;
}

bool GapTile::equals(const GapTile& other, bool ids) const {
  if (count_ != other.count_) return false;
  for (std::size_t cell = 0; cell < first_.size(); ++cell) {
    std::int32_t a = first_[cell], b = other.first_[cell];
    for (; a != kNone && b != kNone; a = nodes_[index(a)].next, b = other.nodes_[index(b)].next) {
      const Gap& x = nodes_[index(a)].gap;
      const Gap& y = other.nodes_[index(b)].gap;
      if (x.low != y.low || x.high != y.high) return false;
      if (ids && (x.low_id != y.low_id || x.high_id != y.high_id)) return false;
    }
    if (a != b) return false;
  }
  return true;
}

std::uint64_t GapTile::hash() const {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  for (std::uint32_t cell = 0; cell < first_.size(); ++cell) {
    each(cell, [&](const Gap& gap) {
      const float ends[2] = {gap.low + 0.0f, gap.high + 0.0f};  // -0 and 0 are the same height
      XXH3_64bits_update(&state, &cell, sizeof cell);
      XXH3_64bits_update(&state, ends, sizeof ends);
    });
  }
  return XXH3_64bits_digest(&state);
}

bool GapGrid::any() const {
  return std::any_of(tiles_.begin(), tiles_.end(), [](const auto& t) { return t != nullptr; });
}

GapTile& GapGrid::make_writable(std::size_t i) {
  std::shared_ptr<GapTile>& tile = tiles_[i];
  if (!tile) {
    tile = std::make_shared<GapTile>();
  } else if (tile.use_count() == 1) {
    meet_other_grids();
  } else {
    std::shared_ptr<GapTile> own = std::make_shared<GapTile>(*tile);
    meet_other_grids();
    tile = std::move(own);
  }
  return *tile;
}

void GapGrid::drop_if_empty(std::size_t i) {
  if (!tiles_[i] || !tiles_[i]->empty()) return;
  meet_other_grids();
  tiles_[i].reset();
}

std::size_t GapGrid::unique_bytes() const {
  std::size_t bytes = 0;
  for (const auto& tile : tiles_)
    if (tile && tile.use_count() == 1) bytes += tile->bytes();
  return bytes;
}

}  // namespace kerf
