// The request is put together here and not by modbus_read_registers(), which compares neither the
// unit nor the length of a reply with what was asked: behind a gateway another unit's positions
// would pass for ours. (MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1.3, for the
// header.)
#include <fmt/format.h>
#include <modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <string>

#include "base/translate.h"
#include "machine_io/modbus/modbus_link.h"

namespace kerf {
namespace {

// transaction, protocol (0), length of what follows: two bytes each; unit; then function and data
constexpr std::size_t kHeaderBytes = 7;
constexpr std::size_t kExceptionBytes = kHeaderBytes + 2;
constexpr unsigned kExceptionFlag = 0x80;
constexpr int kLastException = 11;

unsigned word_at(const std::uint8_t* bytes) {
  return static_cast<unsigned>(bytes[0] << 8 | bytes[1]);
}
std::uint8_t high(unsigned word) { return static_cast<std::uint8_t>(word >> 8 & 0xffU); }
std::uint8_t low(unsigned word) { return static_cast<std::uint8_t>(word & 0xffU); }

class TcpLink final : public ModbusLink {
 public:
  explicit TcpLink(const ModbusSettings& settings) : ModbusLink(settings) {}

  Answer read(const PollRead& read, std::uint16_t* words) override {
    const Answer answer = ask(read, words);
    if (answer == Answer::kBroken) close();
    return answer;
  }
  Settling settle(SteadyClock::time_point) override { return Settling::kSettled; }

 private:
  modbus_t* create() const override {
    return modbus_new_tcp_pi(settings_.host.c_str(), std::to_string(settings_.port).c_str());
  }
  void opened() override {
    transaction_ = 0;
    // libmodbus does this for IPv4 only.
    const int on = 1;
    setsockopt(descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  std::string place() const override {
    return fmt::format("{}:{}", settings_.host, settings_.port);
  }

  Answer ask(const PollRead& read, std::uint16_t* words);
  Answer judge(const PollRead& read, std::size_t size, std::uint16_t* words);
  Answer broken(const PollRead& read, const std::string& what) {
    note(read, what);
    return Answer::kBroken;
  }

  unsigned transaction_ = 0;
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> reply_{};
};

ModbusLink::Answer TcpLink::ask(const PollRead& read, std::uint16_t* words) {
  // What is there before the question cannot be its answer.
  std::uint8_t early = 0;
  const ssize_t pending = recv(descriptor(), &early, 1, MSG_PEEK | MSG_DONTWAIT);
  if (pending > 0) return broken(read, tr("the device sends without being asked"));
  if (pending == 0) return broken(read, tr("the device closed the connection"));

  transaction_ = (transaction_ + 1) & 0xffffU;
  const auto address = static_cast<unsigned>(read.address);
  const auto count = static_cast<unsigned>(read.count);
  const std::array<std::uint8_t, kHeaderBytes + 5> request{
      high(transaction_),
      low(transaction_),
      0,
      0,
      0,
      6,
      low(static_cast<unsigned>(settings_.unit)),
      static_cast<std::uint8_t>(read.table),
      high(address),
      low(address),
      high(count),
      low(count)};
  if (send(descriptor(), request.data(), request.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(request.size())) {
    note_errno(read, errno);
    return Answer::kBroken;
  }
  const int size = modbus_receive_confirmation(context(), reply_.data());
  if (size < 0) {
    note_errno(read, errno);
    return Answer::kBroken;
  }
  return judge(read, static_cast<std::size_t>(size), words);
}

ModbusLink::Answer TcpLink::judge(const PollRead& read, std::size_t size, std::uint16_t* words) {
  if (size < kExceptionBytes) return broken(read, tr("the answer is too short"));
  const std::uint8_t* reply = reply_.data();
  if (word_at(reply) != transaction_) {
    return broken(read, trf("answer to question {} instead of {}", word_at(reply), transaction_));
  }
  if (word_at(reply + 2) != 0) {
    return broken(read, trf("not Modbus: protocol {} instead of 0", word_at(reply + 2)));
  }
  if (word_at(reply + 4) != size - 6) {
    return broken(read, trf("the answer's length {} does not fit its {} bytes", word_at(reply + 4),
                            size - 6));
  }
  const int unit = reply[6];
  if (settings_.unit != 0 && settings_.unit != 255 && unit != settings_.unit) {
    return broken(read, trf("unit {} answers instead of unit {}; is unit {} right, or 255 "
                            "for a device that does not use it?",
                            unit, settings_.unit, unit));
  }
  const unsigned function = reply[7];
  const auto asked = static_cast<unsigned>(read.table);
  if (function == (asked | kExceptionFlag) && reply[8] >= 1 && reply[8] <= kLastException) {
    return refused(read, reply[8]);
  }
  if (function != asked) {
    return broken(read, trf("answer with function {} instead of {}", function, asked));
  }
  const auto count = static_cast<std::size_t>(read.count);
  if (reply[8] != 2 * count || size != kExceptionBytes + 2 * count) {
    return broken(read, trf("answer of {} bytes instead of {}", reply[8], 2 * count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    words[i] = static_cast<std::uint16_t>(word_at(reply + kExceptionBytes + 2 * i));
  }
  return Answer::kWords;
}

}  // namespace

std::unique_ptr<ModbusLink> make_tcp_link(const ModbusSettings& settings) {
  return std::make_unique<TcpLink>(settings);
}

}  // namespace kerf
