#include "interp_bridge/interpreter_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/translate.h"

extern char** environ;

namespace kerf {
namespace {

/// The child writes far ahead of us while the stock is being cut.
constexpr int kPipeBytes = 1 << 20;

struct Pipe {
  int read_end = -1;
  int write_end = -1;

  bool open() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read_end = ends[0];
    write_end = ends[1];
    return true;
  }
  /// A socket: a write to a child that has gone must not raise SIGPIPE in us.
  bool open_socket() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return false;
    read_end = ends[0];
    write_end = ends[1];
    return true;
  }
  void close_read() {
    if (read_end >= 0) ::close(std::exchange(read_end, -1));
  }
  void close_write() {
    if (write_end >= 0) ::close(std::exchange(write_end, -1));
  }
  ~Pipe() {
    close_write();
    if (read_end >= 0) ::close(read_end);
  }
};

std::vector<std::string> child_environment(const std::string& home, const std::string& ini) {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    if (text.substr(0, 5) == "HOME=" || text.substr(0, 14) == "INI_FILE_NAME=") continue;
    environment.emplace_back(text);
  }
  environment.push_back("HOME=" + home);
  if (!ini.empty()) environment.push_back("INI_FILE_NAME=" + ini);
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Between fork and exec: only calls that are safe there. Never returns.
[[noreturn]] void become_child(const InterpreterProcessOptions& options, char* const* arguments,
                               char* const* environment, const Pipe& listing, const Pipe& out,
                               const Pipe& err, const Pipe& failure, const Pipe& answers,
                               pid_t parent) {
  const auto fail = [&] {
    const int error = errno;
    const ssize_t written = write(failure.write_end, &error, sizeof error);
    _exit(written > 0 ? 127 : 126);
  };
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
  // Everything else that this process has open stays here.
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  const int null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (null < 0 || dup2(null, STDIN_FILENO) < 0) fail();
  const int child_stdout = options.listing_is_stdout ? listing.write_end : out.write_end;
  if (dup2(child_stdout, STDOUT_FILENO) < 0 || dup2(err.write_end, STDERR_FILENO) < 0) fail();
  if (dup2(listing.write_end, kListingFd) < 0) fail();
  if (options.answers && dup2(answers.read_end, kAnswerFd) < 0) fail();
  if (chdir(options.folder.c_str()) != 0) fail();
  execve(options.executable.c_str(), arguments, environment);
  fail();
  _exit(127);
}

/// dup2 onto 3 or 4 would close a pipe that sits there already, or leave its close-on-exec flag
/// set.
bool move_above(int& fd, int lowest) {
  if (fd > lowest) return true;
  const int moved = fcntl(fd, F_DUPFD_CLOEXEC, lowest + 1);
  if (moved < 0) return false;
  ::close(std::exchange(fd, moved));
  return true;
}

bool open_pipes(std::initializer_list<Pipe*> pipes) {
  for (Pipe* pipe : pipes) {
    if (!pipe->open() || !move_above(pipe->write_end, kAnswerFd) ||
        !move_above(pipe->read_end, kAnswerFd)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string find_executable(const std::string& name) {
  const auto usable = [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
  };
  std::error_code ignored;
  const auto absolute = [&](const std::string& path) {
    return std::filesystem::absolute(path, ignored).string();
  };
  if (name.empty()) return {};
  if (name.find('/') != name.npos) return usable(name) ? absolute(name) : std::string();
  const char* const path = std::getenv("PATH");
  std::string_view folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
    const std::string candidate = std::string(folder.empty() ? "." : folder) + "/" + name;
    if (usable(candidate)) return absolute(candidate);
  }
  return {};
}

Result<InterpreterProcess> InterpreterProcess::start(const InterpreterProcessOptions& options) {
  const auto error = [&](int number) {
    return Error{trf("cannot start {}: {}", options.executable, std::strerror(number))};
  };
  Pipe listing;
  Pipe out;
  Pipe err;
  Pipe failure;
  Pipe answers;
  if (!open_pipes({&listing, &out, &err, &failure})) return error(errno);
  if (options.answers && (!answers.open_socket() || !move_above(answers.read_end, kAnswerFd) ||
                          !move_above(answers.write_end, kAnswerFd))) {
    return error(errno);
  }
  fcntl(listing.read_end, F_SETPIPE_SZ, kPipeBytes);  // smaller works too

  std::vector<std::string> arguments = {options.executable};
  arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
  std::vector<std::string> environment = child_environment(options.home, options.ini);
  const std::vector<char*> argument_pointers = pointers(arguments);
  const std::vector<char*> environment_pointers = pointers(environment);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) return error(errno);
  if (pid == 0) {
    become_child(options, argument_pointers.data(), environment_pointers.data(), listing, out, err,
                 failure, answers, parent);
  }
  setpgid(pid, pid);  // here too: whichever comes first, the group exists before it can be killed
  for (Pipe* pipe : {&listing, &out, &err, &failure}) pipe->close_write();
  answers.close_read();

  InterpreterProcess process;
  process.pid_ = pid;
  int failed_with = 0;
  ssize_t got = 0;
  do {
    got = read(failure.read_end, &failed_with, sizeof failed_with);
  } while (got < 0 && errno == EINTR);
  if (got == sizeof failed_with) return error(failed_with);
  process.listing_fd_ = std::exchange(listing.read_end, -1);
  process.stdout_fd_ = std::exchange(out.read_end, -1);
  process.stderr_fd_ = std::exchange(err.read_end, -1);
  process.answer_fd_ = std::exchange(answers.write_end, -1);
  return process;
}

InterpreterProcess::InterpreterProcess(InterpreterProcess&& other) noexcept {
  *this = std::move(other);
}

InterpreterProcess& InterpreterProcess::operator=(InterpreterProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(listing_fd_, other.listing_fd_);
  std::swap(stdout_fd_, other.stdout_fd_);
  std::swap(stderr_fd_, other.stderr_fd_);
  std::swap(answer_fd_, other.answer_fd_);
  return *this;
}

InterpreterProcess::~InterpreterProcess() {
  kill();
  wait();
  for (const int fd : {listing_fd_, stdout_fd_, stderr_fd_, answer_fd_}) {
    if (fd >= 0) close(fd);
  }
}

bool InterpreterProcess::answer(const void* bytes, std::size_t count) {
  const ssize_t sent = send(answer_fd_, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(count);
}

void InterpreterProcess::kill() {
  if (pid_ > 0) ::kill(-pid_, SIGKILL);
}

double InterpreterProcess::cpu_s() const {
  clockid_t clock{};
  timespec used{};
  if (pid_ <= 0 || clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &used) != 0) {
    return 0;
  }
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

InterpreterProcess::Exit InterpreterProcess::wait() {
  if (pid_ <= 0) return {};
  int status = 0;
  pid_t got = 0;
  do {
    got = waitpid(pid_, &status, 0);
  } while (got < 0 && errno == EINTR);
  pid_ = -1;
  if (got < 0) return {};
  if (WIFSIGNALED(status)) return {0, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

std::uint64_t InterpreterProcess::read_offset(const std::string& path) const {
  if (pid_ <= 0) return 0;
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path proc = fmt::format("/proc/{}", pid_);
  for (fs::directory_iterator it(proc / "fd", error), end; !error && it != end;
       it.increment(error)) {
    std::error_code ignored;
    if (!fs::equivalent(it->path(), path, ignored)) continue;
    std::ifstream info(proc / "fdinfo" / it->path().filename());
    std::string label;
    std::uint64_t offset = 0;
    if (info >> label >> offset && label == "pos:") return offset;
  }
  return 0;
}

}  // namespace kerf
