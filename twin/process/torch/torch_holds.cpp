#include "twin/process/torch/torch_holds.h"

#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"

namespace kerf {

void TorchHolds::set_materials(std::span<const TorchMaterial> materials) {
  materials_.assign(materials.begin(), materials.end());
}

/// The machine holds its motion from M3 on, and a dwell that follows goes on meanwhile.
MotionHold TorchHolds::of(const Motion& m) {
  MotionHold hold;
  hold.moves = goes_somewhere(m);
  const bool lit = m.start_known && arc_.on(m);
  if (!lit) {
    // Held off by its output the torch has no pause: that is M5's.
    const bool stopped = (m.torch.spindles_on & 1) == 0;
    if (std::exchange(pierced_, false) && stopped) hold.before.pauses_s = pause_s_;
    dwelt_s_ = 0;
    return hold;
  }
  if (pierced_) return hold;
  if (m.kind == MotionKind::kDwell) dwelt_s_ += m.duration_s;
  if (m.kind != MotionKind::kTraverse && !is_feed(m)) return hold;
  pierced_ = true;
  pause_s_ = 0;
  if (m.torch.material >= materials_.size()) return hold;
  const TorchMaterial& material = materials_[m.torch.material];
  hold.before.pierces_s = std::max(0.0, material.pierce_delay_s - dwelt_s_);
  pause_s_ = std::max(0.0, material.pause_at_end_s);
  return hold;
}

std::string TorchHolds::text() const {
  return tr(
      "; pierce delays and pauses at the ends of cuts by the materials, probing and the start "
      "of the arc no time");
}

}  // namespace kerf
