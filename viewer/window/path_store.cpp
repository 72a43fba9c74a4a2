#include "viewer/window/path_store.h"

#include <algorithm>
#include <array>
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

/// Where the two differ. The path of a machine grows at its end: all before that is the same.
Box change_between(const PathChunk* before, const PathChunk& after) {
  const auto same = [](const PathVertex& a, const PathVertex& b) {
    return a.position_mm == b.position_mm && a.kind == b.kind;
  };
  Box box;
  if (before == nullptr) {
    for (const PathVertex& vertex : after.vertices) box.extend(Vec3(vertex.position_mm));
    return box;
  }
  const auto [old_end, new_end] = std::mismatch(before->vertices.begin(), before->vertices.end(),
                                                after.vertices.begin(), after.vertices.end(), same);
  // The segment that ends at the first vertex that differs begins at the one before.
  for (auto v = old_end == before->vertices.begin() ? old_end : old_end - 1;
       old_end != before->vertices.end() && v != before->vertices.end(); ++v) {
    box.extend(Vec3(v->position_mm));
  }
  for (auto v = new_end == after.vertices.begin() ? new_end : new_end - 1;
       new_end != after.vertices.end() && v != after.vertices.end(); ++v) {
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
    if (last.values) {
      dropped_mm_.extend(last.box_mm);
      gpu_bytes_ -= last.values->vertices.size() * sizeof(PathVertex);
    }
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
    if (!chunk.values) continue;
    const std::size_t count = chunk.values->vertices.size();
    const double segment_mm = chunk.length_mm / static_cast<double>(count);
    while (strides[c] < kMaxStride &&
           2.0 * static_cast<double>(strides[c]) * segment_mm <= kSegment_px * chunk.pixel_mm) {
      strides[c] *= 2;
    }
    drawn += count / strides[c] + 1;
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
    const Box changed = change_between(chunk.values.get(), *values);
    if (!changed.empty()) changed_mm->push_back(changed);
    load(&chunk, std::move(values));
    bytes += size;
  }
  if (bytes > 0 || has_dropped) choose_strides(changed_mm);
  return bytes;
}

void PathStore::load(Chunk* chunk, std::shared_ptr<const PathChunk> values) {
  glBindVertexArray(chunk->array.name());
  glBindBuffer(GL_ARRAY_BUFFER, chunk->vertices.name());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(values->vertices.size() * sizeof(PathVertex)),
               values->vertices.data(), GL_DYNAMIC_DRAW);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  const std::size_t before = chunk->values ? chunk->values->vertices.size() : 0;
  gpu_bytes_ += (values->vertices.size() - before) * sizeof(PathVertex);
  chunk->box_mm = {};
  chunk->run_boxes_mm.clear();
  chunk->length_mm = 0.0;
  const std::vector<PathVertex>& vertices = values->vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    chunk->box_mm.extend(Vec3(vertices[i].position_mm));
    if (i > 0) {
      if ((i - 1) % kRunSegments == 0) {
        chunk->run_boxes_mm.emplace_back().extend(Vec3(vertices[i - 1].position_mm));
      }
      chunk->run_boxes_mm.back().extend(Vec3(vertices[i].position_mm));
      const glm::vec3 step = vertices[i].position_mm - vertices[i - 1].position_mm;
      chunk->length_mm += static_cast<double>(glm::length(step));
    }
  }
  chunk->values = std::move(values);
  project(chunk);
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
    if (!chunk.values) continue;
    const std::uint64_t start = c * kPathChunkSegments;
    if (first <= start && start + kPathChunkSegments <= last) {
      box.extend(chunk.box_mm);
      continue;
    }
    const auto& values = chunk.values->vertices;
    const std::uint64_t end = std::min<std::uint64_t>(values.size(), last - start + 1);
    for (std::uint64_t i = first > start ? first - start : 0; i < end; ++i) {
      box.extend(Vec3(values[i].position_mm));
    }
  }
  if (!box.empty()) changed_mm->push_back(box);
}

void PathStore::project(Chunk* chunk) const {
  chunk->rect = covered_rect(chunk->box_mm, projection_);
  chunk->run_rects.clear();
  for (const Box& box : chunk->run_boxes_mm) {
    chunk->run_rects.push_back(covered_rect(box, projection_));
  }
  chunk->pixel_mm = smallest_pixel_mm(chunk->box_mm, projection_);
}

void PathStore::project(const Projection& projection) {
  projection_ = projection;
  for (Chunk& chunk : chunks_) project(&chunk);
  std::vector<Box> all;  // A new projection changes the whole picture anyway.
  choose_strides(&all);
}

/// `segments` of `stride` vertices each, the first one from vertex `first` on: those that come near
/// the rectangle, as strips.
void PathStore::draw_segments(const Chunk& chunk, const ScreenRect& rect, std::size_t first,
                              std::size_t segments, std::size_t stride) const {
  const auto is_seen = [&](std::size_t begin, std::size_t end) {  // vertices
    for (std::size_t run = begin / kRunSegments; run * kRunSegments < end; ++run) {
      if (chunk.run_rects[run].intersects(rect)) return true;
    }
    return false;
  };
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  const std::size_t at_once = std::max<std::size_t>(1, kRunSegments / stride);
  std::size_t strip_end = 0;
  for (std::size_t begin = 0; begin < segments; begin += at_once) {
    const std::size_t end = std::min(begin + at_once, segments);
    if (!is_seen(first + begin * stride, first + end * stride)) continue;
    if (counts.empty() || strip_end != begin) {
      firsts.push_back(static_cast<GLint>(begin));
      counts.push_back(1);
    }
    counts.back() += static_cast<GLsizei>(end - begin);
    strip_end = end;
  }
  if (counts.empty()) return;
  point_to_vertices(first, stride);
  program_.set("first_vertex", static_cast<int>(chunk.values->index * kPathChunkSegments + first));
  program_.set("stride", static_cast<int>(stride));
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
  for (const Chunk& chunk : chunks_) {
    if (!chunk.values || !chunk.rect.intersects(rect)) continue;
    const std::size_t count = chunk.values->vertices.size();
    const std::size_t coarse = (count - 1) / chunk.stride;  // segments
    glBindVertexArray(chunk.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, chunk.vertices.name());
    draw_segments(chunk, rect, 0, coarse, chunk.stride);
    draw_segments(chunk, rect, coarse * chunk.stride, count - 1 - coarse * chunk.stride, 1);
  }
  glDisable(GL_LINE_SMOOTH);
}

}  // namespace kerf
