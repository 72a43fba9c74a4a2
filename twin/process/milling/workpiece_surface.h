// twin/process/milling/workpiece_surface.h - the workpiece as it is now, as a body that others may
// run into.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "stock/stock_model.h"
#include "twin/collision/solid.h"
#include "twin/collision/sweep.h"

namespace kerf {

/// Its surface, tile by tile, made where bodies come over a tile and made anew where that has
/// changed: walls are where the cells have them. Around it the box of the blank, which costs
/// nothing to ask. One thread.
class WorkpieceSurface {
 public:
  /// `complete` makes the model take in all moves that it has been given.
  WorkpieceSurface(const StockModel& stock, std::function<void()> complete)
      : stock_(stock), complete_(std::move(complete)) {}

  const Box& box_mm();
  /// first_touch() of twin/collision/solid_sweep.h.
  std::optional<double> first_touch(const Solid& moving, const RigidWay& way, double thinner_mm);
  /// gap_at(), no farther than `cutoff_mm`.
  double gap_at(const Solid& moving, const Pose& pose, double cutoff_mm);
  /// touch_depth_mm().
  double touch_depth_mm(const Solid& moving, const RigidWay& way, double known_mm);

 private:
  struct Tile {
    std::uint64_t version = 0;
    SolidPointer solid;
  };
  const Solid& tile(std::uint32_t number);
  const Solid& tile_box(std::uint32_t number);
  /// Tiles that may be nearer to this box than that.
  void gather(const Box& box, double within_mm);

  const StockModel& stock_;
  std::function<void()> complete_;
  std::optional<Box> box_mm_;
  std::unordered_map<std::uint32_t, Tile> tiles_;
  std::unordered_map<std::uint32_t, SolidPointer> boxes_;
  std::vector<std::uint32_t> near_;
};

}  // namespace kerf
