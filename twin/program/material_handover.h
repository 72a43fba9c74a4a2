// twin/program/material_handover.h - what a program gathers as it is read (materials of a torch,
// names of files), from the thread that reads it to the one that cuts.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "interp_bridge/torch_materials.h"

namespace kerf {

/// put() before the motions that name the rows are handed over, take() after they have come: then
/// none is missing. Rows are only ever added (MaterialTable, Program::files()).
template <class Row>
class RowHandover {
 public:
  void put(const std::vector<Row>& rows) {
    if (rows.size() == put_) return;
    put_ = rows.size();
    const std::lock_guard lock(mutex_);
    rows_ = rows;
  }
  /// True: `rows` has more of them now.
  bool take(std::vector<Row>& rows) {
    const std::lock_guard lock(mutex_);
    if (rows_.size() == rows.size()) return false;
    rows = rows_;
    return true;
  }

 private:
  std::mutex mutex_;
  std::vector<Row> rows_;
  std::size_t put_ = 0;  ///< by the reading thread alone
};
using MaterialHandover = RowHandover<TorchMaterial>;
using FileHandover = RowHandover<std::string>;

}  // namespace kerf
