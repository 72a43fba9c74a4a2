#include "twin/report/run_json.h"

#include "twin/findings/finding_json.h"
#include "twin/report/sheet_report.h"

namespace kerf {

nlohmann::ordered_json run_json(const LiveRun& run) {
  nlohmann::ordered_json out;
  const LiveFacts& f = run.facts;
  out["number"] = run.number;
  out["part"] = run.part;
  out["program"] = run.program;
  out["end"] = to_string(run.end);
  out["from_line"] = run.from_line;
  out["to_line"] = run.to_line;
  out["begin_s"] = rounded(run.begin_s);
  out["end_s"] = rounded(run.end_s);
  out["samples"] = f.samples;
  out["path_mm"] = rounded(f.path_mm);
  out["chord_mm"] = rounded(f.chord_mm);
  out["on_path"] = f.on_path;
  out["off_path"] = f.off_path;
  out["gaps"] = f.gaps;
  out["removed_mm3"] = rounded(run.removed_mm3);
  out["part_removed_mm3"] = rounded(run.part_removed_mm3);
  out["digest"] = run.digest;
  if (run.sheet) out["sheet"] = sheet_json(*run.sheet, run.files);
  out["errors"] = run.errors;
  out["warnings"] = run.warnings;
  out["notes"] = run.notes;
  return out;
}

}  // namespace kerf
