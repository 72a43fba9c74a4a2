// twin/scene/value_colors.h - colours of path and workpiece by what the moves of a program were
// like: feeds, chips, forces.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "twin/playback/cut_query.h"
#include "twin/playback/load_record.h"
#include "twin/playback/program_track.h"
#include "twin/process/cutting_wish.h"
#include "viewer/scene.h"

namespace kerf {

/// What is known of the moves.
struct MoveFacts {
  std::span<const float> removed_mm3;  ///< by motion, as far as the program has been cut
  const CutQuery* cuts = nullptr;      ///< knows tools' teeth; null: nobody does
  const LoadRecord* loads = nullptr;   ///< null: they are not measured
  const CuttingWish* wish = nullptr;   ///< limits; null: there are none
};

/// For ColorBy::kFeed to kBend: six classes of equal width, of rising brightness, told apart by
/// those who see red and green alike as well. Of feed moves that have removed nothing nothing is
/// said. A peak must not flatten all the rest: the classes end at what is not exceeded for 99 % of
/// the time, the last one goes up to the greatest. What is above a limit (spindle power and torque,
/// deflection) has a colour of its own; so has what goes straight down, for kAngle.
std::shared_ptr<CutColors> value_colors(ColorBy mode, const ProgramTrack& track,
                                        const MoveFacts& facts);

/// The limit that a load is held against; 0: none.
double limit_of(CutLoadKind kind, const CuttingWish& wish);

}  // namespace kerf
