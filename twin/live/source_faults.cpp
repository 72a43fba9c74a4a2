#include "twin/live/source_faults.h"

#include <fmt/format.h>

#include <utility>

#include "base/translate.h"

namespace kerf {

void SourceFaults::tell(std::optional<FindingLog::Handle>& told, std::uint64_t count,
                        std::string text, FindingLog& log) {
  if (count == 0) return;
  if (told) return log.reword(*told, std::move(text));
  Finding finding;
  finding.id = FindingId::kSourceFault;
  finding.severity = Severity::kWarning;
  finding.text = std::move(text);
  told = log.add(std::move(finding));
}

void SourceFaults::look_at(const SourceStatus& status, FindingLog& log) {
  if (status.incomplete != seen_.incomplete) {
    tell(incomplete_, status.incomplete,
         trnf("frames of the bus were lost: {} cycle was without all axes, and dropped",
              "frames of the bus were lost: {} cycles were without all axes, and dropped",
              status.incomplete),
         log);
  }
  if (status.standing != seen_.standing) {
    tell(standing_, status.standing,
         trf("the device's clock stood still during {} samples: they follow by the times "
             "at which they were received, as far as there are any",
             status.standing),
         log);
  }
  if (status.damaged != seen_.damaged) {
    tell(damaged_, status.damaged,
         trf("the recording is damaged: {} samples are in parts whose sum is wrong, and "
             "were dropped",
             status.damaged),
         log);
  }
  seen_ = status;
}

}  // namespace kerf
