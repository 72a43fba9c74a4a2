// interp_bridge/motion.h - what the machine is told to do, after the modal fold: mm, mm/min, tip in
// the workpiece frame.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry.h"

namespace kerf {

/// Where a motion comes from. `file` indexes ProgramSource::files (0 = the program itself, others
/// are called O-word subroutine files); `line` is 1-based, 0 = not known.
struct SourceRef {
  std::uint32_t file = 0;
  std::uint32_t line = 0;
  bool operator==(const SourceRef&) const = default;
};

enum class MotionKind : std::uint8_t {
  kTraverse,  ///< G0 and the rapid parts of cycles
  kFeed,      ///< straight, at feed
  kArc,       ///< circular or helical, at feed
  kThread,    ///< straight, synchronised with the spindle (G33, G76), or the in-and-out of a rigid
              ///< tap
  kProbe,     ///< straight probing move; the tip does not cut
  kDwell,     ///< no motion, `duration_s`
  kToolChange,  ///< `tool` is the new tool; no motion
  kStop,        ///< M0, M1, M60: the program waits for the operator
  kProgramEnd,  ///< M2, M30 or closing %
};

/// Circular part of a motion: the tip turns about an axis through `center_mm` along `axis` (unit
/// vector) by `sweep_rad` (right-hand rule about `axis`, |sweep| > 2 pi for several turns) while it
/// moves along the axis linearly in angle. If the distances of start and end from the axis differ
/// (spiral), the radius changes linearly in angle too.
struct ArcGeometry {
  Vec3 center_mm{0};
  Vec3 axis{0, 0, 1};
  double sweep_rad = 0;
};

enum class SpindleState : std::uint8_t { kStopped, kClockwise, kCounterclockwise };

/// How the machine runs through the corner between two moves: G61.1, G61, G64.
enum class PathMode : std::uint8_t { kExactStop, kExactPath, kContinuous };

/// Where the workpiece frame lies in the machine: a point w of it is, in machine coordinates of the
/// tip, R(rotation) * (w + g92) + g5x. R turns about Z.
struct WorkpieceFrame {
  Vec3 g5x_mm{0};
  Vec3 g92_mm{0};
  double rotation_deg = 0;
  std::array<double, 3> offset_abc_deg{};  ///< added to A, B, C
};

/// One step of the program. Positions are the tool tip in the workpiece frame: the coordinates that
/// the program writes under its first work offset, in mm (ABC in degrees). from_mm of a step is
/// to_mm of the one before, except where a tool length offset changes under a standing machine: the
/// tip (of the new tool) is then elsewhere, and both ends are true workpiece positions.
struct Motion {
  MotionKind kind = MotionKind::kTraverse;
  SpindleState spindle = SpindleState::kStopped;
  bool flood = false;
  bool mist = false;
  PathMode path_mode = PathMode::kContinuous;
  bool feed_per_rev = false;  ///< G95: feed is mm per revolution
  /// False where the start is not known: in the first motion (rs274 starts at 0,0,0 and the real
  /// machine does not) and all steps before it, and after a spline, whose points the listing does
  /// not hold. kerf must not cut along such a move; `to_mm` is right, from_mm equals it, and an arc
  /// has a sweep of 0.
  bool start_known = true;
  int tool = 0;  ///< tool number in the spindle, 0 = none
  SourceRef source;
  Vec3 from_mm{0};
  Vec3 to_mm{0};
  std::array<double, 3> from_abc_deg{};
  std::array<double, 3> to_abc_deg{};
  ArcGeometry arc;  ///< kArc only
  /// In force (G43): the machine's own coordinates are those of the tip plus this, along its axes.
  Vec3 tool_offset_mm{0};
  /// Programmed; 0 for traverses. mm per revolution if feed_per_rev (of a thread: its pitch), and
  /// degrees/min where only A, B or C move.
  double feed_mm_per_min = 0;
  double spindle_rpm = 0;  ///< programmed S; under G96, that at the end of the step
  double duration_s = 0;   ///< kDwell only
  /// G64 P: how far a corner may be cut; 0 = as far as the speed wants. kContinuous only.
  float blend_tolerance_mm = 0;
  /// G64 Q (without Q: P): straight feeds may be merged into one within this; 0 = they are not.
  float merge_tolerance_mm = 0;
};

}  // namespace kerf
