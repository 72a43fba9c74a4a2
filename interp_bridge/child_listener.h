// interp_bridge/child_listener.h - the pipes of an interpreter process, read by turns.
#pragma once

#include <poll.h>

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/motion_feeder.h"

namespace kerf {

/// Takes a stream apart: a listing's text, or records.
class ByteReader {
 public:
  virtual ~ByteReader() = default;
  /// Where to put the next bytes; never empty.
  virtual std::span<char> room() = 0;
  /// Takes `bytes` of room(). False: no more are wanted.
  virtual bool received(std::size_t bytes) = 0;
};

/// How listening ended.
enum class ChildEnding {
  kComplete,  ///< all pipes are at their end
  kStopped,   ///< by the stop token, or the reader wants no more
  kTooMany,   ///< canonical commands
  kSilent,    ///< no canonical command for too long
};

/// The three pipes of the child in one thread, so that none of them can fill up and stop it. What
/// it prints on stdout is foreign text; the end of what it prints on stderr is kept.
class ChildListener {
 public:
  ChildListener(InterpreterProcess& process, ByteReader& reader, MotionFeeder& feeder,
                double max_silent_s);

  /// `on_progress` is called after every piece of the listing.
  ChildEnding listen(const std::stop_token& stop, const std::function<void()>& on_progress);
  const std::string& stderr_text() const { return stderr_text_; }

 private:
  enum : std::size_t { kListing, kStdout, kStderr };

  bool readable(std::size_t index) const { return fds_[index].fd >= 0 && fds_[index].revents != 0; }
  std::size_t read_some(std::size_t index, std::span<char> room);
  void take_stdout(std::string_view text);
  void take_stderr(std::string_view text);

  ByteReader& reader_;
  MotionFeeder& feeder_;
  double max_silent_s_;
  std::array<pollfd, 3> fds_{};
  std::vector<char> buffer_;
  std::string stdout_line_;
  std::string stderr_text_;
};

}  // namespace kerf
