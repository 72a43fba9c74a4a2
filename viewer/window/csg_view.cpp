#include "viewer/window/csg_view.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace kerf {
namespace {

/// As the pictures of the program are made.
constexpr double kTolerance_mm = 0.02;

/// More new moves than this are not made into solids in one frame.
constexpr std::size_t kMostAtOnce = 64;

bool is_same(const SweptMove& a, const SweptMove& b) {
  return a.from_mm == b.from_mm && a.to_mm == b.to_mm && a.tool == b.tool;
}

/// The same move, gone on.
bool has_grown(const SweptMove& before, const SweptMove& now) {
  if (before.from_mm != now.from_mm || before.tool != now.tool) return false;
  const Vec3 was = before.to_mm - before.from_mm, is = now.to_mm - now.from_mm;
  const double along = glm::dot(was, is);
  constexpr double kSameWay = 1e-12;
  return along >= glm::dot(was, was) * (1.0 - kSameWay) &&
         glm::dot(was, was) * glm::dot(is, is) - along * along <=
             kSameWay * glm::dot(is, is) * glm::dot(is, is);
}

}  // namespace

Done CsgView::begin() {
  if (!renderer_) {
    CsgOptions options;
    options.tolerance_mm = kTolerance_mm;
    Result<CsgRenderer> renderer = CsgRenderer::create(options);
    if (!renderer) return Error{renderer.error()};
    renderer_.emplace(std::move(*renderer));
  }
  if (begun_ && begun_->tools == wanted_->tools && begun_->blank_mm == wanted_->blank_mm) {
    return std::monostate{};
  }
  begun_ = wanted_;
  taken_.clear();
  unfed_ = 0;
  grown_ = 0;
  if (Done done = renderer_->set_blank(box_blank(wanted_->blank_mm)); !done) return done;
  return renderer_->set_tools(*wanted_->tools);
}

/// True if all moves have to be subtracted anew.
bool CsgView::take_moves() {
  const std::vector<SweptMove>& moves = wanted_->moves;
  const auto same = static_cast<std::size_t>(
      std::mismatch(taken_.begin(), taken_.end(), moves.begin(), moves.end(), is_same).first -
      taken_.begin());
  const bool grows =
      same + 1 == taken_.size() && same < moves.size() && has_grown(taken_.back(), moves[same]);
  if (grows) ++grown_;
  const bool goes_on = (same == taken_.size() || grows) && grown_ <= kMostGrown &&
                       moves.size() - same <= kMostAtOnce;
  if (goes_on) {
    renderer_->append(std::span(moves).subspan(same));
  } else {
    renderer_->clear_moves();
    grown_ = 0;
    unfed_ = moves.size();
  }
  taken_ = moves;
  return !goes_on;
}

/// The newest first, as they are drawn.
void CsgView::feed() {
  constexpr std::size_t kAtOnce = 16;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double, std::milli>(kFeed_ms));
  while (unfed_ > 0) {
    const std::size_t count = std::min(kAtOnce, unfed_);
    unfed_ -= count;
    renderer_->append(std::span(taken_).subspan(unfed_, count));
    if (Clock::now() >= end) return;
  }
}

Done CsgView::draw(const Projection& projection) {
  if (Done done = begin(); !done) return done;
  const auto now = Clock::now();
  if (take_moves() && projection == projection_ && !quiet_until_) {
    quiet_until_ = now + std::chrono::milliseconds(kPatience_ms);
  }
  if (projection != projection_ || (quiet_until_ && now > *quiet_until_)) quiet_until_.reset();
  projection_ = projection;
  feed();
  if (Done done = renderer_->draw(projection, kFrame_ms, !quiet_until_); !done) return done;
  if (!quiet_until_ || has_waiting()) return std::monostate{};
  quiet_until_.reset();
  return renderer_->draw(projection, kFrame_ms, true);
}

std::size_t CsgView::gpu_bytes() const { return renderer_ ? renderer_->counters().gpu_bytes : 0; }

void CsgView::release() {
  renderer_.reset();
  begun_.reset();
  taken_.clear();
  unfed_ = 0;
  grown_ = 0;
  quiet_until_.reset();
  projection_ = {};
}

}  // namespace kerf
