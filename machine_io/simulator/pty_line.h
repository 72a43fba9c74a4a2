// machine_io/simulator/pty_line.h - a serial line that ends in this process: a pseudo terminal.
#pragma once

#include <string>

#include "base/result.h"

namespace kerf {

/// The machine's end of the line (fd()) and the name of the other end, which a client opens as its
/// serial device. Raw: no echo, no translation; a client that closes and opens again is no event.
/// A pty has no line speed.
class PtyLine {
 public:
  /// `link`: a symbolic link to the device that is made, or one that was there is led anew; empty:
  /// none. Error: no pty is to be had, or `link` cannot be made ("/tmp/ttyM exists and is no
  /// symbolic link").
  static Result<PtyLine> open(const std::string& link);
  PtyLine(PtyLine&& other) noexcept;
  PtyLine& operator=(PtyLine&& other) noexcept;
  /// The device goes: a client that has it open reads EIO. The link is removed if it is still ours.
  ~PtyLine();

  int fd() const { return master_fd_; }
  const std::string& device() const { return device_; }  ///< "/dev/pts/5"

 private:
  PtyLine() = default;
  void release();

  int master_fd_ = -1;
  int slave_fd_ = -1;  ///< held open: else reading the other end fails while no client is there
  std::string device_;
  std::string link_;
};

}  // namespace kerf
