#include "viewer/window/path_store.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxStride = kPathChunkSegments;

void point_to_vertices(std::size_t first, std::size_t stride) {
  const auto bytes = static_cast<GLsizei>(stride * sizeof(PathVertex));
  const std::size_t offset = first * sizeof(PathVertex);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, bytes, reinterpret_cast<const void*>(offset));
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, bytes,
                         reinterpret_cast<const void*>(offset + offsetof(PathVertex, kind)));
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
      vertex_count_ -= last.values->vertices.size();
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

std::size_t PathStore::stride() const {
  std::size_t stride = 1;
  while (stride < kMaxStride && vertex_count_ / stride > kDrawnVertices) stride *= 2;
  return stride;
}

std::size_t PathStore::upload(std::size_t budget_bytes, std::vector<Box>* changed_mm) {
  if (!dropped_mm_.empty()) changed_mm->push_back(std::exchange(dropped_mm_, Box{}));
  std::size_t bytes = 0;
  while (!waiting_.empty()) {
    const std::size_t size = waiting_.front()->vertices.size() * sizeof(PathVertex);
    if (bytes > 0 && bytes + size > budget_bytes) break;
    std::shared_ptr<const PathChunk> values = std::move(waiting_.front());
    waiting_.pop_front();
    if (values->index >= chunks_.size()) chunks_.resize(values->index + 1);
    Chunk& chunk = chunks_[values->index];
    if (!chunk.box_mm.empty()) changed_mm->push_back(chunk.box_mm);
    load(&chunk, std::move(values));
    if (!chunk.box_mm.empty()) changed_mm->push_back(chunk.box_mm);
    bytes += size;
  }
  if (const std::size_t now = stride(); now != drawn_stride_) {
    drawn_stride_ = now;
    for (const Chunk& chunk : chunks_) changed_mm->push_back(chunk.box_mm);
  }
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
  vertex_count_ += values->vertices.size() - before;
  gpu_bytes_ += (values->vertices.size() - before) * sizeof(PathVertex);
  chunk->box_mm = {};
  for (const PathVertex& vertex : values->vertices) chunk->box_mm.extend(Vec3(vertex.position_mm));
  chunk->rect = covered_rect(chunk->box_mm, projection_);
  chunk->values = std::move(values);
}

void PathStore::set_past(std::uint64_t vertices, std::vector<Box>* changed_mm) {
  const std::uint64_t low = std::min(vertices, past_vertices_);
  const std::uint64_t high = std::max(vertices, past_vertices_);
  past_vertices_ = vertices;
  if (low == high) return;
  // Segments are drawn from one multiple of the stride to the next.
  const std::uint64_t margin = drawn_stride_;
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

void PathStore::project(const Projection& projection) {
  projection_ = projection;
  for (Chunk& chunk : chunks_) chunk.rect = covered_rect(chunk.box_mm, projection);
}

void PathStore::draw(const ScreenRect& rect, const PathColors& colors) const {
  program_.use();
  program_.set("clip_from_world", projection_.clip_from_world);
  // Past what an int holds everything is past.
  program_.set("past_vertices",
               static_cast<int>(std::min<std::uint64_t>(past_vertices_, 1u << 30)));
  for (std::size_t kind = 0; kind < colors.past.size(); ++kind) {
    const std::string at = "rgba[" + std::to_string(2 * kind);
    program_.set((at + "]").c_str(), colors.past[kind]);
    program_.set(("rgba[" + std::to_string(2 * kind + 1) + "]").c_str(), colors.future[kind]);
  }
  for (const Chunk& chunk : chunks_) {
    if (!chunk.values || !chunk.rect.intersects(rect)) continue;
    const std::size_t count = chunk.values->vertices.size();
    const std::size_t coarse = (count - 1) / drawn_stride_;  // segments
    const std::size_t rest_first = coarse * drawn_stride_;
    const auto first_vertex = static_cast<int>(chunk.values->index * kPathChunkSegments);
    glBindVertexArray(chunk.array.name());
    glBindBuffer(GL_ARRAY_BUFFER, chunk.vertices.name());
    if (coarse > 0) {
      point_to_vertices(0, drawn_stride_);
      program_.set("first_vertex", first_vertex);
      program_.set("stride", static_cast<int>(drawn_stride_));
      glDrawArrays(GL_LINE_STRIP, 0, static_cast<GLsizei>(coarse + 1));
    }
    if (rest_first + 1 < count) {
      point_to_vertices(rest_first, 1);
      program_.set("first_vertex", first_vertex + static_cast<int>(rest_first));
      program_.set("stride", 1);
      glDrawArrays(GL_LINE_STRIP, 0, static_cast<GLsizei>(count - rest_first));
    }
  }
}

}  // namespace kerf
