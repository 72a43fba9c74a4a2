#include "tests/machine_io/mtconnect/agent_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace kerf {

AgentProcess::AgentProcess() {
  constexpr const char* kPython = "/usr/bin/python3";
  if (access(kPython, X_OK) != 0) return;
  int in[2], out[2];
  if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) return;
  std::string python = kPython, script = KERF_MTCONNECT_AGENT;
  char* arguments[] = {python.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  if (posix_spawn(&pid_, kPython, &actions, nullptr, arguments, environ) != 0) pid_ = -1;
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  in_ = in[1];
  out_ = out[0];
  const std::string hello = line();
  EXPECT_EQ(std::sscanf(hello.c_str(), "port %d %lf", &port_, &begun_s_), 2) << hello;
}

AgentProcess::~AgentProcess() {
  kill();
  close(in_);
  close(out_);
}

void AgentProcess::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::string AgentProcess::url() const { return fmt::format("http://127.0.0.1:{}", port_); }

std::string AgentProcess::line() {
  std::string text;
  for (;;) {
    pollfd asked{out_, POLLIN, 0};
    char c = 0;
    if (poll(&asked, 1, 30000) <= 0 || read(out_, &c, 1) != 1) return text;
    if (c == '\n') return text;
    text += c;
  }
}

void AgentProcess::tell(const std::string& command) {
  const std::string text = command + "\n";
  ASSERT_EQ(write(in_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ASSERT_EQ(line(), "ok");
}

}  // namespace kerf
