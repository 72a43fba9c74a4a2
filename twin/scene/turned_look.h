// twin/scene/turned_look.h - what is special about the look of a workpiece that turns.
#pragma once

#include <cstddef>
#include <vector>

#include "stock/turning/turning_stock.h"
#include "twin/playback/program_track.h"
#include "viewer/scene.h"

namespace kerf {

/// Circles at the corners of the profile, and the profile at four angles; of one with many corners
/// the cylinder around it.
std::vector<LineSegment> turned_outline(const TurningStock& stock);

/// Of the blank, as views draw it.
std::vector<LineSegment> blank_outline_of(const StockModel& blank);

/// Where in a program X is a diameter: from a motion whose line is that of a G7 or behind it to one
/// behind a G8. By the text: what a startup code says is not seen, nor a word in a subroutine that
/// is jumped into behind it.
class DiameterMode {
 public:
  DiameterMode() = default;
  /// Reads all of track and text.
  DiameterMode(const ProgramTrack& track, const ProgramText& text);
  bool holds_at(std::size_t motion) const;

 private:
  std::vector<std::size_t> changes_;  ///< motions from which it is on, off, on, ..
};

}  // namespace kerf
