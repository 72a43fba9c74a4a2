// viewer/window/csg_picture.h - blank minus moves for one eye, a little of it in each frame. For
// the sources of viewer/ only.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "viewer/csg/csg_renderer.h"
#include "viewer/csg/cut_moves.h"

namespace kerf {

/// Moves that the tip can go instead with fewer stops: each stands for those of a row that follow
/// each other with the same tool, and neither way leaves the other by more than the tolerance.
std::vector<SweptMove> straightened(std::span<const SweptMove> moves, double tolerance_mm);

/// Keeps a CsgRenderer in step with the moves that are to be seen. Moves that come at the end cost
/// themselves alone, and so does a last one that grows longer. Moves that go at the front were cut
/// all the same: as long as the eye stands still, the picture keeps what they removed. Only when
/// others go, all are subtracted anew. Until all are subtracted, the picture before stays: that of
/// the eye before for as long as it takes, that of the same eye for kPatience_ms at most; then what
/// is there is shown, which has too much material, nowhere too little.
///
/// A picture of which much has changed is shown in a frame of its own, after the one that has
/// worked on it: to show it takes about as long as a frame may.
class CsgPicture {
 public:
  static constexpr int kPatience_ms = 400;
  /// Moves that went at the front, and shorter forms of one that grew, are left behind: up to 4 kB
  /// each. So many of them, and all is made anew.
  static constexpr std::size_t kMostStale = 2000;
  /// By which polyhedra stay inside of round cutters: as the pictures of the program are made.
  static constexpr double kTolerance_mm = 0.02;

  /// `coarseness`: by as much of the blank's longest edge, if that is more: fewer triangles. Moves
  /// that come together are straightened by as much.
  explicit CsgPicture(double coarseness = 0.0) : coarseness_(coarseness) {}

  /// Takes the moves over, of the blank and the tools of the first ones, and makes solids of them
  /// for `longest_ms`, some 0.1 ms each; the rest wait. Draws nothing. Error: as CsgRenderer has
  /// them.
  Done follow(const std::shared_ptr<const CutMoves>& moves, double longest_ms);
  /// Goes on with the picture of what was taken over, for about so long. Error: as CsgRenderer has
  /// them.
  Done draw(const Projection& projection, double longest_ms);

  /// All moves are subtracted for the eye that was asked for last, and to be seen; or there is no
  /// eye yet.
  bool is_whole() const { return is_subtracted() && !(renderer_ && !renderer_->unshown().empty()); }
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
  void take(const std::shared_ptr<const CutMoves>& now);
  std::size_t dropped_by(const CutMoves& now) const;
  void begin_anew();
  void will_feed(std::span<const SweptMove> moves);
  void feed(double longest_ms);
  bool is_subtracted() const { return unfed_.empty() && !(renderer_ && renderer_->has_waiting()); }

  double coarseness_;
  double coarse_mm_ = 0.0;                 ///< the same in mm
  std::shared_ptr<const CutMoves> taken_;  ///< over last; all have the same blank and tools
  std::vector<SweptMove> unfed_;  ///< of them are still to be made into solids, the last ones first
  std::size_t stale_ = 0;         ///< see kMostStale
  std::optional<CsgRenderer> renderer_;
  Projection projection_;
  std::optional<Projection> shown_;
  bool shows_all_ = false;  ///< it was whole since the eye moved or others came in their place
  std::optional<Clock::time_point> quiet_until_;  ///< the picture before stays until then
};

}  // namespace kerf
