#include "twin/scene/track_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

constexpr std::size_t kChunksAtOnce = 16;
constexpr double kSagitta_mm = 0.02;
/// Of a tool whose tip alone is looked at.
constexpr double kTipReach_mm = 1;
constexpr double kGreatestStep_rad = 2 * kPi / 8;
constexpr double kSmallestStep_rad = 2 * kPi / 360;

int chords_of(const ArcGeometry& arc, const Vec3& from_mm) {
  const Vec3 out = from_mm - arc.center_mm;
  const double radius_mm = glm::length(out - arc.axis * glm::dot(out, arc.axis));
  const double step =
      2 * std::acos(std::clamp(1 - kSagitta_mm / std::max(radius_mm, 1e-9), -1.0, 1.0));
  const double allowed = std::clamp(step, kSmallestStep_rad, kGreatestStep_rad);
  return std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep_rad) / allowed)));
}

/// As large as it gets: grown by doubling, a full one would hold twice its memory.
std::shared_ptr<PathChunk> new_chunk(std::uint32_t index) {
  auto chunk = std::make_shared<PathChunk>();
  chunk->index = index;
  chunk->vertices.reserve(kPathChunkSegments + 1);
  return chunk;
}

}  // namespace

TrackPath::TrackPath(std::shared_ptr<const ProgramTrack> track, bool planned, MotionMoves moves)
    : track_(std::move(track)),
      feed_kind_(planned ? PathKind::kPlanned : PathKind::kFeed),
      moves_(std::move(moves)) {}

std::vector<std::shared_ptr<const PathChunk>> TrackPath::next_chunks() {
  while (!complete() && made_.size() < kChunksAtOnce) add(next_motion_++);
  // An unfinished last one is sent again with the next ones.
  auto chunks = std::exchange(made_, {});
  if (complete() && open_ && open_->vertices.size() > 1) chunks.push_back(std::move(open_));
  return chunks;
}

std::uint64_t TrackPath::past_vertices(const TrackPosition& place) const {
  if (place.motion >= first_vertex_.size()) return vertices_;
  const std::uint64_t begin = first_vertex_.at(place.motion);
  const std::uint64_t end = place.motion + 1 < first_vertex_.size()
                                ? first_vertex_.at(place.motion + 1)
                                : std::max<std::uint64_t>(vertices_, begin);
  return begin +
         static_cast<std::uint64_t>(std::floor(place.fraction * static_cast<double>(end - begin)));
}

void TrackPath::add(std::size_t motion) {
  const MotionKind kind = track_->kind(motion);
  if (!is_move(kind)) {
    first_vertex_.push(vertices_);
    return;
  }
  const PathKind shown = track_->is_traverse(motion) ? PathKind::kTraverse : feed_kind_;
  if (moves_.path() != nullptr && add_tilted(motion, shown)) return;
  const Vec3 from_mm = track_->from_mm(motion);
  if (vertices_ == 0) push(from_mm, PathKind::kTraverse, motion);
  first_vertex_.push(vertices_);
  if (kind == MotionKind::kArc) {
    const Motion arc = track_->motion(motion);
    const int chords = chords_of(arc.arc, arc.from_mm);
    for (int i = 1; i < chords; ++i) {
      push(point_at(arc, static_cast<double>(i) / chords), shown, motion);
    }
  }
  push(track_->to_mm(motion), shown, motion);
}

/// False: the motion is one of an upright tool.
bool TrackPath::add_tilted(std::size_t motion, PathKind kind) {
  const Motion tilted = track_->motion(motion);
  if (moves_.is_upright(tilted)) return false;
  divided_.clear();
  moves_.path()->moves_of(tilted, kTipReach_mm, motion, divided_);
  if (vertices_ == 0 && !divided_.empty())
    push(divided_.front().from_mm, PathKind::kTraverse, motion);
  first_vertex_.push(vertices_);
  for (const CutMove& move : divided_) push(move.to_mm, kind, motion);
  return true;
}

void TrackPath::push(const Vec3& at, PathKind kind, std::size_t motion) {
  const auto move = static_cast<std::uint32_t>(std::min<std::size_t>(motion, PathVertex::kNoMove));
  const PathVertex vertex{glm::vec3(at), kind, move};
  if (!open_) open_ = new_chunk(0);
  open_->vertices.push_back(vertex);
  ++vertices_;
  if (open_->vertices.size() <= kPathChunkSegments) return;
  auto next = new_chunk(open_->index + 1);
  next->vertices.push_back(vertex);
  made_.push_back(std::exchange(open_, std::move(next)));
}

}  // namespace kerf
