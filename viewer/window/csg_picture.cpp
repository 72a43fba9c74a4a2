#include "viewer/window/csg_picture.h"

#include <algorithm>
#include <span>
#include <utility>

namespace kerf {
namespace {

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

Done CsgPicture::begin(const CutMoves& moves) {
  const Vec3 size = moves.blank_mm.size();
  CsgOptions options;
  options.tolerance_mm = std::max(kTolerance_mm, coarseness_ * std::max({size.x, size.y, size.z}));
  Result<CsgRenderer> renderer = CsgRenderer::create(options);
  if (!renderer) return Error{renderer.error()};
  if (Done done = renderer->set_blank(box_blank(moves.blank_mm)); !done) return done;
  if (Done done = renderer->set_tools(*moves.tools); !done) return done;
  renderer_.emplace(std::move(*renderer));
  return std::monostate{};
}

void CsgPicture::take(const std::vector<SweptMove>& moves) {
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
    if (shows_all_ && !moves.empty()) {
      quiet_until_ = Clock::now() + std::chrono::milliseconds(kPatience_ms);
    }
    shows_all_ = false;
  }
  taken_ = moves;
}

/// The newest first, as they are drawn.
void CsgPicture::feed(double longest_ms) {
  constexpr std::size_t kAtOnce = 16;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double, std::milli>(longest_ms));
  while (unfed_ > 0) {
    const std::size_t count = std::min(kAtOnce, unfed_);
    unfed_ -= count;
    renderer_->append(std::span(taken_).subspan(unfed_, count));
    if (Clock::now() >= end) return;
  }
}

Done CsgPicture::follow(const std::shared_ptr<const CutMoves>& moves, double longest_ms) {
  if (!renderer_) {
    if (Done done = begin(*moves); !done) return done;
  }
  if (moves != begun_) take(moves->moves);
  begun_ = moves;
  feed(longest_ms);
  return std::monostate{};
}

Done CsgPicture::draw(const Projection& projection, double longest_ms) {
  if (projection != projection_) {
    projection_ = projection;
    quiet_until_.reset();
    shows_all_ = false;
  }
  const auto show = [&](bool shows) {
    if (shows) shown_ = projection;
    return renderer_->draw(projection, longest_ms, shows);
  };
  const bool shows_parts = shows_all_ || (quiet_until_ && Clock::now() > *quiet_until_);
  if (Done done = show(shows_parts); !done || !is_whole()) return done;
  quiet_until_.reset();
  shows_all_ = true;
  return shows_parts ? Done(std::monostate{}) : show(true);
}

std::size_t CsgPicture::gpu_bytes() const {
  return renderer_ ? renderer_->counters().gpu_bytes : 0;
}

}  // namespace kerf
