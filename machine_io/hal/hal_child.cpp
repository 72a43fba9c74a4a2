#include "machine_io/hal/hal_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

void close_fd(int& fd) {
  if (fd >= 0) close(fd);
  fd = -1;
}

/// Both ends of what connects parent and child.
struct Ends {
  int ours = -1;
  int theirs = -1;
  ~Ends() {
    close_fd(ours);
    close_fd(theirs);
  }
};

bool open_pipe(Ends& ends) {
  std::array<int, 2> fds{};
  if (pipe2(fds.data(), O_CLOEXEC) != 0) return false;
  ends.ours = fds[0];
  ends.theirs = fds[1];
  return fcntl(ends.ours, F_SETFL, O_NONBLOCK) == 0;
}

/// A socket and not a pipe: a send to a child that has gone must not raise SIGPIPE in us.
bool open_socket(Ends& ends) {
  std::array<int, 2> fds{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, fds.data()) != 0) return false;
  ends.ours = fds[0];
  ends.theirs = fds[1];
  return true;
}

/// Directly: the header of glibc 2.36 gives pidfd_open C++ linkage.
int open_pidfd(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }

int spawn(pid_t& pid, const std::string& executable, const std::vector<std::string>& arguments,
          const std::array<int, 3>& streams) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int fd = 0; fd < 3; ++fd) {
    posix_spawn_file_actions_adddup2(&actions, streams[static_cast<std::size_t>(fd)], fd);
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<std::string> words{executable};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int error =
      posix_spawn(&pid, executable.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

}  // namespace

Result<HalChild> HalChild::start(const std::string& executable,
                                 const std::vector<std::string>& arguments) {
  Ends status;
  Ends records;
  Ends messages;
  if (!open_socket(status) || !open_pipe(records) || !open_pipe(messages)) {
    return Error{trf("cannot open a pipe to {}: {}", executable, std::strerror(errno))};
  }
  HalChild child;
  const int error =
      spawn(child.pid_, executable, arguments, {status.theirs, records.theirs, messages.theirs});
  if (error != 0) {
    child.pid_ = -1;
    return Error{trf("cannot start {}: {}", executable, std::strerror(error))};
  }
  child.status_fd_ = std::exchange(status.ours, -1);
  child.records_fd_ = std::exchange(records.ours, -1);
  child.messages_fd_ = std::exchange(messages.ours, -1);
  return child;
}

HalChild::HalChild(HalChild&& other) noexcept { *this = std::move(other); }

HalChild& HalChild::operator=(HalChild&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(status_fd_, other.status_fd_);
  std::swap(records_fd_, other.records_fd_);
  std::swap(messages_fd_, other.messages_fd_);
  return *this;
}

HalChild::~HalChild() {
  end();
  close_all();
}

void HalChild::close_all() {
  close_fd(status_fd_);
  close_fd(records_fd_);
  close_fd(messages_fd_);
}

void HalChild::send(const HalStatusRecord& status) const {
  [[maybe_unused]] const ssize_t sent =
      ::send(status_fd_, &status, sizeof(status), MSG_DONTWAIT | MSG_NOSIGNAL);
}

HalChild::Exit HalChild::end() {
  Exit exit;
  if (pid_ < 0) return exit;
  // One that has ended is not touched by the signal, and its number is ours until the wait.
  kill(pid_, SIGTERM);
  pollfd ended{open_pidfd(pid_), POLLIN, 0};
  while (poll(&ended, 1, kPatience_ms) < 0 && errno == EINTR) {
  }
  if ((ended.revents & POLLIN) == 0) kill(pid_, SIGKILL);
  close_fd(ended.fd);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (WIFSIGNALED(status)) exit.signal = WTERMSIG(status);
  if (WIFEXITED(status)) exit.status = WEXITSTATUS(status);
  return exit;
}

}  // namespace kerf
