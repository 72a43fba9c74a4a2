#include "machine_io/mtconnect/multipart.h"

#include "base/text_scan.h"
#include "base/translate.h"
#include "machine_io/mtconnect/xml_tree.h"

namespace kerf {
namespace {

constexpr std::size_t kMostHead_bytes = 4096;

/// The end of the head lines, and where the body begins: an empty line, of either kind.
std::size_t end_of_head(std::string_view text, std::size_t& body) {
  const std::size_t dos = text.find("\r\n\r\n");
  const std::size_t unix = text.find("\n\n");
  const std::size_t end = std::min(dos, unix);
  if (end != text.npos) body = end + (end == dos ? 4 : 2);
  return end;
}

}  // namespace

std::optional<std::string> MultipartReader::boundary_of(std::string_view content_type) {
  const std::string lower = to_lower(content_type);
  if (!lower.starts_with("multipart/")) return std::nullopt;
  const std::size_t at = lower.find("boundary=");
  if (at == lower.npos) return std::nullopt;
  std::string_view value = content_type.substr(at + 9);
  value = trim(value.substr(0, value.find(';')));
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
    value = value.substr(1, value.size() - 2);
  }
  // 70 is RFC 2046's.
  if (value.empty() || value.size() > 70) return std::nullopt;
  return std::string(value);
}

/// True: the body of a part begins the bytes.
bool MultipartReader::read_head() {
  const std::size_t mark = bytes_.find(mark_);
  if (mark == bytes_.npos) {
    if (bytes_.size() > kMostHead_bytes) fault_ = tr("no boundary between the parts of the stream");
    return false;
  }
  std::string_view head = std::string_view(bytes_).substr(mark + mark_.size());
  if (head.starts_with("--")) {
    ended_ = true;
    return false;
  }
  std::size_t body = 0;
  const std::size_t end = end_of_head(head, body);
  if (end == head.npos) {
    if (head.size() > kMostHead_bytes) fault_ = tr("a part of the stream has an endless head");
    return false;
  }
  const std::size_t begins = mark + mark_.size() + body;
  head = head.substr(0, end);
  length_.reset();
  while (!head.empty()) {
    std::string_view line = trim(take_line(head));
    constexpr std::string_view kLength = "content-length:";
    if (!to_lower(line.substr(0, kLength.size())).starts_with(kLength)) continue;
    std::size_t length = 0;
    if (!read_number(trim(line.substr(kLength.size())), length) || length > kMostXml_bytes) {
      fault_ = trf("a part of the stream says '{}'; up to {} bytes are allowed",
                   std::string(line.substr(0, 60)), kMostXml_bytes);
      return false;
    }
    length_ = length;
  }
  bytes_.erase(0, begins);
  in_body_ = true;
  return true;
}

std::optional<std::string> MultipartReader::take(std::size_t length) {
  std::string part = bytes_.substr(0, length);
  bytes_.erase(0, length);
  in_body_ = false;
  return part;
}

std::optional<std::string> MultipartReader::next() {
  if (ended_ || !fault_.empty()) return std::nullopt;
  if (!in_body_ && !read_head()) return std::nullopt;
  if (length_) return bytes_.size() >= *length_ ? take(*length_) : std::nullopt;
  const std::size_t mark = bytes_.find(mark_);
  if (mark != bytes_.npos) return take(mark);
  if (bytes_.size() > kMostXml_bytes) {
    fault_ = trf("a part of the stream is longer than {} bytes", kMostXml_bytes);
  }
  return std::nullopt;
}

}  // namespace kerf
