// tests/machine_io/mtconnect/agent_process.h - the agent of agent.py, as a process.
#pragma once

#include <sys/types.h>

#include <string>

namespace kerf {

class AgentProcess {
 public:
  AgentProcess();
  ~AgentProcess();
  AgentProcess(const AgentProcess&) = delete;
  AgentProcess& operator=(const AgentProcess&) = delete;

  /// False: there is no Python.
  bool is_there() const { return port_ > 0; }
  std::string url() const;
  /// When X was 0, s since 1970.
  double begun_s() const { return begun_s_; }
  /// A line of agent.py; returns when it is obeyed.
  void tell(const std::string& line);
  /// As kill -9 would.
  void kill();

 private:
  std::string line();

  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;
  int port_ = 0;
  double begun_s_ = 0;
};

}  // namespace kerf
