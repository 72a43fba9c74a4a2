#include "base/small_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <istream>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::size_t kPieceBytes = 256 * 1024;

/// What the system says now.
Error unreadable(const std::string& path) {
  return Error{trf("cannot read {}: {}", path, std::strerror(errno))};
}

/// Adds up to a piece; false at the end.
Result<bool> read_piece(int fd, const std::string& path, std::string& text) {
  const std::size_t before = text.size();
  text.resize(before + kPieceBytes);
  ssize_t got = 0;
  do {
    got = read(fd, text.data() + before, kPieceBytes);
  } while (got < 0 && errno == EINTR);
  text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  if (got < 0) return unreadable(path);
  return got > 0;
}

}  // namespace

Result<std::string> read_small_file(const std::string& path, std::size_t max_bytes,
                                    const std::string& larger) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return unreadable(path);
  if (!S_ISREG(status.st_mode)) {
    return Error{trf("cannot read {}: it is not a regular file", path)};
  }
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return unreadable(path);
  std::string text;
  Result<bool> more = true;
  while (more && *more && text.size() <= max_bytes) more = read_piece(fd, path, text);
  close(fd);
  if (!more) return Error{more.error()};
  if (text.size() <= max_bytes) return text;
  if (!larger.empty()) return Error{larger};
  return Error{trf("cannot read {}: larger than {} MB", path, max_bytes / (1024 * 1024))};
}

std::string read_up_to(std::istream& in, std::size_t most) {
  std::string text(most, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return text;
}

}  // namespace kerf
