// twin/report/live_facts.h - counts and lengths of a watched machine.
#pragma once

#include <algorithm>
#include <cstdint>

namespace kerf {

/// What has been seen. Lengths in mm.
struct LiveFacts {
  std::uint64_t samples = 0;
  std::uint64_t incomplete = 0;  ///< without X, Y or Z
  std::uint64_t wild = 0;  ///< with a position that no machine has (ReadingBounds), or can have
                           ///< between its neighbours (SampleGate): dropped
  std::uint64_t on_path = 0;
  std::uint64_t off_path = 0;  ///< after the machine had been found on the path
  double off_path_max_mm = 0;
  double following_max_mm = 0;  ///< distance from the path of the samples on it
  double following_sum_mm = 0;
  std::uint64_t gaps = 0;   ///< in which the machine moved
  std::uint64_t jumps = 0;  ///< faster than the machine can be, and away from the workpiece: homing
  double gap_s = 0;         ///< in all
  double gap_max_mm = 0;    ///< greatest straight line across one
  double path_mm = 0;       ///< cut along the program
  double chord_mm = 0;      ///< cut straight from sample to sample
  std::uint64_t tool_changes = 0;

  /// Of what was watched afterwards.
  LiveFacts& operator+=(const LiveFacts& later) {
    samples += later.samples;
    incomplete += later.incomplete;
    wild += later.wild;
    on_path += later.on_path;
    off_path += later.off_path;
    off_path_max_mm = std::max(off_path_max_mm, later.off_path_max_mm);
    following_max_mm = std::max(following_max_mm, later.following_max_mm);
    following_sum_mm += later.following_sum_mm;
    gaps += later.gaps;
    jumps += later.jumps;
    gap_s += later.gap_s;
    gap_max_mm = std::max(gap_max_mm, later.gap_max_mm);
    path_mm += later.path_mm;
    chord_mm += later.chord_mm;
    tool_changes += later.tool_changes;
    return *this;
  }
};

}  // namespace kerf
