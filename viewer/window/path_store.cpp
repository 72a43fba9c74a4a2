#include "viewer/window/path_store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "viewer/shaders/shaders.h"
#include "viewer/window/path_thinning.h"

namespace kerf {
namespace {

/// Lines are drawn this many pixels nearer to the eye than they are, so that those that lie in a
/// surface are seen on it: enough for surfaces that are turned away by up to 70 degrees.
constexpr double kNearer_px = 2.5;

/// What is seen of a chunk that reaches an edge of the picture is found by about so many boxes.
constexpr std::size_t kSeenBoxes = 8;

/// After so many the card begins to draw, as PatchStore has it.
constexpr std::size_t kFlushedVertices = 16'384;

/// Of a chunk's box, and of a run's, in each direction.
constexpr double kSteps = 65535.0, kPlaces = 255.0;

/// How far up from `low`; 0 where the whole has no size.
double share_of(double at, double low, double size) { return size > 0 ? (at - low) / size : 0.0; }

Box box_of(const std::vector<PathVertex>& vertices) {
  Box box;
  for (const PathVertex& vertex : vertices) box.extend(Vec3(vertex.position_mm));
  return box;
}

/// Where the two differ. The path of a machine grows at its end: all before that is the same.
Box change_between(const std::vector<PathVertex>& before, const std::vector<PathVertex>& after) {
  const auto same = [](const PathVertex& a, const PathVertex& b) {
    return a.position_mm == b.position_mm && a.kind == b.kind && a.move == b.move;
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

/// Whether what has this rectangle may go on outside the picture.
bool reaches_edge(const ScreenRect& rect, glm::ivec2 size_px) {
  return rect.min.x <= 0 || rect.min.y <= 0 || rect.max.x >= size_px.x || rect.max.y >= size_px.y;
}

/// Whether nothing of the box is in the picture: all of it is beyond one of its edges.
bool is_outside(const Box& box, const Projection& projection) {
  glm::bvec4 is_beyond(true);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 at((corner & 1u) ? box.max.x : box.min.x, (corner & 2u) ? box.max.y : box.min.y,
                  (corner & 4u) ? box.max.z : box.min.z);
    const glm::vec4 clip = projection.clip_from_world * glm::vec4(glm::vec3(at), 1.0f);
    is_beyond.x = is_beyond.x && clip.x > clip.w;
    is_beyond.y = is_beyond.y && clip.x < -clip.w;
    is_beyond.z = is_beyond.z && clip.y > clip.w;
    is_beyond.w = is_beyond.w && clip.y < -clip.w;
  }
  return glm::any(is_beyond);
}

void draw_vertices(const std::vector<PathStore::Part>& parts) {
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  for (const PathStore::Part& part : parts) {
    firsts.push_back(static_cast<GLint>(part.first));
    counts.push_back(static_cast<GLsizei>(part.count));
  }
  glMultiDrawArrays(GL_LINE_STRIP, firsts.data(), counts.data(),
                    static_cast<GLsizei>(counts.size()));
}

/// Of the vertex array that is bound.
void draw_numbers(const GlBuffer& numbers, const std::vector<PathStore::Part>& parts) {
  std::vector<const void*> firsts;
  std::vector<GLsizei> counts;
  for (const PathStore::Part& part : parts) {
    firsts.push_back(reinterpret_cast<const void*>(part.first * sizeof(std::uint16_t)));
    counts.push_back(static_cast<GLsizei>(part.count));
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, numbers.name());
  glMultiDrawElements(GL_LINE_STRIP, counts.data(), GL_UNSIGNED_SHORT, firsts.data(),
                      static_cast<GLsizei>(counts.size()));
}

}  // namespace

std::size_t PathStore::Strip::at_number(std::size_t number) const {
  if (kept.empty()) return number;
  return static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), number) -
                                  kept.begin());
}

std::size_t PathStore::Chunk::gpu_bytes() const {
  std::size_t sum = count() * sizeof(PathVertex);
  for (const Strip& strip : strips) sum += strip.kept.size() * sizeof(std::uint16_t);
  return sum;
}

Box PathStore::Chunk::box_of(const RunBox& run) const {
  const Vec3 step_mm = box_mm.size() / kSteps;
  return {box_mm.min + Vec3(run.low[0], run.low[1], run.low[2]) * step_mm,
          box_mm.min + Vec3(run.high[0], run.high[1], run.high[2]) * step_mm};
}

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
    gpu_bytes_ -= last.gpu_bytes();
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

std::size_t PathStore::level_for(const Chunk& chunk, double tolerance_px) {
  std::size_t level = 0;
  while (level + 1 < chunk.strips.size() &&
         chunk.strips[level + 1].tolerance_mm <= tolerance_px * chunk.pixel_mm) {
    ++level;
  }
  return level;
}

std::size_t PathStore::drawn_vertices(double tolerance_px) const {
  double drawn = 0.0;
  for (const Chunk& chunk : chunks_) {
    if (chunk.count() == 0) continue;
    const Strip& strip = chunk.strips[level_for(chunk, tolerance_px)];
    drawn += chunk.seen_share * static_cast<double>(strip.count);
  }
  return static_cast<std::size_t>(drawn);
}

double PathStore::drawn_px() const {
  double length_px = 0.0;
  for (const Chunk& chunk : chunks_) {
    const double length_mm = chunk.seen_share * chunk.length_mm;
    if (length_mm > 0.0) length_px += length_mm / chunk.pixel_mm;
  }
  return length_px;
}

void PathStore::choose_levels(std::vector<Box>* changed_mm) {
  double tolerance_px = is_by_move_ ? 0.0 : kTolerance_px;
  std::size_t drawn = drawn_vertices(tolerance_px);
  while (drawn > kDrawnVertices && tolerance_px < kMostTolerance_px) {
    tolerance_px = std::max(kTolerance_px, 2.0 * tolerance_px);
    drawn = drawn_vertices(tolerance_px);
  }
  const bool is_smooth = drawn <= kSmoothVertices && drawn_px() <= kSmooth_px;
  for (Chunk& chunk : chunks_) {
    if (chunk.count() == 0) continue;
    const std::size_t level = level_for(chunk, tolerance_px);
    const auto vertices = static_cast<double>(chunk.strips[level].count);
    const bool is_chunk_smooth =
        is_smooth && chunk.length_mm >= kSmoothSegment_px * chunk.pixel_mm * vertices;
    if (level == chunk.level && is_chunk_smooth == chunk.is_smooth) continue;
    chunk.level = level;
    chunk.is_smooth = is_chunk_smooth;
    changed_mm->push_back(chunk.box_mm);
  }
}

std::size_t PathStore::upload(std::size_t budget_bytes, std::vector<Box>* changed_mm) {
  const bool has_dropped = !dropped_mm_.empty();
  if (has_dropped) changed_mm->push_back(std::exchange(dropped_mm_, Box{}));
  std::size_t bytes = 0;
  while (!waiting_.empty()) {
    const std::size_t count = waiting_.front()->vertices.size();
    // Levels have no more vertices together than the path itself.
    const std::size_t size = count * (sizeof(PathVertex) + sizeof(std::uint16_t));
    if (bytes > 0 && bytes + size > budget_bytes) break;
    std::shared_ptr<const PathChunk> values = std::move(waiting_.front());
    waiting_.pop_front();
    if (values->index >= chunks_.size()) chunks_.resize(values->index + 1);
    Chunk& chunk = chunks_[values->index];
    const Box changed = change_of(chunk, *values);
    if (!changed.empty()) changed_mm->push_back(changed);
    load(&chunk, std::move(values));
    bytes += chunk.gpu_bytes();
  }
  if (bytes > 0 || has_dropped) choose_levels(changed_mm);
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
  const bool is_full = vertices.size() > kPathChunkSegments;
  gpu_bytes_ -= chunk->gpu_bytes();
  measure(chunk, vertices);
  chunk->level = 0;
  chunk->strips.clear();
  chunk->strips.push_back({0.0, 0, vertices.size(), {}, boxes_of_runs(*chunk, vertices, {}), {}});
  note_places(chunk, vertices);
  std::vector<std::uint16_t> numbers;
  for (const PathLevel& level : is_full ? path_levels(vertices) : std::vector<PathLevel>{}) {
    Strip& strip = chunk->strips.emplace_back();
    strip.tolerance_mm = level.tolerance_mm;
    strip.first = numbers.size();
    strip.count = level.kept.size();
    strip.kept.assign(level.kept.begin(), level.kept.end());
    strip.run_boxes = boxes_of_runs(*chunk, vertices, strip.kept);
    numbers.insert(numbers.end(), strip.kept.begin(), strip.kept.end());
  }
  chunk->strips.shrink_to_fit();
  gpu_bytes_ += chunk->gpu_bytes();
  glBindVertexArray(chunk->array.name());
  glBindBuffer(GL_ARRAY_BUFFER, chunk->vertices.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(PathVertex)),
               vertices.data(), GL_DYNAMIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PathVertex), nullptr);
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(PathVertex),
                         reinterpret_cast<const void*>(sizeof(glm::vec3)));  // kind and move
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  if (!numbers.empty()) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, chunk->numbers.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(numbers.size() * sizeof(std::uint16_t)), numbers.data(),
                 GL_DYNAMIC_DRAW);
  }
  project(chunk);
  chunk->growing = is_full ? nullptr : std::move(values);
}

void PathStore::measure(Chunk* chunk, const std::vector<PathVertex>& vertices) {
  chunk->box_mm = box_of(vertices);
  chunk->length_mm = 0.0;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const glm::vec3 step = vertices[i].position_mm - vertices[i - 1].position_mm;
    chunk->length_mm += static_cast<double>(glm::length(step));
  }
}

std::vector<PathStore::RunBox> PathStore::boxes_of_runs(const Chunk& chunk,
                                                        const std::vector<PathVertex>& vertices,
                                                        const std::vector<std::uint16_t>& kept) {
  const std::size_t segments = kept.empty() ? kRunSegments : kThinnedRunSegments;
  const std::size_t count = kept.empty() ? vertices.size() : kept.size();
  const Vec3 size = chunk.box_mm.size();
  std::vector<RunBox> boxes;
  boxes.reserve((count + segments - 2) / segments);
  for (std::size_t first = 0; first + 1 < count; first += segments) {
    Box box;
    for (std::size_t i = first; i <= std::min(first + segments, count - 1); ++i) {
      box.extend(Vec3(vertices[kept.empty() ? i : kept[i]].position_mm));
    }
    RunBox& run = boxes.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const double low = chunk.box_mm.min[axis];
      const auto index = static_cast<std::size_t>(axis);
      run.low[index] =
          static_cast<std::uint16_t>(std::floor(share_of(box.min[axis], low, size[axis]) * kSteps));
      run.high[index] =
          static_cast<std::uint16_t>(std::ceil(share_of(box.max[axis], low, size[axis]) * kSteps));
    }
  }
  return boxes;
}

void PathStore::note_places(Chunk* chunk, const std::vector<PathVertex>& vertices) {
  const std::vector<RunBox>& runs = chunk->strips.front().run_boxes;
  chunk->places.assign(vertices.size(), Place{});
  for (std::size_t i = 0; i < vertices.size() && !runs.empty(); ++i) {
    const Box box = chunk->box_of(runs[std::min(i / kRunSegments, runs.size() - 1)]);
    const Vec3 size = box.size(), at(vertices[i].position_mm);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = std::clamp(share_of(at[axis], box.min[axis], size[axis]), 0.0, 1.0);
      chunk->places[i][static_cast<std::size_t>(axis)] =
          static_cast<std::uint8_t>(std::lround(share * kPlaces));
    }
  }
}

Box PathStore::box_of_part(const Chunk& chunk, std::size_t begin, std::size_t end) {
  if (chunk.count() < 2) return begin < end ? chunk.box_mm : Box{};
  const std::vector<RunBox>& runs = chunk.strips.front().run_boxes;
  Box whole;
  for (std::size_t i = begin; i < end;) {
    const std::size_t run = std::min(i / kRunSegments, runs.size() - 1);
    const std::size_t run_end = run + 1 < runs.size() ? (run + 1) * kRunSegments : end;
    Place low{0xff, 0xff, 0xff}, high{0, 0, 0};
    for (; i < std::min(end, run_end); ++i) {
      for (std::size_t axis = 0; axis < low.size(); ++axis) {
        low[axis] = std::min(low[axis], chunk.places[i][axis]);
        high[axis] = std::max(high[axis], chunk.places[i][axis]);
      }
    }
    const Box box = chunk.box_of(runs[run]);
    const Vec3 step_mm = box.size() / kPlaces;
    // A place is rounded: it is less than a step off.
    whole.extend(box.min + (Vec3(low[0], low[1], low[2]) - 1.0) * step_mm);
    whole.extend(box.min + (Vec3(high[0], high[1], high[2]) + 1.0) * step_mm);
  }
  return whole;
}

std::size_t PathStore::past_of(std::size_t chunk, std::uint64_t past_vertices) const {
  const std::uint64_t start = chunk * kPathChunkSegments;
  const std::uint64_t past = past_vertices > start ? past_vertices - start : 0;
  return static_cast<std::size_t>(std::min<std::uint64_t>(past, chunks_[chunk].count()));
}

void PathStore::set_past(std::uint64_t vertices, std::vector<Box>* changed_mm) {
  const std::uint64_t least = std::min(vertices, past_vertices_);
  // All of a tail gets another shade. One more segment begins at the vertex before it.
  const std::uint64_t low = tail_ > 0 ? least - std::min<std::uint64_t>(least, tail_ + 1) : least;
  const std::uint64_t high = std::max(vertices, past_vertices_);
  past_vertices_ = vertices;
  if (least == high) return;
  Box box;
  for (std::size_t c = low / kPathChunkSegments;
       c < chunks_.size() && c * kPathChunkSegments < high; ++c) {
    const Chunk& chunk = chunks_[c];
    const std::size_t first = past_of(c, low), end = past_of(c, high);
    if (first == end) continue;
    // From the last vertex of the strip before those that turn to the first one behind them.
    const Strip& strip = chunk.strips[tail_ > 0 ? 0 : chunk.level];
    const std::size_t from = first > 0 ? strip.number(strip.at_number(first) - 1) : 0;
    const std::size_t to = end < chunk.count() ? strip.number(strip.at_number(end)) : end - 1;
    box.extend(box_of_part(chunk, from, to + 1));
  }
  if (!box.empty()) changed_mm->push_back(box);
}

void PathStore::project(Chunk* chunk) const {
  chunk->rect = covered_rect(chunk->box_mm, projection_);
  chunk->seen_share = chunk->rect.empty() ? 0.0 : 1.0;
  for (Strip& strip : chunk->strips) strip.run_rects.clear();
  chunk->pixel_mm = smallest_pixel_mm(chunk->box_mm, projection_);
  if (!chunk->rect.empty() && reaches_edge(chunk->rect, projection_.size_px)) project_parts(chunk);
}

/// Of a chunk that is in the picture in part, the nearest point may be far outside, even behind the
/// eye.
void PathStore::project_parts(Chunk* chunk) const {
  const auto has_few = [](const Strip& strip) { return strip.run_boxes.size() <= kSeenBoxes; };
  const auto found = std::find_if(chunk->strips.begin(), chunk->strips.end(), has_few);
  const Strip& strip = found == chunk->strips.end() ? chunk->strips.back() : *found;
  double pixel_mm = std::numeric_limits<double>::infinity();
  std::size_t seen = 0;
  for (const RunBox& run : strip.run_boxes) {
    Box box = chunk->box_of(run);
    box.min -= strip.tolerance_mm;
    box.max += strip.tolerance_mm;
    if (is_outside(box, projection_)) continue;
    ++seen;
    pixel_mm = std::min(pixel_mm, smallest_pixel_mm(box, projection_));
  }
  const std::size_t boxes = std::max<std::size_t>(1, strip.run_boxes.size());
  chunk->seen_share = static_cast<double>(seen) / static_cast<double>(boxes);
  chunk->pixel_mm = pixel_mm;
}

void PathStore::set_by_move(bool is_by_move) {
  if (is_by_move == is_by_move_) return;
  is_by_move_ = is_by_move;
  std::vector<Box> all;  // The whole picture changes.
  choose_levels(&all);
}

void PathStore::project(const Projection& projection) {
  projection_ = projection;
  for (Chunk& chunk : chunks_) project(&chunk);
  std::vector<Box> all;  // A new projection changes the whole picture anyway.
  choose_levels(&all);
}

/// Of the chunks that a rectangle cuts only: to know them for all would cost more than drawing,
/// whenever the eye moves.
const std::vector<ScreenRect>& PathStore::run_rects(const Chunk& chunk, const Strip& strip) const {
  if (strip.run_rects.empty()) {
    strip.run_rects.reserve(strip.run_boxes.size());
    for (const RunBox& run : strip.run_boxes) {
      strip.run_rects.push_back(covered_rect(chunk.box_of(run), projection_));
    }
  }
  return strip.run_rects;
}

void PathStore::draw_lines(const Chunk& chunk, const Strip& strip, std::size_t begin,
                           std::size_t end, const ScreenRect& rect) const {
  if (end < begin + 2) return;
  std::vector<Part> parts;
  if (chunk.rect.common(rect) == chunk.rect && !reaches_edge(chunk.rect, projection_.size_px)) {
    parts.push_back({strip.first + begin, end - begin});
  } else {
    const std::vector<ScreenRect>& rects = run_rects(chunk, strip);
    const std::size_t last = end - 1;
    std::size_t drawn_to = 0;
    const std::size_t segments = strip.run_segments();
    for (std::size_t run = begin / segments; run * segments < last; ++run) {
      if (!rects[run].intersects(rect)) continue;
      const std::size_t from = std::max(begin, run * segments);
      const std::size_t to = std::min(last, (run + 1) * segments);
      if (parts.empty() || drawn_to != from) parts.push_back({strip.first + from, 1});
      parts.back().count += to - from;
      drawn_to = to;
    }
  }
  if (parts.empty()) return;
  if (is_wide()) return draw_wide(chunk, strip, parts);
  strip.kept.empty() ? draw_vertices(parts) : draw_numbers(chunk.numbers, parts);
}

void PathStore::draw_wide(const Chunk& chunk, const Strip& strip,
                          const std::vector<Part>& parts) const {
  wide_.set_numbered(!strip.kept.empty());
  if (!strip.kept.empty()) wide_.bind_numbers(chunk.number_texture, chunk.numbers);
  for (const Part& part : parts) {
    wide_.draw_strip(static_cast<int>(part.first), static_cast<int>(part.count));
  }
}

void PathStore::draw_line(std::size_t from, std::size_t to) const {
  if (from == to) return;
  if (is_wide()) return wide_.draw_one(static_cast<int>(from), static_cast<int>(to));
  const std::array numbers{static_cast<GLushort>(from), static_cast<GLushort>(to)};
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, line_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof(numbers), numbers.data(), GL_STREAM_DRAW);
  glDrawElements(GL_LINES, 2, GL_UNSIGNED_SHORT, nullptr);
}

void PathStore::use_program() const {
  const float nearer = towards_eye(projection_, kNearer_px);
  if (is_wide()) return wide_.use(projection_, nearer);
  program_.use();
  program_.set("clip_from_world", projection_.clip_from_world);
  program_.set("towards_eye", nearer);
}

void PathStore::set_colors(const PathColors& colors) const {
  std::array<glm::vec4, 6> rgba;
  for (std::size_t kind = 0; kind < colors.past.size(); ++kind) {
    rgba[2 * kind] = colors.past[kind];
    rgba[2 * kind + 1] = colors.future[kind];
  }
  if (is_wide()) {
    wide_.set_kind_colors(rgba);
    return wide_.set_move_colors(colors.moves);
  }
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    program_.set(("rgba[" + std::to_string(i) + "]").c_str(), rgba[i]);
  }
  set_moves(program_, colors.moves);
}

void PathStore::set_is_past(bool is_past) const {
  if (is_wide()) return wide_.set_past(is_past);
  program_.set("is_past", is_past ? 1 : 0);
}

void PathStore::set_smooth(bool is_smooth) const {
  if (is_wide()) return wide_.set_smooth(is_smooth);
  (is_smooth ? glEnable : glDisable)(GL_LINE_SMOOTH);
}

void PathStore::bind(const Chunk& chunk) const {
  glBindVertexArray(chunk.array.name());
  if (is_wide()) wide_.bind(chunk.vertex_texture, chunk.vertices);
}

void PathStore::draw_tail(const ScreenRect& rect, const PathColors& colors) const {
  set_is_past(true);
  set_smooth(false);
  glEnable(GL_BLEND);
  for (std::size_t shade = 0; shade < kTailShades; ++shade) {
    // From the oldest to the newest; vertices that lie behind the tool.
    const std::size_t newer = tail_ * (kTailShades - shade - 1) / kTailShades;
    const std::size_t older = tail_ * (kTailShades - shade) / kTailShades;
    const std::uint64_t end = past_vertices_ - std::min<std::uint64_t>(past_vertices_, newer);
    const std::uint64_t begin = past_vertices_ - std::min<std::uint64_t>(past_vertices_, older + 1);
    const float share = static_cast<float>(shade + 1) / static_cast<float>(kTailShades);
    PathColors shades = colors;
    for (glm::vec4& rgba : shades.past) rgba.a *= share;
    set_colors(shades);
    for (std::size_t c = begin / kPathChunkSegments;
         c < chunks_.size() && c * kPathChunkSegments < end; ++c) {
      const Chunk& chunk = chunks_[c];
      if (chunk.count() == 0 || !chunk.rect.intersects(rect)) continue;
      bind(chunk);
      draw_lines(chunk, chunk.strips.front(), past_of(c, begin), past_of(c, end), rect);
    }
  }
}

void PathStore::draw(const ScreenRect& rect, const PathColors& colors, bool may_smooth) const {
  use_program();
  if (tail_ > 0) {
    draw_tail(rect, colors);
    return;
  }
  set_colors(colors);
  const auto is_opaque_color = [](const glm::vec4& rgba) { return rgba.a == 0 || rgba.a == 1; };
  // Blending is a fifth of what lines cost a processor.
  const bool is_opaque = std::ranges::all_of(colors.past, is_opaque_color) &&
                         std::ranges::all_of(colors.future, is_opaque_color);
  std::optional<bool> told_past;
  const auto tell_past = [&](bool is_past) {
    if (is_past != told_past) set_is_past(is_past);
    told_past = is_past;
  };
  std::size_t waiting = 0;
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    if (chunk.count() == 0 || !chunk.rect.intersects(rect)) continue;
    waiting += chunk.strips[chunk.level].count;
    if (waiting > kFlushedVertices) {
      glFlush();
      waiting = 0;
    }
    const bool is_smooth = may_smooth && chunk.is_smooth;
    set_smooth(is_smooth);
    (is_smooth || !is_opaque ? glEnable : glDisable)(GL_BLEND);
    bind(chunk);
    const Strip& strip = chunk.strips[chunk.level];
    const std::size_t past = past_of(c, past_vertices_);
    // The segment to the first vertex belongs to the chunk before.
    if (past <= 1 || past == chunk.count()) {
      tell_past(past > 1);
      draw_lines(chunk, strip, 0, strip.count, rect);
      continue;
    }
    const std::size_t next = strip.at_number(past);
    tell_past(true);
    draw_lines(chunk, strip, 0, next, rect);
    draw_line(strip.number(next - 1), past - 1);
    tell_past(false);
    draw_line(past - 1, strip.number(next));
    draw_lines(chunk, strip, next, strip.count, rect);
  }
  glDisable(GL_LINE_SMOOTH);
  glEnable(GL_BLEND);
}

}  // namespace kerf
