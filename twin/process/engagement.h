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
///      |////(  |  ) |       `wide_mm`: how wide that is across the way (ae, radial width of cut),
///      |/////`-.-'  |       less gaps in it. `deep_mm`: its greatest height (ap, axial depth of
///      |///| wide|  |       cut), at least what one move removes there at once.
///
/// A tooth comes round in front of the tool from phi = 0, square to the way, by pi / 2, straight
/// ahead, to pi. A spindle that runs clockwise (M3; one that stands counts as such) has 0 on the
/// left of the way, one of M4 on its right. So material that begins at 0 is cut conventionally (up:
/// chips begin with nothing), what ends at pi in climb (down).
struct EngagementLook {
  double angle_rad = 0, wide_mm = 0, deep_mm = 0;
  double gaps_mm = 0;  ///< across the way, between spans of material: not in wide_mm
  bool is_plunge = false;
  /// The tool's middle goes down into material: straight, or along a slope.
  bool cuts_centre = false;
  /// phi where a tooth first meets material and where it last leaves it; what lies between is
  /// angle_rad, less gaps. Straight down 0 and 2 pi.
  double entry_rad = 0, exit_rad = 0;
  double climb = 0;  ///< share of angle_rad beyond pi / 2, where chips get thinner
  /// The widest diameter of the tool that is in material.
  double effective_mm = 0;
  /// The longest stretch of the tool's profile, from the end of its flat bottom up, that is in
  /// material at once: ap of a flat tool, the arc and what is above it of a ball.
  double contact_mm = 0;
  bool is_engaged() const { return angle_rad > 0; }
};

/// A part of a feed move on which the tool is engaged as the look says.
struct EngagedWay {
  double length_mm = 0;
  double seconds = 0;   ///< of the planned feed
  double down_rad = 0;  ///< how steep it goes down; 0: level, up, or straight down
};

/// Of a way, or of several together. Means are by length of what was cut sideways.
struct EngagementSums {
  double cut_mm = 0;         ///< sideways, in material
  double plunge_mm = 0;      ///< straight down, in material
  double cut_s = 0;          ///< the time of both
  double full_mm = 0;        ///< of cut_mm, in a full slot: kFullSlot_rad at least
  double ramp_mm = 0;        ///< of cut_mm, down a slope with material below the tool's middle
  double ramp_most_rad = 0;  ///< the steepest of these
  /// Times length. Of cut_mm the share climb_mm / cut_mm is cut in climb.
  double wide_sum_mm2 = 0, angle_sum = 0, deep_sum_mm2 = 0, climb_mm = 0;
  double entry_sum = 0, exit_sum = 0;
  double wide_most_mm = 0, angle_most_rad = 0, deep_most_mm = 0;
  double contact_most_mm = 0, effective_most_mm = 0;
  double removed_mm3 = 0;
  /// The greatest rate of a move, over its way in material; of short ones over so much of the way
  /// as a quarter of the tool's diameter.
  double rate_most_mm3_per_s = 0;
  /// 160 degrees: with less the tool has a wall on one side alone.
  static constexpr double kFullSlot_rad = 160 * kPi / 180;
  /// What is less steep is level.
  static constexpr double kLeastRamp_rad = 0.05 * kPi / 180;

  void add(const EngagementLook& look, const EngagedWay& way);
  void add(const EngagementSums& other);
  /// What has been added of a way does not count; what was the most of any stays.
  void take_back(const EngagementLook& look, const EngagedWay& way);
  double in_material_mm() const { return cut_mm + plunge_mm; }
  double mean(double sum) const { return cut_mm > 0 ? sum / cut_mm : 0; }
  double rate_mm3_per_s() const { return cut_s > 0 ? removed_mm3 / cut_s : 0; }
};

/// A run of feed moves of one tool in material, not broken by a traverse, a change of the tool, nor
/// by more than a diameter of the tool's way that is not in material.
struct EngagementPass {
  int tool = 0;
  SourceRef from, to;
  double start_s = 0;  ///< program time of the first move
  EngagementSums sums;
};

/// Crests that a tool has left between its passes.
struct Scallops {
  double p95_mm = 0;  ///< what 95 of 100 are not above
  double most_mm = 0;
  Vec3 most_at_mm{0};
  std::size_t count = 0;  ///< places that were looked at; 0: there are none, or they are not seen
};

/// All passes of one tool.
struct EngagementOfTool {
  int tool = 0;
  std::string shape;
  double diameter_mm = 0;
  std::size_t passes = 0;
  EngagementSums sums;
  /// All of its feed moves that were measured, and what of them was in no material.
  double feed_mm = 0, feed_s = 0, air_mm = 0, air_s = 0;
  Scallops scallops;  ///< when the program is over
};

/// A part of a feed move of a tool that stands still, while the workpiece turns.
struct TurnedWay {
  double length_mm = 0, seconds = 0;
  double cut_mm = 0;           ///< of length_mm, in material
  double depth_mm = 0;         ///< of cut, across the way (TurnCut::depth_mm)
  double feed_mm_per_rev = 0;  ///< as planned; 0: the spindle stands
  double chip_mm = 0;          ///< mean thickness: the feed by the sine of the lead angle
  double removed_mm3 = 0;
};

/// All that one turning tool has cut. Means are by length in material.
struct TurningEngagement {
  int tool = 0;
  std::string shape;
  double feed_mm = 0, feed_s = 0, air_mm = 0, air_s = 0, cut_mm = 0, cut_s = 0, removed_mm3 = 0;
  double depth_sum_mm2 = 0, feed_sum = 0, chip_sum = 0;  ///< times length
  double depth_most_mm = 0, feed_most_mm = 0, chip_most_mm = 0, rate_most_mm3_per_s = 0;

  void add(const TurnedWay& way);
  double mean(double sum) const { return cut_mm > 0 ? sum / cut_mm : 0; }
  double rate_mm3_per_s() const { return cut_s > 0 ? removed_mm3 / cut_s : 0; }
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
  std::vector<EngagementOfTool> tools;    ///< over all passes
  std::vector<TurningEngagement> turned;  ///< of a workpiece that turns
  /// Feed moves of which it was not measured (tilted tools, such with an undercut, models that are
  /// no heights), that came near the workpiece, and what they removed.
  double unmeasured_mm = 0, unmeasured_mm3 = 0;
  std::optional<EngagementMap> map;
  static constexpr std::size_t kMostPasses = 1000;
};

}  // namespace kerf
