// stock/octree/brick_cut.h - takes away from one brick what one sweep covers.
#pragma once

#include <cstdint>
#include <vector>

#include "stock/octree/brick.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"
#include "stock/octree/turn_groups.h"

namespace kerf::octree {

/// What a sweep passes by less than this counts as reached (BrickTree::untouched()): the places of
/// programs are rounded, and so are ways back along the same wall.
inline constexpr double kReachMargin_mm = 0.02;

/// A solid node becomes empty exactly if F < 0 there. An edge that then joins solid and empty has
/// its crossing where F is 0; one that had a crossing before keeps the one that leaves less.
/// Nothing else depends on how space is divided: a node or crossing comes out in the same bits from
/// each brick that holds it.
///
/// Buffers only; one for each thread.
class BrickCutter {
 public:
  BrickCutter(const Lattice& lattice, const SweepKernel& kernel, bool additive);

  /// To be called before apply(): the brick's place in the whole.
  void set_place(int bx, int by, int bz);
  /// False if nothing has changed. Else sets what was removed: volume in kNodeVolume, and of each
  /// column (j * kBrick + i) the height in kEdgeParts. `group`, if it is not null, is that of the
  /// sweep, and lives until set_place(): it makes this faster, no other.
  bool apply(const Sweep& sweep, OpenBrick& brick, const TurnGroup* group = nullptr);
  /// Bits of the 2 x 2 x 2 blocks that any sweep since set_place() may have come into.
  unsigned reached() const { return reached_; }
  std::int64_t removed() const { return removed_; }
  const std::int32_t* removed_heights() const { return heights_; }

  /// A place where an edge has lost its crossing with material left between that and the sweep: a
  /// film, whose other face is the sweep's.
  struct Film {
    Vec3 at_mm;
    double faces;  ///< its share of the area, in faces of a cell
    double thickness_mm;
  };
  /// Whether apply() looks for films (not where material is added); at first it does not.
  void seek_films(bool seek) { seeks_films_ = seek; }
  /// All since forget_films(), of the present brick.
  const std::vector<Film>& films() const { return films_; }
  /// Those that `sweep` takes.
  void drop_films(const Sweep& sweep);
  void forget_films() { films_.clear(); }

  /// Is there material deeper than the sweep's shrink_mm in it? Changes nothing.
  bool touches(const Sweep& sweep, const OpenBrick& brick, const TurnGroup* group = nullptr);
  /// All nodes of a brick lie within this of its middle.

 private:
  enum Side : std::uint8_t { kOutside, kInside, kMixed };
  struct Crossing {
    int edge;  ///< axis * kBrickNodes + node
    int axis;
    bool solid_is_lower;
    double sign;   ///< which way along the axis the edge goes from its solid end
    Vec3 from_mm;  ///< the solid end
    double start;  ///< mm from the solid node: the crossing lies between here
    double reach;  ///< and here, where there is surely no material
  };
  struct Root {
    double low, high;     ///< bracket, as Crossing::start
    double f_low, slope;  ///< at `low`
    double tried;
    Vec3 normal;  ///< of the sweep, at `low`
  };
  /// What one group leaves to look at in this brick.
  struct Near {
    const TurnGroup* group = nullptr;
    std::uint64_t changes = 0;                  ///< of the brick, when `any` was found
    bool any = false;                           ///< false: no piece of it changes anything
    bool nodes = false;                         ///< some of the nodes below
    bool outside[8] = {};                       ///< blocks that no piece comes near
    std::uint16_t columns[kSide * kSide] = {};  ///< nodes that a piece may clear
    /// What F is not less than, of all pieces, at the other nodes that were solid; [column * 16 +
    /// k].
    float bounds[kSide * kSide * 16];
  };
  Near* near_of(const TurnGroup* group, const OpenBrick& brick);
  void look_near(const TurnGroup& group, const OpenBrick& brick, Near& near);
  bool any_edge_near(const OpenBrick& brick, const Near& near) const;

  bool passes_above(const Sweep& sweep, const OpenBrick& brick) const;
  void sort_blocks(const Sweep& sweep, const Near* near);
  bool find_nodes(const Sweep& sweep, const OpenBrick& brick, const Near* near);
  void find_edges(const Sweep& sweep, const OpenBrick& brick);
  void push_point(double x, double y, double z) {
    px_[points_] = x;
    py_[points_] = y;
    pz_[points_++] = z;
  }
  /// `way` mm from the solid end.
  void push_point(const Crossing& crossing, double way) {
    Vec3 at = crossing.from_mm;
    at[crossing.axis] += crossing.sign * way;
    push_point(at.x, at.y, at.z);
  }
  unsigned edges(const std::uint16_t* columns, int axis, int i, int j) const;
  void push_edges(const OpenBrick& brick, int axis, int i, int j, unsigned kept, unsigned fresh);
  bool may_be_inside(const Crossing& crossing, const int solid[3]) const;
  void push_lost(const OpenBrick& brick, int axis, int i, int j, unsigned lost);
  void keep_deeper(const Sweep& sweep);
  void find_films(const Sweep& sweep, const OpenBrick& brick);
  void solve(const Sweep& sweep);
  bool next_place(const Crossing& crossing, Root& root, double f, const Vec3& gradient,
                  int step) const;
  void write(const Sweep& sweep, OpenBrick& brick);
  void account(OpenBrick& brick);

  const Lattice& lattice_;
  SweepKernel kernel_;
  bool additive_;
  double half_diagonal_, block_half_diagonal_, place_slack_;
  int first_[3] = {0, 0, 0};
  double x_[kSide], y_[kSide], z_[kSide];
  bool at_end_ = false;  ///< some nodes are outside of the blank
  std::uint16_t may_clear_[kSide * kSide];
  Side blocks_[8];
  /// F in a block is nowhere less than at + slope . p; no such bound is known if at is -infinity.
  struct LowerPlane {
    double at;
    Vec3 slope;
    double under(double x, double y, double z) const {
      return at + slope.x * x + slope.y * y + slope.z * z;
    }
  };
  LowerPlane planes_[8];
  std::uint16_t columns_[kSide * kSide];  ///< after the sweep
  unsigned reached_ = 0;
  std::int64_t removed_ = 0;
  std::int32_t heights_[kBrick * kBrick];
  std::uint8_t changed_[kBrick * kBrick];  ///< nodes of a column whose crossings have changed
  /// As many points as a brick has edges or nodes.
  static constexpr std::size_t kPoints = 3 * kBrickNodes + kLanes;
  alignas(64) double px_[kPoints] = {}, py_[kPoints] = {}, pz_[kPoints] = {};
  alignas(64) double f_[kPoints], gx_[kPoints], gy_[kPoints], gz_[kPoints];
  std::uint16_t nodes_[kPoints];
  int points_ = 0;
  /// F at the solid nodes of mixed blocks, or a bound below it, [column * 16 + k].
  double node_f_[kSide * kSide * 16];
  static constexpr std::size_t kNears = 4;  ///< bodies of a tool take turns
  Near nears_[kNears];
  std::size_t next_near_ = 0;
  std::uint64_t changes_ = 0;  ///< that apply() has made
  std::vector<Crossing> kept_, open_, lost_;
  bool seeks_films_ = false;
  std::vector<Film> films_;
  std::vector<Root> roots_;
  std::vector<int> active_;
};

}  // namespace kerf::octree
