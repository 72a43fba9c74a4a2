#include "viewer/window/csg_view.h"

#include <algorithm>
#include <utility>

namespace kerf {
namespace {

/// Of a coarse picture, in pixels of the full one.
ScreenRect scaled(const PixelRect& rect, glm::ivec2 from_px, glm::ivec2 to_px) {
  if (rect.empty()) return {};
  const glm::ivec2 last = from_px - 1;
  return {rect.min * to_px / from_px, (rect.max * to_px + last) / from_px};
}

}  // namespace

void CsgView::set(std::shared_ptr<const CutMoves> moves) {
  if (moves_ && (moves_->tools != moves->tools || !(moves_->blank_mm == moves->blank_mm))) {
    release();
  }
  moves_ = std::move(moves);
}

Done CsgView::draw(const Projection& projection) {
  const auto now = Clock::now();
  changed_ = {};
  is_all_new_ = false;
  if (projection != wanted_) {
    // The first one is not awaited.
    if (shown_) still_from_ = now + std::chrono::milliseconds(kStill_ms);
    wanted_ = projection;
  }
  for (CsgPicture* picture : {&full_, &coarse_}) {
    if (Done done = picture->follow(moves_, kFeed_ms); !done) return done;
  }
  const bool is_full_begun = full_.shows(wanted_);
  if (!is_full_begun) {
    if (Done done = draw_coarse(); !done) return done;
  }
  const bool is_coarse_there = eye_ == wanted_ && coarse_.shows(coarse_projection_);
  if (is_full_begun || (is_coarse_there && now >= still_from_)) {
    if (Done done = full_.draw(wanted_, kFrame_ms); !done) return done;
    if (full_.shows(wanted_)) show(full_, wanted_);
  }
  return std::monostate{};
}

void CsgView::begin_coarse(Clock::time_point now) {
  eye_ = wanted_;
  coarse_projection_ = wanted_;
  coarse_projection_.size_px = (wanted_.size_px + divisor_ - 1) / divisor_;
  coarse_begin_ = now;
  is_timed_ = true;
}

/// Goes on with the coarse picture, or begins one for where the eye is now.
Done CsgView::draw_coarse() {
  const auto now = Clock::now();
  const std::chrono::duration<double, std::milli> took = now - coarse_begin_;
  const bool is_there = eye_ && coarse_.shows(coarse_projection_);
  if (!eye_ || (is_there && *eye_ != wanted_)) {
    begin_coarse(now);
  } else if (!is_there && took.count() > 2 * kSlow_ms && divisor_ < kCoarsest) {
    divisor_ *= 2;
    begin_coarse(now);
  }
  if (Done done = coarse_.draw(coarse_projection_, kFrame_ms); !done) return done;
  if (!coarse_.shows(coarse_projection_)) return std::monostate{};
  show(coarse_, *eye_);
  if (!std::exchange(is_timed_, false)) return std::monostate{};
  const std::chrono::duration<double, std::milli> whole = Clock::now() - coarse_begin_;
  if (whole.count() > kSlow_ms) divisor_ = std::min(2 * divisor_, kCoarsest);
  if (whole.count() < kQuick_ms) divisor_ = std::max(divisor_ / 2, 1);
  return std::monostate{};
}

void CsgView::show(const CsgPicture& picture, const Projection& eye) {
  const bool is_full = &picture == &full_;
  is_all_new_ = is_all_new_ || is_full != shows_full_ || shown_ != eye;
  shows_full_ = is_full;
  shown_ = eye;
  changed_ = scaled(picture.changed(), picture.shown()->size_px, eye.size_px);
}

void CsgView::release() { *this = CsgView(); }

}  // namespace kerf
