// twin/job/load_text.h - forces and the like as people read them.
#pragma once

#include <fmt/format.h>

#include <string>

namespace kerf {

/// Three digits, and no power of ten: "0.0162", "16.2", "1620".
inline std::string load_text(double value) {
  return value >= 1000 || value <= -1000 ? fmt::format("{:.0f}", value)
                                         : fmt::format("{:.3g}", value);
}

}  // namespace kerf
