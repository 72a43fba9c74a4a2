// viewer/window/csg_view.h - blank minus moves, a little of it in each frame. For the sources of
// viewer/ only.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "viewer/csg/csg_renderer.h"
#include "viewer/csg/cut_moves.h"

namespace kerf {

/// Keeps a CsgRenderer in step with the moves that are to be seen. Moves that come at the end cost
/// themselves alone, and so does a last one that grows longer; only when others go, all are
/// subtracted anew. No frame takes longer than about kFrame_ms: when the eye moves, the newest
/// moves are there at once and the older ones come in the frames after it. While all are subtracted
/// anew for the same eye, the picture before stays for kPatience_ms at most.
class CsgView {
 public:
  static constexpr double kFrame_ms = 12.0;
  /// Of it for making solids of moves, some 0.1 ms each.
  static constexpr double kFeed_ms = 6.0;
  static constexpr int kPatience_ms = 400;
  /// A move that grows leaves its shorter forms behind; so many of them, and all is made anew.
  static constexpr std::size_t kMostGrown = 500;

  /// Null: nothing is shown.
  void set(std::shared_ptr<const CutMoves> moves) { wanted_ = std::move(moves); }
  bool has_moves() const { return wanted_ != nullptr; }

  /// Goes on with the picture. Error: as CsgRenderer has them.
  Done draw(const Projection& projection);
  /// There is more to be subtracted: draw again.
  bool has_waiting() const { return renderer_ && (unfed_ > 0 || renderer_->has_waiting()); }
  /// Of the last draw().
  const CsgRenderer& picture() const { return *renderer_; }
  std::size_t gpu_bytes() const;
  /// Gives the memory back.
  void release();

 private:
  using Clock = std::chrono::steady_clock;
  Done begin();
  bool take_moves();
  void feed();

  std::shared_ptr<const CutMoves> wanted_;
  std::shared_ptr<const CutMoves> begun_;  ///< whose blank and tools the renderer has
  std::vector<SweptMove> taken_;           ///< that the renderer has, without those that grew
  std::size_t unfed_ = 0;  ///< of them the first so many are still to be made into solids
  std::size_t grown_ = 0;
  std::optional<CsgRenderer> renderer_;
  Projection projection_;
  std::optional<Clock::time_point> quiet_until_;  ///< the picture before stays until then
};

}  // namespace kerf
