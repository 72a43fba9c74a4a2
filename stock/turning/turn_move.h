// stock/turning/turn_move.h - a move of a turning tool in the plane of its axis.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/geometry.h"
#include "stock/turning/insert_sweep.h"

namespace kerf {

/// About `center_mm` by `sweep_rad`, counter-clockwise with z to the right and x up. If start and
/// end lie at different distances from it, the radius changes linearly in angle.
struct TurnArc {
  Vec2 center_mm{0};  ///< (z, x)
  double sweep_rad = 0;
};

/// Of the controlled point: (z, x) in mm, x from the axis (a radius, not a diameter) and negative
/// beyond it. Straight unless `arc` is set.
struct TurnMove {
  Vec2 from_mm{0};
  Vec2 to_mm{0};
  std::optional<TurnArc> arc;
  std::uint64_t id = 0;  ///< the caller's; comes back in reports
  /// Not 0: the workpiece turns once a lead of the way, which is straight: a thread. Positive as
  /// M3 has it, so that a way toward -z leaves a right-hand one. It is at angle 0 where the move
  /// begins, or goes on from one that ended there.
  double lead_mm = 0;
  /// It has a lead that is one (kLeastLead_mm).
  bool winds() const;
};

namespace turning {

/// Corners of the way, straight between them, with the share of the move that is done there.
struct WayPoint {
  Vec2 at_mm{0};
  double t = 0;
};

/// The way of a move within kWayBound_mm (insert_sweep.h), as far as it is near enough to matter:
/// nothing of what is farther than `reach_mm` from the origin along either axis, and nothing of a
/// move with a number that is none or an arc of more than kMostSteps. Where the way leaves that
/// range and comes back there is a gap: pairs of points, the way goes from each first to the
/// second.
struct WayChord {
  WayPoint from, to;
};
void append_way(const TurnMove& move, double reach_mm, std::vector<WayChord>& chords);

inline constexpr int kMostSteps = 1'000'000;
/// How an arc of a way is divided. None: into more than kMostSteps, or numbers that are none.
std::optional<ArcSteps> way_steps(double radius_mm, double sweep_rad);

}  // namespace turning
}  // namespace kerf
