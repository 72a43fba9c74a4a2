// twin/diff/diff_text.h - what differs between two programs or workpieces, for people and as JSON.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "twin/diff/motion_diff.h"
#include "twin/diff/part_diff.h"

namespace kerf {

/// One of the two.
struct DiffSide {
  std::string path;                ///< as the user wrote it
  std::vector<std::string> files;  ///< what SourceRef::file means
  std::vector<DiffStep> steps;     ///< of a program
  /// The tools that have cut: number and shape.
  std::vector<std::pair<int, std::string>> tools;
};

struct DiffReport {
  DiffSide a, b;
  double tolerance_mm = 0;
  std::optional<MotionDiff> motion;  ///< of two programs
  std::optional<PartDiff> part;

  bool tools_same() const { return !motion || a.tools == b.tools; }
  bool is_same() const {
    return (!motion || motion->is_same()) && (!part || part->same) && tools_same();
  }
};

/// A page: motion, the first `most_hunks` places where it differs, part, tools. In mm.
std::string diff_text(const DiffReport& report, std::size_t most_hunks);

/// kerf-diff/1: schema, version, a, b, tolerance_mm, same; motion (null: not compared): same,
/// a_motions, b_motions, apart_mm, places, hunks: each kinds, a and b (file, first_line, last_line,
/// motions), apart_mm, at_mm, a_line, b_line, feed, tool, rpm (of the first motion of either); part
/// (null: not compared): same, equal_bits, a_mm3, b_mm3, measured ("heights", "surfaces"), most_mm,
/// at_mm, a_cut and b_cut (file, line, tool), area_mm2, a_more_mm3, b_more_mm3, wall_cells,
/// cell_mm; tools: number, a, b (shapes), of those that differ. Lengths are rounded to 1e-6.
std::string diff_json(const DiffReport& report, const std::string& version);

}  // namespace kerf
