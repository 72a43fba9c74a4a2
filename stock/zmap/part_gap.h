// stock/zmap/part_gap.h - how near shank or holder come to the columns of a grid. Reads only.
#pragma once

#include <optional>

#include "stock/stock_model.h"
#include "stock/zmap/part_contact.h"
#include "stock/zmap/tile_grid.h"

namespace kerf {

/// StockModel::part_spare_mm(): by tiles, and closer than `enough_mm` by cells. Some ns for each
/// tile in reach that is high enough; where its cells are looked at, about 5 us.
double find_part_spare_mm(const TileGrid& grid, TileTops& tops, const CarriedPart& part,
                          const CutMove& move, double enough_mm, double most_mm);

/// StockModel::part_gap(): to the middles of cells, each as high as the move leaves it; of ramps
/// too little by up to 0.02 mm. Cost: as the bound; most of a ramp is passed over, its lowest parts
/// come first.
std::optional<PartGap> find_part_gap(const TileGrid& grid, TileTops& tops, const Cutter& cutter,
                                     const CarriedPart& part, const CutMove& move, double below_mm);

}  // namespace kerf
