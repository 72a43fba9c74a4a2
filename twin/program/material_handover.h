// twin/program/material_handover.h - the materials of a torch program, from the thread that reads
// it to the one that cuts.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "interp_bridge/torch_materials.h"

namespace kerf {

/// put() before the motions that name the materials are handed over, take() after they have come:
/// then none is missing. Rows are only ever added (MaterialTable).
class MaterialHandover {
 public:
  void put(const std::vector<TorchMaterial>& materials) {
    if (materials.size() == put_) return;
    put_ = materials.size();
    const std::lock_guard lock(mutex_);
    materials_ = materials;
  }
  /// True: `materials` has more of them now.
  bool take(std::vector<TorchMaterial>& materials) {
    const std::lock_guard lock(mutex_);
    if (materials_.size() == materials.size()) return false;
    materials = materials_;
    return true;
  }

 private:
  std::mutex mutex_;
  std::vector<TorchMaterial> materials_;
  std::size_t put_ = 0;  ///< by the reading thread alone
};

}  // namespace kerf
