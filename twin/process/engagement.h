// twin/process/engagement.h - how the tools of a program were engaged in the material: values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

/// A tool at one place of its way: what its side, ahead of it, has in it.
///
///         way ^             `angle_rad`: of its edge that is in material, seen along the axis:
///       ______|_____        0 .. pi for a tool that goes sideways, 2 pi where it goes straight
///      |/////.-'-.  |       down.
///      |////(  |  ) |       `wide_mm`: how wide that is across the way (ae, radial width of cut).
///      |/////`-.-'  |       `deep_mm`: its greatest height (ap, axial depth of cut), at least
///      |///| wide|  |       what one move removes there at once.
struct EngagementLook {
  double angle_rad = 0, wide_mm = 0, deep_mm = 0;
  bool is_plunge = false;
  bool is_engaged() const { return angle_rad > 0; }
};

/// Of a way, or of several together. Means are by length of what was cut sideways.
struct EngagementSums {
  double cut_mm = 0;     ///< sideways, in material
  double plunge_mm = 0;  ///< straight down, in material
  double full_mm = 0;    ///< of cut_mm, in a full slot: kFullSlot_rad at least
  double wide_sum_mm2 = 0, angle_sum = 0, deep_sum_mm2 = 0;  ///< times length
  double wide_most_mm = 0, angle_most_rad = 0, deep_most_mm = 0;
  double removed_mm3 = 0;
  /// 160 degrees: with less the tool has a wall on one side alone.
  static constexpr double kFullSlot_rad = 160 * kPi / 180;

  void add(const EngagementLook& look, double length_mm) {
    if (look.is_plunge) {
      plunge_mm += length_mm;
      return;
    }
    cut_mm += length_mm;
    if (look.angle_rad >= kFullSlot_rad) full_mm += length_mm;
    wide_sum_mm2 += look.wide_mm * length_mm;
    angle_sum += look.angle_rad * length_mm;
    deep_sum_mm2 += look.deep_mm * length_mm;
    wide_most_mm = std::max(wide_most_mm, look.wide_mm);
    angle_most_rad = std::max(angle_most_rad, look.angle_rad);
    deep_most_mm = std::max(deep_most_mm, look.deep_mm);
  }
  void add(const EngagementSums& other) {
    cut_mm += other.cut_mm, plunge_mm += other.plunge_mm, full_mm += other.full_mm;
    wide_sum_mm2 += other.wide_sum_mm2;
    angle_sum += other.angle_sum;
    deep_sum_mm2 += other.deep_sum_mm2;
    wide_most_mm = std::max(wide_most_mm, other.wide_most_mm);
    angle_most_rad = std::max(angle_most_rad, other.angle_most_rad);
    deep_most_mm = std::max(deep_most_mm, other.deep_most_mm);
    removed_mm3 += other.removed_mm3;
  }
  double mean(double sum) const { return cut_mm > 0 ? sum / cut_mm : 0; }
};

/// A run of feed moves of one tool in material, not broken by a traverse, a change of the tool, nor
/// by more than a diameter of the tool's way that is not in material.
struct EngagementPass {
  int tool = 0;
  SourceRef from, to;
  double start_s = 0;  ///< program time of the first move
  EngagementSums sums;
};

/// All passes of one tool.
struct EngagementOfTool {
  int tool = 0;
  std::string shape;
  double diameter_mm = 0;
  std::size_t passes = 0;
  EngagementSums sums;
};

/// Seen from above: how the tool was engaged that cut there last.
struct EngagementMap {
  Box bounds_mm;
  int nx = 0, ny = 0;
  /// Of each cell, row by row from low x, y: EngagementLook::angle_rad; 0: nothing was cut there.
  std::vector<float> angle_rad;
};

struct Engagement {
  std::vector<EngagementPass> passes;  ///< in program order; kMostPasses of most volume at most
  std::size_t passes_in_all = 0;
  std::vector<EngagementOfTool> tools;  ///< over all passes
  /// Feed moves of which it was not measured (tilted tools, such with an undercut, models that are
  /// no heights), that came near the workpiece, and what they removed.
  double unmeasured_mm = 0, unmeasured_mm3 = 0;
  std::optional<EngagementMap> map;
  static constexpr std::size_t kMostPasses = 1000;
};

}  // namespace kerf
