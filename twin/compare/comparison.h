// twin/compare/comparison.h - what came of comparing a workpiece with the part as designed: values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/geometry.h"
#include "interp_bridge/motion.h"

namespace kerf {

enum class CompareVerdict : std::uint8_t { kInTolerance, kExcessLeft, kGouged };

/// "in tolerance", "excess left", "gouged": of the report.
const char* to_string(CompareVerdict verdict);

/// Who cut there. Line 0: nobody, it is the blank's own surface; or it is not known (a sheet).
struct CutBy {
  SourceRef source;
  int tool = 0;
  bool operator==(const CutBy&) const = default;
};

/// The worst place of one kind, gouge or excess.
struct DeviationPlace {
  double mm = 0;  ///< 0: there is none beyond the tolerance
  Vec3 at_mm{0};
  CutBy by;                     ///< of a gouge who made it, of excess whose pass left it
  double pass_distance_mm = 0;  ///< of excess that nobody cut: how near `by` came to it
};

/// What hangs together beyond the tolerance: places that are nearer than three cells are one.
struct DeviationRegion {
  bool is_gouge = false;
  DeviationPlace worst;
  Box box_mm;
  double area_mm2 = 0;
  double volume_mm3 = 0;
  std::vector<CutBy> by;  ///< by the volume that is theirs, kMostLines at most
  static constexpr std::size_t kMostLines = 10;
};

/// Area of the workpiece's surface whose deviation lies between the two; infinite at the ends.
struct DeviationBin {
  double from_mm = 0, to_mm = 0;
  double area_mm2 = 0;
};

/// Deviations are distances from the design's surface: positive where material is left over
/// (excess), negative where too much is gone (gouge).
struct Comparison {
  std::string design;     ///< the file
  std::size_t piece = 0;  ///< the how manieth of what came off a turned workpiece; 0: the workpiece
  std::size_t triangles = 0;
  double tolerance_mm = 0;
  /// Error of the comparison itself: how far a deviation that is told may be off for a workpiece
  /// that is what the model says. It is below a tenth of a cell.
  double bound_mm = 0;
  /// How far walls of the model may stand from where the tool left them; 0: they were worked out
  /// from the moves themselves. What is told is what is sure in spite of it.
  double walls_mm = 0;
  CompareVerdict verdict = CompareVerdict::kInTolerance;
  DeviationPlace gouge, excess;          ///< `mm` of both are positive
  double gouge_mm3 = 0, excess_mm3 = 0;  ///< of what is beyond the tolerance
  double area_mm2 = 0;                   ///< of the surface that was looked at
  double within_mm2 = 0;                 ///< of it, in tolerance
  std::vector<DeviationBin> histogram;   ///< from gouge to excess, by multiples of the tolerance
  std::vector<DeviationRegion> regions;  ///< the largest of both kinds, gouges first
  std::size_t gouges = 0, excesses = 0;  ///< regions in all
  double outside_mm3 = 0;                ///< of the design beyond the blank
  std::string placement;                 ///< how the design was placed; empty: as it is
  std::optional<double> fit_residue_mm;  ///< of --compare-fit: root of the mean square
  double seconds = 0;
  static constexpr std::size_t kMostRegions = 10;  ///< of either kind

  double within_percent() const { return area_mm2 > 0 ? 100 * within_mm2 / area_mm2 : 100; }
};

}  // namespace kerf
