#include "stock/sheet/sheet_grid.h"

#include <algorithm>

namespace kerf::sheet {
namespace {

/// Corner `i` of `count` equal parts of low .. high.
Unit part(Unit low, Unit high, int i, int count) {
  return low + (high - low) / count * i + (high - low) % count * i / count;
}

/// The part of low .. high that holds `at`, which lies within.
int part_of(Unit low, Unit high, Unit at, int count) {
  const double share = static_cast<double>(at - low) / static_cast<double>(high - low);
  int i = std::clamp(static_cast<int>(share * count), 0, count - 1);
  while (i > 0 && at < part(low, high, i, count)) --i;
  while (i + 1 < count && at >= part(low, high, i + 1, count)) ++i;
  return i;
}

Ring ring_of(const Rect& rect) {
  return {{rect.min_x, rect.min_y},
          {rect.max_x, rect.min_y},
          {rect.max_x, rect.max_y},
          {rect.min_x, rect.max_y}};
}

/// The rings as far as they matter within `rect`. Returns a box round their edges there.
Rect shorten_rings(const Rings& rings, const Rect& rect, Rings& shortened) {
  Rect edges;
  shortened.resize(rings.size());
  std::size_t kept = 0;
  for (const Ring& ring : rings) {
    shorten_beyond(ring, rect, shortened[kept], edges);
    if (shortened[kept].size() >= 3) ++kept;
  }
  shortened.resize(kept);
  return edges;
}

bool is_outline_of(const Ring& ring, const Rect& rect) {
  return ring.size() == 4 && bounds_of(ring).min_x == rect.min_x &&
         twice_area(ring) == twice_area(ring_of(rect));
}

}  // namespace

SheetGrid::SheetGrid(const Rings& outline, int columns, int rows) : columns_(columns), rows_(rows) {
  for (const Ring& ring : outline) bounds_.extend(bounds_of(ring));
  const bool plain = outline.size() == 1 && is_outline_of(outline[0], bounds_);
  const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  tiles_.reserve(count);
  Rings clipped, cut;
  for (std::size_t i = 0; i < count; ++i) {
    const Rect rect = tile_rect(i);
    std::vector<TileRingPointer> rings;
    if (plain) {
      rings.push_back(make_tile_ring(ring_of(rect)));
    } else if (shorten_rings(outline, rect, clipped).empty()) {
      if (winding_number(clipped, {rect.min_x, rect.min_y}) != 0)
        rings.push_back(make_tile_ring(ring_of(rect)));
    } else {
      ClipperLib::Clipper clipper;
      clipper.AddPaths(clipped, ClipperLib::ptSubject, true);
      clipper.AddPath(ring_of(rect), ClipperLib::ptClip, true);
      clipper.Execute(ClipperLib::ctIntersection, cut, ClipperLib::pftNonZero,
                      ClipperLib::pftNonZero);
      for (Ring& ring : cut) rings.push_back(make_tile_ring(std::move(ring)));
    }
    tiles_.push_back(std::make_shared<Tile>(make_tile(rect, std::move(rings))));
    area2_ += tiles_.back()->area2;
  }
}

SheetGrid::SheetGrid(const Rect& bounds, int columns, int rows)
    : bounds_(bounds), columns_(columns), rows_(rows) {
  const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  tiles_.assign(count, std::make_shared<Tile>(make_tile({}, {})));
}

void SheetGrid::set_rings(std::size_t index, std::vector<Ring> rings) {
  std::vector<TileRingPointer> shared;
  shared.reserve(rings.size());
  for (Ring& ring : rings) shared.push_back(make_tile_ring(std::move(ring)));
  tiles_[index] = std::make_shared<Tile>(make_tile(tile_rect(index), std::move(shared)));
  area2_ += tiles_[index]->area2;
}

Rect SheetGrid::tile_rect(std::size_t index) const {
  const int column = static_cast<int>(index) % columns_, row = static_cast<int>(index) / columns_;
  return {part(bounds_.min_x, bounds_.max_x, column, columns_),
          part(bounds_.min_y, bounds_.max_y, row, rows_),
          part(bounds_.min_x, bounds_.max_x, column + 1, columns_),
          part(bounds_.min_y, bounds_.max_y, row + 1, rows_)};
}

std::int64_t SheetGrid::neighbour(std::size_t index, BorderSide side) const {
  return neighbours(index)[side];
}

std::array<std::int64_t, 4> SheetGrid::neighbours(std::size_t index) const {
  const auto at = static_cast<std::int64_t>(index);
  const int column = static_cast<int>(index) % columns_, row = static_cast<int>(index) / columns_;
  std::array<std::int64_t, 4> next;
  next[kLeft] = column > 0 ? at - 1 : -1;
  next[kBottom] = row > 0 ? at - columns_ : -1;
  next[kRight] = column + 1 < columns_ ? at + 1 : -1;
  next[kTop] = row + 1 < rows_ ? at + columns_ : -1;
  return next;
}

SheetGrid::TileRange SheetGrid::tiles_meeting(const Rect& rect) const {
  if (!rect.meets(bounds_) || rect.empty()) return {0, -1, 0, -1};
  const auto column = [&](Unit x) {
    return part_of(bounds_.min_x, bounds_.max_x, std::clamp(x, bounds_.min_x, bounds_.max_x),
                   columns_);
  };
  const auto row = [&](Unit y) {
    return part_of(bounds_.min_y, bounds_.max_y, std::clamp(y, bounds_.min_y, bounds_.max_y),
                   rows_);
  };
  return {column(rect.min_x), column(rect.max_x), row(rect.min_y), row(rect.max_y)};
}

void SheetGrid::subtract(const Kerf& kerf, std::vector<TileChange>& changes) {
  if (kerf.rings.empty()) return;
  const TileRange range = tiles_meeting(kerf.box);
  for (int row = range.first_row; row <= range.last_row; ++row) {
    // Once for the row: what its tiles have to look at is then short.
    const std::size_t first = index_of(range.first_column, row);
    const std::size_t last = index_of(range.last_column, row);
    Rect band = tile_rect(first);
    band.extend(tile_rect(last));
    shorten_rings(kerf.rings, band, row_rings_);
    for (std::size_t index = first; index <= last; ++index) {
      if (!tiles_[index]->rings.empty()) subtract_from_tile(index, row_rings_, kerf.plain, changes);
    }
  }
}

void SheetGrid::subtract_from_tile(std::size_t index, const Rings& kerf, bool plain,
                                   std::vector<TileChange>& changes) {
  const Rect rect = tile_rect(index);
  const Rect edges = shorten_rings(kerf, rect, shortened_);
  if (edges.empty() && winding_number(shortened_, {rect.min_x, rect.min_y}) == 0) return;
  const Tile& tile = *tiles_[index];
  subject_.clear();
  subject_rings_.clear();
  for (std::uint32_t i = 0; i < tile.rings.size(); ++i) {
    const TileRing& ring = *tile.rings[i];
    if (!ring.box.meets(edges)) continue;
    subject_.push_back(&ring.points);
    subject_rings_.push_back(i);
  }
  bool by_crossings = false;
  if (!subject_.empty()) {
    ++operations_;
    by_crossings = plain && difference_.subtract(subject_, shortened_, rect);
    if (!by_crossings) subtract_by_library();
  }
  std::vector<TileRingPointer> rings, again;
  rings.reserve(tile.rings.size() + 4);
  std::vector<std::uint32_t> pieces;
  TileChange change;
  for (std::uint32_t i = 0, at = 0; i < tile.rings.size(); ++i) {
    const bool took_part = at < subject_rings_.size() && subject_rings_[at] == i;
    bool stays = false;
    if (took_part) {
      stays = by_crossings && difference_.untouched()[at];
      ++at;
      // It may have lost a piece from its inside.
      if (stays && difference_.has_fresh_outer()) {
        again.push_back(tile.rings[i]);
        stays = false;
      }
    } else {
      stays = winding_number(shortened_, tile.rings[i]->points[0]) == 0;
    }
    if (stays) {
      rings.push_back(tile.rings[i]);
      pieces.push_back(tile.pieces[i]);
    } else {
      change.gone.push_back(i);
    }
  }
  change.first_new = static_cast<std::uint32_t>(rings.size());
  for (TileRingPointer& ring : again) rings.push_back(std::move(ring));
  if (!subject_.empty()) {
    for (Ring& points : by_crossings ? difference_.fresh() : result_) {
      TileRingPointer ring = make_tile_ring(std::move(points));
      if (std::abs(ring->area2) >= kMinArea2) rings.push_back(std::move(ring));
    }
  }
  if (change.gone.empty() && rings.size() == tile.rings.size()) return;
  Tile next = make_tile(rect, std::move(rings));
  if (next.area2 >= tile.area2) return;  // met nothing, but for rounding
  std::copy(pieces.begin(), pieces.end(), next.pieces.begin());
  for (std::size_t i = change.first_new; i < next.rings.size(); ++i) {
    if (next.rings[i]->is_outer())
      next.pieces[i] = tile.pieces[origin_of(next.rings[i]->points, tile, change.gone)];
  }
  replace(index, std::move(next), std::move(change), changes);
}

void SheetGrid::subtract_by_library() {
  ClipperLib::Clipper clipper;
  for (const Ring* const ring : subject_) clipper.AddPath(*ring, ClipperLib::ptSubject, true);
  clipper.AddPaths(shortened_, ClipperLib::ptClip, true);
  clipper.Execute(ClipperLib::ctDifference, result_, ClipperLib::pftNonZero,
                  ClipperLib::pftNonZero);
}

void SheetGrid::replace(std::size_t index, Tile tile, TileChange change,
                        std::vector<TileChange>& changes) {
  area2_ += tile.area2 - tiles_[index]->area2;
  change.tile = static_cast<std::uint32_t>(index);
  change.before = std::move(tiles_[index]);
  tiles_[index] = std::make_shared<Tile>(std::move(tile));
  changes.push_back(std::move(change));
}

std::vector<std::uint32_t>& SheetGrid::pieces(std::size_t index) {
  std::shared_ptr<Tile>& tile = tiles_[index];
  if (is_shared(index)) {
    tile = std::make_shared<Tile>(*tile);
  } else {
    // use_count() alone does not order the last reads of a grid that has let go of the tile before
    // the writes of this one: letting go of it as well does.
    std::shared_ptr<Tile>(tile).reset();
  }
  return tile->pieces;
}

std::size_t SheetGrid::corner_count() const {
  std::size_t corners = 0;
  for (const std::shared_ptr<Tile>& tile : tiles_) {
    for (const TileRingPointer& ring : tile->rings) corners += ring->points.size();
  }
  return corners;
}

}  // namespace kerf::sheet
