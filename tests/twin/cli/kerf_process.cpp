#include "tests/twin/cli/kerf_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace kerf {

TestFolder::TestFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "kerf-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no folder for the test";
  path_ = name;
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TestFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(file(name), std::ios::binary) << text;
  return file(name);
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

bool file_exists(const std::string& path) { return std::filesystem::exists(path); }

std::string listing(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : " ") + name;
  return out;
}

namespace {

/// In the child: becomes kerf.
[[noreturn]] void become_kerf(const KerfCall& call, int input, const std::string& out,
                              const std::string& err) {
  dup2(input, STDIN_FILENO);
  dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
  if (!call.folder.empty() && chdir(call.folder.c_str()) != 0) _exit(126);
  // No window comes up on the desktop of whoever runs the tests.
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  for (const auto& [name, value] : call.environment) setenv(name.c_str(), value.c_str(), 1);
  if (call.file_size_limit >= 0) {
    const rlimit limit{static_cast<rlim_t>(call.file_size_limit),
                       static_cast<rlim_t>(call.file_size_limit)};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  // Whatever started the tests (a background job, nohup) may ignore these.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(number, SIG_DFL);
  std::vector<std::string> words = call.arguments;
  words.insert(words.begin(), KERF_EXECUTABLE);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(KERF_EXECUTABLE, argv.data());
  _exit(127);
}

}  // namespace

RunningKerf::RunningKerf(const KerfCall& call) {
  std::signal(SIGPIPE, SIG_IGN);
  int fds[2] = {-1, -1};
  if (pipe2(fds, O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
  pid_ = fork();
  if (pid_ == 0) become_kerf(call, fds[0], scratch_.file("out"), scratch_.file("err"));
  close(fds[0]);
  input_fd_ = fds[1];
}

RunningKerf::~RunningKerf() {
  if (input_fd_ >= 0) close(input_fd_);
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void RunningKerf::write_input(const std::string& text) const {
  std::size_t at = 0;
  while (at < text.size()) {
    const ssize_t count = write(input_fd_, text.data() + at, text.size() - at);
    if (count <= 0) return;
    at += static_cast<std::size_t>(count);
  }
}

bool RunningKerf::has_read_its_input() const {
  int left = 0;
  return ioctl(input_fd_, FIONREAD, &left) == 0 && left == 0;
}

bool RunningKerf::catches_interrupts() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  std::string line;
  while (std::getline(status, line)) {
    // One that crashed, until somebody asks for its end, has its handlers still.
    if (line.rfind("State:\tZ", 0) == 0) return false;
    if (line.rfind("SigCgt:", 0) == 0) {
      return ((std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1)) & 1U) != 0;
    }
  }
  return false;
}

bool RunningKerf::wait_until(const std::function<bool()>& ready) const {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < limit) {
    if (has_read_its_input() && catches_interrupts() && ready()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

void RunningKerf::send(int signal) const { kill(pid_, signal); }

double RunningKerf::cpu_s() const {
  clockid_t clock{};
  timespec spent{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &spent) != 0) return 0;
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

void RunningKerf::wait_for_end() const {
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT);
}

std::string RunningKerf::err() const { return read_file(scratch_.file("err")); }

KerfResult RunningKerf::finish() {
  KerfResult result;
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  close(input_fd_);
  input_fd_ = -1;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_file(scratch_.file("out"));
  result.err = err();
  return result;
}

KerfResult run_kerf(const KerfCall& call) {
  RunningKerf running(call);
  running.write_input(call.input);
  close(running.input_fd_);
  running.input_fd_ = -1;
  return running.finish();
}

}  // namespace kerf
