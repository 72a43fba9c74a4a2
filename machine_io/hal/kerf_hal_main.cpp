// kerf-hal - reads the pins of the running LinuxCNC and hands them on; shows kerf's findings as
// pins kerf.*. A process of its own, because LinuxCNC ends every component when it ends, and
// because HAL's library is for one purpose.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/text_scan.h"
#include "machine_io/hal/hal_pins.h"

namespace kerf {
namespace {

constexpr double kDefaultRate_hz = 100.0;
constexpr double kLowestRate_hz = 1.0;
constexpr double kHighestRate_hz = 1000.0;

/// Values that nobody writes any more are not handed on, and are not waited for longer than this:
/// a process that stays attached keeps a dead HAL alive.
constexpr std::int64_t kServoPatience_ns = 2'000'000'000;

constexpr const char* kHelp =
    "usage: kerf-hal [--rate HZ] [--load PIN] >PIPE\n"
    "Reads positions, tool, program line and spindle of the LinuxCNC that runs on this computer\n"
    "and writes them to stdout as binary records; `kerf shadow` starts it. It links no pin and\n"
    "changes nothing in HAL but its own pins kerf.*, which show what comes in by stdin.\n"
    "  --rate HZ   readings per second, 1 to 1000 (100)\n"
    "  --load PIN  float, s32 or u32: the spindle's load, handed on as it is\n"
    "  --help      this text\n"
    "Exit status: 0 asked to end (SIGTERM, SIGINT, stdout closed), 1 HAL refused, 2 wrong\n"
    "arguments, 4 no LinuxCNC runs or it has ended.\n";

void complain(const std::string& message) {
  std::fprintf(stderr, "kerf-hal: %s\n", message.c_str());
}

void complain(HalMessage message, std::string_view detail = {}) {
  complain(filled_in(message, detail));
}

/// The rate, or nothing if the arguments are wrong (said).
std::optional<double> rate_from(std::string_view text) {
  double rate = 0.0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, rate);
  const bool is_number = error == std::errc() && stopped == end;
  if (is_number && rate >= kLowestRate_hz && rate <= kHighestRate_hz) return rate;
  complain(HalMessage::kRateRange, text);
  return std::nullopt;
}

/// What kerf says, in whole records from a stream of bytes.
class StatusInput {
 public:
  bool is_open() const { return open_; }

  /// Reads what is there and gives the newest whole record. Closes for good at its end or at
  /// anything that is no record: nothing after it could be trusted.
  std::optional<HalStatusRecord> read_newest() {
    std::optional<HalStatusRecord> newest;
    const ssize_t got = ::read(STDIN_FILENO, buffer_.data() + filled_, buffer_.size() - filled_);
    if (got <= 0) {
      open_ = got < 0 && (errno == EINTR || errno == EAGAIN);
      return newest;
    }
    filled_ += static_cast<std::size_t>(got);
    std::size_t used = 0;
    for (; filled_ - used >= sizeof(HalStatusRecord); used += sizeof(HalStatusRecord)) {
      HalStatusRecord record;
      std::memcpy(&record, buffer_.data() + used, sizeof(record));
      if (const auto fault = head_fault(record)) {
        complain(HalMessage::kBadStatus, text_of(*fault));
        open_ = false;
        return std::nullopt;
      }
      newest = record;
    }
    filled_ -= used;
    std::memmove(buffer_.data(), buffer_.data() + used, filled_);
    return newest;
  }

 private:
  bool open_ = true;
  std::size_t filled_ = 0;
  std::array<char, 64 * sizeof(HalStatusRecord)> buffer_{};
};

/// Descriptors of the loop. Closed by the end of the process.
struct Descriptors {
  int records = -1;  ///< what was stdout
  int timer = -1;
  int signals = -1;
};

/// HAL's library prints some messages on stdout, in the middle of our records: from here on
/// stdout is stderr.
int take_stdout() {
  const int records = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return records;
}

int open_signals() {
  signal(SIGPIPE, SIG_IGN);
  sigset_t ends;
  sigemptyset(&ends);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&ends, number);
  sigprocmask(SIG_BLOCK, &ends, nullptr);
  return signalfd(-1, &ends, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Absolute deadlines: late readings do not move the ones after them.
int open_timer(double rate_hz) {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  const auto period_ns = std::llround(1e9 / rate_hz);
  itimerspec times{};
  times.it_interval.tv_sec = period_ns / 1'000'000'000;
  times.it_interval.tv_nsec = period_ns % 1'000'000'000;
  clock_gettime(CLOCK_MONOTONIC, &times.it_value);
  return timerfd_settime(timer, TFD_TIMER_ABSTIME, &times, nullptr) == 0 ? timer : -1;
}

/// A record is shorter than PIPE_BUF, so a pipe that is ready takes it whole. One that is not
/// ready has a slow reader, who gets the next reading instead.
bool hand_on(int fd, const HalSampleRecord& record) {
  pollfd out{fd, POLLOUT, 0};
  if (poll(&out, 1, 0) != 1 || (out.revents & POLLOUT) == 0) return true;
  return write(fd, &record, sizeof(record)) == static_cast<ssize_t>(sizeof(record));
}

/// Readings and status between HAL and the two pipes.
class Server {
 public:
  Server(HalPins& pins, int records_fd) : pins_(pins), records_fd_(records_fd) {
    record_.bytes = sizeof(record_);
  }

  int status_fd() const { return input_.is_open() ? STDIN_FILENO : -1; }

  void take_status() {
    if (const auto status = input_.read_newest()) {
      pins_.show(*status);
      last_status_ns_ = now_ns(CLOCK_MONOTONIC);
    }
  }

  /// One reading, `ticks` deadlines after the one before. The exit status if it is the last.
  std::optional<int> read_once(std::uint64_t ticks) {
    const HalPins::Reading reading = pins_.read(record_);
    const std::int64_t now = record_.monotonic_ns;
    if (reading == HalPins::Reading::kNoJoints) {
      complain(HalMessage::kNoJoints);
      return kHalExitNoLinuxCnc;
    }
    if (last_status_ns_ && now - *last_status_ns_ > kHalStatusTimeout_ns) {
      pins_.show_silence();
      last_status_ns_.reset();
    }
    pins_.beat(now);
    if (reading == HalPins::Reading::kServoStill) {
      if (!still_since_ns_) still_since_ns_ = now;
      if (now - *still_since_ns_ < kServoPatience_ns) return std::nullopt;
      complain(HalMessage::kServoStill);
      return kHalExitNoLinuxCnc;
    }
    still_since_ns_.reset();
    // Deadlines that have passed unused leave a gap; those of a still servo thread do not.
    record_.sequence = next_sequence_ + ticks - 1;
    next_sequence_ += ticks;
    if (!hand_on(records_fd_, record_)) return kHalExitAsked;
    return std::nullopt;
  }

 private:
  HalPins& pins_;
  int records_fd_;
  StatusInput input_;
  HalSampleRecord record_;
  std::uint64_t next_sequence_ = 0;
  std::optional<std::int64_t> last_status_ns_;  ///< empty: silent
  std::optional<std::int64_t> still_since_ns_;
};

/// Runs until something ends it: the exit status.
int serve(HalPins& pins, const Descriptors& fds) {
  Server server(pins, fds.records);
  while (true) {
    std::array<pollfd, 4> waits{{{fds.timer, POLLIN, 0},
                                 {fds.signals, POLLIN, 0},
                                 {fds.records, 0, 0},
                                 {server.status_fd(), POLLIN, 0}}};
    if (poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) return kHalExitTrouble;
    if (waits[1].revents != 0) return kHalExitAsked;
    if ((waits[2].revents & (POLLERR | POLLHUP)) != 0) return kHalExitAsked;
    if (waits[3].revents != 0) server.take_status();
    std::uint64_t ticks = 0;
    if (read(fds.timer, &ticks, sizeof(ticks)) != sizeof(ticks)) continue;
    if (const std::optional<int> status = server.read_once(ticks)) return *status;
  }
}

int run(double rate_hz, const std::string& load_pin) {
  if (isatty(STDOUT_FILENO) != 0) {
    complain(HalMessage::kTerminal);
    return kHalExitUsage;
  }
  Descriptors fds;
  fds.records = take_stdout();
  fds.signals = open_signals();
  switch (look_for_hal()) {
    case HalPresence::kRunning:
      break;
    case HalPresence::kNone:
      complain(HalMessage::kNoLinuxCnc);
      return kHalExitNoLinuxCnc;
    case HalPresence::kForbidden:
      complain(HalMessage::kForbidden, std::strerror(errno));
      return kHalExitTrouble;
  }
  std::string trouble;
  const std::unique_ptr<HalPins> pins = HalPins::attach(load_pin, trouble);
  if (!pins) {
    complain(trouble);
    return kHalExitTrouble;
  }
  if (pins->taken()) complain(HalMessage::kPinsTaken);
  fds.timer = open_timer(rate_hz);
  if (fds.records < 0 || fds.signals < 0 || fds.timer < 0) {
    complain(HalMessage::kNoTimer, std::strerror(errno));
    return kHalExitTrouble;
  }
  return serve(*pins, fds);
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  double rate_hz = kerf::kDefaultRate_hz;
  std::string load_pin;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kerf::kHelp, stdout);
      return 0;
    }
    const bool is_rate = argument == "--rate", is_load = argument == "--load";
    if ((!is_rate && !is_load) || i + 1 == argc) {
      kerf::complain(is_rate   ? kerf::HalMessage::kRateMissing
                     : is_load ? kerf::HalMessage::kLoadMissing
                               : kerf::HalMessage::kUnknownArgument,
                     argument);
      return kerf::kHalExitUsage;
    }
    if (is_load) {
      load_pin = argv[++i];
      continue;
    }
    const std::optional<double> rate = kerf::rate_from(argv[++i]);
    if (!rate) return kerf::kHalExitUsage;
    rate_hz = *rate;
  }
  return kerf::run(rate_hz, load_pin);
}
