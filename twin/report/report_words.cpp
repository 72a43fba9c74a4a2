#include "twin/report/report_words.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "base/translate.h"
#include "twin/job/load_text.h"

namespace kerf {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (seconds < 60) return span_text(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min {:02} s", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string distance_text(double mm) {
  return mm < 10000 ? fmt::format("{:.1f} mm", mm) : fmt::format("{:.2f} m", mm / 1000);
}

std::string volume_text(double mm3) { return fmt::format("{:.3f} cm3", mm3 / 1000); }

std::string verdict_text(const FindingLog& log) {
  if (log.total() == 0) return tr("no findings");
  return verdict_text(log.count(Severity::kError), log.count(Severity::kWarning));
}

std::string verdict_text(std::uint64_t errors, std::uint64_t warnings) {
  std::string out =
      errors == 0 ? std::string(tr("no errors")) : trnf("{} error", "{} errors", errors);
  if (warnings > 0) out += ", " + trnf("{} warning", "{} warnings", warnings);
  return out;
}

}  // namespace kerf
