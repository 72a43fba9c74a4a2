// twin/playback/programmed_steps.h - what a program says, beside a track of the path that the
// machine makes of it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "twin/playback/program_track.h"

namespace kerf {

/// Findings are told of the motions that the program has, also where the track that is cut is of
/// the planned path, whose pieces are motions of their own.
struct ProgrammedSteps {
  /// As programmed, with the times of the whole motions. Null: the track itself is that.
  std::shared_ptr<const ProgramTrack> track;
  /// Of each of its motions: the number of its first piece in the other track.
  std::vector<std::uint32_t> first_pieces;
};

}  // namespace kerf
