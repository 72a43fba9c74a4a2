#include "stock/stock_model.h"

#include <fmt/format.h>

namespace kerf {

Done StockModel::save(const std::string& path) const {
  return Error{fmt::format("{}: a workpiece of the model {} cannot be saved; --stl keeps its shape",
                           path, name())};
}

}  // namespace kerf
