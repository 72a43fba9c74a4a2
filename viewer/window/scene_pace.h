// viewer/window/scene_pace.h - how finely the scene is drawn while the eye moves. For the sources
// of viewer/ only.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

#include "viewer/orbit_camera.h"

namespace kerf {

/// Of a picture of which every frame is a whole one, a slow card or a processor gets fewer pixels
/// to draw: every second or fourth each way. The full picture follows when the eye has stood still
/// for kStill_ms. What moves while the eye stands still costs little anyhow.
class ScenePace {
 public:
  using Clock = std::chrono::steady_clock;
  /// A whole picture that took longer than kSlow_ms is followed by one of half the edges, if that
  /// has helped so far; one that took less than kQuick_ms by one of twice. A factor of 4 is the
  /// pixels' own: with less between the two the choice would go to and fro.
  static constexpr double kSlow_ms = 24.0, kQuick_ms = 5.0;
  /// Half the edges have not helped if more than this share of the time is left: it goes into
  /// triangles, not into pixels.
  static constexpr double kHelped = 0.7;
  static constexpr int kStill_ms = 120;
  static constexpr int kCoarsest = 4;

  /// By what the edges of the picture for this eye are to be divided.
  int divisor(const Projection& eye, Clock::time_point now);
  /// A whole picture of the present divisor took so long.
  void took(double ms);
  /// The picture for the last eye is not there in full yet.
  bool has_waiting() const { return divisor_ > 1; }

 private:
  std::optional<Projection> eye_;
  Clock::time_point still_from_{};
  int divisor_ = 1;                  ///< as told last
  std::size_t step_ = 0;             ///< of an eye that moves, the divisor is 2 to this
  std::array<double, 3> last_ms_{};  ///< by step; 0: not known
  static_assert(1 << (3 - 1) == kCoarsest);
};

}  // namespace kerf
