#include "tests/machine_io/modbus/faulty_device.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kRegisters = 64;
constexpr std::size_t kHole = 40;  // registers kHole .. kHoleEnd - 1 do not exist
constexpr std::size_t kHoleEnd = 44;
constexpr std::size_t kTcpQuestion = 12;
constexpr std::size_t kRtuQuestion = 8;

std::uint8_t high(unsigned word) { return static_cast<std::uint8_t>(word >> 8 & 0xffU); }
std::uint8_t low(unsigned word) { return static_cast<std::uint8_t>(word & 0xffU); }

/// CRC-16 of "MODBUS over Serial Line" V1.02, 6.2.2, bit by bit.
unsigned crc_of(const std::vector<std::uint8_t>& bytes) {
  unsigned crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xa001U : crc >> 1;
  }
  return crc;
}

bool is_of_another_machine(Fault fault) {
  return fault == Fault::kWrongTransaction || fault == Fault::kWrongProtocol ||
         fault == Fault::kWrongUnit || fault == Fault::kWrongLength ||
         fault == Fault::kWrongFunction || fault == Fault::kWrongCount ||
         fault == Fault::kHalfFrame;
}

}  // namespace

Clock::time_point FaultyDevice::epoch() {
  static const Clock::time_point begin = Clock::now();
  return begin;
}

double FaultyDevice::now_s() {
  return std::chrono::duration<double>(Clock::now() - epoch()).count();
}

std::unique_ptr<FaultyDevice> FaultyDevice::tcp() {
  std::unique_ptr<FaultyDevice> made(new FaultyDevice(false));
  made->start();
  return made;
}

std::unique_ptr<FaultyDevice> FaultyDevice::rtu() {
  std::unique_ptr<FaultyDevice> made(new FaultyDevice(true));
  made->start();
  return made;
}

FaultyDevice::FaultyDevice(bool rtu) : rtu_(rtu) {
  epoch();
  if (rtu_) terminal_ = std::make_unique<PseudoTerminal>();
}

FaultyDevice::~FaultyDevice() { kill(); }

void FaultyDevice::listen_on(int port) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, generic, size) != 0 || listen(listener_, 4) != 0 ||
      getsockname(listener_, generic, &size) != 0) {
    std::abort();
  }
  port_ = ntohs(address.sin_port);
}

void FaultyDevice::start() {
  kill();
  if (!rtu_) listen_on(port_);
  if (pipe(stop_) != 0) std::abort();
  thread_ = std::thread([this] { serve(); });
}

void FaultyDevice::kill() {
  if (!thread_.joinable()) return;
  close(stop_[1]);
  thread_.join();
  close(stop_[0]);
  if (client_ >= 0) close(client_);
  if (listener_ >= 0) close(listener_);
  client_ = listener_ = -1;
  in_.clear();
  out_.clear();
}

void FaultyDevice::chatter() {
  const Bytes noise{0x01, 0x03, 0x20};
  if (write(terminal_->master(), noise.data(), noise.size()) != 3) std::abort();
}

void FaultyDevice::serve() {
  for (;;) {
    const int line = rtu_ ? terminal_->master() : client_;
    int wait = -1;
    if (!out_.empty()) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(out_.front().due - Clock::now());
      wait = std::max(0, static_cast<int>(left.count()));
    }
    pollfd watched[] = {{stop_[0], 0, 0}, {listener_, POLLIN, 0}, {line, POLLIN, 0}};
    if (poll(watched, 3, wait) < 0 || watched[0].revents != 0) return;
    if ((watched[1].revents & POLLIN) != 0) {
      const int fresh = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      const int on = 1;
      setsockopt(fresh, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      if (client_ >= 0) close(client_);
      client_ = fresh;
      in_.clear();
      out_.clear();
      continue;
    }
    bool closed = false;
    if (watched[2].revents != 0) serve_line(line, closed);
    while (!closed && !out_.empty() && out_.front().due <= Clock::now()) {
      const Bytes& bytes = out_.front().bytes;
      const ssize_t put = rtu_ ? write(line, bytes.data(), bytes.size())
                               : send(line, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      closed = put != static_cast<ssize_t>(bytes.size());
      out_.pop_front();
    }
    if (closed && !rtu_) {
      close(client_);
      client_ = -1;
      out_.clear();
    }
  }
}

void FaultyDevice::serve_line(int fd, bool& closed) {
  std::uint8_t bytes[512];
  const ssize_t got = read(fd, bytes, sizeof bytes);
  if (got <= 0) {
    closed = true;
    return;
  }
  in_.insert(in_.end(), bytes, bytes + got);
  take_questions(closed);
}

void FaultyDevice::take_questions(bool& closed) {
  const std::size_t size = rtu_ ? kRtuQuestion : kTcpQuestion;
  while (in_.size() >= size) {
    const auto end = in_.begin() + static_cast<std::ptrdiff_t>(size);
    const Bytes question(in_.begin(), end);
    in_.erase(in_.begin(), end);
    ++questions_;
    functions_ |= std::uint64_t{1} << (question[rtu_ ? 1 : 7] & 63U);
    const Fault fault = fault_;
    const std::size_t count_at = rtu_ ? 4 : 10;
    const bool is_refused = (question[count_at] << 8 | question[count_at + 1]) < refused_below_;
    if (fault == Fault::kSilent || (is_refused && !refuses_by_exception_)) continue;
    if (fault == Fault::kClose) {
      closed = true;
      return;
    }
    auto due = Clock::now();
    if (fault == Fault::kLate) due += std::chrono::milliseconds(late_ms_);
    // A device answers one question after the other, whatever becomes of it meanwhile.
    if (!out_.empty()) due = std::max(due, out_.back().due);
    out_.push_back({due, answer(question, is_refused ? Fault::kException2 : fault)});
    if (!is_refused) ++good_answers_;
  }
}

std::vector<std::uint16_t> FaultyDevice::registers(Fault fault) {
  double x = is_of_another_machine(fault) ? kElsewhere : now_s();
  if (fault == Fault::kStuck) {
    if (stuck_s_ < 0) stuck_s_ = x;
    x = stuck_s_;
  } else {
    stuck_s_ = -1;
    ++counter_;
  }
  std::vector<std::uint16_t> out(kRegisters);
  const auto order = fault == Fault::kWrongOrder ? WordOrder::kCdab : WordOrder::kAbcd;
  double y = 2 * x + 1;
  if (fault == Fault::kNan) y = std::numeric_limits<double>::quiet_NaN();
  if (fault == Fault::kInfinite) y = -std::numeric_limits<double>::infinity();
  if (fault == Fault::kHuge) y = 1e30;
  encode_registers(ModbusType::kFloat64, order, x, &out[0]);
  encode_registers(ModbusType::kFloat64, order, y, &out[4]);
  encode_registers(ModbusType::kFloat64, order, -x, &out[8]);
  encode_registers(ModbusType::kFloat32, order, 100 + std::fmod(x, 1), &out[12]);
  out[14] = 7;
  out[15] = 321;
  out[16] = out[17] = counter_;
  if (fault == Fault::kTornAlways || (fault == Fault::kTorn && counter_ % 3 != 0)) {
    encode_registers(ModbusType::kFloat64, order, y - 0.02, &out[4]);
    ++out[17];
  }
  return out;
}

FaultyDevice::Bytes FaultyDevice::answer(const Bytes& question, Fault fault) {
  const std::size_t pdu_at = rtu_ ? 1 : 7;
  const unsigned function = question[pdu_at];
  const auto address = static_cast<std::size_t>(question[pdu_at + 1] << 8 | question[pdu_at + 2]);
  auto count = static_cast<std::size_t>(question[pdu_at + 3] << 8 | question[pdu_at + 4]);
  if (fault == Fault::kGarbage) return Bytes(61, 0xa5);
  Bytes pdu;
  const bool reads = function == 3 || function == 4;
  if (fault >= Fault::kException1 && fault <= Fault::kException4) {
    const int code = static_cast<int>(fault) - static_cast<int>(Fault::kException1) + 1;
    pdu = {static_cast<std::uint8_t>(function | 0x80U), static_cast<std::uint8_t>(code)};
  } else if (!reads || address + count > kRegisters ||
             (address < kHoleEnd && address + count > kHole)) {
    pdu = {static_cast<std::uint8_t>(function | 0x80U), static_cast<std::uint8_t>(reads ? 2 : 1)};
  } else {
    if (fault == Fault::kWrongCount) count = count > 2 ? count - 2 : count + 2;
    const std::vector<std::uint16_t> words = registers(fault);
    pdu = {static_cast<std::uint8_t>(fault == Fault::kWrongFunction ? function ^ 7U : function),
           static_cast<std::uint8_t>(2 * count)};
    for (std::size_t i = 0; i < count; ++i) {
      pdu.push_back(high(words[address + i]));
      pdu.push_back(low(words[address + i]));
    }
  }
  Bytes frame = rtu_ ? framed_rtu(question, pdu, fault) : framed_tcp(question, pdu, fault);
  if (fault == Fault::kHalfFrame) frame.resize(frame.size() / 2);
  return frame;
}

FaultyDevice::Bytes FaultyDevice::framed_tcp(const Bytes& question, const Bytes& pdu,
                                             Fault fault) const {
  const std::size_t length = pdu.size() + (fault == Fault::kWrongLength ? 2 : 1);
  Bytes frame(7 + pdu.size());
  frame[0] = question[0];
  frame[1] = static_cast<std::uint8_t>(question[1] + (fault == Fault::kWrongTransaction ? 1 : 0));
  frame[3] = fault == Fault::kWrongProtocol ? 1 : 0;
  frame[4] = high(static_cast<unsigned>(length));
  frame[5] = low(static_cast<unsigned>(length));
  frame[6] = fault == Fault::kWrongUnit ? 9 : question[6];
  std::copy(pdu.begin(), pdu.end(), frame.begin() + 7);
  return frame;
}

FaultyDevice::Bytes FaultyDevice::framed_rtu(const Bytes& question, const Bytes& pdu,
                                             Fault fault) const {
  Bytes frame(1 + pdu.size());
  frame[0] = fault == Fault::kWrongUnit ? 9 : question[0];
  std::copy(pdu.begin(), pdu.end(), frame.begin() + 1);
  const unsigned crc = crc_of(frame);
  frame.push_back(low(crc));
  frame.push_back(high(crc));
  return frame;
}

ModbusSettings settings_for(const FaultyDevice& device, bool rtu) {
  ModbusSettings settings;
  settings.rtu = rtu;
  if (rtu) {
    settings.device = device.device();
    settings.baud = 115200;
  } else {
    settings.host = "127.0.0.1";
    settings.port = device.port();
  }
  settings.timeout_ms = 100;
  for (std::size_t i = 0; i < 3; ++i) {
    settings.axes[i] =
        ModbusRegister{static_cast<int>(4 * i), ModbusTable::kHolding, ModbusType::kFloat64};
    settings.ranges[i].min = -5000;
    settings.ranges[i].max = 5000;
  }
  settings.axes[3] = ModbusRegister{12, ModbusTable::kHolding, ModbusType::kFloat32};
  settings.ranges[3].min = -360;
  settings.ranges[3].max = 360;
  settings.tool = ModbusRegister{14, ModbusTable::kHolding, ModbusType::kUint16};
  settings.line = ModbusRegister{15, ModbusTable::kHolding, ModbusType::kUint16};
  return settings;
}

}  // namespace kerf
