// twin/live/source_faults.h - what a source has counted against itself, as findings.
#pragma once

#include <optional>

#include "machine_io/position_source.h"
#include "twin/findings/finding.h"

namespace kerf {

/// One finding for each kind of fault (source-fault), reworded as it is counted on. The source has
/// done what can be done already: see SourceStatus.
class SourceFaults {
 public:
  /// `status` as it is now.
  void look_at(const SourceStatus& status, FindingLog& log);

 private:
  void tell(std::optional<FindingLog::Handle>& told, std::uint64_t count, std::string text,
            FindingLog& log);

  SourceStatus seen_;
  std::optional<FindingLog::Handle> incomplete_;
  std::optional<FindingLog::Handle> standing_;
  std::optional<FindingLog::Handle> damaged_;
};

/// Any of them makes what was cut doubtful.
inline bool is_at_fault(const SourceStatus& status) {
  return status.incomplete > 0 || status.standing > 0 || status.damaged > 0;
}

}  // namespace kerf
