// viewer/window/path_store.h - the toolpath on the graphics card. For the sources of viewer/ only.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "viewer/gl_objects.h"
#include "viewer/scene.h"
#include "viewer/window/screen_rect.h"

namespace kerf {

/// Colours of traverse, feed and planned segments; alpha 0 hides them.
struct PathColors {
  std::array<glm::vec4, 3> past{};
  std::array<glm::vec4, 3> future{};
  bool operator==(const PathColors&) const = default;
};

/// The vertices are on the card, not here as well. What stays of a chunk that is full, and thus
/// does not grow any more, is where its vertices are to a 65535th of its size: that says which part
/// of the picture is old when the tool has passed them. With boxes it is half of what the card has.
///
/// A chunk whose segments are shorter than a pixel on average is drawn through every 2nd, 4th, ...
/// of its vertices; all chunks are, further, while more than kDrawnVertices remain: ten million
/// lines are more than there are pixels. Lines are antialiased up to kSmoothVertices. Of a chunk
/// only what comes near the rectangle is drawn, in runs of kRunSegments.
class PathStore {
 public:
  static constexpr std::size_t kDrawnVertices = 250'000;
  static constexpr std::size_t kSmoothVertices = 60'000;
  static constexpr std::size_t kRunSegments = 32;

  static Result<PathStore> create();

  void set_chunk_count(std::uint32_t count);
  void offer(std::shared_ptr<const PathChunk> chunk);
  void clear();

  /// Uploads chunks until `budget_bytes` are used up, but at least one. Appends the boxes of what
  /// came or changed. Returns the bytes.
  std::size_t upload(std::size_t budget_bytes, std::vector<Box>* changed_mm);
  bool has_waiting() const { return !waiting_.empty(); }

  /// Appends the box of the segments that turn from future to past or back.
  void set_past(std::uint64_t vertices, std::vector<Box>* changed_mm);

  void project(const Projection& projection);
  /// `may_smooth`: lines may be antialiased. Their faint rims have a depth as well.
  void draw(const ScreenRect& rect, const PathColors& colors, bool may_smooth) const;

  std::size_t gpu_bytes() const { return gpu_bytes_; }

 private:
  /// Of a chunk's box, in each direction.
  using Steps = std::array<std::uint16_t, 3>;

  struct Chunk {
    std::size_t count = 0;  ///< of its vertices on the card; 0 until uploaded
    /// While it grows, to be compared with what comes next; else null.
    std::shared_ptr<const PathChunk> growing;
    GlVertexArray array;
    GlBuffer vertices;
    Box box_mm;
    std::vector<Steps> places;  ///< of the vertices within the box
    std::vector<Box> run_boxes_mm;
    ScreenRect rect;
    mutable std::vector<ScreenRect> run_rects;  ///< of the present projection; empty until needed
    double length_mm = 0.0;
    double pixel_mm = 0.0;   // edge of a pixel at the point of the box that is nearest to the eye
    std::size_t stride = 1;  // from one drawn vertex to the next
  };

  explicit PathStore(GlProgram program) : program_(std::move(program)) {}
  void load(Chunk* chunk, std::shared_ptr<const PathChunk> values);
  /// Where the chunk's picture changes with the new values.
  static Box change_of(const Chunk& chunk, const PathChunk& values);
  static void measure(Chunk* chunk, const std::vector<PathVertex>& vertices);
  /// Holds vertices [begin, end) of it, and is at most two steps larger.
  static Box box_of_part(const Chunk& chunk, std::size_t begin, std::size_t end);
  void project(Chunk* chunk) const;
  /// Appends the boxes of chunks that are drawn through other vertices than before.
  void choose_strides(std::vector<Box>* changed_mm);
  struct DrawnPart {
    std::size_t first;     ///< vertex
    std::size_t segments;  ///< of `stride` vertices each
    std::size_t stride;
  };
  /// `path_begin`: number of the chunk's first vertex in the path.
  void draw_segments(const Chunk& chunk, std::size_t path_begin, const ScreenRect& rect,
                     const DrawnPart& part) const;
  const std::vector<ScreenRect>& run_rects(const Chunk& chunk) const;

  GlProgram program_;
  std::vector<Chunk> chunks_;
  std::deque<std::shared_ptr<const PathChunk>> waiting_;
  std::uint64_t past_vertices_ = 0;
  std::size_t largest_stride_ = 1;
  bool is_smooth_ = true;
  std::size_t gpu_bytes_ = 0;
  Box dropped_mm_;
  Projection projection_;
};

}  // namespace kerf
