#include "twin/report/finding_lists.h"

#include <nlohmann/json.hpp>

namespace kerf {

ListedProgram listed_program(const Report& report) {
  ListedProgram out;
  out.path = report.program_path.empty() && report.live ? report.live->source : report.program_path;
  out.files = report.program.files;
  out.findings = report.findings;
  out.partial_reason = report.partial_reason;
  out.total_s = report.timing.total_s;
  const auto look = [&](FindingTopic topic) {
    out.looked_at[static_cast<std::size_t>(topic)] = true;
  };
  for (const FindingTopic topic : {FindingTopic::kProgram, FindingTopic::kTools,
                                   FindingTopic::kBlank, FindingTopic::kMachine}) {
    look(topic);
  }
  if (!report.sheet) {
    look(FindingTopic::kCutter);
    look(FindingTopic::kCollisions);
  }
  if (report.turning) look(FindingTopic::kTurning);
  if (report.sheet && report.sheet->sums) {
    nlohmann::ordered_json sums;
    report.sheet->sums->add_json(sums);
    look(sums.contains("punch") ? FindingTopic::kPunch : FindingTopic::kBeam);
  }
  if (report.live) look(FindingTopic::kSource);
  for (const Finding& finding : report.findings.kept()) look(row_of(finding.id).topic);
  return out;
}

}  // namespace kerf
