#include "stock/zmap/mmap/column_relief.h"

#include <algorithm>
#include <cmath>

namespace kerf {
namespace {

constexpr int kStride = TileRelief::kStride;
/// Cells beyond the tile whose links are needed: one for corners, one more for slopes.
constexpr int kLinked = 2;

/// Gaps sorted from the top downward, those that meet joined.
void join(std::vector<Gap>& gaps, std::vector<Gap>& out) {
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
    return a.high != b.high ? a.high > b.high : a.low > b.low;
  });
  out.clear();
  for (const Gap& gap : gaps) {
    if (out.empty() || gap.high < out.back().low) {
      out.push_back(gap);
    } else if (gap.low < out.back().low) {
      out.back().low = gap.low;
      out.back().low_id = gap.low_id;
    }
  }
}

}  // namespace

ColumnRelief::ColumnRelief(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile, int level)
    : level_(level),
      reach_(TileRelief::wall_reach(level)),
      relief_(grid, tile, level),
      cell_x_(static_cast<float>(grid.cell_x_mm() * (1 << level))),
      cell_y_(static_cast<float>(grid.cell_y_mm() * (1 << level))) {
  if (grid.keeps_cut_ids()) cut_ids_.emplace(grid, tile, level);
  const int tx = static_cast<int>(tile) % grid.tiles_x();
  const int ty = static_cast<int>(tile) / grid.tiles_x();
  const int span = 1 << level, per_tile = kTileCells / span;
  tile_begin_ = glm::ivec2(tx, ty) * kTileCells;
  grid_begin_ = -glm::ivec2(tx, ty) * per_tile;
  grid_end_ =
      grid_begin_ + glm::ivec2((grid.nx() + span - 1) / span, (grid.ny() + span - 1) / span);
  int filled = 0;  // slots before this one know where their faces begin
  const auto begin_slot = [&](int slot) {
    for (; filled <= slot; ++filled) first_[at(filled)] = static_cast<FaceIndex>(faces_.size());
  };
  for (int j = -reach_; j < ny() + reach_; ++j) {
    for (int i = -reach_; i < nx() + reach_; ++i) {
      begin_slot(TileRelief::slot(i, j));
      if (is_in_grid(i, j)) load(grid, gaps, i, j);
    }
  }
  begin_slot(TileRelief::kSlots);
  for (Links& links : links_) {
    links.next.assign(faces_.size(), kNone);
    links.before.assign(faces_.size(), kNone);
  }
  for (int j = -kLinked; j < ny() + kLinked; ++j) {
    for (int i = -kLinked; i < nx() + kLinked; ++i) {
      if (i + 1 < nx() + kLinked) link(TileRelief::slot(i, j), false);
      if (j + 1 < ny() + kLinked) link(TileRelief::slot(i, j), true);
    }
  }
}

void ColumnRelief::load(const TileGrid& grid, const GapGrid& gaps, int i, int j) {
  const int span = 1 << level_;
  const int i0 = tile_begin_.x + i * span, j0 = tile_begin_.y + j * span;
  const int i1 = std::min(grid.nx(), i0 + span), j1 = std::min(grid.ny(), j0 + span);
  float height = grid.height(i0, j0);
  std::uint32_t top_cut_by = MeshPatch::kNotCut;
  column_.clear();
  for (int y = j0; y < j1; ++y) {
    for (int x = i0; x < i1; ++x) {
      const float here = grid.height(x, y);
      if (cut_ids_ && (here < height || (x == i0 && y == j0))) top_cut_by = grid.cut_id(x, y);
      height = std::min(height, here);
      const std::size_t tile =
          static_cast<std::size_t>(y / kTileCells * grid.tiles_x() + x / kTileCells);
      if (const GapTile* const hollow = gaps.tile(tile))
        hollow->read(TileGrid::offset(x, y), column_);
    }
  }
  load_column(height, top_cut_by);
}

/// Of a cell with that height and the gaps in column_.
void ColumnRelief::load_column(float height, std::uint32_t top_cut_by) {
  const float floor = relief_.floor();
  if (!(height > floor)) return;
  join(column_, merged_);
  Face top{height, true, true, false, top_cut_by};
  bool has_material = true;
  const auto add_face = [&](const Face& face) { faces_.push_back(face); };
  const float whole = height;
  for (const Gap& gap : merged_) {
    if (gap.low >= top.z) continue;
    if (gap.high < top.z) {  // else the gap is open above: what is below it is the top
      add_face(top);
      add_face({gap.high, false, false, false, gap.high_id});
    }
    has_material = gap.low > floor;
    top = {gap.low, true, false, false, gap.low_id};
    if (!has_material) break;
  }
  if (!has_material) return;
  top.is_top = top.z == whole;
  add_face(top);
  add_face({floor, false, false, true, MeshPatch::kNotCut});
}

ColumnRelief::FaceIndex ColumnRelief::nearest(int cell, bool up, float z) const {
  FaceIndex best = kNone;
  for (FaceIndex f = first_face(cell); f < end_face(cell); ++f) {
    if (face(f).up != up || face(f).is_ground) continue;
    if (best == kNone || std::abs(face(f).z - z) < std::abs(face(best).z - z)) best = f;
  }
  return best;
}

/// As TileRelief finds it for heights, with the face beyond that continues the surface best.
bool ColumnRelief::is_smooth(int cell, bool in_y, FaceIndex a, FaceIndex b) const {
  const float edge = in_y ? cell_y_ : cell_x_;
  const int step = in_y ? kStride : 1;
  const float d = face(b).z - face(a).z;
  float before = 0, after = 0;
  if (const FaceIndex f = nearest(cell - step, face(a).up, face(a).z - d); f != kNone)
    before = face(a).z - face(f).z;
  if (const FaceIndex f = nearest(cell + 2 * step, face(b).up, face(b).z + d); f != kNone)
    after = face(f).z - face(b).z;
  return SurfaceSlopes::is_smooth(d, before, after, edge);
}

void ColumnRelief::link(int cell, bool in_y) {
  const int other = cell + (in_y ? kStride : 1);
  Links& links = links_[in_y ? 1 : 0];
  const auto join_faces = [&](FaceIndex a, FaceIndex b) {
    links.next[at(a)] = b;
    links.before[at(b)] = a;
  };
  const FaceIndex first = first_face(cell), end = end_face(cell);
  const FaceIndex other_first = first_face(other), other_end = end_face(other);
  if (first == end || other_first == other_end) return;
  if (face(end - 1).is_ground && face(other_end - 1).is_ground) join_faces(end - 1, other_end - 1);
  const bool tops = face(first).is_top && face(other_first).is_top;
  if (tops && (in_y ? relief_.linked_y(cell) : relief_.linked_x(cell)))
    join_faces(first, other_first);
  const auto crosses = [&](FaceIndex a, FaceIndex b) {
    for (FaceIndex f = first; f < end; ++f) {
      const FaceIndex g = links.next[at(f)];
      if (g != kNone && (f < a) != (g < b)) return true;
    }
    return false;
  };
  for (FaceIndex a = first; a < end; ++a) {
    if (face(a).is_ground || links.next[at(a)] != kNone) continue;
    const FaceIndex b = nearest(other, face(a).up, face(a).z);
    if (b == kNone || links.before[at(b)] != kNone) continue;
    if (face(a).is_top && face(b).is_top) continue;
    if (nearest(cell, face(b).up, face(b).z) != a || crosses(a, b)) continue;
    if (is_smooth(cell, in_y, a, b)) join_faces(a, b);
  }
}

glm::vec2 ColumnRelief::slope(FaceIndex f) const {
  const auto along = [&](bool in_y, float edge) {
    const FaceIndex low = before(f, in_y), high = next(f, in_y);
    const float rise = face(high == kNone ? f : high).z - face(low == kNone ? f : low).z;
    return rise / (low != kNone && high != kNone ? 2 * edge : edge);
  };
  return {along(false, cell_x_), along(true, cell_y_)};
}

bool ColumnRelief::is_solid(int i, int j, float z) const {
  const int cell = TileRelief::slot(i, j);
  for (FaceIndex f = first_face(cell); f < end_face(cell); f += 2)
    if (z <= face(f).z && z > face(f + 1).z) return true;
  return false;
}

std::uint32_t ColumnRelief::cut_by_below(int i, int j, float z) const {
  if (!cut_ids_ || !is_in_grid(i, j)) return MeshPatch::kNotCut;
  const int cell = TileRelief::slot(i, j);
  for (FaceIndex f = first_face(cell); f < end_face(cell); ++f)
    if (face(f).up && face(f).z <= z) return face(f).cut_by;
  return cut_ids_->of(cell);
}

}  // namespace kerf
