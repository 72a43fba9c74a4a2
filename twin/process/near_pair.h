// twin/process/near_pair.h - a part of a tool and what it is held against: how near they came, and
// the row and near-miss that come of it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "twin/collision/pair_rules.h"
#include "twin/findings/finding.h"
#include "twin/process/collision_table.h"

namespace kerf {

struct NearPair {
  CollisionPair row;  ///< least_clearance_mm is in least_mm
  double least_mm = std::numeric_limits<double>::infinity();
  double near_mm = 0;    ///< what counts as near
  bool ignored = false;  ///< PairRules
  std::optional<FindingLog::Handle> event;
  Finding nearest;  ///< line, time and place of the least clearance

  /// Tool, part and row.other are set. `clearance_mm`: where no rule says what is near.
  void set_rules(const PairRules& rules, double clearance_mm);
  /// Nearer than ever.
  void note(double mm, SourceRef source, double time_s, const Vec3& position_mm);
  /// Of a new event.
  void count_contact(SourceRef source);
  /// The program is over. Without its text; none: they touched, or were never so near.
  std::optional<Finding> near_miss() const;
};

/// Rows for reports, of those that are not ignored.
template <class Pairs>
std::vector<CollisionPair> rows_of(const Pairs& pairs) {
  std::vector<CollisionPair> rows;
  for (const NearPair& pair : pairs) {
    if (pair.ignored) continue;
    rows.push_back(pair.row);
    if (pair.least_mm < std::numeric_limits<double>::infinity())
      rows.back().least_clearance_mm = pair.row.contacts > 0 ? 0 : pair.least_mm;
  }
  return rows;
}

}  // namespace kerf
