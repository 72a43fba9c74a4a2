// interp_bridge/machine_limits.h - how far and how fast the axes of a machine go, in mm, degrees
// and seconds. Filled from a LinuxCNC INI by the twin, or the defaults below.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kerf {

/// Axes in LinuxCNC's order.
inline constexpr std::size_t kAxisCount = 9;
inline constexpr std::array<char, kAxisCount> kAxisLetters = {'X', 'Y', 'Z', 'A', 'B',
                                                              'C', 'U', 'V', 'W'};
/// A, B, C turn: their lengths are degrees.
constexpr bool is_rotary_axis(std::size_t axis) { return axis >= 3 && axis < 6; }

/// One axis, machine frame: mm, mm/s, mm/s2, or the same in degrees.
struct AxisLimits {
  bool present = false;
  double min = -std::numeric_limits<double>::infinity();  ///< soft limits
  double max = std::numeric_limits<double>::infinity();
  double max_velocity = 0;
  double max_acceleration = 0;
};

/// What LinuxCNC's planner is told about a machine. The defaults are those of a small mill, stated
/// in every report that used them; planner settings default as LinuxCNC 2.9's do.
struct MachineLimits {
  std::array<AxisLimits, kAxisCount> axes{};
  /// [TRAJ]MAX_LINEAR_VELOCITY: a cap on every move of X, Y, Z (U, V, W). mm/s.
  double max_linear_velocity_mm_per_s = std::numeric_limits<double>::infinity();
  double max_angular_velocity_deg_per_s = std::numeric_limits<double>::infinity();
  double max_linear_acceleration_mm_per_s2 = std::numeric_limits<double>::infinity();

  double servo_period_s = 0.001;      ///< [EMCMOT]SERVO_PERIOD
  bool arc_blend = true;              ///< [TRAJ]ARC_BLEND_ENABLE
  bool arc_blend_fallback = false;    ///< [TRAJ]ARC_BLEND_FALLBACK_ENABLE
  int arc_blend_depth = 50;           ///< [TRAJ]ARC_BLEND_OPTIMIZATION_DEPTH
  int arc_blend_gap_cycles = 4;       ///< [TRAJ]ARC_BLEND_GAP_CYCLES
  double arc_blend_ramp_hz = 100;     ///< [TRAJ]ARC_BLEND_RAMP_FREQ
  double arc_blend_kink_ratio = 0.1;  ///< [TRAJ]ARC_BLEND_KINK_RATIO

  /// [EMCIO]CYCLE_TIME: how often LinuxCNC's I/O task looks; a tool change takes a few of them even
  /// where nothing has to turn.
  double io_period_s = 0.1;

  /// [TASK]CYCLE_TIME: how often LinuxCNC's task looks whether the machine stands, so that it may
  /// send what waits for that.
  double task_period_s = 0.001;

  /// X, Y, Z 100, 100, 60 mm/s and 500, 500, 300 mm/s2; A, B, C 90 deg/s and 360 deg/s2; no soft
  /// limits.
  static MachineLimits small_mill();
};

}  // namespace kerf
