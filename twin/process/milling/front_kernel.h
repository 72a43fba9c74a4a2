// twin/process/milling/front_kernel.h - what EngagementScan asks of many places at once, compiled
// for several instruction sets. Equal bits whichever of them runs: each operation is one correctly
// rounded IEEE operation, in the order of the text.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace kerf {

/// How high a cutter's surface is over its tip, over even steps of the radius: what lies between
/// two steps is on the line between them, what is beyond the last one as high as that.
struct LiftTable {
  const double* lift = nullptr;  ///< kLifts + 2 of them
  double scale = 0;              ///< steps for each mm
  double last = 0;               ///< kLifts
};

/// Cells, seen from above.
struct FrontGrid {
  double min_x = 0, min_y = 0, cell_x = 0, cell_y = 0;
  double nx = 0, ny = 0;
};

/// The end of a straight way: what is neither so near to it nor behind it is none of it.
struct FrontEnd {
  bool is_near = false;
  double x = 0, y = 0, radius2 = 0;
  double along_x = 1, along_y = 0;
};

/// Places along one direction from the cutter's middle, at these radii.
struct RayPlaces {
  static constexpr int kMost = 32;
  static constexpr int kTileCells = 64, kBlockX = 2, kBlockY = 4;  ///< HeightGrid's
  using Each = double[kMost];
  alignas(32) Each radius;
  alignas(32) Each x, y;          ///< where they are
  alignas(32) Each right, up;     ///< within the square of four cells' middles
  alignas(32) Each low_x, low_y;  ///< the middle of the first of these, from the cutter's
  alignas(32) Each lift;          ///< of the cutter there
  alignas(32) Each depth;         ///< of the material over that
  alignas(32) std::int32_t i[kMost], j[kMost];  ///< the first of the four
  /// Within its tile as heights are kept (HeightGrid), and from there to the next along x and y;
  /// less than 0: the four are in several tiles.
  alignas(32) std::int32_t offset[kMost], next_x[kMost], next_y[kMost];
  alignas(32) float height[4][kMost];  ///< of the four
  /// What is still to be asked of a place.
  enum State : std::int32_t {
    kDone,
    kHeld,    ///< what is held back, if it is in `depth`
    kOwners,  ///< the moves that cut the four
    kAsk,     ///< all
  };
  alignas(32) std::int32_t state[kMost];
};

struct RayLine {
  double center_x = 0, center_y = 0, out_x = 1, out_y = 0;
};

/// What there is to know of the material about all places.
struct RayGround {
  double tip = 0;
  double floor = 0;            ///< no cell is lower
  double film = 0;             ///< what is thinner is level, or none
  double wall = 0, twist = 0;  ///< heights that differ by more
  bool knows_owners = false, has_held = false;
};

/// Cells before the cutter, seen from its middle.
struct CellBatch {
  static constexpr int kMost = 256;
  using Each = double[kMost];
  int count = 0;
  alignas(32) Each x, y, height;
  alignas(32) Each radius, lift;  ///< of their places, and the cutter's surface there over its tip
  alignas(32) Each depth;         ///< how deep they are in material
  alignas(32) Each ahead, beside, step;  ///< along and beside the way, and the direction
  alignas(32) Each under;                ///< what the cutter leaves there, over its tip
  alignas(32) Each deep;                 ///< how high material is over that
  /// Of those ahead of the cutter.
  double most_deep = 0, most_radius = 0, most_beside = 0, least_beside = 0;
  /// The share of the height, spread evenly over the directions in which the cell is seen, from
  /// one to the other: what each end of that adds up to, of directions in steps. Below an end all
  /// steps have the same; at `low` and the two after it, that much more than at the next one.
  struct End {
    alignas(32) int low[kMost];
    alignas(32) Each first, second, third;
  };
  End first_end, last_end;
  void move(int from, int to) {
    x[to] = x[from], y[to] = y[from], height[to] = height[from];
    radius[to] = radius[from], lift[to] = lift[from], depth[to] = depth[from];
  }
};

/// Some blocks of cells side by side in one tile, as heights are kept (HeightGrid), seen from the
/// cutter's middle; and which cells of them are asked about, of each of its rows.
struct CellBlocks {
  static constexpr int kX = RayPlaces::kBlockX, kY = RayPlaces::kBlockY, kCells = kX * kY;
  const float* heights = nullptr;
  int count = 0;  ///< of blocks
  int i = 0;      ///< the first cell of the first
  int first[kY]{}, last[kY]{};
  double x = 0, y = 0;  ///< of the middle of its first cell
  double cell_x = 0, cell_y = 0;
  double tip = 0;
  /// By the square of the distance from the cutter's middle, times `to_part`, up to `last_part`:
  /// lower than the cutter is there by more than floats are rounded by.
  const float* low_lift = nullptr;
  double to_part = 0, last_part = 0;
};

/// A straight way that the heights may not have yet. No `length`: there is none.
struct HeldWay {
  double start_x = 0, start_y = 0, along_x = 1, along_y = 0, length = 0;
  double z = 0, slope = 0;
  double lean = 0;  ///< of a ball, whose lowest place is so much of the way behind; 0: it is level
  double lowest = 0;  ///< it leaves what is no higher
};

/// Where the cutter is, for a batch of cells.
struct CellGround {
  double center_x = 0, center_y = 0, ahead_x = 1, ahead_y = 0;
  double tip = 0, film = 0;
  double radius = 0;      ///< of the cutter
  double wall_slope = 0;  ///< what rises by more for each mm of the radius is a wall of the cutter
  double slope = 0;       ///< of its way up; it leaves what is less steep
  double most_above_tip = 0;
  double fresh = 0;  ///< so thick is a chip straight ahead; 0: a thin one counts by its thickness
  double thin = 0, thinnest = 0;  ///< EngagementScan::of_thin_chips()
};

/// By the distance from the cutter's middle, as LiftTable: what a cell in material adds.
struct CellWeights {
  const double* height_rad = nullptr;
  const double* thick_per_mm = nullptr;
  const double* upright = nullptr;  ///< a level chip's share that is normal to the cutter there
  const double* steps = nullptr;    ///< so wide it is, as directions
  double last_step = 0;             ///< of directions
};

struct FrontKernel {
  std::string_view name;
  /// Where the first `count` places are (rounded up to a multiple of 4): all of it but the heights.
  /// State kAsk: the four are not all there, or it is no place of the way (depth: - infinite).
  void (*lay_ray)(const FrontGrid& grid, const RayLine& line, const FrontEnd& end, int count,
                  RayPlaces& at);
  /// How deep they are, where these heights are known.
  void (*look_along)(const FrontGrid& grid, const RayLine& line, const LiftTable& table,
                     const RayGround& ground, int count, RayPlaces& at);
  /// Appends x, y and height of what is higher than the cutter may be there, until there is no room
  /// for another block; how many blocks there was room for.
  int (*collect)(const CellBlocks& blocks, CellBatch& cells);
  /// From x, y and height: radius, lift and depth; below 0 where it is none of the way, or left by
  /// it.
  void (*take_cells)(const CellGround& ground, const FrontEnd& end, const HeldWay& held,
                     const LiftTable& table, CellBatch& cells);
  /// .. of what is in material: directions, and what it adds. `least`: the least radius;
  /// `per_step`: from radians to steps of directions.
  void (*place_cells)(const CellGround& ground, const LiftTable& table, const CellWeights& weights,
                      double least, double per_step, CellBatch& cells);
};

/// Those that this machine can run, the quickest first.
std::span<const FrontKernel> front_kernels();

}  // namespace kerf
