// viewer/window/csg_picture.h - blank minus moves for one eye, a little of it in each frame. For
// the sources of viewer/ only.
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
/// subtracted anew. Until all are subtracted, the picture before stays: that of the eye before for
/// as long as it takes, that of the same eye for kPatience_ms at most; then what is there is shown,
/// which has too much material, nowhere too little.
class CsgPicture {
 public:
  static constexpr int kPatience_ms = 400;
  /// A move that grows leaves its shorter forms behind; so many of them, and all is made anew.
  static constexpr std::size_t kMostGrown = 500;
  /// By which polyhedra stay inside of round cutters: as the pictures of the program are made.
  static constexpr double kTolerance_mm = 0.02;

  /// `coarseness`: by as much of the blank's longest edge, if that is more: fewer triangles.
  explicit CsgPicture(double coarseness = 0.0) : coarseness_(coarseness) {}

  /// Takes the moves over, of the blank and the tools of the first ones, and makes solids of them
  /// for `longest_ms`, some 0.1 ms each; the rest wait. Draws nothing. Error: as CsgRenderer has
  /// them.
  Done follow(const std::shared_ptr<const CutMoves>& moves, double longest_ms);
  /// Goes on with the picture of what was taken over, for about so long. Error: as CsgRenderer has
  /// them.
  Done draw(const Projection& projection, double longest_ms);

  /// All moves are subtracted for the eye that was asked for last, or there is none yet.
  bool is_whole() const { return unfed_ == 0 && !(renderer_ && renderer_->has_waiting()); }
  /// What can be seen was drawn for this eye.
  bool shows(const Projection& projection) const { return shown_ == projection; }
  /// There is something to be seen, drawn for this eye, maybe before the last draw().
  const std::optional<Projection>& shown() const { return shown_; }
  /// That draw() may have changed.
  PixelRect changed() const { return renderer_->changed(); }
  void bind(int color_unit, int depth_unit) const {
    renderer_->bind_picture(color_unit, depth_unit);
  }
  std::size_t gpu_bytes() const;

 private:
  using Clock = std::chrono::steady_clock;
  Done begin(const CutMoves& moves);
  void take(const std::vector<SweptMove>& moves);
  void feed(double longest_ms);

  double coarseness_;
  std::shared_ptr<const CutMoves> begun_;  ///< taken over last; all have the same blank and tools
  std::vector<SweptMove> taken_;           ///< that the renderer has, without those that grew
  std::size_t unfed_ = 0;  ///< of them the first so many are still to be made into solids
  std::size_t grown_ = 0;
  std::optional<CsgRenderer> renderer_;
  Projection projection_;
  std::optional<Projection> shown_;
  bool shows_all_ = false;  ///< it was whole since the eye moved or other moves came
  std::optional<Clock::time_point> quiet_until_;  ///< the picture before stays until then
};

}  // namespace kerf
