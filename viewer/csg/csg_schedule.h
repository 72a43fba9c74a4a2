// viewer/csg/csg_schedule.h - which solids can be subtracted in one pass, and which ones have to be
// looked at again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "base/geometry.h"
#include "viewer/orbit_camera.h"

namespace kerf {

/// Pixels [min, max) from the lower left corner. Default: empty.
struct PixelRect {
  glm::ivec2 min{0, 0};
  glm::ivec2 max{0, 0};
  bool empty() const { return min.x >= max.x || min.y >= max.y; }
  std::int64_t pixels() const;
  void extend(const PixelRect& other);
};

struct PixelArea {
  PixelRect rect;
  bool is_around_eye = false;  ///< Reaches the plane of the eye; rect is the whole picture.
};

/// All pixels that something inside the box can touch.
PixelArea pixels_of(const Box& box, const Projection& projection);

/// Cuts the picture into tiles and keeps, per tile, when a pixel of it last moved. A solid needs
/// another look only if that was after its last one. Times are counted by the caller, rising.
class TileClock {
 public:
  explicit TileClock(glm::ivec2 size_px = {1, 1});

  void mark(const PixelRect& rect, std::uint64_t time);
  /// Of the tiles under the rectangle; 0: none was marked.
  std::uint64_t newest(const PixelRect& rect) const;

  /// Splits a sequence into batches whose members share no tile. Each member comes in the first
  /// batch after all earlier members that it shares a tile with, so what lies behind each other is
  /// taken in the order of the sequence. Gives the number of the batch per member; batches count
  /// from 0. O(tiles under the rectangles).
  std::vector<std::uint32_t> batches(std::span<const PixelRect> sequence) const;

 private:
  template <class Use>
  void for_each_tile(const PixelRect& rect, const Use& use) const;

  glm::ivec2 tiles_{1, 1};
  std::vector<std::uint64_t> moved_at_;
};

}  // namespace kerf
