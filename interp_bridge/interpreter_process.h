// interp_bridge/interpreter_process.h - LinuxCNC's interpreter as a child process: rs274 or
// kerf-interp.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"

namespace kerf {

struct InterpreterProcessOptions {
  std::string executable;              ///< with its path
  std::vector<std::string> arguments;  ///< without the executable's name
  std::string folder;                  ///< working folder
  std::string home;  ///< private: rs274 truncates $HOME/.tool.mmap, which a running LinuxCNC shares
  /// INI_FILE_NAME of the child; empty: it has none, whatever LinuxCNC was started from this shell.
  std::string ini;
  /// The listing is the child's stdout.
  bool listing_is_stdout = false;
  /// The child reads answers from kAnswerFd, which answer() writes.
  bool answers = false;
};

/// Where the child finds the listing's pipe open: a file descriptor, and its name.
inline constexpr int kListingFd = 3;
inline constexpr const char* kListingPath = "/dev/fd/3";

/// Where a child that asks finds its answers.
inline constexpr int kAnswerFd = 4;

/// The full path of `name` as PATH gives it (or `name` itself if it holds a slash); empty if it
/// cannot be executed.
std::string find_executable(const std::string& name);

/// A running interpreter. Its listing comes through a pipe of its own (kListingFd), so that nothing
/// foreign is mixed in. It runs in its own process group; the destructor kills that group and
/// waits. The child also dies if this process does, or the thread that started it. No thread is
/// started.
class InterpreterProcess {
 public:
  /// Error: "cannot start /usr/bin/rs274: Permission denied".
  static Result<InterpreterProcess> start(const InterpreterProcessOptions& options);
  InterpreterProcess(InterpreterProcess&& other) noexcept;
  InterpreterProcess& operator=(InterpreterProcess&& other) noexcept;
  ~InterpreterProcess();

  /// Read ends, to be polled; closed by the destructor.
  int listing_fd() const { return listing_fd_; }
  int stdout_fd() const { return stdout_fd_; }
  int stderr_fd() const { return stderr_fd_; }

  /// False: the child does not take it any more. Does not wait: answers are few and short.
  bool answer(const void* bytes, std::size_t count);

  struct Exit {
    int status = 0;  ///< exit status, if signal is 0
    int signal = 0;
  };
  /// Waits for the end. Call when all pipes are at their end, or after kill().
  Exit wait();
  void kill();
  /// Processor time that it has used, s; 0 when it is gone.
  double cpu_s() const;

  /// How many bytes of the file `name` the child has read, in blocks: what is known of a program
  /// that prints nothing. 0 if it cannot be told.
  std::uint64_t read_offset(const std::string& path) const;

 private:
  InterpreterProcess() = default;
  pid_t pid_ = -1;
  int listing_fd_ = -1;
  int stdout_fd_ = -1;
  int stderr_fd_ = -1;
  int answer_fd_ = -1;
};

}  // namespace kerf
