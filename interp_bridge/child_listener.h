// interp_bridge/child_listener.h - the pipes of an interpreter process, read by turns.
#pragma once

#include <poll.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
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
  kComplete,   ///< all pipes are at their end
  kStopped,    ///< by the stop token, or the reader wants no more
  kTooMany,    ///< canonical commands
  kSilent,     ///< no canonical command for too long
  kRepeating,  ///< none but those that it has given before, and no end of them in sight
  kTooLong,    ///< its processor time is used up
};

/// The three pipes of the child in one thread, so that none of them can fill up and stop it. What
/// it prints on stdout is foreign text; the end of what it prints on stderr is kept.
class ChildListener {
 public:
  ChildListener(InterpreterProcess& process, ByteReader& reader, MotionFeeder& feeder,
                const ProgramOptions& limits);

  /// `on_progress` is called after every piece of the listing.
  ChildEnding listen(const std::stop_token& stop, const std::function<void()>& on_progress);
  const std::string& stderr_text() const { return stderr_text_; }

 private:
  enum : std::size_t { kListing, kStdout, kStderr };

  std::optional<ChildEnding> look_for_endlessness();
  bool readable(std::size_t index) const { return fds_[index].fd >= 0 && fds_[index].revents != 0; }
  std::size_t read_some(std::size_t index, std::span<char> room);
  void take_stdout(std::string_view text);
  void take_stderr(std::string_view text);

  ByteReader& reader_;
  MotionFeeder& feeder_;
  InterpreterProcess& process_;
  double max_silent_s_;
  double max_cpu_s_;
  double cpu_at_news_s_ = 0;  ///< the child's, when its commands were last new
  std::uint64_t news_ = 0;
  std::array<pollfd, 3> fds_{};
  std::vector<char> buffer_;
  std::string stdout_line_;
  std::string stderr_text_;
};

}  // namespace kerf
