#include "twin/cli/stop_signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "base/exit_code.h"

namespace kerf {
namespace {

constexpr char kSignal = 's';
constexpr char kQuit = 'q';

/// The write end of the pipe; -1 = no StopSignals lives. A handler can reach nothing else.
std::atomic<int> g_write_fd{-1};

void on_signal(int) {
  const int saved = errno;
  const int fd = g_write_fd;
  if (fd >= 0) {
    const ssize_t written = write(fd, &kSignal, 1);
    static_cast<void>(written);  // a full pipe has signals enough in it
  }
  errno = saved;
}

}  // namespace

StopSignals::StopSignals(std::stop_source& stop, std::function<void()> abandon) {
  int fds[2] = {-1, -1};
  if (pipe2(fds, O_CLOEXEC) != 0)
    return;  // no descriptors left: the signals keep their default effect
  read_fd_ = fds[0];
  g_write_fd = fds[1];
  thread_ = std::thread([this, stop, abandon = std::move(abandon)] { watch(stop, abandon); });
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

void StopSignals::watch(std::stop_source stop, const std::function<void()>& abandon) {
  int signals = 0;
  char byte = 0;
  while (true) {
    const ssize_t count = read(read_fd_, &byte, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || byte == kQuit) return;
    if (++signals == 1) {
      stop.request_stop();
    } else {
      abandon();
      _exit(kExitFailure);
    }
  }
}

StopSignals::~StopSignals() {
  if (read_fd_ < 0) return;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  const int fd = g_write_fd.exchange(-1);
  const ssize_t written = write(fd, &kQuit, 1);
  static_cast<void>(written);
  close(fd);  // wakes the thread even if the pipe was full
  thread_.join();
  close(read_fd_);
}

}  // namespace kerf
