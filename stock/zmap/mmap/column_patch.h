// stock/zmap/mmap/column_patch.h - the surface of one tile of columns with gaps, for a view.
#pragma once

#include <cstdint>
#include <optional>

#include "base/mesh_patch.h"
#include "stock/zmap/mmap/gap_grid.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// Whether the tile or one of its eight neighbours has gaps.
bool gaps_near(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile);

/// make_tile_patch() for columns with gaps: tops, floors and ceilings of gaps, and walls between
/// cells where one has material and the next has none.
///
///   ________         A surface of a cell (top; ceiling, floor of a gap) is one square with corners
///  |  top   |        at the mean heights of those surfaces about each corner that are smoothly
///  |________| ceil.  linked. Tops are linked as make_tile_patch() does it, and have its corners
///           |        where nothing but tops meets, so that the patches of both fit together. The
///   ________|        floor of a gap is linked to the top beside it that goes on level (where the
///  |  floor of gap   gap opens), floors to floors and ceilings to ceilings. Between surfaces that
///  |________         are not linked stands a wall at the border of the cells; corners of walls are
///                    moved to the walls' course as there, also below a top that is level about
///                    them.
///
/// A cell of level n is as low as the lowest of its cells, and hollow where any of them is. A wall
/// belongs to the tile that has the material. Over all tiles of one level each edge is in two
/// triangles, once in each direction; in four where pieces of material touch at an edge only.
MeshPatch make_column_patch(const TileGrid& grid, const GapGrid& gaps, std::uint32_t tile,
                            int level);

/// Number of the move that made the ceiling or the floor of a gap at a point on it, to half a cell
/// of height; none where no end of a gap is near.
std::optional<std::uint32_t> gap_id_at(const TileGrid& grid, const GapGrid& gaps,
                                       const Vec3& point_mm);

}  // namespace kerf
