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

/// Its surface, tile by tile, made where bodies come over a tile: walls are where the cells have
/// them. What is cut only takes material away, so a surface of before is asked first, and made anew
/// where that is touched; those of tiles side by side are always of one time. Around it is the box
/// of the blank, which costs nothing to ask. One thread.
class WorkpieceSurface {
 public:
  /// `complete` makes the model take in all moves that it has been given.
  WorkpieceSurface(const StockModel& stock, std::function<void()> complete)
      : stock_(stock), complete_(std::move(complete)) {}

  const Box& box_mm();
  /// first_touch() of twin/collision/solid_sweep.h.
  std::optional<double> first_touch(const Solid& moving, const RigidWay& way, double thinner_mm);
  /// gap_at(); `cutoff_mm` no more than kFarthest_mm. Who is told that a body is so far away need
  /// not ask until it may have gone so far.
  static constexpr double kFarthest_mm = 3;
  double gap_at(const Solid& moving, const Pose& pose, double cutoff_mm);
  /// touch_depth_mm().
  double touch_depth_mm(const Solid& moving, const RigidWay& way, double known_mm);

 private:
  struct Tile {
    std::uint64_t version = 0;
    std::uint64_t time = 0;  ///< of the workpiece that it was made of, or has been compared with
    SolidPointer solid;
  };
  /// Tiles that the body comes near to, their surfaces of one time. `is_near` says it of the box of
  /// a tile, `box` is around the body.
  template <class IsNear>
  void gather(const Box& box, const IsNear& is_near);
  void gather_along(const Solid& moving, const RigidWay& way);
  /// Those are as the workpiece is now. False: they were.
  bool renew();
  void make(std::uint32_t number, Tile& tile);
  void make_room();
  const Solid& tile_box(std::uint32_t number);
  const Solid& surface(std::uint32_t number) const { return *tiles_.at(number).solid; }
  std::optional<double> touch_of_near(const Solid& moving, const RigidWay& way, double thinner_mm);
  double gap_of_near(const Solid& moving, const Pose& pose, double cutoff_mm);

  const StockModel& stock_;
  std::function<void()> complete_;
  std::optional<Box> box_mm_;
  std::unordered_map<std::uint32_t, Tile> tiles_;
  std::unordered_map<std::uint32_t, SolidPointer> boxes_;
  std::vector<std::uint32_t> near_;
  std::uint64_t time_ = 0;
  std::size_t triangles_ = 0;  ///< of all tiles_
};

}  // namespace kerf
