#include "viewer/csg/csg_schedule.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>

namespace kerf {
namespace {

/// Small enough to keep neighbours apart, large enough that a solid covers few of them.
constexpr int kTile_px = 16;
/// Rounding of the rasterizer.
constexpr int kBorder_px = 1;
/// Below this w a corner counts as reaching the eye.
constexpr float kMinW = 1e-4f;

}  // namespace

std::int64_t PixelRect::pixels() const {
  return empty() ? 0 : static_cast<std::int64_t>(max.x - min.x) * (max.y - min.y);
}

void PixelRect::extend(const PixelRect& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  min = {std::min(min.x, other.min.x), std::min(min.y, other.min.y)};
  max = {std::max(max.x, other.max.x), std::max(max.y, other.max.y)};
}

PixelArea pixels_of(const Box& box, const Projection& projection) {
  if (box.empty()) return {};
  const glm::vec2 size(projection.size_px);
  glm::vec2 low(std::numeric_limits<float>::max());
  glm::vec2 high(-low);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(static_cast<float>((corner & 1u) ? box.max.x : box.min.x),
                      static_cast<float>((corner & 2u) ? box.max.y : box.min.y),
                      static_cast<float>((corner & 4u) ? box.max.z : box.min.z));
    const glm::vec4 clip = projection.clip_from_world * glm::vec4(p, 1.0f);
    if (!(clip.w > kMinW)) return {{{0, 0}, projection.size_px}, true};
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * size;
    low = {std::min(low.x, at.x), std::min(low.y, at.y)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y)};
  }
  const auto inside = [](float value, int border, int limit) {
    const float kept = std::clamp(std::floor(value), -1.0f - kBorder_px, limit + 1.0f);
    return std::clamp(static_cast<int>(kept) + border, 0, limit);
  };
  return {{{inside(low.x, -kBorder_px, projection.size_px.x),
            inside(low.y, -kBorder_px, projection.size_px.y)},
           {inside(high.x, kBorder_px + 1, projection.size_px.x),
            inside(high.y, kBorder_px + 1, projection.size_px.y)}},
          false};
}

TileClock::TileClock(glm::ivec2 size_px)
    : tiles_((size_px + kTile_px - 1) / kTile_px),
      moved_at_(static_cast<std::size_t>(tiles_.x) * static_cast<std::size_t>(tiles_.y), 0) {}

template <class Use>
void TileClock::for_each_tile(const PixelRect& rect, const Use& use) const {
  if (rect.empty()) return;
  const glm::ivec2 first = rect.min / kTile_px;
  const glm::ivec2 last = (rect.max - 1) / kTile_px;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) use(static_cast<std::size_t>(y * tiles_.x + x));
  }
}

void TileClock::mark(const PixelRect& rect, std::uint64_t time) {
  for_each_tile(rect, [this, time](std::size_t tile) { moved_at_[tile] = time; });
}

std::uint64_t TileClock::newest(const PixelRect& rect) const {
  std::uint64_t newest = 0;
  for_each_tile(rect, [&](std::size_t tile) { newest = std::max(newest, moved_at_[tile]); });
  return newest;
}

std::vector<std::uint32_t> TileClock::batches(std::span<const PixelRect> sequence) const {
  std::vector<std::uint32_t> free_from(moved_at_.size(), 0);  // first batch that may use the tile
  std::vector<std::uint32_t> batch_of;
  batch_of.reserve(sequence.size());
  for (const PixelRect& rect : sequence) {
    std::uint32_t batch = 0;
    for_each_tile(rect, [&](std::size_t tile) { batch = std::max(batch, free_from[tile]); });
    for_each_tile(rect, [&](std::size_t tile) { free_from[tile] = batch + 1; });
    batch_of.push_back(batch);
  }
  return batch_of;
}

}  // namespace kerf
