// kerf-status - says which program the running LinuxCNC has loaded. A process of its own, since
// LinuxCNC's NML library is for one purpose, and HAL has no pin for a file's name. It opens the
// status channel for reading alone; no command goes to LinuxCNC.
#include <poll.h>
#include <signal.h>
#include <sys/shm.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

// LinuxCNC's, in this order.
#include <emc.hh>
#include <emc_nml.hh>
#include <rcs.hh>

#include "machine_io/hal/hal_messages.h"
#include "machine_io/hal/hal_stream.h"

namespace kerf {
namespace {

constexpr const char* kDefaultNmlFile = "/usr/share/linuxcnc/linuxcnc.nml";
constexpr int kPeriod_ms = 100;
/// Of the task controller's heartbeat, which goes on while it lives.
constexpr std::int64_t kStill_ns = 2'000'000'000;

constexpr const char* kHelp =
    "usage: kerf-status [--nml FILE] >PIPE\n"
    "Writes a line \"program PATH\" to stdout for each program that the LinuxCNC on this computer\n"
    "loads, and \"program \" where it has none; `kerf shadow` starts it. It reads LinuxCNC's "
    "status\n"
    "and commands nothing.\n"
    "  --nml FILE  where LinuxCNC's channels are described, if the INI says [EMC]NML_FILE\n"
    "  --help      this text\n"
    "Exit status: 0 nobody reads any more, 2 wrong arguments, 4 no LinuxCNC runs or it has "
    "ended.\n";

void complain(const std::string& message) {
  std::fprintf(stderr, "kerf-status: %s\n", message.c_str());
}

std::int64_t monotonic_ns() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// Of the buffer emcStatus in LinuxCNC's own description. Looked for first: NML would make one
/// where there is none.
bool has_status_buffer() {
  constexpr key_t kStatusKey = 1002;
  return shmget(kStatusKey, 0, 0) >= 0;
}

/// False: nobody reads.
bool say(int fd, const std::string& line) {
  std::size_t at = 0;
  while (at < line.size()) {
    const ssize_t got = write(fd, line.data() + at, line.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += static_cast<std::size_t>(got);
  }
  return true;
}

int watch(const std::string& nml_file, int out) {
  if (nml_file == kDefaultNmlFile && !has_status_buffer()) {
    complain(filled_in(HalMessage::kNoLinuxCnc));
    return kHalExitNoLinuxCnc;
  }
  RCS_STAT_CHANNEL channel(emcFormat, "emcStatus", "xemc", nml_file.c_str());
  if (!channel.valid()) {
    complain(filled_in(HalMessage::kNoLinuxCnc));
    return kHalExitNoLinuxCnc;
  }
  std::optional<std::string> told;
  std::uint32_t beat = 0;
  std::int64_t beat_ns = monotonic_ns();
  while (true) {
    if (channel.peek() == EMC_STAT_TYPE) {
      const auto* const status = static_cast<const EMC_STAT*>(channel.get_address());
      const std::uint32_t now = status->task.heartbeat;
      if (std::exchange(beat, now) != now) beat_ns = monotonic_ns();
      const char* const file = status->task.file;
      std::string program(file, strnlen(file, sizeof(status->task.file)));
      // A line break in a name would end the message.
      if (program.find('\n') != program.npos) program.clear();
      if (program != told) {
        if (!say(out, "program " + program + "\n")) return kHalExitAsked;
        told = std::move(program);
      }
    }
    if (monotonic_ns() - beat_ns > kStill_ns) {
      complain(filled_in(HalMessage::kNoLinuxCnc));
      return kHalExitNoLinuxCnc;
    }
    pollfd reader{out, 0, 0};
    poll(&reader, 1, kPeriod_ms);
    if ((reader.revents & (POLLERR | POLLHUP)) != 0) return kHalExitAsked;
  }
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  std::string nml_file = kerf::kDefaultNmlFile;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kerf::kHelp, stdout);
      return 0;
    }
    if (argument != "--nml" || i + 1 == argc) {
      kerf::complain(kerf::filled_in(kerf::HalMessage::kUnknownArgument, argument));
      return kerf::kHalExitUsage;
    }
    nml_file = argv[++i];
  }
  // NML prints on stdout what it has to say: from here on that is stderr.
  signal(SIGPIPE, SIG_IGN);
  const int out = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return kerf::watch(nml_file, out);
}
