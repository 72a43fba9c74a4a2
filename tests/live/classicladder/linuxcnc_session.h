// tests/live/classicladder/linuxcnc_session.h - a LinuxCNC that serves its registers, and what was
// seen of it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kerf {

/// What configs/linuxcnc/README.md says the registers mean.
struct ServedRegisters {
  std::array<std::int32_t, 3> position_um{};
  std::int32_t tool_offset_um = 0;
  std::int32_t spindle_rpm = 0;
  std::int32_t line = 0;
  std::uint16_t tool = 0;
  std::uint16_t line_low_word = 0;
  std::uint16_t scan = 0;
  std::uint16_t scan_begun = 0;
};
inline constexpr int kServedRegisters = 16;

/// The same, as HAL had it in one servo cycle. In the machine's units.
struct LoggedCycle {
  std::array<double, 3> joint{};
  double tool_offset = 0;
  double spindle_rpm = 0;
  std::int32_t tool = 0;
  std::int32_t line = 0;
  std::int32_t scan = 0;
};

/// One run of tests/live/linuxcnc/run_linuxcnc with the files of configs/linuxcnc, in a folder of
/// its own that goes with it. Its registers are polled 50 times a second meanwhile.
class LinuxCncSession {
 public:
  /// `before` and `after` are Tcl around the reading of kerf_positions.tcl. `at_ready`, `at_end`:
  /// shell commands, before the program and behind it. `sessions`: LinuxCNC is started so often.
  struct Plan {
    std::string program;
    std::string before;
    std::string after;
    std::string at_ready;
    std::string at_end;
    int sessions = 1;
  };

  /// Why no such session is possible here; empty if it is.
  static std::string missing();

  explicit LinuxCncSession(const Plan& plan);
  ~LinuxCncSession();
  LinuxCncSession(const LinuxCncSession&) = delete;
  LinuxCncSession& operator=(const LinuxCncSession&) = delete;

  int status() const { return status_; }
  /// What run_linuxcnc said, and LinuxCNC's own log.
  std::string said() const;
  /// A file that the session left; empty if it left none of this name.
  std::string file(const std::string& name) const;
  /// How often "connected": connections that the client made; "refused": answers that it refused,
  /// as their two scan counters differed.
  int times(const std::string& event) const;
  std::vector<ServedRegisters> polls() const;
  /// What halsampler wrote into samples.txt. Servo cycles that it lost are in `lost`.
  std::vector<LoggedCycle> cycles(int& lost) const;

 private:
  std::filesystem::path folder_;
  std::string output_;
  int status_ = -1;
};

/// The exit status; stdout is appended to `output`.
int shell(const std::string& command, std::string& output);

}  // namespace kerf
