// twin/config/job_turn.h - how a workpiece lies in one setup, seen from the one before.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/placement.h"

namespace kerf {

/// How the workpiece lies in a setup, seen from how it lay in the one before.
struct JobTurn {
  enum class Zero : std::uint8_t { kStays, kTop, kCorner, kMiddle, kPoint };

  char flip = 0;       ///< 'x', 'y': half a turn about that axis, through the middle of its box
  Vec3 rotate_deg{0};  ///< then about X, Y and Z through that middle
  Zero zero = Zero::kStays;
  Vec3 point_mm{0};  ///< kPoint: what becomes the origin, as it lies once it is turned
  /// Three points of it, as they lay and as they were touched: they say all there is to say.
  struct Touched {
    std::array<Vec3, 3> was_mm{}, is_mm{};
  };
  std::optional<Touched> touched;

  /// It only goes on: nobody has moved it.
  bool is_none() const {
    return flip == 0 && rotate_deg == Vec3(0) && zero == Zero::kStays && !touched;
  }
  /// `solid_mm`: the box of what the setup before has left. Where Z0 is to be on top, it is on top
  /// of what is there once it is turned.
  Placement placement(const Box& solid_mm) const;
  /// The turn alone, which is known before anything is cut.
  Placement turn() const;
};

/// Points that were touched may lie so much otherwise to each other than they did.
inline constexpr double kTouchSlack_mm = 0.1;

}  // namespace kerf
