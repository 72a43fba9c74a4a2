// stock/octree/octree_state.h - an octree on disk: kerf-state/1 (stock/state_bytes.h).
//
//   model octree
//   beside n               bytes of another file behind the tiles; the line is missing where there
//                          are none
//   bounds_mm x0 y0 z0 x1 y1 z1
//   cells nx ny nz
//   additive 0|1           1: what is kept is the air around the material
//   blank_mm3 v
//   removed n              in kNodeVolume
//   data
// Then the tiles, x fastest, then y: one byte, 0 empty, 1 solid, 2 bricks. Of the latter the 64
// bricks, x fastest, then y: one byte of the same meaning; 2 is followed by the 81 columns, 16 bits
// each, then, of each crossed edge in the order of for_each_crossed(), the direction, 32 bits, then
// of each of them the place, 16 bits (brick.h).
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "stock/octree/brick_tree.h"

namespace kerf::octree {

struct SavedTree {
  BrickTree tree;
  bool additive = false;
  double blank_mm3 = 0;
  std::int64_t removed = 0;
  std::string beside;  ///< what belongs to who saved it: an octree knows nothing of it
};

/// Without ids.
Done write_tree(const std::string& path, const SavedTree& saved);

/// From a file's bytes; `name` is used in messages. What comes back can be cut and meshed whatever
/// the bytes were: neighbours agree about the nodes that both know, nothing lies outside of the
/// blank. Errors say what is wrong. Allocates in proportion to the bytes.
Result<SavedTree> parse_tree(const std::string& bytes, const std::string& name);

}  // namespace kerf::octree
