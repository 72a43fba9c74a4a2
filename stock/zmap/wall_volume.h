// stock/zmap/wall_volume.h - how much material there is between the middles of cells and the walls.
#pragma once

#include "stock/zmap/tile_grid.h"
#include "stock/zmap/wall_marks.h"

namespace kerf {

/// By how much there is more material than volume_of(grid) has, which gives each cell the height of
/// its middle; negative where walls leave less. Each wall (WallKind::kAll) counts from its foot to
/// the higher side, where the mesh has it (height_mesh_steps.h), round ones as arcs. The rest is as
/// the middles have it: floors, sides that lean or are round in section, walls of which there is no
/// mark, webs that are thinner than a cell.
///
/// On level floors this makes it the volume of the mesh, but for the arcs. Beside steep flanks it
/// is nearer to the true one than the mesh's, which joins middles and feet by straight lines.
///
/// 0 for a grid that is one cell wide. Memory: 20 bytes a wall and some 100 kB. Time: about a
/// microsecond a wall.
double wall_volume_mm3(const TileGrid& grid, const WallMarks& marks);

}  // namespace kerf
