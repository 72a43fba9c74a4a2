// twin/job/load_text.h - forces, and for how long there are some, as people read them.
#pragma once

#include <fmt/format.h>

#include <string>

namespace kerf {

/// Three digits, and no power of ten: "0.0162", "16.2", "1620".
inline std::string load_text(double value) {
  return value >= 1000 || value <= -1000 ? fmt::format("{:.0f}", value)
                                         : fmt::format("{:.3g}", value);
}

/// "12.3 s"; what would be "0.0 s" in ms: "40 ms", "0.3 ms".
inline std::string span_text(double seconds) {
  if (seconds <= 0 || seconds >= 0.05) return fmt::format("{:.1f} s", seconds);
  return seconds < 0.001 ? fmt::format("{:.1g} ms", seconds * 1e3)
                         : fmt::format("{:.2g} ms", seconds * 1e3);
}

/// "12"; below 1 its first digit: "0.3".
inline std::string percent_text(double percent) {
  return percent < 0.95 ? fmt::format("{:.1g}", percent) : fmt::format("{:.0f}", percent);
}

}  // namespace kerf
