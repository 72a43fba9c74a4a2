#include "viewer/window/csg_picture.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

namespace kerf {
namespace {

/// To show more pixels than these takes so long on a software renderer, together with all that is
/// drawn around the picture, that there is no time for anything else in that frame.
constexpr std::int64_t kLong_px = 100'000;

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

double distance_mm(const Vec3& point, const SweptMove& move) {
  const Vec3 way = move.to_mm - move.from_mm, to_point = point - move.from_mm;
  const double length2 = glm::dot(way, way);
  const double share = length2 > 0 ? std::clamp(glm::dot(to_point, way) / length2, 0.0, 1.0) : 0.0;
  return glm::length(to_point - share * way);
}

/// As many of the moves, from the first one on, as one straight move may stand for: the tip's way
/// and that move lie within the tolerance of each other.
std::size_t count_as_one(std::span<const SweptMove> moves, double tolerance_mm) {
  constexpr std::size_t kMost = 32;  // the work grows with its square
  std::size_t count = 1;
  while (count < std::min(kMost, moves.size())) {
    const SweptMove& next = moves[count];
    if (next.from_mm != moves[count - 1].to_mm || next.tool != moves[0].tool) break;
    const SweptMove one{moves[0].from_mm, next.to_mm, next.tool};
    const bool is_near =
        std::all_of(moves.begin(), moves.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](const SweptMove& m) { return distance_mm(m.to_mm, one) <= tolerance_mm; });
    if (!is_near) break;
    ++count;
  }
  return count;
}

}  // namespace

std::vector<SweptMove> straightened(std::span<const SweptMove> moves, double tolerance_mm) {
  std::vector<SweptMove> fewer;
  while (!moves.empty()) {
    const std::size_t count = count_as_one(moves, tolerance_mm);
    fewer.push_back({moves[0].from_mm, moves[count - 1].to_mm, moves[0].tool});
    moves = moves.subspan(count);
  }
  return fewer;
}

Done CsgPicture::begin(const CutMoves& moves) {
  const Vec3 size = moves.blank_mm.size();
  CsgOptions options;
  coarse_mm_ = coarseness_ * std::max({size.x, size.y, size.z});
  options.tolerance_mm = std::max(kTolerance_mm, coarse_mm_);
  Result<CsgRenderer> renderer = CsgRenderer::create(options);
  if (!renderer) return Error{renderer.error()};
  if (Done done = renderer->set_blank(box_blank(moves.blank_mm)); !done) return done;
  if (Done done = renderer->set_tools(*moves.tools); !done) return done;
  renderer_.emplace(std::move(*renderer));
  return std::monostate{};
}

/// As many of the moves taken over last are missing at the front of these, which have all others of
/// them; 0 if they have not.
std::size_t CsgPicture::dropped_by(const CutMoves& now) const {
  // Else it is a place before that, and equal moves are others.
  if (now.left_out <= taken_->left_out) return 0;
  const std::vector<SweptMove>& before = taken_->moves;
  for (std::size_t first = 0; first < before.size(); ++first) {
    const std::size_t last = before.size() - 1 - first;
    if (last >= now.moves.size()) continue;
    // That one may have grown meanwhile.
    if (std::equal(now.moves.begin(), now.moves.begin() + static_cast<std::ptrdiff_t>(last),
                   before.begin() + static_cast<std::ptrdiff_t>(first), is_same) &&
        has_grown(before.back(), now.moves[last])) {
      return first;
    }
  }
  return 0;
}

void CsgPicture::take(const std::shared_ptr<const CutMoves>& now) {
  const std::vector<SweptMove>& moves = now->moves;
  const std::size_t dropped = taken_ ? dropped_by(*now) : 0;
  const std::span<const SweptMove> before =
      taken_ ? std::span(taken_->moves).subspan(dropped) : std::span<const SweptMove>();
  const auto same = static_cast<std::size_t>(
      std::mismatch(before.begin(), before.end(), moves.begin(), moves.end(), is_same).first -
      before.begin());
  const bool grows =
      same + 1 == before.size() && same < moves.size() && has_grown(before.back(), moves[same]);
  const bool is_back = taken_ && now->left_out < taken_->left_out;
  const bool goes_on = !is_back && (same == before.size() || grows);
  stale_ += dropped + (grows ? 1 : 0);
  taken_ = now;
  if (goes_on && stale_ <= kMostStale) {
    will_feed(std::span(moves).subspan(same));
    return;
  }
  if (shows_all_ && !moves.empty()) {
    quiet_until_ = Clock::now() + std::chrono::milliseconds(kPatience_ms);
  }
  shows_all_ = false;
  begin_anew();
}

void CsgPicture::begin_anew() {
  renderer_->clear_moves();
  unfed_.clear();
  will_feed(taken_->moves);
  stale_ = 0;
}

void CsgPicture::will_feed(std::span<const SweptMove> moves) {
  if (coarse_mm_ > 0.0) {
    const std::vector<SweptMove> fewer = straightened(moves, coarse_mm_);
    unfed_.insert(unfed_.end(), fewer.begin(), fewer.end());
  } else {
    unfed_.insert(unfed_.end(), moves.begin(), moves.end());
  }
}

/// The newest first, as they are drawn.
void CsgPicture::feed(double longest_ms) {
  constexpr std::size_t kAtOnce = 16;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double, std::milli>(longest_ms));
  while (!unfed_.empty()) {
    const std::size_t count = std::min(kAtOnce, unfed_.size());
    renderer_->append(std::span(unfed_).last(count));
    unfed_.resize(unfed_.size() - count);
    if (Clock::now() >= end) return;
  }
}

Done CsgPicture::follow(const std::shared_ptr<const CutMoves>& moves, double longest_ms) {
  if (!renderer_) {
    if (Done done = begin(*moves); !done) return done;
  }
  if (moves != taken_) take(moves);
  feed(longest_ms);
  return std::monostate{};
}

Done CsgPicture::draw(const Projection& projection, double longest_ms) {
  const bool is_new_eye = projection != projection_;
  if (is_new_eye) {
    projection_ = projection;
    quiet_until_.reset();
    shows_all_ = false;
    // All are to be subtracted again: not those too that nobody asks for.
    if (taken_ && stale_ > taken_->moves.size() / 2) begin_anew();
  }
  const auto begin = Clock::now();
  const auto is_due = [&] {
    return shows_all_ || is_subtracted() || (quiet_until_ && begin > *quiet_until_);
  };
  const auto is_long = [&] { return renderer_->unshown().pixels() > kLong_px; };
  const bool only_shows = !is_new_eye && is_due() && is_long();
  if (!only_shows) {
    if (Done done = renderer_->draw(projection, longest_ms, false); !done) return done;
    const std::chrono::duration<double, std::milli> worked = Clock::now() - begin;
    if (!is_due() || (is_long() && worked.count() > 0.5 * longest_ms)) return std::monostate{};
  }
  shown_ = projection;
  if (is_subtracted()) {
    quiet_until_.reset();
    shows_all_ = true;
  }
  return renderer_->draw(projection, 0.0, true);
}

std::size_t CsgPicture::gpu_bytes() const {
  return renderer_ ? renderer_->counters().gpu_bytes : 0;
}

}  // namespace kerf
