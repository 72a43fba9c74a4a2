#include "viewer/window/path_store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxStride = kPathChunkSegments;
/// A drawn segment is about this long, where the path has more vertices.
constexpr double kSegment_px = 1.0;
/// Lines are drawn this many pixels nearer to the eye than they are, so that those that lie in a
/// surface are seen on it: enough for surfaces that are turned away by up to 70 degrees.
constexpr double kNearer_px = 2.5;

void point_to_vertices(std::size_t first, std::size_t stride) {
  const auto bytes = static_cast<GLsizei>(stride * sizeof(PathVertex));
  const std::size_t offset = first * sizeof(PathVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, bytes, reinterpret_cast<const void*>(offset));
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, bytes,
                         reinterpret_cast<const void*>(offset + offsetof(PathVertex, kind)));
}

/// Of a chunk's box in each direction.
constexpr double kSteps = 65535.0;

Box box_of(const std::vector<PathVertex>& vertices) {
  Box box;
  for (const PathVertex& vertex : vertices) box.extend(Vec3(vertex.position_mm));
  return box;
}

/// Where the two differ. The path of a machine grows at its end: all before that is the same.
Box change_between(const std::vector<PathVertex>& before, const std::vector<PathVertex>& after) {
  const auto same = [](const PathVertex& a, const PathVertex& b) {
    return a.position_mm == b.position_mm && a.kind == b.kind;
  };
  const auto [old_end, new_end] =
      std::mismatch(before.begin(), before.end(), after.begin(), after.end(), same);
  Box box;
  // The segment that ends at the first vertex that differs begins at the one before.
  for (auto v = old_end == before.begin() ? old_end : old_end - 1;
       old_end != before.end() && v != before.end(); ++v) {
    box.extend(Vec3(v->position_mm));
  }
  for (auto v = new_end == after.begin() ? new_end : new_end - 1;
       new_end != after.end() && v != after.end(); ++v) {
    box.extend(Vec3(v->position_mm));
  }
  return box;
}

}  // namespace

Result<PathStore> PathStore::create() {
  Result<GlProgram> program = GlProgram::create(shaders::path_vert, shaders::path_frag);
  if (!program) return Error{program.error()};
  return PathStore(std::move(*program));
}

void PathStore::set_chunk_count(std::uint32_t count) {
  std::erase_if(waiting_, [count](const auto& chunk) { return chunk->index >= count; });
  while (chunks_.size() > count) {
    const Chunk& last = chunks_.back();
    dropped_mm_.extend(last.box_mm);
    gpu_bytes_ -= last.count * sizeof(PathVertex);
    chunks_.pop_back();
  }
}

void PathStore::offer(std::shared_ptr<const PathChunk> chunk) {
  for (auto& waiting : waiting_) {
    if (waiting->index == chunk->index) {
      waiting = std::move(chunk);
      return;
    }
  }
  waiting_.push_back(std::move(chunk));
}

void PathStore::clear() {
  set_chunk_count(0);
  past_vertices_ = 0;
}

void PathStore::choose_strides(std::vector<Box>* changed_mm) {
  std::vector<std::size_t> strides(chunks_.size(), 1);
  std::size_t drawn = 0;
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    if (chunk.count == 0) continue;
    const double segment_mm = chunk.length_mm / static_cast<double>(chunk.count);
    while (strides[c] < kMaxStride &&
           2.0 * static_cast<double>(strides[c]) * segment_mm <= kSegment_px * chunk.pixel_mm) {
      strides[c] *= 2;
    }
    drawn += chunk.count / strides[c] + 1;
  }
  std::size_t thinning = 1;
  while (thinning < kMaxStride && drawn / thinning > kDrawnVertices) thinning *= 2;
  const bool is_smooth = drawn / thinning <= kSmoothVertices;
  largest_stride_ = 1;
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const std::size_t stride = std::min(thinning * strides[c], kMaxStride);
    largest_stride_ = std::max(largest_stride_, stride);
    if (stride == chunks_[c].stride && is_smooth == is_smooth_) continue;
    chunks_[c].stride = stride;
    if (!chunks_[c].box_mm.empty()) changed_mm->push_back(chunks_[c].box_mm);
  }
  is_smooth_ = is_smooth;
}

std::size_t PathStore::upload(std::size_t budget_bytes, std::vector<Box>* changed_mm) {
  const bool has_dropped = !dropped_mm_.empty();
  if (has_dropped) changed_mm->push_back(std::exchange(dropped_mm_, Box{}));
  std::size_t bytes = 0;
  while (!waiting_.empty()) {
    const std::size_t size = waiting_.front()->vertices.size() * sizeof(PathVertex);
    if (bytes > 0 && bytes + size > budget_bytes) break;
    std::shared_ptr<const PathChunk> values = std::move(waiting_.front());
    waiting_.pop_front();
    if (values->index >= chunks_.size()) chunks_.resize(values->index + 1);
    Chunk& chunk = chunks_[values->index];
    const Box changed = change_of(chunk, *values);
    if (!changed.empty()) changed_mm->push_back(changed);
    load(&chunk, std::move(values));
    bytes += size;
  }
  if (bytes > 0 || has_dropped) choose_strides(changed_mm);
  return bytes;
}

Box PathStore::change_of(const Chunk& chunk, const PathChunk& values) {
  if (chunk.growing) return change_between(chunk.growing->vertices, values.vertices);
  Box box = chunk.box_mm;
  box.extend(box_of(values.vertices));
  return box;
}

void PathStore::load(Chunk* chunk, std::shared_ptr<const PathChunk> values) {
  const std::vector<PathVertex>& vertices = values->vertices;
  glBindVertexArray(chunk->array.name());
  glBindBuffer(GL_ARRAY_BUFFER, chunk->vertices.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(PathVertex)),
               vertices.data(), GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  gpu_bytes_ += (vertices.size() - chunk->count) * sizeof(PathVertex);
  chunk->count = vertices.size();
  measure(chunk, vertices);
  project(chunk);
  chunk->growing = vertices.size() <= kPathChunkSegments ? std::move(values) : nullptr;
}

void PathStore::measure(Chunk* chunk, const std::vector<PathVertex>& vertices) {
  chunk->box_mm = box_of(vertices);
  chunk->run_boxes_mm.clear();
  chunk->run_boxes_mm.reserve(vertices.size() / kRunSegments + 1);
  chunk->length_mm = 0.0;
  chunk->places.clear();
  chunk->places.reserve(vertices.size());
  const Vec3 size = chunk->box_mm.size();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 at(vertices[i].position_mm);
    Steps& place = chunk->places.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const double share = size[axis] > 0 ? (at[axis] - chunk->box_mm.min[axis]) / size[axis] : 0.0;
      place[static_cast<std::size_t>(axis)] =
          static_cast<std::uint16_t>(std::lround(share * kSteps));
    }
    if (i == 0) continue;
    if ((i - 1) % kRunSegments == 0) {
      chunk->run_boxes_mm.emplace_back().extend(Vec3(vertices[i - 1].position_mm));
    }
    chunk->run_boxes_mm.back().extend(at);
    const glm::vec3 step = vertices[i].position_mm - vertices[i - 1].position_mm;
    chunk->length_mm += static_cast<double>(glm::length(step));
  }
}

Box PathStore::box_of_part(const Chunk& chunk, std::size_t begin, std::size_t end) {
  Steps low{0xffff, 0xffff, 0xffff}, high{0, 0, 0};
  if (begin >= end) return {};
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t axis = 0; axis < low.size(); ++axis) {
      low[axis] = std::min(low[axis], chunk.places[i][axis]);
      high[axis] = std::max(high[axis], chunk.places[i][axis]);
    }
  }
  const Vec3 step_mm = chunk.box_mm.size() / kSteps;
  // A place is rounded: it is less than a step off.
  return {chunk.box_mm.min + (Vec3(low[0], low[1], low[2]) - 1.0) * step_mm,
          chunk.box_mm.min + (Vec3(high[0], high[1], high[2]) + 1.0) * step_mm};
}

void PathStore::set_past(std::uint64_t vertices, std::vector<Box>* changed_mm) {
  const std::uint64_t low = std::min(vertices, past_vertices_);
  const std::uint64_t high = std::max(vertices, past_vertices_);
  past_vertices_ = vertices;
  if (low == high) return;
  // Segments are drawn from one multiple of the stride to the next.
  const std::uint64_t margin = largest_stride_;
  const std::uint64_t first = low > margin ? low - margin - 1 : 0;
  const std::uint64_t last = high + margin;
  Box box;
  for (std::uint64_t c = first / kPathChunkSegments;
       c < chunks_.size() && c * kPathChunkSegments <= last; ++c) {
    const Chunk& chunk = chunks_[c];
    const std::uint64_t start = c * kPathChunkSegments;
    const std::uint64_t begin = first > start ? first - start : 0;
    const std::uint64_t end = std::min<std::uint64_t>(chunk.count, last - start + 1);
    const bool is_whole = begin == 0 && end == chunk.count;
    box.extend(is_whole ? chunk.box_mm : box_of_part(chunk, begin, end));
  }
  if (!box.empty()) changed_mm->push_back(box);
}

void PathStore::project(Chunk* chunk) const {
  chunk->rect = covered_rect(chunk->box_mm, projection_);
  chunk->run_rects.clear();
  chunk->pixel_mm = smallest_pixel_mm(chunk->box_mm, projection_);
}

void PathStore::project(const Projection& projection) {
  projection_ = projection;
  for (Chunk& chunk : chunks_) project(&chunk);
  std::vector<Box> all;  // A new projection changes the whole picture anyway.
  choose_strides(&all);
}

/// Of the chunks that a rectangle cuts only: to know them for all would cost more than drawing,
/// whenever the eye moves.
const std::vector<ScreenRect>& PathStore::run_rects(const Chunk& chunk) const {
  if (chunk.run_rects.empty()) {
    chunk.run_rects.reserve(chunk.run_boxes_mm.size());
    for (const Box& box : chunk.run_boxes_mm) {
      chunk.run_rects.push_back(covered_rect(box, projection_));
    }
  }
  return chunk.run_rects;
}

/// The segments that come near the rectangle, as strips.
void PathStore::draw_segments(const Chunk& chunk, std::size_t path_begin, const ScreenRect& rect,
                              const DrawnPart& part) const {
  const bool is_whole = chunk.rect.common(rect) == chunk.rect;
  const auto is_seen = [&](std::size_t begin, std::size_t end) {  // vertices
    if (is_whole) return true;
    const std::vector<ScreenRect>& rects = run_rects(chunk);
    for (std::size_t run = begin / kRunSegments; run * kRunSegments < end; ++run) {
      if (rects[run].intersects(rect)) return true;
    }
    return false;
  };
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  const std::size_t at_once = std::max<std::size_t>(1, kRunSegments / part.stride);
  std::size_t strip_end = 0;
  for (std::size_t begin = 0; begin < part.segments; begin += at_once) {
    const std::size_t end = std::min(begin + at_once, part.segments);
    if (!is_seen(part.first + begin * part.stride, part.first + end * part.stride)) continue;
    if (counts.empty() || strip_end != begin) {
      firsts.push_back(static_cast<GLint>(begin));
      counts.push_back(1);
    }
    counts.back() += static_cast<GLsizei>(end - begin);
    strip_end = end;
  }
  if (counts.empty()) return;
  point_to_vertices(part.first, part.stride);
  program_.set("first_vertex", static_cast<int>(path_begin + part.first));
  program_.set("stride", static_cast<int>(part.stride));
  glMultiDrawArrays(GL_LINE_STRIP, firsts.data(), counts.data(),
                    static_cast<GLsizei>(counts.size()));
}

void PathStore::draw(const ScreenRect& rect, const PathColors& colors, bool may_smooth) const {
  program_.use();
  program_.set("clip_from_world", projection_.clip_from_world);
  program_.set("towards_eye", towards_eye(projection_, kNearer_px));
  // Past what an int holds everything is past.
  program_.set("past_vertices",
               static_cast<int>(std::min<std::uint64_t>(past_vertices_, 1u << 30)));
  for (std::size_t kind = 0; kind < colors.past.size(); ++kind) {
    const std::string at = "rgba[" + std::to_string(2 * kind);
    program_.set((at + "]").c_str(), colors.past[kind]);
    program_.set(("rgba[" + std::to_string(2 * kind + 1) + "]").c_str(), colors.future[kind]);
  }
  if (may_smooth && is_smooth_) glEnable(GL_LINE_SMOOTH);
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    if (chunk.count == 0 || !chunk.rect.intersects(rect)) continue;
    const std::size_t path_begin = c * kPathChunkSegments;
    const std::size_t segments = chunk.count - 1;
    const std::size_t coarse = segments / chunk.stride;
    const std::size_t rest = coarse * chunk.stride;
    glBindVertexArray(chunk.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, chunk.vertices.name());
    draw_segments(chunk, path_begin, rect, {0, coarse, chunk.stride});
    draw_segments(chunk, path_begin, rect, {rest, segments - rest, 1});
  }
  glDisable(GL_LINE_SMOOTH);
}

}  // namespace kerf
