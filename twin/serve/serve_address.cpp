#include "twin/serve/serve_address.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace kerf {
namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr std::size_t kMostDigits = 19;

std::optional<std::uint16_t> read_port(std::string_view text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, port);
  if (text.empty() || error != std::errc() || stop != end) return std::nullopt;
  return port;
}

bool is_address(int family, const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const bool is_all = host.find('\0') == host.npos;  // inet_pton() looks no farther
  return is_all && inet_pton(family, host.c_str(), bytes.data()) == 1;
}

/// The port, and without it what is before its colon.
bool split_port(std::string_view& text, std::uint16_t& port) {
  const std::size_t colon = text.rfind(':');
  const std::optional<std::uint16_t> read = read_port(text.substr(colon + 1));
  if (!read) return false;
  port = *read;
  text = text.substr(0, colon);
  return true;
}

/// "name", "name:8734", "[::1]:8734" without port and brackets.
std::string_view host_name_of(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == host.npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

}  // namespace

bool ServeAddress::is_loopback() const { return host.starts_with("127.") || host == "::1"; }

bool ServeAddress::is_any() const { return host == "0.0.0.0" || host == "::"; }

std::optional<ServeAddress> read_serve_address(std::string_view text) {
  ServeAddress address;
  if (const std::optional<std::uint16_t> port = read_port(text)) {
    address.port = *port;
    return address;
  }
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == text.npos) return std::nullopt;
    std::string_view port = text.substr(end + 1);
    if (!port.empty() && !(port.front() == ':' && split_port(port, address.port))) {
      return std::nullopt;
    }
    address.host = text.substr(1, end - 1);
    if (!is_address(AF_INET6, address.host)) return std::nullopt;
    return address;
  }
  if (text.find(':') != text.npos && !split_port(text, address.port)) return std::nullopt;
  if (text == "localhost") return address;
  address.host = text;
  if (!is_address(AF_INET, address.host)) return std::nullopt;
  return address;
}

std::string to_string(const ServeAddress& address) {
  return address.is_ipv6() ? fmt::format("[{}]:{}", address.host, address.port)
                           : fmt::format("{}:{}", address.host, address.port);
}

bool is_own_host(std::string_view host) {
  const std::string_view name = host_name_of(host);
  if (name == "localhost" || name == "::1") return true;
  return name.starts_with("127.") && is_address(AF_INET, std::string(name));
}

std::string new_access_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t more = getrandom(bytes.data() + got, bytes.size() - got, 0);
    if (more > 0) got += static_cast<std::size_t>(more);
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_authorized(std::string_view authorization, std::string_view token) {
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme)) return false;
  const std::string_view said = authorization.substr(kScheme.size());
  if (said.size() != token.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    differs |= static_cast<unsigned>(static_cast<unsigned char>(said[i]) ^
                                     static_cast<unsigned char>(token[i]));
  }
  return differs == 0 && !token.empty();
}

bool takes_gzip(std::string_view accept_encoding) {
  while (!accept_encoding.empty()) {
    const std::size_t end = std::min(accept_encoding.find(','), accept_encoding.size());
    std::string one;
    for (const char c : accept_encoding.substr(0, end)) {
      if (c != ' ' && c != '\t') one += c;
    }
    accept_encoding.remove_prefix(std::min(end + 1, accept_encoding.size()));
    if (one != "gzip" && !one.starts_with("gzip;")) continue;
    return one.find_first_not_of("0.", std::min(one.find("q=") + 2, one.size())) != one.npos ||
           one.find("q=") == one.npos;
  }
  return false;
}

std::optional<std::uint64_t> read_seen_number(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  if (text.empty() || text.size() > kMostDigits) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace kerf
