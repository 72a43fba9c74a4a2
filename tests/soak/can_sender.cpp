// soak_can_sender INTERFACE SETS_PER_SECOND SECONDS: sets of the eight frames of kerf-machine (CiA
// 402 layout), X A B C up by 0.001 with each set, so that a reader can tell that it has them all.
// kerf-machine skips updates that it is too late for; this one sends them late, so that the rate is
// held where the computer stalls now and then. A stall of more than half a second is left out: no
// bus would have the frames of seconds ready at once. Prints how many frames the interface took.
#include "machine_io/simulator/can_sender.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

/// Between two looks at the clock. What is due by then goes out together.
constexpr std::chrono::milliseconds kPause{2};
/// Between two looks at the clock: more than that, and all of this computer stood still.
constexpr std::chrono::milliseconds kStall{500};
/// Sets that one call may take.
constexpr std::int64_t kBurst = 64;

/// The time since it was made, less that of stalls.
class RunningTime {
 public:
  double seconds() {
    const auto now = Clock::now();
    if (now - seen_ > kStall) stalled_ += now - seen_;
    seen_ = now;
    return std::chrono::duration<double>(now - begin_ - stalled_).count();
  }
  double stalled_s() const { return std::chrono::duration<double>(stalled_).count(); }

 private:
  Clock::time_point begin_ = Clock::now();
  Clock::time_point seen_ = begin_;
  Clock::duration stalled_{};
};

class Bus {
 public:
  explicit Bus(const char* interface) : fd_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address = {};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    const void* const raw = &address;
    is_open_ = address.can_ifindex > 0 &&
               setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) == 0 &&
               bind(fd_, static_cast<const sockaddr*>(raw), sizeof address) == 0;
  }
  ~Bus() { close(fd_); }
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  bool is_open() const { return is_open_; }

  void add(const SentCanFrame& sent) {
    can_frame& frame = frames_.emplace_back();
    frame.can_id = sent.id;
    frame.can_dlc = static_cast<std::uint8_t>(sent.size);
    std::copy(sent.data.begin(), sent.data.end(), std::begin(frame.data));
  }
  /// All that was added. Waits while the interface's queue is full; false if it is no more.
  bool flush() {
    vectors_.clear();
    headers_.clear();
    for (can_frame& frame : frames_) vectors_.push_back({&frame, sizeof frame});
    for (iovec& vector : vectors_) {
      headers_.push_back({});
      headers_.back().msg_hdr.msg_iov = &vector;
      headers_.back().msg_hdr.msg_iovlen = 1;
    }
    for (std::size_t done = 0; done < headers_.size();) {
      const int sent =
          sendmmsg(fd_, &headers_[done], static_cast<unsigned>(headers_.size() - done), 0);
      if (sent < 0 && errno != ENOBUFS && errno != EINTR) return false;
      if (sent < 0) {
        std::this_thread::sleep_for(kPause);
      } else {
        done += static_cast<std::size_t>(sent);
        sent_ += static_cast<std::uint64_t>(sent);
      }
    }
    frames_.clear();
    return true;
  }
  std::uint64_t sent() const { return sent_; }

 private:
  int fd_;
  bool is_open_ = false;
  std::vector<can_frame> frames_;
  std::vector<iovec> vectors_;
  std::vector<mmsghdr> headers_;
  std::uint64_t sent_ = 0;
};

int send(const char* interface, double sets_per_s, double seconds) {
  Bus bus(interface);
  if (!bus.is_open()) {
    fmt::print(stderr, "soak_can_sender: {}: {}\n", interface, std::strerror(errno));
    return 1;
  }
  CanEncoder encoder(CanLayout::kCia402);
  std::array<SentCanFrame, CanEncoder::kMaxFrames> frames;
  ServedState served;
  served.state.tool = 1;
  served.state.spindle_rpm = 8000;
  const auto total = static_cast<std::int64_t>(sets_per_s * seconds);
  RunningTime time;
  std::int64_t sets = 0;
  while (sets < total) {
    const auto due = static_cast<std::int64_t>(time.seconds() * sets_per_s);
    const std::int64_t until = std::min({due, total, sets + kBurst});
    for (; sets < until; ++sets) {
      const double count = static_cast<double>(sets + 1) * 0.001;
      served.state.position = {count, 0, -1, count, count, count};
      ++served.state.scan;
      const std::size_t size = encoder.encode(served, 0, frames);
      for (std::size_t i = 0; i < size; ++i) bus.add(frames[i]);
    }
    if (!bus.flush()) {
      fmt::print(stderr, "soak_can_sender: {}: {}\n", interface, std::strerror(errno));
      return 1;
    }
    if (sets == due) std::this_thread::sleep_for(kPause);
  }
  const double took_s = time.seconds();
  fmt::print("{} frames in {:.3f} s and {:.3f} s of stalls\n", bus.sent(), took_s,
             time.stalled_s());
  return 0;
}

}  // namespace
}  // namespace kerf

int main(int argc, char** argv) {
  const double sets_per_s = argc == 4 ? std::atof(argv[2]) : 0;
  const double seconds = argc == 4 ? std::atof(argv[3]) : 0;
  if (!(sets_per_s > 0 && seconds > 0)) {
    fmt::print(stderr, "usage: soak_can_sender INTERFACE SETS_PER_SECOND SECONDS\n");
    return 2;
  }
  return kerf::send(argv[1], sets_per_s, seconds);
}
