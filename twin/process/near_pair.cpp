#include "twin/process/near_pair.h"

namespace kerf {

void NearPair::set_rules(const PairRules& rules, double clearance_mm) {
  ignored = rules.ignores(to_string(row.part), row.other);
  near_mm = rules.clearance_mm(to_string(row.part), row.other).value_or(clearance_mm);
}

void NearPair::note(double mm, SourceRef source, double time_s, const Vec3& position_mm) {
  least_mm = mm;
  if (row.contacts > 0) return;
  row.source = source;
  nearest.source = source;
  nearest.time_s = time_s;
  nearest.position_mm = position_mm;
  nearest.tool = row.tool;
}

void NearPair::count_contact(SourceRef source) {
  if (row.contacts++ == 0) row.source = source;
}

std::optional<Finding> NearPair::near_miss() const {
  if (ignored || row.contacts > 0 || least_mm >= near_mm) return std::nullopt;
  Finding near = nearest;
  near.id = FindingId::kNearMiss;
  near.severity = Severity::kNote;
  near.bodies = {to_string(row.part), row.other};
  return near;
}

}  // namespace kerf
