#include "machine_io/simulator/modbus_server.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "machine_io/simulator/modbus_endpoint.h"
#include "machine_io/simulator/register_layout.h"

namespace kerf {
namespace {

constexpr int kRestartLook_ms = 20;
constexpr int kReadHolding = 3;
constexpr int kReadInput = 4;

struct FreeMapping {
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};

/// Bytes of function and data of the answer to a read; one of too many registers is refused.
int answer_bytes(const std::uint8_t* pdu) {
  const int count = pdu[3] << 8 | pdu[4];
  return 2 + (count <= MODBUS_MAX_READ_REGISTERS ? 2 * count : 0);
}

}  // namespace

struct ModbusServer::Answering {
  std::unique_ptr<modbus_mapping_t, FreeMapping> mapping;
  Registers registers{};
  std::vector<pollfd> waiting;
};

Result<std::unique_ptr<ModbusServer>> ModbusServer::open_tcp(const ModbusTcpEnd& end,
                                                             const StateBoard& board, bool restarts,
                                                             Reopened reopened) {
  return open(std::make_unique<ModbusTcpEndpoint>(end), board, restarts, std::move(reopened));
}

Result<std::unique_ptr<ModbusServer>> ModbusServer::open_rtu(const ModbusRtuEnd& end,
                                                             const StateBoard& board, bool restarts,
                                                             Reopened reopened) {
  return open(std::make_unique<ModbusRtuEndpoint>(end), board, restarts, std::move(reopened));
}

Result<std::unique_ptr<ModbusServer>> ModbusServer::open(std::unique_ptr<ModbusEndpoint> endpoint,
                                                         const StateBoard& board, bool restarts,
                                                         Reopened reopened) {
  if (const Done opened = endpoint->open(); !opened) return Error{opened.error()};
  std::unique_ptr<ModbusServer> server(
      new ModbusServer(std::move(endpoint), board, restarts, std::move(reopened)));
  server->answering_->mapping.reset(modbus_mapping_new(0, 0, kRegisterCount, kRegisterCount));
  server->stop_fd_ = eventfd(0, EFD_CLOEXEC);
  if (!server->answering_->mapping || server->stop_fd_ < 0) {
    return Error{trf("starting a Modbus server: {}", std::strerror(errno))};
  }
  server->thread_ = std::thread([raw = server.get()] { raw->run(); });
  return server;
}

ModbusServer::ModbusServer(std::unique_ptr<ModbusEndpoint> endpoint, const StateBoard& board,
                           bool restarts, Reopened reopened)
    : endpoint_(std::move(endpoint)),
      board_(board),
      restarts_(restarts),
      reopened_(std::move(reopened)),
      address_(endpoint_->address()),
      answering_(std::make_unique<Answering>()) {}

ModbusServer::~ModbusServer() {
  if (thread_.joinable()) {
    eventfd_write(stop_fd_, 1);
    thread_.join();
  }
  if (stop_fd_ >= 0) close(stop_fd_);
}

void ModbusServer::run() {
  std::vector<pollfd>& waiting = answering_->waiting;
  while (true) {
    if (restarts_) follow_restarts();
    waiting.assign(endpoint_->fds().begin(), endpoint_->fds().end());
    waiting.push_back({stop_fd_, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), restarts_ ? kRestartLook_ms : -1) < 0) continue;
    if (waiting.back().revents != 0) return;
    waiting.pop_back();
    for (const pollfd& entry : waiting) {
      if (entry.revents == 0 || endpoint_->accept_client(entry.fd)) continue;
      if (!take_request(entry.fd)) return;
    }
  }
}

void ModbusServer::follow_restarts() {
  const bool gone = board_.read().faults.has(FaultKind::kRestart);
  if (gone && endpoint_->is_open()) endpoint_->close();
  if (gone || endpoint_->is_open()) return;
  // Somebody may have taken the port meanwhile: it is tried again at the next look.
  if (endpoint_->open() && reopened_) reopened_(endpoint_->address());
}

/// False: the server is to stop.
bool ModbusServer::take_request(int fd) {
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> query{};
  modbus_t* const context = endpoint_->context();
  modbus_set_socket(context, fd);
  const int length = modbus_receive(context, query.data());
  if (length < 0) endpoint_->recover(fd);
  if (length == 0) endpoint_->passed_over();
  if (length <= 0) return true;
  const Outcome outcome = answer(fd, query.data(), length);
  if (outcome == Outcome::kFailed) endpoint_->recover(fd);
  return outcome != Outcome::kStop;
}

ModbusServer::Outcome ModbusServer::answer(int fd, const std::uint8_t* query, int length) {
  modbus_t* const context = endpoint_->context();
  const std::uint8_t* const pdu = query + modbus_get_header_length(context);
  const bool reads = pdu[0] == kReadHolding || pdu[0] == kReadInput;
  ++asked_;
  if (!reads) ++refused_;
  const ServedState served = board_.read();
  const ActiveFaults& faults = served.faults;
  if (faults.has(FaultKind::kDrop) || faults.has(FaultKind::kRestart)) return Outcome::kDone;
  const bool exception = !reads || faults.has(FaultKind::kException);
  const int bytes = endpoint_->envelope_bytes() + (exception ? 2 : answer_bytes(pdu));
  if (!pause(faults.delay_ms * 1e-3 + endpoint_->line_seconds(length + bytes))) {
    return Outcome::kStop;
  }
  int sent = 0;
  if (faults.has(FaultKind::kGarbage)) {
    sent = send_garbage(fd, bytes);
  } else if (exception) {
    const int code = reads ? faults.exception_code : MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
    sent = modbus_reply_exception(context, query, static_cast<unsigned>(code));
  } else {
    encode_registers(served, answering_->registers);
    modbus_mapping_t* const mapping = answering_->mapping.get();
    uint16_t* const table =
        pdu[0] == kReadHolding ? mapping->tab_registers : mapping->tab_input_registers;
    std::copy(answering_->registers.begin(), answering_->registers.end(), table);
    sent = modbus_reply(context, query, length, mapping);
  }
  return sent < 0 ? Outcome::kFailed : Outcome::kDone;
}

int ModbusServer::send_garbage(int fd, int bytes) {
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> noise{};
  const auto count = std::min(static_cast<std::size_t>(bytes), noise.size());
  for (std::size_t i = 0; i < count; ++i) {
    noise_ = noise_ * 1664525U + 1013904223U;  // Numerical Recipes' generator: any noise will do
    noise[i] = static_cast<std::uint8_t>(noise_ >> 24U);
  }
  const ssize_t sent = send(fd, noise.data(), count, MSG_NOSIGNAL);
  const bool is_pty = sent < 0 && errno == ENOTSOCK;
  return static_cast<int>(is_pty ? write(fd, noise.data(), count) : sent);
}

/// False: stopped meanwhile.
bool ModbusServer::pause(double seconds) const {
  if (seconds <= 0) return true;
  const double whole = std::floor(seconds);
  const timespec time{static_cast<time_t>(whole), static_cast<long>((seconds - whole) * 1e9)};
  pollfd stop{stop_fd_, POLLIN, 0};
  return ppoll(&stop, 1, &time, nullptr) <= 0;
}

}  // namespace kerf
