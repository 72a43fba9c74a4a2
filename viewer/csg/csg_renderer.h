// viewer/csg/csg_renderer.h - blank minus swept volumes, worked out in the picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "viewer/csg/csg_blank.h"
#include "viewer/csg/csg_schedule.h"
#include "viewer/csg/depth_picture.h"
#include "viewer/csg/swept_solid.h"
#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// A cutter by its outline (ToolShape::cutter; shank and holder remove nothing).
struct CsgTool {
  ToolShape shape;
  std::uint32_t color = 0xffc8a878;  ///< 0xAABBGGRR, of the surfaces that it leaves
};

struct CsgOptions {
  /// By which the polyhedra that stand for round cutters may stay inside of them, mm, around the
  /// axis and once more along the outline. Finer costs triangles: about 1 / tolerance.
  double tolerance_mm = 0.05;
  /// Keep what was subtracted while the view stands still. Off: everything, every time; for
  /// measuring and for doubtful drivers.
  bool is_local = true;
};

/// What drawing cost.
struct CsgCounters {
  std::size_t solids = 0;  ///< convex pieces of the moves that reach the blank
  std::size_t triangles = 0;
  std::size_t gpu_bytes = 0;     ///< solids, blank, pictures
  bool was_full = false;         ///< the last draw() began from the blank; all below are its own
  std::size_t sweeps = 0;        ///< until nothing changed any more
  std::size_t batches = 0;       ///< of solids side by side, two passes each
  std::size_t subtractions = 0;  ///< solids taken from the picture, again ones included
};

/// The picture of a workpiece after some moves, without any stock model: per pixel only the depth
/// of the nearest point that is left is kept. Each move of a cutter with vertical axis removes
/// convex solids (swept_solid.h); the region above the cutter goes with it, as in a Z-map.
///
///     eye ---->  |blank         S1            S2            |
///                z0 is in S1:   |------->z1 is in S2 ------>z2 stays
///
/// A solid moves the depth of a pixel to its back where its front lies before that depth and its
/// back behind it: front faces before the depth set the stencil (a pass without colour), back faces
/// behind the depth where the stencil is set write depth and colour. Depths only grow, so the
/// end does not depend on the order; solids are taken from front to back, and again while an
/// occlusion query finds that a neighbour moved a pixel, until none does. Pixels that end outside
/// of the blank are background. A blank that is not convex is drawn in layers, one per front that a
/// ray can meet; the nearest point left of all layers counts.
/// Sources: J. Goldfeather, S. Molnar, G. Turk, H. Fuchs, "Near real-time CSG rendering using tree
/// normalization and geometric pruning", IEEE CG&A 9(3), 1989 (layers, parity); N. Stewart,
/// G. Leach, S. John, "Linear-time CSG rendering of intersected convex objects", WSCG 2002
/// (sequenced convex subtraction).
///
/// Adding a move costs its own passes and those of the solids that it overlaps; a new view costs
/// all passes of all moves. On a software renderer (two cores, 640 x 480 pixels; bench_csg) another
/// move takes 1 to 10 ms up to 1000 moves and some 40 ms after 10 000; a new view 10 ms for 10
/// moves, 50 for 100, 500 for 1000 and 8 s for 10 000. Memory: about 4.4 kB per move, in the
/// card's.
///
/// What it does not do: undercuts, tilted tools, volumes or measures, light by smooth normals
/// (faces are flat). Needs a current OpenGL 3.3 context from create() to the destructor; leaves
/// depth, stencil and scissor test, blending and culling off and all masks open.
class CsgRenderer {
 public:
  /// Error: a tolerance that is not above 0, or the GL compiler's log.
  static Result<CsgRenderer> create(const CsgOptions& options);
  CsgRenderer(CsgRenderer&&) noexcept;
  CsgRenderer& operator=(CsgRenderer&&) noexcept;
  ~CsgRenderer();

  /// Also forgets the moves. Error: see check(CsgBlank); the old blank stays then.
  Done set_blank(const CsgBlank& blank);
  /// Also forgets the moves. Error: an outline that convex_pieces() refuses, with its number.
  Done set_tools(std::span<const CsgTool> tools);
  /// Moves of tools that do not exist are our mistake. Needs a blank. O(moves).
  void append(std::span<const SweptMove> moves);
  void clear_moves();

  /// Draws what is left, over a background. Without a blank: the background alone. Error: the size
  /// is more than this OpenGL can do.
  ///
  /// With a time limit moves are taken in small groups, the newest first, until it has passed; the
  /// others wait for the next draw() (has_waiting()). So do those of a group that there was no time
  /// for; some of it is always done, so that the end comes, but for a limit of 0: nothing is done
  /// then but to show what is there. What is drawn until the end has too much material, nowhere too
  /// little. `shows` false: the moves are taken, but the picture stays as it is until a draw() that
  /// shows.
  Done draw(const Projection& projection,
            double longest_ms = std::numeric_limits<double>::infinity(), bool shows = true);
  /// Moves are not yet subtracted from the picture of the last draw().
  bool has_waiting() const;
  /// The pixels that a draw() that shows will change, beside those of moves that it takes. To show
  /// them costs some 20 ns a pixel on a software renderer.
  PixelRect unshown() const;
  /// The pixels that the last draw() can have changed.
  PixelRect changed() const;
  /// Binds colour and depth of the picture last drawn to these texture units, rows from below. The
  /// background has depth 1.
  void bind_picture(int color_unit, int depth_unit) const;

  /// Copies the picture last drawn to a framebuffer (0: the window's), from its pixel `corner_px`
  /// (counted from the lower left) on.
  void show_in(unsigned framebuffer, glm::ivec2 corner_px) const;
  /// Waits until the card has drawn everything; for measuring.
  void finish() const;
  /// The picture last drawn.
  Picture read() const;
  DepthPicture read_depth() const;
  /// Number of moves since the blank was set.
  std::size_t move_count() const;
  const CsgCounters& counters() const;

 private:
  class Impl;
  explicit CsgRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
