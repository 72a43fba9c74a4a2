// twin/scene/frame_moves.h - what a program's motions cut, as moves for the CSG picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "base/geometry.h"
#include "surface/height_grid.h"
#include "twin/playback/cut_query.h"
#include "twin/playback/program_track.h"
#include "viewer/csg/csg_renderer.h"

namespace kerf {

/// Cells of a blank that do not reach its top: none of a box. Reads all cells.
std::size_t low_cells(const HeightGrid& grid);

/// The moves that the player's workpiece is cut with: traverses, feeds, arcs and threads whose
/// start and tool are known. Probes and moves of unknown tools are left out, and so are moves whose
/// box, with the cutter around it, lies beside or above the blank.
class FrameMoves {
 public:
  /// By which chords may leave their arc.
  static constexpr double kChordTolerance_mm = 0.02;

  /// `cuts` null: nothing cuts. Reads the whole track, about 0.5 us a motion.
  FrameMoves(std::shared_ptr<const ProgramTrack> track, std::shared_ptr<const CutQuery> cuts,
             const Box& blank_mm);

  /// SweptMove::tool indexes them. Tools of equal shape are one.
  const std::vector<CsgTool>& tools() const { return tools_; }

  /// From one place to a later one; arcs as chords. A motion that is taken in two parts sweeps what
  /// it sweeps as a whole (arcs within the tolerance).
  std::vector<SweptMove> between(const TrackPosition& from, const TrackPosition& to) const;
  /// Moves of between(start, to), a motion that has begun counted whole. Makes none of them.
  std::size_t count_until(const TrackPosition& to) const;

 private:
  const Cutter* cutter_of(const Motion& motion, std::size_t number) const;

  std::shared_ptr<const ProgramTrack> track_;
  std::shared_ptr<const CutQuery> cuts_;
  Box blank_mm_;
  std::vector<CsgTool> tools_;
  std::unordered_map<const Cutter*, std::uint32_t> tool_of_;
};

}  // namespace kerf
