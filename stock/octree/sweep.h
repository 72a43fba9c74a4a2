// stock/octree/sweep.h - one convex body of a tool on one piece of its path.
//
//   F(p) = min over s in 0..1 of value(p as seen by the tool at s): negative inside what the body
//   sweeps, 1-Lipschitz, and its gradient is the normal of the swept body.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "stock/octree/tool_bodies.h"
#include "stock/stock_model.h"

namespace kerf::octree {

/// Frame of a piece with fixed spindle direction: u along the path seen along the spindle, v across
/// it, w up the spindle; origin at the start of the tip, or of the centre of a ball nose or sphere
/// (origin_above_mm). Positions are mm.
struct Sweep {
  enum class Kind : std::uint8_t {
    kLevel,   ///< the tip moves square to the spindle, or not at all
    kBall,    ///< ball nose, any straight piece
    kSphere,  ///< whole sphere, any straight piece, also of a spindle that turns
    kArc,     ///< about an axis along the spindle, level; u points from the centre to the middle
    kRamp,    ///< any straight piece: minimum by iteration
    kTurn     ///< the spindle turns
  };
  Kind kind = Kind::kLevel;
  const ToolBody* body = nullptr;
  std::uint32_t report = 0;  ///< which move of the batch
  std::uint32_t cut_id = 0;
  double shrink_mm = 0;  ///< F is greater by this: the tool is drawn in
  Vec3 origin_mm{0};
  double origin_above_mm = 0;  ///< its height above the tip
  Vec3 u{1, 0, 0}, v{0, 1, 0}, w{0, 0, 1};
  double length_u = 0, length_w = 0;  ///< of the path, along u and w
  // kArc
  double arc_radius = 0, cos_half = 0, end_u = 0, end_v = 0;
  // kBall, kSphere, kTurn: from origin to origin + step, kTurn: spindle along w + s * turn
  Vec3 step{0}, turn{0};
  double per_step2 = 0;  ///< 1 / step^2; 0 where there is none
  double bend_mm = 0;    ///< kTurn: by how much F along s may bend the wrong way, at most
  /// kTurn: the same way with the spindle fixed half way between its directions, whose F is convex:
  /// u, v, length_u and length_w are of its frame. It turns away from that by at most off_rad.
  Vec3 mean_w{0, 0, 1};
  double off_rad = 0;
  /// Nothing below this is touched, by a tool that stands upright; by others -infinity.
  double bottom_mm = -std::numeric_limits<double>::infinity();
  Box box_mm;  ///< what it can touch, within the bounds given to append_sweeps()
};

/// Arcs that are not exact (kArc) become chords that deviate by at most this.
double chord_mm(double cell_mm);
/// A turning spindle is divided into pieces that turn by at most this, and so far that F along a
/// piece is as if it had one minimum to within chord_mm. Within a piece the tool at s has the tip's
/// true position and a direction within 1e-7 rad of the true one. Of a ball nose the centre goes
/// straight in a piece: it is within chord_mm of where it is with the tip on its way.
inline constexpr double kTurnPiece_rad = 0.02;

/// By how much F may bend the wrong way along a turning piece, so that it has two minima: of points
/// within `reach_mm` of the tip, where the tip goes `step_mm` and the spindle turns by `turn_rad`.
double bend_mm(double reach_mm, double step_mm, double turn_rad);

struct SweepTarget {
  Box bounds_mm;            ///< sweeps that miss it are left out
  double chord_mm = 0.002;  ///< what chords and turning pieces may leave, see above
  double shrink_mm = 0;
};

/// The pieces of `move`, in the order of the path, each for every body. `bodies` must outlive them.
void append_sweeps(const std::vector<ToolBody>& bodies, const CutMove& move, std::uint32_t report,
                   const SweepTarget& target, std::vector<Sweep>& out);

/// `move` up to `part` (0..1) of its path.
CutMove first_part(const CutMove& move, double part);
/// From one part of it to another.
CutMove middle_part(const CutMove& move, double from, double to);

}  // namespace kerf::octree
