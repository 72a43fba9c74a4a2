// interp_bridge/timing/segment.h - one piece of path with its speed limits, as the planner queues
// it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/geometry.h"
#include "interp_bridge/machine_limits.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/timing/spindle_speed.h"

namespace kerf {

/// Limits of the axes in the form that is needed per segment: seconds per mm (degree) and
/// seconds squared per mm; 0 where an axis is absent or has no limit.
struct AxisRates {
  std::array<double, kAxisCount> slowness{};  ///< 1 / max_velocity
  std::array<double, kAxisCount> inertia{};   ///< 1 / max_acceleration
  Vec3 velocity{0};                           ///< of X, Y, Z; 0 = no limit
  Vec3 acceleration{0};                       ///< of X, Y, Z; 0 = no limit
  double linear_cap = 0;                      ///< mm/s
  double angular_cap = 0;                     ///< deg/s
  double cycle_s = 0.001;
  double kink_ratio = 0.1;
  double gap_s = 0.004;  ///< a line shorter than this between two corners is swallowed by one
  bool arc_blend = true;
  int depth = 50;

  explicit AxisRates(const MachineLimits& limits);
};

/// Share of an acceleration that a curved path may use across and along itself: cos and sin of 30
/// degrees.
inline constexpr double kAcrossShare = 0.86602540378443864676;
inline constexpr double kAlongShare = 0.5;

/// Stands for a limit that is not there, mm/s and mm/s2 (degrees): finite, so that sums stay so.
inline constexpr double kUnlimited = 1e6;
/// Arcs of a smaller radius are run as straight lines, mm.
inline constexpr double kLeastRadius_mm = 1e-6;

enum class SegmentShape : std::uint8_t { kLine, kArc, kBlend };

/// What happens at the end of a segment.
enum class SegmentEnd : std::uint8_t {
  kStop,       ///< full stop at full deceleration: G61.1, between traverse and feed
  kExact,      ///< G61: stop unless the corner is nearly straight
  kParabolic,  ///< G64: half deceleration, so that the next segment may start meanwhile
  kTangent,    ///< run through
};

///               length_mm
///     from |----------------| to         trim_*: what the corners cut away, mm (radians of arcs)
///       ^ trim_from      ^ trim_to
struct Segment {
  SegmentShape shape = SegmentShape::kLine;
  SegmentEnd end = SegmentEnd::kStop;
  bool traverse = false;
  bool extra = false;             ///< moves A, B, C, U, V or W: no arc blends its corners
  bool linear = true;             ///< moves X, Y, Z, U, V or W
  bool begins_parabolic = false;  ///< starts while the one before slows down
  bool keeps_start = false;       ///< switches an output where it begins: no corner swallows it
  bool finalized = false;         ///< its length does not change any more
  double length_mm = 0;           ///< what is left of it; degrees if only A, B, C move
  double nominal_mm = 0;          ///< as programmed
  double request = 0;             ///< speed that the program wants, mm/s
  /// Of a feed per revolution: what the spindle makes of it. LinuxCNC rounds corners for `request`,
  /// which is then the fastest that there is, and runs through them at this.
  double spindle_speed = kUnlimited;
  double max_speed = 0;  ///< that the machine can do along it
  double max_accel = 0;
  double along_share = 1;  ///< of max_accel that is left along a curve
  /// If > 0: the segment after it came only then, on the schedule's clock; until then it was run
  /// with accel_alone towards a stop.
  double next_comes_s = 0;
  double accel_alone = 0;
  bool half_run = false;     ///< more than half of it was run by then: no corner is made of its end
  double corner_speed = -1;  ///< limit at its end, -1: none
  double corner_load = 0;    ///< share of the acceleration kept for turning at its end
  double corner_load_from = 0;  ///< ... at its start
  double tolerance_mm = 0;      ///< G64 P
  Vec3 from{0}, to{0};          ///< untrimmed ends
  Vec3 tangent_from{0}, tangent_to{0};
  ArcGeometry arc;       ///< kArc, kBlend
  double radius_mm = 0;  ///< kArc, kBlend
  double trim_from = 0, trim_to = 0;
  double lead_mm = 0;  ///< kBlend: straight part before the arc, of a line that was swallowed
  /// A feed per revolution under G96: how slow it is at both ends, s/mm; 0: that does not change.
  double slow_from = 0, slow_to = 0;
  std::uint64_t first_piece = 0;
  std::uint32_t piece_count = 0;

  /// Acceleration after what corners keep for themselves.
  double overall_accel() const {
    const double load = corner_load > corner_load_from ? corner_load : corner_load_from;
    double share = 1.0 - load;
    if (begins_parabolic || end == SegmentEnd::kParabolic) share *= 0.5;
    return max_accel * share;
  }
  /// That along the path: less what the curvature keeps.
  double accel() const { return overall_accel() * along_share; }
  bool follows_spindle() const { return spindle_speed < kUnlimited; }
  /// The speed that it is run at where nothing else limits it.
  double target(const AxisRates& rates) const {
    const double cap = linear ? rates.linear_cap : rates.angular_cap;
    double wanted = request < max_speed ? request : max_speed;
    if (spindle_speed < wanted) wanted = spindle_speed;
    return wanted < cap ? wanted : cap;
  }
  /// Shares of the programmed way that its corners cut away, at the start and at the end.
  double cut_from() const { return cut(trim_from); }
  double cut_to() const { return cut(trim_to); }
  /// Point at angle (radians from the untrimmed start) of an arc.
  Vec3 arc_point(double angle) const;
  /// Point of a line or an arc so far from its trimmed start, 0 to length_mm.
  Vec3 point_at(double way_mm) const;

 private:
  double cut(double trim) const {
    const double whole = shape == SegmentShape::kArc ? std::abs(arc.sweep_rad) : nominal_mm;
    return whole > 0 ? std::min(trim / whole, 1.0) : 0.0;
  }
};

/// How far a move takes A B C and U V W.
struct ExtraWay {
  std::array<double, 3> abc_deg{};
  Vec3 uvw_mm{0};
};
ExtraWay extra_way(const Motion& motion);

/// What the axes allow along a straight move: speed and acceleration along the path, and its
/// length: that of X Y Z; where these stand that of U V W; where those stand too that of A B C,
/// degrees. length 0: no move.
struct StraightRates {
  double length = 0;
  double speed = 0;
  double accel_s2 = 0;  ///< seconds squared that the slowest axis takes; 0: none has a limit
  double accel() const {
    return accel_s2 > 0 ? std::min(length / accel_s2, kUnlimited) : kUnlimited;
  }
  bool tip = false;     ///< X, Y or Z move
  bool linear = false;  ///< they, or U, V, W
  bool extra = false;   ///< A, B, C, U, V or W move
};
StraightRates straight_rates(const AxisRates& rates, const Vec3& delta_mm, const ExtraWay& extra);

/// A straight segment; `speed` is the programmed speed in mm/s (degrees/s), infinite for traverses.
Segment make_line(const Vec3& from, const Vec3& to, const StraightRates& straight, double speed);

/// A circular or helical segment of a kArc motion that has_radius().
bool has_radius(const Motion& motion);
Segment make_arc(const AxisRates& rates, const Motion& motion, double speed);

/// G95: the segment is run at what the spindle makes of the feed.
void follow_spindle(Segment& segment, const SpindleFeed& feed);

/// Where that changes along the segment: only this part of it is left.
void keep_slowness(Segment& segment, double from, double to);

/// Caps speed so that the segment takes a servo period at least.
void clamp_to_cycle(Segment& segment, double cycle_s);

/// Fixes length and speed limits: nothing is cut from it any more.
void finalize(Segment& segment, double cycle_s);

}  // namespace kerf
