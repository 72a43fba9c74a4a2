#include "tests/machine_io/simulator/machine_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>

namespace kerf {
namespace {

constexpr int kPatience_ms = 60'000;

bool read_some(int fd, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t got = read(fd, buffer.data(), buffer.size());
  if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
  return got > 0;
}

}  // namespace

MachineProcess::MachineProcess(const std::vector<std::string>& arguments) {
  std::array<int, 2> out{-1, -1};
  if (pipe2(out.data(), O_CLOEXEC) != 0) ADD_FAILURE() << "no pipe";
  err_fd_ = memfd_create("stderr", MFD_CLOEXEC);  // a pipe that nobody reads could fill up
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), KERF_MACHINE_EXECUTABLE);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err_fd_, STDERR_FILENO);
    // Whatever started the tests (a background job, nohup) may ignore these.
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(number, SIG_DFL);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(out[1]);
  out_fd_ = out[0];
}

MachineProcess::~MachineProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(out_fd_);
  close(err_fd_);
}

bool MachineProcess::read_out() {
  pollfd ready{out_fd_, POLLIN, 0};
  return poll(&ready, 1, kPatience_ms) > 0 && read_some(out_fd_, out_);
}

std::string MachineProcess::wait_line(const std::string& head) {
  while (true) {
    const std::size_t end = out_.find('\n', looked_);
    if (end == out_.npos) {
      if (!read_out()) return "";
      continue;
    }
    const std::string line = out_.substr(looked_, end - looked_);
    looked_ = end + 1;
    if (line.starts_with(head + " ")) return line.substr(head.size() + 1);
    if (line == head) return line;
  }
}

void MachineProcess::send(int signal) const { kill(pid_, signal); }

int MachineProcess::finish() {
  while (read_out()) {
  }
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  lseek(err_fd_, 0, SEEK_SET);
  while (read_some(err_fd_, err_)) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace kerf
