#include "tests/live/classicladder/linuxcnc_session.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace kerf {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::int32_t from_cdab(std::uint32_t low, std::uint32_t high) {
  return static_cast<std::int32_t>(high << 16U | low);
}

/// X servers of this computer keep sockets there, in a folder of root's. In the session's own view
/// of the files it is empty, and belongs to who runs the test.
constexpr const char* kOwnSockets =
    "exec sh -c {mkdir -p /tmp/.X11-unix && mount -t tmpfs -o mode=1777 tmpfs /tmp/.X11-unix}\n";

ServedRegisters meaning_of(const std::array<std::uint16_t, kServedRegisters>& r) {
  ServedRegisters served;
  for (std::size_t i = 0; i < 3; ++i) served.position_um[i] = from_cdab(r[2 * i], r[2 * i + 1]);
  served.tool = r[6];
  served.line_low_word = r[7];
  served.scan = r[8];
  served.tool_offset_um = from_cdab(r[9], r[10]);
  served.spindle_rpm = from_cdab(r[11], r[12]);
  served.line = from_cdab(r[13], r[14]);
  served.scan_begun = r[15];
  return served;
}

}  // namespace

int shell(const std::string& command, std::string& output) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) output += part.data();
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string LinuxCncSession::missing() {
  std::string reason;
  if (shell(RUN_LINUXCNC " --check", reason) != 0) return reason;
  if (shell("command -v Xvfb", reason) != 0) return "package xvfb is not installed";
  return {};
}

LinuxCncSession::LinuxCncSession(const Plan& plan) {
  std::string pattern = (std::filesystem::temp_directory_path() / "classicladder.XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) return;
  folder_ = pattern;
  const std::filesystem::path run = folder_ / "run";
  std::filesystem::create_directory(run);
  for (const char* name : {"kerf_positions.tcl", "kerf_positions.clp", "kerf_ladder"}) {
    std::filesystem::copy(std::filesystem::path(LINUXCNC_CONFIGS) / name, run);
  }
  std::ofstream(folder_ / "program.ngc") << plan.program;
  std::ofstream(folder_ / "session.tcl")
      << kOwnSockets << plan.before
      << "\nsource [file join [file dirname [info script]] kerf_positions.tcl]\n"
      << plan.after << '\n';
  setenv("KERF_LIVE_READY", plan.at_ready.c_str(), 1);
  setenv("KERF_LIVE_AT_END", plan.at_end.c_str(), 1);
  status_ = shell(RUN_LINUXCNC " --sessions " + std::to_string(plan.sessions) +
                      " --beside '" REGISTER_PROBE " 1502 50 polls.txt' --hal " +
                      (folder_ / "session.tcl").string() + " " +
                      (folder_ / "program.ngc").string() + " " + run.string() + " 2>&1",
                  output_);
}

LinuxCncSession::~LinuxCncSession() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::string LinuxCncSession::said() const { return output_ + file("linuxcnc.log"); }

std::string LinuxCncSession::file(const std::string& name) const {
  return text_of(folder_ / "run" / name);
}

int LinuxCncSession::times(const std::string& event) const {
  std::istringstream lines(file("polls.txt"));
  std::string line;
  int count = 0;
  while (std::getline(lines, line)) count += line == event ? 1 : 0;
  return count;
}

std::vector<ServedRegisters> LinuxCncSession::polls() const {
  std::istringstream lines(file("polls.txt"));
  std::string line;
  std::vector<ServedRegisters> polls;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::array<std::uint16_t, kServedRegisters> registers{};
    std::size_t count = 0;
    while (count < registers.size() && words >> registers[count]) ++count;
    if (count == registers.size()) polls.push_back(meaning_of(registers));
  }
  return polls;
}

std::vector<LoggedCycle> LinuxCncSession::cycles(int& lost) const {
  std::istringstream lines(file("samples.txt"));
  std::string line;
  std::vector<LoggedCycle> cycles;
  lost = 0;
  long before = -1;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    long number = 0;
    LoggedCycle c;
    if (!(words >> number >> c.joint[0] >> c.joint[1] >> c.joint[2] >> c.tool_offset >>
          c.spindle_rpm >> c.tool >> c.line >> c.scan)) {
      ++lost;
      continue;
    }
    if (before >= 0 && number != before + 1) ++lost;
    before = number;
    cycles.push_back(c);
  }
  return cycles;
}

}  // namespace kerf
