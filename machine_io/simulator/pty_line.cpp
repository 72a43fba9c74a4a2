#include "machine_io/simulator/pty_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

Error system_error_of(const std::string& what) {
  return Error{fmt::format("{}: {}", what, std::strerror(errno))};
}

bool leads_to(const std::string& link, const std::string& device) {
  std::array<char, 256> target{};
  const ssize_t length = readlink(link.c_str(), target.data(), target.size());
  return length >= 0 && device == std::string(target.data(), static_cast<std::size_t>(length));
}

/// Under another name first, so that a client finds the old link or the new one, never none.
Done make_link(const std::string& link, const std::string& device) {
  struct stat found = {};
  if (lstat(link.c_str(), &found) == 0 && !S_ISLNK(found.st_mode)) {
    return Error{trf("{} exists and is no symbolic link", link)};
  }
  const std::string temporary = fmt::format("{}.{}.new", link, getpid());
  unlink(temporary.c_str());
  if (symlink(device.c_str(), temporary.c_str()) != 0) {
    return system_error_of(tr("making the link ") + link);
  }
  if (rename(temporary.c_str(), link.c_str()) != 0) {
    const Error error = system_error_of(tr("making the link ") + link);
    unlink(temporary.c_str());
    return error;
  }
  return std::monostate{};
}

}  // namespace

Result<PtyLine> PtyLine::open(const std::string& link) {
  PtyLine line;
  line.master_fd_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 128> name{};
  if (line.master_fd_ < 0 || grantpt(line.master_fd_) != 0 || unlockpt(line.master_fd_) != 0 ||
      ptsname_r(line.master_fd_, name.data(), name.size()) != 0) {
    return system_error_of(tr("opening a pseudo terminal"));
  }
  line.device_ = name.data();
  line.slave_fd_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios mode = {};
  if (line.slave_fd_ < 0 || tcgetattr(line.slave_fd_, &mode) != 0) {
    return system_error_of(trf("opening {}", line.device_));
  }
  cfmakeraw(&mode);
  if (tcsetattr(line.slave_fd_, TCSANOW, &mode) != 0) {
    return system_error_of(trf("setting up {}", line.device_));
  }
  if (!link.empty()) {
    if (const Done made = make_link(link, line.device_); !made) return Error{made.error()};
    line.link_ = link;
  }
  return line;
}

PtyLine::PtyLine(PtyLine&& other) noexcept { *this = std::move(other); }

PtyLine& PtyLine::operator=(PtyLine&& other) noexcept {
  if (this == &other) return *this;
  release();
  master_fd_ = std::exchange(other.master_fd_, -1);
  slave_fd_ = std::exchange(other.slave_fd_, -1);
  device_ = std::exchange(other.device_, {});
  link_ = std::exchange(other.link_, {});
  return *this;
}

PtyLine::~PtyLine() { release(); }

void PtyLine::release() {
  if (!link_.empty() && leads_to(link_, device_)) unlink(link_.c_str());
  if (slave_fd_ >= 0) close(slave_fd_);
  if (master_fd_ >= 0) close(master_fd_);
}

}  // namespace kerf
