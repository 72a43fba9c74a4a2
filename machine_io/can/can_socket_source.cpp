#include "machine_io/can/can_socket_source.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kBatch = 64;  // frames per system call
constexpr int kLeastBuffer = 4096;
constexpr int kLargestBuffer = 256 * 1024 * 1024;
constexpr int kLongestRetry_ms = 600'000;
constexpr std::size_t kLongestInterface = IFNAMSIZ - 1;

std::int64_t host_now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// A whole number of milliseconds that does not end before `until`.
int poll_timeout_ms(Clock::time_point until) {
  const auto left = std::chrono::ceil<milliseconds>(until - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

/// What the controller reports, the gravest first.
std::string error_frame_text(const can_frame& frame, const std::string& interface) {
  const canid_t id = frame.can_id;
  if ((id & CAN_ERR_BUSOFF) != 0) {
    return trf(
        "bus-off: the controller has left the bus after too many errors (wrong bit rate, wiring, "
        "termination?); 'ip link set {} type can restart-ms 100' lets it come back",
        interface);
  }
  if ((id & CAN_ERR_RESTARTED) != 0) return tr("the controller was restarted");
  if ((id & CAN_ERR_CRTL) != 0) {
    const unsigned what = frame.data[1];
    if ((what & CAN_ERR_CRTL_RX_OVERFLOW) != 0) {
      return tr("the controller's receive buffer overran: frames are lost");
    }
    if ((what & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      return tr("error passive: more than 127 errors on the bus");
    }
    if ((what & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      return tr("error warning: more than 96 errors on the bus");
    }
    if ((what & CAN_ERR_CRTL_ACTIVE) != 0) return tr("the controller is error active again");
    return tr("the controller reports a problem");
  }
  if ((id & CAN_ERR_ACK) != 0) return tr("no node acknowledged a frame");
  if ((id & CAN_ERR_TRX) != 0) return tr("the transceiver reports a wiring fault");
  if ((id & (CAN_ERR_PROT | CAN_ERR_BUSERROR)) != 0) return tr("a protocol error on the bus");
  if ((id & CAN_ERR_LOSTARB) != 0) return tr("lost arbitration");
  if ((id & CAN_ERR_TX_TIMEOUT) != 0) return tr("a transmission of this computer timed out");
  return trf("error frame 0x{:X}", id & CAN_ERR_MASK);
}

/// One filter for each id of the map.
std::vector<can_filter> filters_of(const CanMap& map) {
  std::vector<can_filter> filters;
  const auto add = [&filters](const std::optional<CanSignal>& signal) {
    if (!signal) return;
    can_filter filter{};
    filter.can_id = signal->id | (signal->extended ? CAN_EFF_FLAG : 0U);
    filter.can_mask =
        (signal->extended ? CAN_EFF_MASK : CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG;
    const bool there = std::any_of(filters.begin(), filters.end(), [&filter](const can_filter& f) {
      return f.can_id == filter.can_id;
    });
    if (!there) filters.push_back(filter);
  };
  for (const auto& axis : map.axes) add(axis);
  add(map.tool);
  add(map.line);
  add(map.spindle);
  add(map.tool_offset_z);
  add(map.trigger);
  if (map.sync_id >= 0) {
    CanSignal sync;
    sync.id = static_cast<std::uint32_t>(map.sync_id);
    add(sync);
  }
  return filters;
}

CanFrame frame_of(const canfd_frame& raw, std::size_t bytes) {
  CanFrame frame;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.fd = bytes == CANFD_MTU;
  frame.id = raw.can_id & (frame.error || frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  const std::size_t most = frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
  frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(raw.len, most));
  std::copy_n(std::begin(raw.data), frame.length, frame.data.begin());
  return frame;
}

/// What the kernel says about one frame, beside it.
struct FrameRemarks {
  std::int64_t stamp_ns = AxisSample::kNoTime;
  bool has_dropped = false;
  std::uint32_t dropped = 0;  // since the socket was opened
};

FrameRemarks remarks_of(const msghdr& header) {
  FrameRemarks remarks;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr;
       part = CMSG_NXTHDR(const_cast<msghdr*>(&header), part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      remarks.stamp_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    } else if (part->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&remarks.dropped, CMSG_DATA(part), sizeof remarks.dropped);
      remarks.has_dropped = true;
    }
  }
  return remarks;
}

}  // namespace

std::vector<std::string> validate(const CanSourceOptions& options) {
  std::vector<std::string> faults;
  const std::string& name = options.interface;
  if (name.empty() || name.size() > kLongestInterface ||
      name.find_first_of("/ \t\n:") != name.npos || name.find('\0') != name.npos) {
    faults.push_back(trf(
        "interface: '{}' is not allowed; must be the name of a network interface, 1 to {} bytes",
        name, kLongestInterface));
  }
  const auto of_map = validate(options.map);
  faults.insert(faults.end(), of_map.begin(), of_map.end());
  const auto check = [&faults](const char* key, int value, int least, int most) {
    if (value >= least && value <= most) return;
    faults.push_back(trf("{}: {} is not allowed; must be {} to {}", key, value, least, most));
  };
  check("receive_buffer_bytes", options.receive_buffer_bytes, kLeastBuffer, kLargestBuffer);
  check("retry_first_ms", options.retry_first_ms, 1, kLongestRetry_ms);
  check("retry_longest_ms", options.retry_longest_ms,
        std::clamp(options.retry_first_ms, 1, kLongestRetry_ms), kLongestRetry_ms);
  return faults;
}

/// The socket, the batch of frames that was read last, and what becomes of them.
class CanSource::Reader {
 public:
  explicit Reader(CanSourceOptions options)
      : options_(std::move(options)),
        filters_(filters_of(options_.map)),
        assembler_(options_.map),
        retry_(options_.retry_first_ms) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      vectors_[i] = {&frames_[i], sizeof frames_[i]};
      headers_[i] = {};
      headers_[i].msg_hdr.msg_iov = &vectors_[i];
      headers_[i].msg_hdr.msg_iovlen = 1;
    }
  }
  ~Reader() { close_socket(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Next next(AxisSample& sample, milliseconds patience);
  const SourceStatus& status() const { return status_; }
  std::string describe() const { return "can " + options_.interface; }

 private:
  /// What is cut off a wait: the patience of the one who asks is not the only limit.
  Clock::time_point wait_until(Clock::time_point deadline) const;

  bool try_open();
  bool bind_interface(int socket);
  bool set_up(int socket);
  void close_socket();
  void lose(std::string trouble);
  void fail(std::string trouble);
  void wait(Clock::time_point until);
  void fetch();
  bool take_batch(AxisSample& sample);
  void take(std::size_t index);
  void take_error(std::size_t index);
  void count_dropped(const FrameRemarks& remarks);
  void read_failed(int fault);
  void connected();
  void say(std::string what) { status_.trouble = options_.interface + ": " + std::move(what); }

  CanSourceOptions options_;
  std::vector<can_filter> filters_;
  CanAssembler assembler_;
  SourceStatus status_;
  int socket_ = -1;
  milliseconds retry_;
  Clock::time_point retry_at_{};  // when socket_ is -1
  bool is_silent_ = false;        // since it was opened
  bool was_connected_ = false;
  std::uint32_t dropped_ = 0;  // the kernel's count when last seen
  std::int64_t fetched_ns_ = 0;

  std::size_t batch_size_ = 0;
  std::size_t batch_at_ = 0;
  std::array<mmsghdr, kBatch> headers_;
  std::array<iovec, kBatch> vectors_;
  std::array<canfd_frame, kBatch> frames_;
  struct alignas(cmsghdr) Control {
    std::array<char, 128> bytes;
  };
  std::array<Control, kBatch> controls_;
};

void CanSource::Reader::close_socket() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
}

/// The connection is gone; it is tried again after a pause.
void CanSource::Reader::lose(std::string trouble) {
  close_socket();
  assembler_.flush();
  status_.state = SourceState::kConnecting;
  say(std::move(trouble));
  retry_at_ = Clock::now() + retry_;
  retry_ = std::min(retry_ * 2, milliseconds(options_.retry_longest_ms));
}

void CanSource::Reader::fail(std::string trouble) {
  close_socket();
  status_.state = SourceState::kFailed;
  ++status_.errors;
  say(std::move(trouble));
}

bool CanSource::Reader::bind_interface(int socket) {
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(options_.interface.c_str()));
  // Index 0 would be every interface at once.
  if (address.can_ifindex == 0) {
    lose(tr("there is no such network interface (yet)"));
    return false;
  }
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return true;
  lose(errno == ENODEV ? tr("is no CAN interface, or has just gone")
                       : trf("cannot be bound: {}", std::strerror(errno)));
  return false;
}

bool CanSource::Reader::set_up(int socket) {
  const int on = 1;
  const can_err_mask_t errors = CAN_ERR_MASK;
  const auto filter_bytes = static_cast<socklen_t>(filters_.size() * sizeof(can_filter));
  // Only root may exceed net.core.rmem_max; others are given that much.
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &options_.receive_buffer_bytes, sizeof(int)) !=
      0) {
    setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &options_.receive_buffer_bytes, sizeof(int));
  }
  return setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(), filter_bytes) == 0 &&
         setsockopt(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
         setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) == 0 &&
         setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0 &&
         setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) == 0;
}

bool CanSource::Reader::try_open() {
  socket_ = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (socket_ < 0) {
    if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
      lose(trf("no socket: {}", std::strerror(errno)));
    } else {
      fail(trf("this computer gives no CAN socket ({}); 'modprobe can-raw' may help",
               std::strerror(errno)));
    }
    return false;
  }
  if (!set_up(socket_)) {
    fail(trf("the CAN socket cannot be set up: {}", std::strerror(errno)));
    return false;
  }
  if (!bind_interface(socket_)) return false;
  dropped_ = 0;
  batch_size_ = 0;
  batch_at_ = 0;
  say(tr("no frame with a mapped id has come yet"));
  is_silent_ = true;
  return true;
}

/// A frame has come.
void CanSource::Reader::connected() {
  if (std::exchange(is_silent_, false)) status_.trouble.clear();
  if (status_.state == SourceState::kReading) return;
  status_.state = SourceState::kReading;
  retry_ = milliseconds(options_.retry_first_ms);
  if (std::exchange(was_connected_, true)) ++status_.reconnects;
}

Clock::time_point CanSource::Reader::wait_until(Clock::time_point deadline) const {
  if (socket_ < 0) return std::min(deadline, retry_at_);
  if (!assembler_.is_gathering()) return deadline;
  // A cycle that stays incomplete must not wait for the next one, which may never come. Stamps are
  // of this computer's clock; if that was set, the longest wait is one gather time.
  const auto longest = std::chrono::nanoseconds(assembler_.gather_ns());
  const auto left = std::chrono::nanoseconds(assembler_.gather_end_ns() - host_now_ns());
  return std::min(deadline, Clock::now() + std::clamp(left, std::chrono::nanoseconds(0), longest));
}

void CanSource::Reader::wait(Clock::time_point until) {
  pollfd waiting{socket_, POLLIN, 0};
  // Without a socket this is a sleep until it is tried again.
  const int ready = ::poll(&waiting, socket_ < 0 ? 0 : 1, poll_timeout_ms(until));
  if (ready > 0) fetch();
}

void CanSource::Reader::fetch() {
  for (std::size_t i = 0; i < kBatch; ++i) {
    headers_[i].msg_hdr.msg_control = controls_[i].bytes.data();
    headers_[i].msg_hdr.msg_controllen = controls_[i].bytes.size();
  }
  const int count = ::recvmmsg(socket_, headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
  batch_at_ = 0;
  batch_size_ = count > 0 ? static_cast<std::size_t>(count) : 0;
  fetched_ns_ = host_now_ns();
  if (count < 0) read_failed(errno);
}

void CanSource::Reader::read_failed(int fault) {
  if (fault == EAGAIN || fault == EWOULDBLOCK || fault == EINTR) return;
  ++status_.errors;
  if (fault == ENETDOWN) {
    // The socket stays good: frames come again when the interface is up again.
    status_.state = SourceState::kConnecting;
    say(trf("the interface is down; 'ip link set {} up' brings it up", options_.interface));
    return;
  }
  lose(fault == ENODEV ? tr("the interface was removed")
                       : trf("cannot be read: {}", std::strerror(fault)));
}

void CanSource::Reader::count_dropped(const FrameRemarks& remarks) {
  if (!remarks.has_dropped || remarks.dropped == dropped_) return;
  const std::uint32_t more = remarks.dropped - dropped_;  // the count may wrap around
  dropped_ = remarks.dropped;
  status_.lost += more;
  assembler_.frames_lost();
  say(
      trf("{} frames were lost: the receive queue was full (is net.core.rmem_max too "
          "small?)",
          more));
}

void CanSource::Reader::take_error(std::size_t index) {
  can_frame frame{};
  frame.can_id = frames_[index].can_id;
  std::copy_n(std::begin(frames_[index].data), CAN_MAX_DLEN, std::begin(frame.data));
  const bool bus_off = (frame.can_id & CAN_ERR_BUSOFF) != 0;
  ++status_.errors;
  if ((frame.can_id & CAN_ERR_CRTL) != 0 && (frame.data[1] & CAN_ERR_CRTL_RX_OVERFLOW) != 0) {
    ++status_.lost;
    assembler_.frames_lost();
  }
  if (bus_off) {
    status_.state = SourceState::kConnecting;
  } else if ((frame.can_id & CAN_ERR_RESTARTED) != 0) {
    connected();
  }
  say(error_frame_text(frame, options_.interface));
}

void CanSource::Reader::take(std::size_t index) {
  const std::size_t bytes = headers_[index].msg_len;
  const FrameRemarks remarks = remarks_of(headers_[index].msg_hdr);
  count_dropped(remarks);
  if (bytes != CAN_MTU && bytes != CANFD_MTU) {
    ++status_.errors;
    say(trf("a frame of {} bytes, neither CAN nor CAN FD", bytes));
    return;
  }
  if ((frames_[index].can_id & CAN_ERR_FLAG) != 0) {
    take_error(index);
    return;
  }
  const std::int64_t stamp =
      remarks.stamp_ns == AxisSample::kNoTime ? fetched_ns_ : remarks.stamp_ns;
  const CanAssembler::Taken taken = assembler_.push(frame_of(frames_[index], bytes), stamp);
  // A SYNC is no sign of life of a drive.
  if (taken != CanAssembler::Taken::kNotMapped) connected();
  if (assembler_.incomplete() != status_.incomplete) {
    status_.incomplete = assembler_.incomplete();
    say(assembler_.incomplete_text());
  }
  switch (taken) {
    case CanAssembler::Taken::kUnfit:
      ++status_.errors;
      say(assembler_.unfit_text());
      break;
    case CanAssembler::Taken::kLate:
      ++status_.disordered;
      break;
    case CanAssembler::Taken::kClockStepped:
      ++status_.disordered;
      say(tr("the clock of this computer was set back"));
      break;
    case CanAssembler::Taken::kNotMapped:
    case CanAssembler::Taken::kTaken:
      break;
  }
}

/// From what was fetched already: no system call.
bool CanSource::Reader::take_batch(AxisSample& sample) {
  for (;;) {
    if (assembler_.next(sample)) {
      sample.host_ns = fetched_ns_;
      ++status_.samples;
      return true;
    }
    if (batch_at_ == batch_size_) return false;
    take(batch_at_++);
  }
}

CanSource::Next CanSource::Reader::next(AxisSample& sample, milliseconds patience) {
  if (status_.state == SourceState::kFailed) return Next::kEnd;
  if (take_batch(sample)) return Next::kSample;
  const auto deadline = Clock::now() + patience;
  for (;;) {
    if (socket_ < 0 && Clock::now() >= retry_at_ && !try_open()) {
      return status_.state == SourceState::kFailed ? Next::kEnd : Next::kNothing;
    }
    const auto until = wait_until(deadline);
    wait(until);
    const bool fetched = batch_at_ < batch_size_;
    if (take_batch(sample)) return Next::kSample;
    const auto now = Clock::now();
    if (!fetched && assembler_.is_gathering() && until < deadline && now >= until) {
      assembler_.flush();
      if (take_batch(sample)) return Next::kSample;
    }
    if (now >= deadline) return Next::kNothing;
  }
}

CanSource::CanSource(CanSourceOptions options)
    : reader_(std::make_unique<Reader>(std::move(options))) {}
CanSource::~CanSource() = default;

CanSource::Next CanSource::next(AxisSample& sample, std::chrono::milliseconds patience) {
  return reader_->next(sample, patience);
}
const SourceStatus& CanSource::status() const { return reader_->status(); }
std::string CanSource::describe() const { return reader_->describe(); }

}  // namespace kerf
