// tests/machine_io/simulator/machine_process.h - the executable kerf-machine, started by a test.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace kerf {

class MachineProcess {
 public:
  explicit MachineProcess(const std::vector<std::string>& arguments);
  /// Kills it if it still runs.
  ~MachineProcess();
  MachineProcess(const MachineProcess&) = delete;
  MachineProcess& operator=(const MachineProcess&) = delete;

  /// The next line of its standard output that begins with `head`, without it and a blank; lines
  /// before are passed over. Empty after a minute, or if the output ends before.
  std::string wait_line(const std::string& head);
  void send(int signal) const;
  /// Waits for the end: the exit code, 128 + signal if it was killed.
  int finish();
  /// After finish(): all of it.
  const std::string& out() const { return out_; }
  const std::string& err() const { return err_; }

 private:
  bool read_out();

  pid_t pid_ = -1;
  int out_fd_ = -1;
  int err_fd_ = -1;
  std::string out_;
  std::string err_;
  std::size_t looked_ = 0;
};

}  // namespace kerf
