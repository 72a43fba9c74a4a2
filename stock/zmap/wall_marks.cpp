#include "stock/zmap/wall_marks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "surface/height_grid.h"

namespace kerf {
namespace {

struct Cell {
  int i, j;
};

Cell neighbour(const Cell& cell, CellWay way) {
  switch (way) {
    case CellWay::kRight:
      return {cell.i + 1, cell.j};
    case CellWay::kLeft:
      return {cell.i - 1, cell.j};
    case CellWay::kUp:
      return {cell.i, cell.j + 1};
    case CellWay::kDown:
      break;
  }
  return {cell.i, cell.j - 1};
}

/// Of the cell at `offset` of a tile: TileGrid::offset() the other way round.
Cell cell_at(const TileGrid& grid, std::size_t tile, std::size_t offset) {
  const int block = static_cast<int>(offset) / kBlockFloats,
            within = static_cast<int>(offset) % kBlockFloats;
  const int tx = static_cast<int>(tile) % grid.tiles_x(),
            ty = static_cast<int>(tile) / grid.tiles_x();
  return {tx * kTileCells + block % kTileBlocksX * kBlockX + within % kBlockX,
          ty * kTileCells + block / kTileBlocksX * kBlockY + within / kBlockX};
}

bool is_in(const TileGrid& grid, const Cell& cell) {
  return cell.i >= 0 && cell.j >= 0 && cell.i < grid.nx() && cell.j < grid.ny();
}

/// In the order of ways, from the deepest up, the farthest first.
std::uint64_t rank(const WallMark& mark) {
  const auto bits = std::bit_cast<std::uint32_t>(mark.foot_mm);
  const std::uint32_t rising = (bits >> 31) != 0 ? ~bits : bits | 0x8000'0000u;
  return std::uint64_t{mark.cell} << 48 | std::uint64_t{rising} << 16 | (255u - mark.reach);
}
constexpr auto is_before = [](const WallMark& a, const WallMark& b) { return rank(a) < rank(b); };

/// Leaves those that count.
void drop_idle(const TileGrid& grid, std::size_t tile, std::vector<WallMark>& marks) {
  if (!std::is_sorted(marks.begin(), marks.end(), is_before))
    std::sort(marks.begin(), marks.end(), is_before);
  std::size_t kept = 0;
  for (std::size_t n = 0; n < marks.size();) {
    const std::uint16_t way = marks[n].cell;
    const Cell next = neighbour(cell_at(grid, tile, marks[n].offset()), marks[n].way());
    const float top = is_in(grid, next) ? grid.height(next.i, next.j) : grid.floor_mm();
    int reach = -1;
    for (; n < marks.size() && marks[n].cell == way; ++n) {
      if (marks[n].reach <= reach || marks[n].foot_mm >= top) continue;
      reach = marks[n].reach;
      marks[kept++] = marks[n];
    }
  }
  marks.resize(kept);
}

/// Which neighbours are one smooth surface.
class Smoothness {
 public:
  Smoothness(const TileGrid& grid, WallKind kind)
      : grid_(grid),
        edge_(static_cast<float>(std::max(grid.cell_x_mm(), grid.cell_y_mm()))),
        kind_(kind) {}
  bool is_smooth(const Cell& a, int axis) const {
    const Cell b = along(a, axis, 1);
    if (is_solid(a) != is_solid(b)) return false;
    const float step = rise(a, axis), before = rise(along(a, axis, -1), axis),
                after = rise(b, axis);
    if (kind_ == WallKind::kSharp) return SurfaceSlopes::is_smooth(step, before, after, edge_);
    const float goes_on = std::max(step * before, step * after);
    return std::abs(step) <= SurfaceSlopes::kFlank * edge_ &&
           step * step <= SurfaceSlopes::kMostSteepening * goes_on;
  }

 private:
  static Cell along(const Cell& a, int axis, int steps) {
    return axis == 0 ? Cell{a.i + steps, a.j} : Cell{a.i, a.j + steps};
  }
  bool is_solid(const Cell& a) const { return grid_.height(a.i, a.j) > grid_.floor_mm(); }
  float rise(const Cell& a, int axis) const {
    const Cell b = along(a, axis, 1);
    if (!is_in(grid_, a) || !is_in(grid_, b) || !is_solid(a) || !is_solid(b)) return 0;
    return grid_.height(b.i, b.j) - grid_.height(a.i, a.j);
  }
  const TileGrid& grid_;
  float edge_;
  WallKind kind_;
};

/// Of the marks of one way the one behind which most of the material is missing.
const WallMark& widest(const WallMark* first, const WallMark* last, float low, float high) {
  const auto area = [&](const WallMark& m) { return m.part() * (high - std::max(low, m.foot_mm)); };
  const WallMark* best = first;
  for (const WallMark* m = first + 1; m < last; ++m)
    if (area(*m) > area(*best)) best = m;
  return *best;
}

}  // namespace

std::uint64_t WallMarks::next_owner() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

WallMarks::WallMarks(const WallMarks& other) : tiles_(other.tiles_) {
  other.owner_.store(next_owner(), std::memory_order_relaxed);
}

WallMarks::Tile& WallMarks::writable(std::size_t index) {
  std::shared_ptr<Tile>& tile = tiles_[index];
  const std::uint64_t owner = owner_.load(std::memory_order_relaxed);
  if (!tile)
    tile = std::make_shared<Tile>();
  else if (tile->owner != owner)
    tile = std::make_shared<Tile>(*tile);
  tile->owner = owner;
  return *tile;
}

void WallMarks::add(std::size_t index, const WallMark& mark, const TileGrid& grid) {
  Tile& tile = writable(index);
  tile.marks.push_back(mark);
  tile.is_settled = false;
  if (tile.marks.size() < tile.drop_at) return;
  drop_idle(grid, index, tile.marks);
  tile.drop_at = std::max(kLeastDrop, 2 * tile.marks.size());
}

void WallMarks::settle(const TileGrid& grid) {
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    if (!tiles_[index] || tiles_[index]->is_settled) continue;
    Tile& tile = writable(index);
    drop_idle(grid, index, tile.marks);
    if (tile.marks.capacity() > 2 * tile.marks.size()) tile.marks.shrink_to_fit();
    tile.drop_at = std::max(kLeastDrop, 2 * tile.marks.size());
    tile.is_settled = true;
  }
}

std::vector<WallMark> WallMarks::marks(std::size_t tile, const TileGrid& grid) const {
  if (!has_marks(tile)) return {};
  std::vector<WallMark> out = tiles_[tile]->marks;
  drop_idle(grid, tile, out);
  return out;
}

bool WallMarks::any() const {
  return std::any_of(tiles_.begin(), tiles_.end(),
                     [](const auto& tile) { return tile != nullptr; });
}

std::size_t WallMarks::unique_bytes() const {
  std::size_t bytes = 0;
  for (const std::shared_ptr<Tile>& tile : tiles_)
    if (tile && tile.use_count() == 1)
      bytes += sizeof(Tile) + tile->marks.capacity() * sizeof(WallMark);
  return bytes;
}

bool is_sound(const WallMark& mark, std::size_t tile, const TileGrid& grid) {
  if (mark.cell >> WallMark::kWayShift > 3 || mark.none != 0) return false;
  if (!std::isfinite(mark.foot_mm) || mark.foot_mm < grid.floor_mm()) return false;
  const Cell cell = cell_at(grid, tile, mark.offset());
  return is_in(grid, cell) && is_in(grid, neighbour(cell, mark.way()));
}

std::vector<CellStep> cell_steps(const TileGrid& grid, const WallMarks& table, WallKind kind) {
  const Smoothness smoothness(grid, kind);
  std::vector<CellStep> steps;
  for (std::size_t tile = 0; tile < grid.tile_count(); ++tile) {
    const std::vector<WallMark> marks = table.marks(tile, grid);
    const WallMark* const end = marks.data() + marks.size();
    for (const WallMark* first = marks.data(); first < end;) {
      const WallMark* last = first;
      while (last < end && last->cell == first->cell) ++last;
      const Cell from = cell_at(grid, tile, first->offset());
      const Cell to = neighbour(from, first->way());
      const float low = grid.height(from.i, from.j), high = grid.height(to.i, to.j);
      const bool is_back = first->way() == CellWay::kLeft || first->way() == CellWay::kDown;
      const int axis = first->way() == CellWay::kUp || first->way() == CellWay::kDown ? 1 : 0;
      const Cell& start = is_back ? to : from;
      if (low < high && !smoothness.is_smooth(start, axis)) {
        const WallMark& mark = widest(first, last, low, high);
        steps.push_back({start.i, start.j, static_cast<std::int8_t>(axis),
                         is_back ? 1 - mark.part() : mark.part(), std::max(low, mark.foot_mm)});
      }
      first = last;
    }
  }
  std::sort(steps.begin(), steps.end(), [](const CellStep& a, const CellStep& b) {
    if (a.j != b.j) return a.j < b.j;
    return a.i != b.i ? a.i < b.i : a.axis < b.axis;
  });
  return steps;
}

}  // namespace kerf
