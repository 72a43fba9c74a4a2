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
#include "viewer/window/move_paint.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/wide_lines.h"

namespace kerf {

/// Colours of traverse, feed and planned segments; alpha 0 hides them.
struct PathColors {
  std::array<glm::vec4, 3> past{};
  std::array<glm::vec4, 3> future{};
  /// Of feed and planned segments, instead; the alphas above count for them, too.
  MovePaint moves{};
  bool operator==(const PathColors&) const = default;
};

/// The vertices are on the card, not here as well; where the processor draws, its memory is the
/// card's. What stays of a chunk that is full, and thus does not grow any more, is where its
/// vertices are to a 255th of the run that they are in: that says which part of the picture is old
/// when the tool has passed them. With boxes it is a fourth of what the card has.
///
/// Of a chunk that is full the card knows the numbers of fewer vertices as well (PathLevel). It is
/// drawn through the fewest that are nowhere further than kTolerance_px from it: closer than that,
/// what is left out is not seen. Where that is still more than kDrawnVertices, the tolerance grows,
/// the same for all chunks, until it is not: the picture is coarser then, but there in time. Where
/// the past ends, the vertex at which it does is drawn as well. Lines are antialiased up to
/// kSmoothVertices and kSmooth_px, in chunks whose segments are longer than kSmoothSegment_px on
/// average: of shorter ones, the faint rims of one hide the next. Of a chunk only what comes near
/// the rectangle is drawn, in runs of kRunSegments or kThinnedRunSegments. Lines of more than a
/// pixel (Projection::line_px) are drawn by WideLines, of the same buffers.
class PathStore {
 public:
  static constexpr double kTolerance_px = 0.5, kMostTolerance_px = 64.0;
  static constexpr std::size_t kDrawnVertices = 250'000;
  /// A processor takes a microsecond for such a line and a twentieth of one for each of its pixels,
  /// which is three times what it takes for a plain one.
  static constexpr std::size_t kSmoothVertices = 20'000;
  static constexpr double kSmooth_px = 300'000, kSmoothSegment_px = 1.0;
  static constexpr std::size_t kTailShades = 8;
  static constexpr std::size_t kRunSegments = 32;
  static constexpr std::size_t kThinnedRunSegments = 4;  ///< longer ones

  /// Of a strip: vertices, or numbers of vertices.
  struct Part {
    std::size_t first = 0, count = 0;
  };

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

  /// Of what is past only so many segments are drawn, the newest, in kTailShades steps paler the
  /// older they are, and none of the future; 0: all of the path. The whole picture changes.
  void set_tail(std::size_t segments) { tail_ = segments; }

  /// It is going to be drawn in the colours of its moves: of what is left out of a chunk nobody
  /// would see the colour, so all of it is drawn while that is no more than kDrawnVertices. Beyond
  /// that a line has the colour of the last of the moves that it stands for.
  void set_by_move(bool is_by_move);

  void project(const Projection& projection);
  /// `may_smooth`: lines may be antialiased. Their faint rims have a depth as well. Blending has to
  /// be on, and is afterwards.
  void draw(const ScreenRect& rect, const PathColors& colors, bool may_smooth) const;

  std::size_t gpu_bytes() const { return gpu_bytes_; }

 private:
  /// Around a run, in steps of the chunk's box: each side a 65535th of it further out at most.
  struct RunBox {
    std::array<std::uint16_t, 3> low{}, high{};
  };
  /// Of a vertex in the box of its run, to a 255th of that.
  using Place = std::array<std::uint8_t, 3>;

  /// Strip of lines of a chunk.
  struct Strip {
    double tolerance_mm = 0.0;        ///< nowhere further from the path; 0: the path itself
    std::size_t first = 0;            ///< in the chunk's numbers, of those that are kept
    std::size_t count = 0;            ///< of vertices
    std::vector<std::uint16_t> kept;  ///< their numbers in the chunk; empty: all of them
    std::vector<RunBox> run_boxes;
    mutable std::vector<ScreenRect> run_rects;  ///< of the present projection; empty until needed

    std::size_t run_segments() const { return kept.empty() ? kRunSegments : kThinnedRunSegments; }
    std::size_t number(std::size_t i) const { return kept.empty() ? i : kept[i]; }
    /// The first of its vertices with this number in the chunk, or with a larger one.
    std::size_t at_number(std::size_t number) const;
  };

  struct Chunk {
    /// All vertices, then fewer and fewer; empty until uploaded.
    std::vector<Strip> strips;
    /// While it grows, to be compared with what comes next; else null.
    std::shared_ptr<const PathChunk> growing;
    GlVertexArray array;
    GlBuffer vertices;
    GlBuffer numbers;  ///< of what its strips have kept, one after the other
    GlTexture vertex_texture, number_texture;  ///< of the buffers
    Box box_mm;
    std::vector<Place> places;  ///< of the vertices
    double length_mm = 0.0;
    std::size_t level = 0;  ///< of its strips: that is drawn
    bool is_smooth = true;
    ScreenRect rect;
    double pixel_mm = 0.0;    ///< its edge where the path that is in the picture is nearest
    double seen_share = 1.0;  ///< of the path is about in the picture

    std::size_t count() const { return strips.empty() ? 0 : strips.front().count; }
    std::size_t gpu_bytes() const;
    Box box_of(const RunBox& run) const;
  };

  explicit PathStore(GlProgram program) : program_(std::move(program)) {}
  bool is_wide() const { return WideLines::are_needed(projection_); }
  /// The program that draws, with what all lines have in common.
  void use_program() const;
  void set_colors(const PathColors& colors) const;
  void set_is_past(bool is_past) const;
  void set_smooth(bool is_smooth) const;
  void bind(const Chunk& chunk) const;
  void load(Chunk* chunk, std::shared_ptr<const PathChunk> values);
  /// Where the chunk's picture changes with the new values.
  static Box change_of(const Chunk& chunk, const PathChunk& values);
  static void measure(Chunk* chunk, const std::vector<PathVertex>& vertices);
  /// Of a chunk that has been measured; `kept` as in Strip.
  static std::vector<RunBox> boxes_of_runs(const Chunk& chunk,
                                           const std::vector<PathVertex>& vertices,
                                           const std::vector<std::uint16_t>& kept);
  static void note_places(Chunk* chunk, const std::vector<PathVertex>& vertices);
  /// Holds vertices [begin, end) of it, and is larger by at most a 127th of their runs.
  static Box box_of_part(const Chunk& chunk, std::size_t begin, std::size_t end);
  void project(Chunk* chunk) const;
  void project_parts(Chunk* chunk) const;
  /// Appends the boxes of chunks that are drawn through other vertices than before.
  void choose_levels(std::vector<Box>* changed_mm);
  static std::size_t level_for(const Chunk& chunk, double tolerance_px);
  /// Of the chunks in the picture.
  std::size_t drawn_vertices(double tolerance_px) const;
  double drawn_px() const;
  /// Of the vertices of a chunk, how many the tool has left behind.
  std::size_t past_of(std::size_t chunk, std::uint64_t past_vertices) const;
  /// Lines between the vertices [begin, end) of a strip that come near the rectangle.
  void draw_lines(const Chunk& chunk, const Strip& strip, std::size_t begin, std::size_t end,
                  const ScreenRect& rect) const;
  void draw_wide(const Chunk& chunk, const Strip& strip, const std::vector<Part>& parts) const;
  void draw_tail(const ScreenRect& rect, const PathColors& colors) const;
  /// One line, between vertices of the chunk that is bound.
  void draw_line(std::size_t from, std::size_t to) const;
  const std::vector<ScreenRect>& run_rects(const Chunk& chunk, const Strip& strip) const;

  GlProgram program_;
  WideLines wide_;
  GlBuffer line_;  ///< numbers of the vertices of one
  std::vector<Chunk> chunks_;
  std::deque<std::shared_ptr<const PathChunk>> waiting_;
  std::uint64_t past_vertices_ = 0;
  std::size_t tail_ = 0;  ///< segments; 0: all
  bool is_by_move_ = false;
  std::size_t gpu_bytes_ = 0;
  Box dropped_mm_;
  Projection projection_;
};

}  // namespace kerf
