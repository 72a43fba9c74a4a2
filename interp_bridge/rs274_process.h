// interp_bridge/rs274_process.h - LinuxCNC's stand-alone interpreter as a child process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "base/result.h"

namespace kerf {

struct Rs274Options {
  std::string executable;  ///< with its path
  std::string program;     ///< file name in `folder`
  std::string folder;      ///< working folder: programs and subroutines
  std::string home;  ///< private: rs274 truncates $HOME/.tool.mmap, which a running LinuxCNC shares
  std::string tool_table;  ///< path
  bool block_delete = true;
  /// Every command at once instead of 4 KB at a time, which takes twice the time; the foreign lines
  /// of stdout then stand in the listing.
  bool unbuffered = false;
};

/// The full path of `name` as PATH gives it (or `name` itself if it holds a slash); empty if it
/// cannot be executed.
std::string find_executable(const std::string& name);

/// A running rs274. Its listing comes through a pipe that is passed as the output file, so that
/// rs274 buffers it (its stdout is not buffered: twice the time) and nothing foreign is mixed in.
/// It runs in its own process group; the destructor kills that group and waits. The child also dies
/// if this process does, or the thread that started it. No thread is started.
class Rs274Process {
 public:
  /// Error: "cannot start /usr/bin/rs274: Permission denied".
  static Result<Rs274Process> start(const Rs274Options& options);
  Rs274Process(Rs274Process&& other) noexcept;
  Rs274Process& operator=(Rs274Process&& other) noexcept;
  ~Rs274Process();

  /// Read ends, to be polled; closed by the destructor.
  int listing_fd() const { return listing_fd_; }
  int stdout_fd() const { return stdout_fd_; }
  int stderr_fd() const { return stderr_fd_; }

  struct Exit {
    int status = 0;  ///< exit status, if signal is 0
    int signal = 0;
  };
  /// Waits for the end. Call when all pipes are at their end, or after kill().
  Exit wait();
  void kill();

  /// How many bytes of the file `name` the child has read, in blocks: what is known of a program
  /// that prints nothing. 0 if it cannot be told.
  std::uint64_t read_offset(const std::string& path) const;

 private:
  Rs274Process() = default;
  pid_t pid_ = -1;
  int listing_fd_ = -1;
  int stdout_fd_ = -1;
  int stderr_fd_ = -1;
};

}  // namespace kerf
