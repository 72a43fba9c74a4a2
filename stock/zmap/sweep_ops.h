// stock/zmap/sweep_ops.h - what the cutting kernels are given: elementary sweeps of convex tools
// over a tiled height grid. Plain data only: included by sources that are compiled for different
// instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kerf {

/// Heights lie in tiles of kTileCells x kTileCells cells; inside a tile in blocks of 2 x 4 cells
/// (one vector of eight floats), blocks row by row, cells of a block row by row. Narrow in X
/// because the strips of a raster along X are: fewer cells that lie outside of a strip are looked
/// at.
inline constexpr int kBlockX = 2;
inline constexpr int kBlockY = 4;
inline constexpr int kBlockFloats = kBlockX * kBlockY;
inline constexpr int kTileBlocksX = 32;
inline constexpr int kTileBlocksY = 16;
inline constexpr int kTileCells = kBlockX * kTileBlocksX;
static_assert(kTileCells == kBlockY * kTileBlocksY);
inline constexpr int kTileFloats = kTileCells * kTileCells;

/// Where a grid keeps them, the numbers of the moves that lowered the cells of a tile last lie
/// behind its heights, in the same order. `cells` may be any cell of the tile.
inline std::uint32_t* cut_ids_of(float* cells) {
  return reinterpret_cast<std::uint32_t*>(cells + kTileFloats);
}
inline const std::uint32_t* cut_ids_of(const float* cells) {
  return reinterpret_cast<const std::uint32_t*>(cells + kTileFloats);
}

/// What is hollow below the heights of a grid, as the kernels see it.
struct GapView {
  /// By tile, null where it has no gaps: the upper end of the topmost gap of each cell, -infinity
  /// where there is none. May change with each call of open().
  const float* const* tops = nullptr;
  float thinnest = 0;  ///< material that is no thicker over a gap is not kept, mm
  void* owner = nullptr;
  /// Cells `first` + n of the tile, for each bit n of `lanes`, have been lowered from before[n] to
  /// heights[n], which leaves nothing over their topmost gaps. Lowers heights[n] to where there is
  /// material, and sets gone[n], mm, to how much was removed. Called by the band's thread.
  void (*open)(void* owner, int tile, int first, unsigned lanes, float* heights,
               const float* before, float* gone, std::uint32_t report) = nullptr;
};

/// A grid as the kernels see it. Row `band` of tiles is written by one thread only.
struct GridView {
  float** tiles =
      nullptr;  ///< tiles_x * tiles_y pointers; null where the tile is shared with a snapshot
  void* owner = nullptr;
  float* (*make_writable)(void* owner, int tile) =
      nullptr;         ///< replaces a null entry; called by the band's thread
  int nx = 0, ny = 0;  ///< cells
  int tiles_x = 0, tiles_y = 0;
  double x0 = 0, y0 = 0;                    ///< lower corner, mm
  double cell_x = 0, cell_y = 0;            ///< mm
  double per_block_x = 0, per_block_y = 0;  ///< blocks per mm
  float floor = 0;                          ///< nothing is cut below
  const std::uint32_t* cut_ids = nullptr;   ///< by SweepOp::report; null where nobody keeps them
  GapView gaps;                             ///< only for kernels that know of gaps
};

/// One piece of a convex profile: height over the tip at distance d from the axis, r0 <= d <= r1.
///   line: z0 + slope * (d - r0)          arc: center_z - sqrt(radius^2 - (d - center_r)^2)
struct ToolPiece {
  double r0 = 0, r1 = 0, z0 = 0, slope = 0;
  double center_r = 0, center_z = 0, radius = 0;
  bool arc = false;
};

/// A tool whose lower surface is a convex function of the distance from the axis, with a vertical
/// wall at `radius`. Every cutter without undercut is the union of a few of these
/// (cutter_components.h).
struct ConvexTool {
  static constexpr int kMaxPieces = 8;
  enum class Kind : std::uint8_t { kFlat, kBall, kPieces };
  Kind kind = Kind::kFlat;
  double radius = 0;  ///< mm
  double base_z = 0;  ///< kFlat, kBall: height of the lowest point above the tip
  int piece_count = 0;
  ToolPiece pieces[kMaxPieces];
  double wall_slope =
      0;  ///< slope of the surface where it meets the wall (infinity for a ball or bull-nose)
  bool needs_double = false;  ///< so steep that single precision would miss kHeightTolerance_mm
};

/// One elementary sweep. Strips and arcs carry no end caps: those are sweeps of their own (kCap),
/// so that a path is cut piece by piece without covering any cell twice.
struct SweepOp {
  enum class Kind : std::uint8_t {
    kStrip,  ///< straight: the cells whose lowest point over them lies between the ends
    kCap,    ///< the tool standing at one point
    kArc,    ///< level arc in XY
    kHelix,  ///< arc in XY with linear z
  };
  Kind kind = Kind::kCap;
  bool use_double = false;
  bool joined = false;  ///< kStrip: the wedge of cells between this strip and the next is cut too
  bool straight_on = false;    ///< joined: the next strip has the same direction
  bool full_circle = false;    ///< kArc
  bool over_half = false;      ///< kArc: sweep above pi
  std::uint32_t report = 0;    ///< index of the move in its batch
  double x = 0, y = 0, z = 0;  ///< strip: start; cap: tip; arc, helix: centre, z of the start
  double cos = 1, sin = 0;     ///< strip: direction; arc, helix: direction from the centre to the
                               ///< start (counter-clockwise)
  double slope = 0;            ///< strip: dz per mm of XY length; helix: dz per radian
  double slope_m = 1;          ///< strip: sqrt(1 + slope^2)
  double length = 0;           ///< strip: XY length, mm; helix: sweep, rad
  double next_cos = 1, next_sin = 0,
         next_slope = 0;            ///< joined: the next strip, relative to XY axes
  double next_m = 1;                ///< joined: sqrt(1 + next_slope^2)
  double end_cos = 1, end_sin = 0;  ///< arc: direction to the end
  double radius = 0;                ///< arc, helix: of the tip's path
  double min_x = 0, max_x = 0, min_y = 0,
         max_y = 0;  ///< of the tip's path; the tool's radius comes on top
};

/// Per move: sums that do not depend on the order of their parts.
struct SweepTotals {
  std::int64_t removed = 0;  ///< sum of height removed over cells, in units of kRemovedUnit_mm
  float depth = 0;           ///< greatest height removed in one cell, mm
};
/// Fine enough for cuts of a micrometre, coarse enough that 32-bit lanes hold 512 blocks of 256 mm
/// depth.
inline constexpr double kRemovedUnit_mm = 1.0 / (1 << 13);

/// Cuts ops (in order) with one convex tool into the tile rows first_band, first_band + band_step,
/// ...
using SweepKernel = void(GridView& grid, const ConvexTool& tool, const SweepOp* ops,
                         std::size_t count, int first_band, int band_step, SweepTotals* totals);

/// All lower the heights to the same bits; those of the "_ids" also write GridView::cut_ids to
/// every cell that they lower. A tie leaves the earlier move's. Those of the "_gaps" look at
/// GridView::gaps, and write the numbers if there are any.
namespace zmap_scalar {
SweepKernel run_sweeps;
}
namespace zmap_scalar_ids {
SweepKernel run_sweeps;
}
namespace zmap_avx2 {
SweepKernel run_sweeps;
}
namespace zmap_avx2_ids {
SweepKernel run_sweeps;
}
namespace zmap_scalar_gaps {
SweepKernel run_sweeps;
}
namespace zmap_vector {
SweepKernel run_sweeps;
}
namespace zmap_vector_ids {
SweepKernel run_sweeps;
}
namespace zmap_vector_gaps {
SweepKernel run_sweeps;
}
namespace zmap_avx2_gaps {
SweepKernel run_sweeps;
}

}  // namespace kerf
