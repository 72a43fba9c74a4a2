// machine_io/mtconnect/http_get.h - one question by HTTP, and an answer that may go on and on.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "machine_io/source_clock.h"

namespace kerf {

/// Asks with GET, and with nothing else: no setting makes it send. The connection is kept for the
/// next question where the server keeps it. Goes to the server itself, by no proxy; follows no
/// redirections. Starts no thread (libcurl may, to look a name up).
class HttpGet {
 public:
  HttpGet();
  ~HttpGet();
  HttpGet(const HttpGet&) = delete;
  HttpGet& operator=(const HttpGet&) = delete;

  /// Begins; what was under way is dropped. Error: libcurl is missing, or takes no such URL.
  Done begin(const std::string& url);

  enum class State {
    kWaiting,  ///< `deadline` has passed
    kBytes,    ///< some have come: take_bytes()
    kDone,     ///< the answer is whole
    kFailed,   ///< trouble()
  };
  /// Waits for what comes. An answer that is longer than kMostXml_bytes, while nobody takes its
  /// bytes, has failed.
  State wait(SteadyClock::time_point deadline);

  /// What has come, and was not taken before.
  std::string take_bytes();
  /// Of the head, which has come with the first bytes, at the latest when it is done.
  long status() const;
  std::string content_type() const;
  /// When the question was sent, and when the last bytes came: CLOCK_MONOTONIC, ns.
  std::int64_t asked_ns() const;
  std::int64_t received_ns() const;
  const std::string& trouble() const;

  /// The whole answer within `timeout`. Error: what went wrong, or "HTTP 404" with its first words.
  /// A server that tells an error in its own words (status 4xx, a body) is heard: `status()`.
  Result<std::string> ask(const std::string& url, std::chrono::milliseconds timeout);

 private:
  struct Transfer;
  std::unique_ptr<Transfer> transfer_;
};

}  // namespace kerf
