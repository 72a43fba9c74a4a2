#include "viewer/window/scene_pace.h"

namespace kerf {

int ScenePace::divisor(const Projection& eye, Clock::time_point now) {
  if (!eye_ || eye_->size_px != eye.size_px) {
    still_from_ = now;  // another window, not another eye
  } else if (*eye_ != eye) {
    still_from_ = now + std::chrono::milliseconds(kStill_ms);
  }
  eye_ = eye;
  divisor_ = now < still_from_ ? 1 << step_ : 1;
  return divisor_;
}

void ScenePace::took(double ms) {
  if (divisor_ != 1 << step_) return;  // a full one after the eye has moved
  last_ms_[step_] = ms;
  const bool has_helped = step_ == 0 || ms < kHelped * last_ms_[step_ - 1];
  if (ms > kSlow_ms && has_helped && step_ + 1 < last_ms_.size()) {
    ++step_;
  } else if (ms < kQuick_ms && step_ > 0) {
    --step_;
  }
}

}  // namespace kerf
