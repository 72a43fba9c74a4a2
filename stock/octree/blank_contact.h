// stock/octree/blank_contact.h - contacts with the blank as it was given, where nothing has come
// yet: what cells are too coarse to tell.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stock/blank.h"
#include "stock/octree/brick_tree.h"
#include "stock/octree/sweep_kernel.h"

namespace kerf::octree {

/// Looks at the blocks of bricks (of 4 x 4 x 4 nodes) that no tool has reached (BrickTree), against
/// the bodies of the blank less `tolerance` on every side: a tool that enters an untouched face by
/// more than that touches, whatever the cells. The tool is the exact one.
class BlankContact {
 public:
  BlankContact(const Lattice& lattice, const SweepKernel& kernel, std::span<const BlankBody> bodies)
      : lattice_(lattice), kernel_(kernel), bodies_(bodies) {}

  /// `blocks`: bits of those that are to be looked at; the tolerance is the sweep's shrink_mm.
  /// Searches by projecting to and fro: of convex parts (all but hollow tubes, level arcs and
  /// turning pieces, of which a block sees little) it finds what there is.
  bool touches(const Sweep& sweep, int bx, int by, int bz, unsigned blocks);
  /// The same of one block, as a point of it that is in both, or nothing.
  std::optional<Vec3> point_in(const Sweep& sweep, const Box& block);
  /// The point of one block of the blank that is nearest to what is swept, to a micrometre or so;
  /// nothing if none is nearer than `below_mm`. A negative distance is only that: inside.
  struct Nearest {
    double mm;
    Vec3 at_mm;
  };
  std::optional<Nearest> nearest_in(const Sweep& sweep, const Box& block, double below_mm);
  /// Of block `number` (0..7) of a brick.
  Box block_of(int bx, int by, int bz, int number) const;
  /// How deep an upright tool goes below the top of a blank that is one box, at the most, where
  /// that is untouched from there to the top; 0: nowhere, or it is not known.
  double depth_mm(const BrickTree& tree, std::span<const Sweep> sweeps);
  /// How much of a blank that is one upright body lies above `tip_mm`, to where a tool goes
  /// straight down that is lowest at its axis; 0: none, something has been there, or it is not
  /// known.
  double plunge_depth_mm(const BrickTree& tree, const Vec3& tip_mm) const;

 private:
  /// Sets `found_mm` if there is a point.
  bool search(const Sweep& sweep, const BlankBody& body, const Box& block, Vec3& found_mm);
  bool is_untouched_above(const BrickTree& tree, const Vec3& point_mm) const;
  bool is_near(const Sweep& sweep, const Box& block, double within_mm = 0);
  /// Lane by lane, the middles of the eighths of a block that the body less `in_mm` has a share of.
  struct Lanes {
    Box boxes[kLanes];
    Vec3 at[kLanes];
    bool searching[kLanes];
    bool any = false;
  };
  static Lanes lanes_of(const BlankBody& body, const Box& block, double in_mm);

  const Lattice& lattice_;
  SweepKernel kernel_;
  std::span<const BlankBody> bodies_;
  alignas(64) double x_[kLanes] = {}, y_[kLanes] = {}, z_[kLanes] = {};
  alignas(64) double f_[kLanes] = {}, gx_[kLanes] = {}, gy_[kLanes] = {}, gz_[kLanes] = {};
};

}  // namespace kerf::octree
