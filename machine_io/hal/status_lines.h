// machine_io/hal/status_lines.h - what kerf-status says, line by line.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// Lines "program PATH": the path begins behind the blank and goes to the end of the line, whatever
/// is in it; none: LinuxCNC has no program. Other lines mean nothing (a later kerf-status may say
/// more), and one that is longer than any path is not taken for the path that its beginning would
/// be.
class StatusLines {
 public:
  /// "program " and PATH_MAX bytes.
  static constexpr std::size_t kLongestLine = 8 + 4096;

  /// Bytes as they come, parted anywhere.
  void take(std::string_view bytes);
  /// Whoever spoke has ended: what was not said to its end is not the next one's.
  void forget();
  /// Nothing: none has been named yet. Empty: there is none.
  const std::optional<std::string>& program() const { return program_; }

 private:
  std::string line_;  ///< that is not at its end
  bool is_too_long_ = false;
  std::optional<std::string> program_;
};

}  // namespace kerf
