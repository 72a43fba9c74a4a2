// viewer/window/csg_view.h - blank minus moves, for an eye that turns while they are cut. For the
// sources of viewer/ only.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "base/result.h"
#include "viewer/csg/cut_moves.h"
#include "viewer/window/csg_picture.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Two pictures of the same moves, so that there is a whole one to be seen at any time and no frame
/// takes longer than about kFrame_ms:
///
///     full      for the eye that stands still; new moves are there at once
///     coarse    a fraction of the pixels, for the eye that moves: begun when it has moved, shown
///               when it is whole, and begun again for where the eye is then; so it lags behind
///               the eye. New moves come into it until the full one is there.
///
/// The fraction is the one whose last picture took about kQuick_ms to kSlow_ms.
class CsgView {
 public:
  static constexpr double kFrame_ms = 12.0;
  /// Of it for making solids of moves.
  static constexpr double kFeed_ms = 3.0;
  /// An eye that has not moved for so long stands still.
  static constexpr int kStill_ms = 120;
  /// A coarse picture that took longer than kSlow_ms is followed by one of half the edges, one that
  /// took less than kQuick_ms by one of twice. A factor of 4 is the pixels' own: with less between
  /// the two the choice would go to and fro.
  static constexpr double kSlow_ms = 100.0, kQuick_ms = 15.0;
  static constexpr int kCoarsest = 8;
  /// Round cutters of the coarse picture stay so far inside, and its moves are straightened by as
  /// much, in shares of the blank's longest edge: half a pixel or less where the blank fills a
  /// window. A new view costs moves and triangles first.
  static constexpr double kCoarseness = 0.002;

  /// Never null. Of another blank or other tools: begins anew.
  void set(std::shared_ptr<const CutMoves> moves);
  bool has_moves() const { return moves_ != nullptr; }

  /// Goes on with the picture. Error: as CsgRenderer has them.
  Done draw(const Projection& projection);
  /// There is more to be done for the eye that was asked for: draw again.
  bool has_waiting() const { return moves_ && !(full_.is_whole() && full_.shows(wanted_)); }

  /// The eye of what is to be seen now, with the size that was asked for; none: there is nothing
  /// yet.
  const std::optional<Projection>& shown() const { return shown_; }
  /// What is to be seen is the full picture, for the eye that was asked for last; the newest moves
  /// may be missing.
  bool is_full() const { return shows_full_ && shown_ == wanted_; }
  /// By the last draw(): all of the picture, or this rectangle of the size that was asked for.
  bool is_all_new() const { return is_all_new_; }
  const ScreenRect& changed() const { return changed_; }
  /// Colour and depth of what is to be seen, maybe of fewer pixels.
  void bind(int color_unit, int depth_unit) const {
    (shows_full_ ? full_ : coarse_).bind(color_unit, depth_unit);
  }
  std::size_t gpu_bytes() const { return full_.gpu_bytes() + coarse_.gpu_bytes(); }
  /// Gives the memory back.
  void release();

 private:
  using Clock = std::chrono::steady_clock;
  Done draw_coarse();
  void begin_coarse(Clock::time_point now);
  void show(const CsgPicture& picture, const Projection& eye);

  std::shared_ptr<const CutMoves> moves_;
  CsgPicture full_;
  CsgPicture coarse_{kCoarseness};
  Projection wanted_;
  Clock::time_point still_from_{};
  std::optional<Projection> eye_;  ///< of the coarse picture that is being made; in full size
  Projection coarse_projection_;   ///< the same, in its own size
  bool is_timed_ = false;          ///< how long it took is still to be found
  Clock::time_point coarse_begin_{};
  int divisor_ = 2;
  bool shows_full_ = false;
  std::optional<Projection> shown_;
  bool is_all_new_ = false;
  ScreenRect changed_;
};

}  // namespace kerf
