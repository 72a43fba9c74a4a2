#include "twin/compare/wall_finder.h"

#include <cmath>

namespace kerf {
namespace {

/// Cells in a row of a block that has its moves looked up once.
constexpr int kBlock = 16;

}  // namespace

const KeptMoves::Near& WallFinder::near_to(const Vec2& at_mm) {
  const Vec2 cell = grid_.cell_mm();
  const Vec2 place = (at_mm - Vec2(grid_.bounds_mm.min)) / cell;
  const int x = static_cast<int>(std::floor(place.x)) / kBlock;
  const int y = static_cast<int>(std::floor(place.y)) / kBlock;
  if (!near_ || x != block_x_ || y != block_y_) {
    block_x_ = x;
    block_y_ = y;
    const Vec3 low(Vec2(grid_.bounds_mm.min) + Vec2(x, y) * (kBlock * 1.0) * cell - cell,
                   grid_.bounds_mm.min.z);
    const Vec3 high(Vec2(low) + (kBlock + 2.0) * cell, grid_.bounds_mm.max.z);
    near_.emplace(*kept_, Box{low, high});
    work_ += kept_->size() / 64 + near_->size();
  }
  return *near_;
}

WallFinder::Place WallFinder::find(const Vec2& low_mm, const Vec2& high_mm, double z_mm) {
  if (kept_ == nullptr || work_ > kMostWork) {
    all_found_ = false;
    return {};
  }
  const KeptMoves::Near& near = near_to(low_mm);
  const KeptMoves::Far far = near.farthest(low_mm, high_mm, z_mm, kFine);
  work_ += near.size() + 16 * far.tried;
  if (!far.is_cut) {  // the side of a blank that is no box
    all_found_ = false;
    return {};
  }
  return {far.share, far.label, true};
}

}  // namespace kerf
