#include "twin/batch/bounded_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kExecFailed = 127;

void limit(decltype(RLIMIT_DATA) resource, double mb) {
  if (mb <= 0) return;
  const auto bytes = static_cast<rlim_t>(mb * 1024 * 1024);
  const rlimit both{bytes, bytes};
  setrlimit(resource, &both);
}

/// Between fork() and exec(): nothing here allocates.
[[noreturn]] void become(char* const* arguments, int said_fd, const ProcessBounds& bounds,
                         pid_t parent, const sigset_t& mask) {
  // What this process ignores, the new one would ignore, too; and its handlers are not for a child.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) signal(number, SIG_DFL);
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kExecFailed);
  limit(RLIMIT_DATA, bounds.memory_mb);
  limit(RLIMIT_FSIZE, bounds.file_mb);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int none = open("/dev/null", O_RDONLY);
  if (none < 0 || dup2(none, STDIN_FILENO) < 0 || dup2(said_fd, STDOUT_FILENO) < 0 ||
      dup2(said_fd, STDERR_FILENO) < 0) {
    _exit(kExecFailed);
  }
  execv("/proc/self/exe", arguments);
  _exit(kExecFailed);
}

Error refused(const std::string& what) { return Error{trf("{}: {}", what, std::strerror(errno))}; }

}  // namespace

Result<BoundedProcess> BoundedProcess::start(const std::vector<std::string>& words,
                                             const std::string& said_path,
                                             const ProcessBounds& bounds) {
  const int said_fd = open(said_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (said_fd < 0) return refused(said_path);
  std::vector<std::string> texts{"kerf"};
  texts.insert(texts.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& text : texts) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  BoundedProcess process;
  process.begun_ = Clock::now();
  const pid_t parent = getpid();
  // Until the child has no handlers any more: what they write would reach this process.
  sigset_t all, mask;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &mask);
  process.pid_ = fork();
  if (process.pid_ == 0) become(arguments.data(), said_fd, bounds, parent, mask);
  const int error = errno;
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
  close(said_fd);
  errno = error;
  if (process.pid_ < 0) return refused("fork");
  setpgid(process.pid_, process.pid_);  // whoever comes first: it must be before kill()
  // The header of Debian 12's C library that has it is none for C++.
  process.ended_fd_ = static_cast<int>(syscall(SYS_pidfd_open, process.pid_, 0));
  if (process.ended_fd_ < 0) return refused("pidfd_open");
  if (bounds.seconds > 0) {
    process.deadline_ =
        process.begun_ + std::chrono::milliseconds(std::llround(bounds.seconds * 1000));
  }
  return process;
}

BoundedProcess::BoundedProcess(BoundedProcess&& other) noexcept { *this = std::move(other); }

BoundedProcess& BoundedProcess::operator=(BoundedProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(ended_fd_, other.ended_fd_);
  asked_ = other.asked_;
  end_ = other.end_;
  begun_ = other.begun_;
  deadline_ = other.deadline_;
  return *this;
}

BoundedProcess::~BoundedProcess() {
  if (pid_ > 0) {
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (ended_fd_ >= 0) close(ended_fd_);
}

void BoundedProcess::ask_to_end(Clock::time_point now) {
  if (!std::exchange(asked_, true)) {
    kill(pid_, SIGTERM);
    deadline_ = now + (end_.stopped ? kStopGrace : kGrace);
  } else {
    kill(-pid_, SIGKILL);
    deadline_ = Clock::time_point::max();
  }
}

void BoundedProcess::stop() {
  if (pid_ <= 0 || asked_) return;
  end_.stopped = true;
  ask_to_end(Clock::now());
}

std::optional<ProcessEnd> BoundedProcess::look(Clock::time_point now) {
  int status = 0;
  rusage usage{};
  const pid_t ended = wait4(pid_, &status, WNOHANG, &usage);
  if (ended == pid_) {
    kill(-pid_, SIGKILL);  // an interpreter that is left
    pid_ = -1;
    end_.wall_s = std::chrono::duration<double>(Clock::now() - begun_).count();
    end_.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024;
    end_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    return end_;
  }
  if (now >= deadline_) {
    if (!end_.stopped) end_.out_of_time = true;
    ask_to_end(now);
  }
  return std::nullopt;
}

}  // namespace kerf
