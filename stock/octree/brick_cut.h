// stock/octree/brick_cut.h - takes away from one brick what one sweep covers.
#pragma once

#include <cstdint>
#include <vector>

#include "stock/octree/brick.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {

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
  /// column (j * kBrick + i) the height in kEdgeParts.
  bool apply(const Sweep& sweep, OpenBrick& brick);
  /// Bits of the 2 x 2 x 2 blocks that any sweep since set_place() may have come into.
  unsigned reached() const { return work_.reached; }
  std::int64_t removed() const { return work_.removed; }
  const std::int32_t* removed_heights() const { return work_.heights; }

  /// A place where an edge has lost its crossing with material left between that and the sweep: a
  /// film, whose other face is the sweep's.
  struct Film {
    Vec3 at_mm;
    double faces;  ///< its share of the area, in faces of a cell
    double thickness_mm;
  };
  /// Whether apply() looks for films (not where material is added); at first it does not.
  void seek_films(bool seek) { work_.seeks_films = seek; }
  /// All since forget_films(), of the present brick.
  const std::vector<Film>& films() const { return films_; }
  /// Those that `sweep` takes.
  void drop_films(const Sweep& sweep);
  void forget_films() { films_.clear(); }

  /// Is there material deeper than the sweep's shrink_mm in it? Changes nothing.
  bool touches(const Sweep& sweep, OpenBrick& brick);

 private:
  bool passes_above(const Sweep& sweep, OpenBrick& brick) const;
  void note_films(const OpenBrick& brick);

  const Lattice& lattice_;
  SweepKernel kernel_;
  double half_diagonal_;
  BrickWork work_;
  std::vector<Film> films_;
};

}  // namespace kerf::octree
