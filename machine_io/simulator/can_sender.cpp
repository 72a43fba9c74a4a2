#include "machine_io/simulator/can_sender.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/translate.h"
#include "machine_io/simulator/register_layout.h"

namespace kerf {
namespace {

constexpr std::uint32_t kTpdo3 = 0x380;
constexpr std::uint32_t kBootUp = 0x700;
constexpr std::uint32_t kEncoderEstimates = 0x09;
/// CiA 402 status word: operation enabled, voltage there, remote.
constexpr std::uint16_t kOperationEnabled = 0x0637;

/// Little endian, at the end of the frame.
template <class Unsigned>
void put(SentCanFrame& frame, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    frame.data[frame.size++] = static_cast<std::uint8_t>(value >> (8 * i) & 0xffU);
  }
}

void put_float(SentCanFrame& frame, double value) {
  put(frame, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::uint32_t node_of(CanLayout layout, std::size_t axis) {
  return static_cast<std::uint32_t>(layout == CanLayout::kCia402 ? axis + 1 : axis);
}

}  // namespace

SentCanFrame CanEncoder::position_frame(std::size_t axis, double position, double speed) const {
  SentCanFrame frame;
  const std::uint32_t node = node_of(layout_, axis);
  if (layout_ == CanLayout::kCia402) {
    frame.id = kTpdo3 + node;
    put(frame, kOperationEnabled);
    put(frame, static_cast<std::uint32_t>(thousandths(position)));
    return frame;
  }
  const double turn = axis < 3 ? kOdriveTurn_mm : kOdriveTurn_deg;
  frame.id = node << 5U | kEncoderEstimates;
  put_float(frame, position / turn);
  put_float(frame, speed / turn);
  return frame;
}

std::size_t CanEncoder::encode(const ServedState& served, double since_last_s,
                               std::array<SentCanFrame, kMaxFrames>& frames) {
  const SimulatedState& state = served.state;
  const std::array<double, kSimulatedAxes> before = before_;
  before_ = state.position;
  const bool was_gone = gone_;
  gone_ = served.faults.has(FaultKind::kRestart);
  if (gone_ || served.faults.has(FaultKind::kDrop)) return 0;
  std::size_t count = 0;
  if (was_gone && layout_ == CanLayout::kCia402) {
    for (std::size_t axis = 0; axis < kSimulatedAxes; ++axis) {
      frames[count++] = {kBootUp + node_of(layout_, axis), 1, {}};
    }
  }
  for (std::size_t axis = 0; axis < kSimulatedAxes; ++axis) {
    const bool nan = served.faults.has(FaultKind::kNan);
    const double position = nan ? std::numeric_limits<double>::quiet_NaN() : state.position[axis];
    const double speed = since_last_s > 0 ? (position - before[axis]) / since_last_s : 0;
    frames[count++] = position_frame(axis, position, speed);
  }
  SentCanFrame status{kCanStatusId, 0, {}};
  put(status, static_cast<std::uint16_t>(std::clamp(state.tool, 0, 0xffff)));
  put(status, state.line);
  put(status, state.scan);
  frames[count++] = status;
  SentCanFrame spindle{kCanSpindleId, 0, {}};
  const double rpm = std::clamp(std::round(state.spindle_rpm), -32768.0, 32767.0);
  put(spindle, static_cast<std::uint16_t>(static_cast<std::int16_t>(rpm)));
  put(spindle, static_cast<std::uint32_t>(thousandths(state.tool_offset_z_mm)));
  const double load = std::clamp(std::round(100 * state.load), -32768.0, 32767.0);
  put(spindle, static_cast<std::uint16_t>(static_cast<std::int16_t>(load)));
  frames[count++] = spindle;
  if (!served.faults.has(FaultKind::kGarbage)) return count;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint8_t& byte : frames[i].data) {
      noise_ = noise_ * 1664525U + 1013904223U;  // Numerical Recipes' generator: any noise will do
      byte = static_cast<std::uint8_t>(noise_ >> 24U);
    }
  }
  return count;
}

Result<std::unique_ptr<CanSender>> CanSender::open(const std::string& interface, CanLayout layout) {
  const auto failed = [&] { return Error{trf("opening {}: {}", interface, std::strerror(errno))}; };
  const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (fd < 0) return failed();
  std::unique_ptr<CanSender> sender(new CanSender(fd, layout));
  sockaddr_can address = {};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  const void* const raw = &address;
  // No filter at all: nothing is received. Index 0 would mean all interfaces.
  if (address.can_ifindex == 0 || setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) != 0 ||
      bind(fd, static_cast<const sockaddr*>(raw), sizeof address) != 0) {
    return failed();
  }
  return sender;
}

CanSender::~CanSender() { close(fd_); }

void CanSender::send(const ServedState& served, double since_last_s) {
  const std::size_t count = encoder_.encode(served, since_last_s, frames_);
  for (std::size_t i = 0; i < count; ++i) {
    can_frame frame = {};
    frame.can_id = frames_[i].id;
    frame.can_dlc = static_cast<std::uint8_t>(frames_[i].size);
    std::copy(frames_[i].data.begin(), frames_[i].data.end(), std::begin(frame.data));
    if (write(fd_, &frame, sizeof frame) == sizeof frame) {
      ++sent_;
    } else {
      ++not_sent_;
      last_error_ = errno;
    }
  }
}

std::string CanSender::trouble() const {
  return last_error_ == 0 ? "" : std::strerror(last_error_);
}

}  // namespace kerf
