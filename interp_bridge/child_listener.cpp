#include "interp_bridge/child_listener.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include "interp_bridge/program_kinds.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

/// An interpreter's last words; the lines before are of no use.
constexpr std::size_t kMaxStderrBytes = 64 * 1024;
constexpr std::size_t kMaxStdoutLineBytes = 4096;
/// Of max_silent_s, in processor time: what is said again and again takes the reader as long as the
/// child.
constexpr double kRepeatShare = 0.5;

}  // namespace

ChildListener::ChildListener(InterpreterProcess& process, ByteReader& reader, MotionFeeder& feeder,
                             const ProgramOptions& limits)
    : reader_(reader),
      feeder_(feeder),
      process_(process),
      max_silent_s_(limits.max_silent_s),
      max_cpu_s_(limits.max_cpu_s),
      buffer_(64 * 1024) {
  fds_[kListing] = {process.listing_fd(), POLLIN, 0};
  fds_[kStdout] = {process.stdout_fd(), POLLIN, 0};
  fds_[kStderr] = {process.stderr_fd(), POLLIN, 0};
}

/// 0: nothing came. At the end of a pipe it is taken out of the poll.
std::size_t ChildListener::read_some(std::size_t index, std::span<char> room) {
  const ssize_t got = read(fds_[index].fd, room.data(), room.size());
  if (got > 0) return static_cast<std::size_t>(got);
  if (got == 0 || (errno != EINTR && errno != EAGAIN)) fds_[index].fd = -1;
  return 0;
}

void ChildListener::take_stdout(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t room = kMaxStdoutLineBytes - stdout_line_.size();
    stdout_line_ += line.substr(0, room);
    if (line.size() == text.size()) return;
    feeder_.add_foreign(stdout_line_);
    stdout_line_.clear();
    text.remove_prefix(line.size() + 1);
  }
}

void ChildListener::take_stderr(std::string_view text) {
  stderr_text_ += text;
  if (stderr_text_.size() > 2 * kMaxStderrBytes) {
    stderr_text_.erase(0, stderr_text_.size() - kMaxStderrBytes);
  }
}

/// By its processor time: that it waits for whoever cuts is no fault of its own.
std::optional<ChildEnding> ChildListener::look_for_endlessness() {
  const double cpu_s = process_.cpu_s();
  if (max_cpu_s_ > 0 && cpu_s > max_cpu_s_) return ChildEnding::kTooLong;
  const RepeatWatch& repeats = feeder_.repeats();
  if (repeats.news() != news_) {
    news_ = repeats.news();
    cpu_at_news_s_ = cpu_s;
    return std::nullopt;
  }
  const bool for_long = cpu_s - cpu_at_news_s_ > kRepeatShare * max_silent_s_;
  if (for_long && repeats.seems_endless()) return ChildEnding::kRepeating;
  return std::nullopt;
}

ChildEnding ChildListener::listen(const std::stop_token& stop,
                                  const std::function<void()>& on_progress) {
  auto heard = Clock::now();
  std::uint64_t commands = 0;
  const auto is_open = [](const pollfd& pipe) { return pipe.fd >= 0; };
  while (std::any_of(fds_.begin(), fds_.end(), is_open)) {
    if (stop.stop_requested()) return ChildEnding::kStopped;
    for (pollfd& pipe : fds_) pipe.revents = 0;
    poll(fds_.data(), fds_.size(), kReaderPatience_ms);
    if (readable(kListing)) {
      const std::size_t got = read_some(kListing, reader_.room());
      if (got > 0 && !reader_.received(got)) {
        return feeder_.too_many_commands() ? ChildEnding::kTooMany : ChildEnding::kStopped;
      }
      on_progress();
      if (const auto endless = look_for_endlessness()) return *endless;
    } else if (!feeder_.flush_if_old()) {
      return ChildEnding::kStopped;
    }
    // Looked at after the sink: the time it takes is not the child's.
    const auto now = Clock::now();
    if (feeder_.commands() != commands) {
      commands = feeder_.commands();
      heard = now;
    } else if (std::chrono::duration<double>(now - heard).count() > max_silent_s_) {
      return ChildEnding::kSilent;
    }
    if (readable(kStdout)) take_stdout({buffer_.data(), read_some(kStdout, buffer_)});
    if (readable(kStderr)) take_stderr({buffer_.data(), read_some(kStderr, buffer_)});
  }
  if (!stdout_line_.empty()) feeder_.add_foreign(stdout_line_);
  return ChildEnding::kComplete;
}

}  // namespace kerf
