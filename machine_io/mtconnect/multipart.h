// machine_io/mtconnect/multipart.h - the parts of an answer that goes on and on.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// Splits multipart/x-mixed-replace as agents send it: a boundary, head lines, the body. It does
/// not matter where the bytes are cut on their way. A part with a Content-length is there as soon
/// as its bytes are; one without ends at the next boundary.
class MultipartReader {
 public:
  /// Of a Content-Type: what follows boundary=; nothing: it is not multipart, or names none.
  static std::optional<std::string> boundary_of(std::string_view content_type);

  explicit MultipartReader(std::string boundary) : mark_("--" + std::move(boundary)) {}

  void add(std::string_view bytes) { bytes_ += bytes; }
  /// The body of the next part that is whole. Nothing: not yet, or fault() says why never.
  std::optional<std::string> next();
  /// The closing boundary has come.
  bool is_ended() const { return ended_; }
  /// Bytes that are no parts, or a part that is too long. Empty: none so far.
  const std::string& fault() const { return fault_; }

 private:
  bool read_head();
  std::optional<std::string> take(std::size_t length);

  std::string mark_;
  std::string bytes_;  ///< not yet handed out
  bool in_body_ = false;
  std::optional<std::size_t> length_;  ///< of the body
  bool ended_ = false;
  std::string fault_;
};

}  // namespace kerf
