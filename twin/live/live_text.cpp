#include "twin/live/live_text.h"

#include <fmt/format.h>

#include <cmath>

#include "base/translate.h"

namespace kerf {

std::string time_left_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string short_age_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.0f} ms", seconds * 1e3) : fmt::format("{:.1f} s", seconds);
}

std::string notice_of(const LiveStatus& status) {
  if (status.state == LiveState::kWaiting) {
    return status.source.trouble.empty() ? tr("waiting for positions") : status.source.trouble;
  }
  if (!status.place.missing_axes.empty() && !status.place.known) {
    return trf("no position of {}", status.place.missing_axes);
  }
  if (status.collision_in_s >= 0) {
    return trf("collision in {:.1f} s, line {}", status.collision_in_s, status.collision_line);
  }
  if (status.off_path_mm > 0) return trf("off the path by {:.2f} mm", status.off_path_mm);
  if (!status.source.trouble.empty() && status.source.state != SourceState::kReading) {
    return status.source.trouble;
  }
  return status.state == LiveState::kEnded ? tr("the log is at its end") : std::string();
}

}  // namespace kerf
