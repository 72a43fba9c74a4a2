// viewer/raycast/height_picture.h - the picture of a finished part that is heights.
#pragma once

#include <memory>

#include "surface/height_grid.h"
#include "viewer/picture.h"

namespace kerf {

/// What draw_part() draws of the workpiece's patches, drawn of its heights by rays on the CPU: the
/// same view, light, ambient occlusion, sharp edges, outline of the blank, axes and lettering. A
/// pixel is the mean of 2 x 2 rays; on an even surface, of the normals about one. Needs neither
/// OpenGL nor patches. The same pixels as those of draw_part() but for rounding, along edges, and
/// where cells are finer than pixels: draw_part() may join them. Same pixels for the same input on
/// every host of one build, for any number of threads (at least 1). About 1 s of processor time for
/// 1600 x 1200 pixels over 2000 x 2000 cells, shared by the threads. Error as draw_part(): if the
/// size is not allowed, and if the grid (not null) holds no material and the blank is empty.
Result<Picture> draw_heights(std::shared_ptr<const HeightGrid> grid, const PictureOptions& options,
                             int threads = 2);

}  // namespace kerf
