// machine_io/hal/hal_child.h - kerf-hal as a child process with its three pipes.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.h"
#include "machine_io/hal/hal_stream.h"

namespace kerf {

/// A running kerf-hal. Nothing foreign is inherited by it but the environment; no signal is blocked
/// or ignored in it. It ends by itself when this process does (its stdout closes).
class HalChild {
 public:
  /// Error: "cannot start /usr/bin/kerf-hal: Permission denied".
  static Result<HalChild> start(const std::string& executable,
                                const std::vector<std::string>& arguments);
  HalChild(HalChild&& other) noexcept;
  HalChild& operator=(HalChild&& other) noexcept;
  ~HalChild();

  /// Read ends, to be polled; non-blocking.
  int records_fd() const { return records_fd_; }
  int messages_fd() const { return messages_fd_; }

  /// Without blocking and without SIGPIPE; a status that does not fit is dropped, for a newer one
  /// will follow.
  void send(const HalStatusRecord& status) const;

  struct Exit {
    int status = 0;  ///< exit status, if signal is 0
    int signal = 0;
  };
  /// Asks it to end, and waits: it must leave HAL by itself, or its pins stay until LinuxCNC
  /// restarts. Killed after kPatience_ms. If it has ended already: how.
  Exit end();

  static constexpr int kPatience_ms = 2000;

 private:
  HalChild() = default;
  void close_all();

  pid_t pid_ = -1;
  int status_fd_ = -1;
  int records_fd_ = -1;
  int messages_fd_ = -1;
};

}  // namespace kerf
