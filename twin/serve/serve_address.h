// twin/serve/serve_address.h - where the page for the shop is served, and whose requests it
// answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

inline constexpr std::uint16_t kServePort = 8734;

/// An address of this computer, and a port of it.
struct ServeAddress {
  std::string host = "127.0.0.1";   ///< numeric, IPv4 or IPv6, without brackets
  std::uint16_t port = kServePort;  ///< 0: any that is free

  bool is_ipv6() const { return host.find(':') != std::string::npos; }
  /// Nobody but this computer reaches it: no token is needed.
  bool is_loopback() const;
  /// It stands for all addresses of this computer.
  bool is_any() const;
  bool operator==(const ServeAddress&) const = default;
};

/// "192.168.1.5:8734", "[fe80::1]:8734", "localhost:8734", "8734", "192.168.1.5"; what is missing
/// is as in ServeAddress{}. Names but localhost are not looked up. None: it is not an address.
std::optional<ServeAddress> read_serve_address(std::string_view text);

/// "127.0.0.1:8734", "[::1]:8734"
std::string to_string(const ServeAddress& address);

/// What a request's Host may say where no token is asked for: this computer by its own name. Else a
/// page of some other site, whose name was made to lead here, could read along.
bool is_own_host(std::string_view host);

/// 128 bits of the system's random numbers as 32 hex digits.
std::string new_access_token();
/// "Bearer TOKEN". Takes as long whatever is wrong with it.
bool is_authorized(std::string_view authorization, std::string_view token);

/// Of an Accept-Encoding: "gzip, deflate, br"; "gzip;q=0" does not.
bool takes_gzip(std::string_view accept_encoding);

/// A number in a request: up to 19 digits, no sign. None: it is not a number.
std::optional<std::uint64_t> read_seen_number(std::string_view text);

}  // namespace kerf
