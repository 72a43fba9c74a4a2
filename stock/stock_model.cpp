#include "stock/stock_model.h"

#include <fmt/format.h>

#include "base/translate.h"

namespace kerf {

Done StockModel::save(const std::string& path) const {
  return Error{
      trf("{}: a workpiece of the model {} cannot be saved; --stl keeps its shape", path, name())};
}

}  // namespace kerf
