// twin/process/torch/torch_holds.h - where a QtPlasmaC machine stands: pierce delays, pauses at the
// ends of cuts.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interp_bridge/beam_trigger.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"
#include "twin/machine/program_holds.h"

namespace kerf {

/// Of a torch whose materials have no times nothing is held. QtPlasmaC's probing, the start of its
/// arc and its moves between heights are not counted: nothing says how long they take.
class TorchHolds final : public ProgramHolds {
 public:
  /// `arc`: what turns it on.
  explicit TorchHolds(BeamTrigger arc) : arc_(std::move(arc)) {}

  void set_materials(std::span<const TorchMaterial> materials) override;
  MotionHold of(const Motion& motion) override;
  std::string text() const override;

 private:
  BeamTrigger arc_;
  std::vector<TorchMaterial> materials_;
  bool pierced_ = false;  ///< since the arc came on
  double dwelt_s_ = 0;    ///< with the arc on, before the first move
  double pause_s_ = 0;    ///< at the end of the present cut
};

}  // namespace kerf
