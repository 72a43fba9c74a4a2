#include "machine_io/hal/status_lines.h"

namespace kerf {

void StatusLines::take(std::string_view bytes) {
  constexpr std::string_view kProgram = "program ";
  for (const char letter : bytes) {
    if (letter != '\n') {
      is_too_long_ = is_too_long_ || line_.size() >= kLongestLine;
      if (!is_too_long_) line_.push_back(letter);
      continue;
    }
    if (!is_too_long_ && line_.starts_with(kProgram)) program_ = line_.substr(kProgram.size());
    line_.clear();
    is_too_long_ = false;
  }
}

void StatusLines::forget() { *this = StatusLines(); }

}  // namespace kerf
