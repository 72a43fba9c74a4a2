#include "stock/stock_model.h"

#include <fmt/format.h>

#include "base/translate.h"

namespace kerf {

bool StockModel::pack(std::span<StockModel* const> /*copies*/, std::size_t /*at*/) const {
  return true;
}

std::size_t StockModel::kept_bytes(const StockModel& before, const StockModel* /*after*/) const {
  const std::size_t tiles = tile_count();
  const std::size_t tile_bytes =
      (cell_count() + tiles - 1) / tiles * sizeof(float) * (keeps_cut_ids() ? 2 : 1);
  return differing_tiles(before).size() * tile_bytes;
}

Done StockModel::save(const std::string& path) const {
  return Error{
      trf("{}: a workpiece of the model {} cannot be saved; --stl keeps its shape", path, name())};
}

}  // namespace kerf
