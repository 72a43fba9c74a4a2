#include "machine_io/simulator/modbus_endpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/translate.h"

namespace kerf {
namespace {

/// libmodbus waits with select(), which takes descriptors below 1024.
constexpr std::size_t kMaxClients = 64;
constexpr int kBacklog = 8;
/// Half a request keeps the others waiting for this long.
constexpr std::uint32_t kByteTimeout_us = 100'000;
/// libmodbus sleeps for a response timeout before it refuses a request for too many registers.
constexpr std::uint32_t kFlushPause_us = 1000;
constexpr timeval kSendTimeout{1, 0};
constexpr int kBitsPerByte = 10;  // 8N1: with start and stop bit

void set_timeouts(modbus_t* context) {
  modbus_set_byte_timeout(context, 0, kByteTimeout_us);
  modbus_set_response_timeout(context, 0, kFlushPause_us);
}

/// "127.0.0.1:502", "[::1]:502", of a socket that is bound.
std::string bound_address(int fd, int& port) {
  sockaddr_storage address = {};
  socklen_t length = sizeof address;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  void* const raw = &address;
  if (getsockname(fd, static_cast<sockaddr*>(raw), &length) != 0 ||
      getnameinfo(static_cast<sockaddr*>(raw), length, host.data(), host.size(), service.data(),
                  service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return "?";
  }
  port = std::stoi(service.data());
  return address.ss_family == AF_INET6 ? fmt::format("[{}]:{}", host.data(), service.data())
                                       : fmt::format("{}:{}", host.data(), service.data());
}

}  // namespace

Done ModbusTcpEndpoint::open() {
  const std::string service = std::to_string(end_.port);
  const std::string what = trf("listening on {}:{}", end_.host, end_.port);
  addrinfo wanted = {};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  // libmodbus says "connection refused" of a name that nobody knows.
  if (const int error = getaddrinfo(end_.host.c_str(), service.c_str(), &wanted, &found)) {
    return Error{fmt::format("{}: {}", what, gai_strerror(error))};
  }
  freeaddrinfo(found);
  context_.reset(modbus_new_tcp_pi(end_.host.c_str(), service.c_str()));
  if (!context_) return Error{fmt::format("{}: {}", what, modbus_strerror(errno))};
  set_timeouts(context_.get());
  const int fd = modbus_tcp_pi_listen(context_.get(), kBacklog);
  if (fd < 0) {
    const int error = errno;
    context_.reset();
    return Error{fmt::format("{}: {}", what, std::strerror(error))};
  }
  address_ = bound_address(fd, end_.port);  // the port chosen stays the same after a restart
  fds_.push_back({fd, POLLIN, 0});
  return std::monostate{};
}

void ModbusTcpEndpoint::close() {
  for (const pollfd& entry : fds_) ::close(entry.fd);
  fds_.clear();
  context_.reset();
}

bool ModbusTcpEndpoint::accept_client(int fd) {
  if (fd != fds_.front().fd) return false;
  const int client = accept4(fd, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) return true;  // it has gone again
  if (fds_.size() > kMaxClients) {
    ::close(client);
    return true;
  }
  // One that does not take its answers must not stop the others for good.
  setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &kSendTimeout, sizeof kSendTimeout);
  fds_.push_back({client, POLLIN, 0});
  return true;
}

void ModbusTcpEndpoint::recover(int fd) {
  const auto client =
      std::find_if(fds_.begin(), fds_.end(), [fd](const pollfd& entry) { return entry.fd == fd; });
  ::close(fd);
  fds_.erase(client);
}

Done ModbusRtuEndpoint::open() {
  Result<PtyLine> line = PtyLine::open(end_.link);
  if (!line) return Error{line.error()};
  // Answers that nobody reads must not hold the server.
  fcntl(line->fd(), F_SETFL, fcntl(line->fd(), F_GETFL) | O_NONBLOCK);
  line_ = std::move(*line);
  make_context();
  if (!context_) {
    const Error error{fmt::format("{}: {}", line_->device(), modbus_strerror(errno))};
    line_.reset();
    return error;
  }
  fds_.push_back({line_->fd(), POLLIN, 0});
  return std::monostate{};
}

void ModbusRtuEndpoint::make_context() {
  context_.reset(modbus_new_rtu(line_->device().c_str(), end_.baud, 'N', 8, 1));
  if (!context_) return;
  set_timeouts(context_.get());
  modbus_set_slave(context_.get(), end_.unit);
  modbus_set_socket(context_.get(), line_->fd());
}

void ModbusRtuEndpoint::close() {
  fds_.clear();
  context_.reset();
  line_.reset();
}

std::string ModbusRtuEndpoint::address() const {
  if (!line_) return "";
  return end_.link.empty() ? line_->device()
                           : fmt::format("{} link {}", line_->device(), end_.link);
}

void ModbusRtuEndpoint::recover(int) { modbus_flush(context_.get()); }

double ModbusRtuEndpoint::line_seconds(int bytes) const {
  return static_cast<double>(bytes) * kBitsPerByte / end_.baud;
}

}  // namespace kerf
