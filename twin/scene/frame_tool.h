// twin/scene/frame_tool.h - the tool of a player's state, for pictures by rays.
#pragma once

#include <memory>

#include "stock/cutter/cutter.h"
#include "twin/playback/player.h"
#include "viewer/raycast/ray_caster.h"

namespace kerf {

/// Hands the tool in the spindle and its place over. Makes a shape only when the cutter changes.
class FrameTool {
 public:
  void show(const PlayerState& state, RayCaster& caster);

 private:
  /// Kept, so that a new one cannot have its address.
  std::shared_ptr<const Cutter> shown_;
};

/// Threads for rays where nobody said how many: one a core, 8 at most.
int ray_threads();

}  // namespace kerf
