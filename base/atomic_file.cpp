#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <system_error>
#include <thread>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr int kNameAttempts = 100;
/// Of the target's name in the temporary one, so that a name of the greatest length still works.
constexpr std::size_t kNameBytesKept = 200;

Error failure(const std::string& path, int error_number) {
  const std::string name = path == "-" ? tr("standard output") : path;
  return Error{trf("writing {}: {}", name, std::generic_category().message(error_number))};
}

/// ".NAME.XXXXXX" in the folder of `target`. open() is used instead of mkstemp() because that
/// creates files that only their owner can read.
std::string temporary_name(const std::string& target) {
  static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
  static thread_local std::minstd_rand random{std::random_device{}()};
  std::uniform_int_distribution<std::size_t> pick(0, sizeof kLetters - 2);
  const std::size_t slash = target.rfind('/');
  const std::size_t name = slash == std::string::npos ? 0 : slash + 1;
  std::string out = target.substr(0, name) + "." + target.substr(name, kNameBytesKept) + ".";
  for (int i = 0; i < 6; ++i) out += kLetters[pick(random)];
  return out;
}

/// The file that a chain of links leads to; `path` itself if it is no link, or one to nowhere.
std::string resolve_links(const std::string& path) {
  struct stat status;
  if (lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
  const std::unique_ptr<char, void (*)(void*)> resolved(realpath(path.c_str(), nullptr), std::free);
  return resolved ? std::string(resolved.get()) : path;
}

/// The descriptor of this process that a path names, or -1. Opening such a path anew would start at
/// the beginning of a file that the process is half way through, and renaming over it would leave
/// the descriptor with the old one.
int named_descriptor(const std::string& path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const char* folder : {"/dev/fd/", "/proc/self/fd/"}) {
    const std::size_t length = std::strlen(folder);
    if (path.compare(0, length, folder) != 0) continue;
    int fd = -1;
    const char* const end = path.data() + path.size();
    const auto [stop, error] = std::from_chars(path.data() + length, end, fd);
    if (error == std::errc() && stop == end && fd >= 0) return fd;
  }
  return -1;
}

/// Exists, and is neither a file nor a folder.
bool is_device(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool is_folder(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

/// Writes everything or returns errno.
int write_all(int fd, const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(fd, data, bytes);
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

/// Entries are never freed, only reused: a signal handler may be walking the list.
struct AtomicFile::Registration {
  enum State { kIdle, kPending, kRemoving, kRemoved };
  std::atomic<State> state{kIdle};
  std::atomic<bool> in_use{true};
  std::string path;  // not changed while pending or removing
  Registration* next = nullptr;

  static std::atomic<Registration*> head;
};

std::atomic<AtomicFile::Registration*> AtomicFile::Registration::head{nullptr};

AtomicFile::Registration* AtomicFile::enroll(const std::string& temporary_path) {
  Registration* entry = Registration::head.load();
  for (; entry != nullptr; entry = entry->next) {
    bool in_use = false;
    if (entry->in_use.compare_exchange_strong(in_use, true)) break;
  }
  if (entry == nullptr) {
    entry = new Registration;
    entry->next = Registration::head.load();
    while (!Registration::head.compare_exchange_weak(entry->next, entry)) {
    }
  }
  entry->path = temporary_path;
  entry->state = Registration::kPending;
  return entry;
}

/// The temporary file is no longer there.
void AtomicFile::release() {
  Registration::State state = Registration::kPending;
  if (!registration_->state.compare_exchange_strong(state, Registration::kIdle)) {
    // Another thread is between the two steps of remove_uncommitted_files().
    while (registration_->state == Registration::kRemoving) std::this_thread::yield();
  }
  std::exchange(registration_, nullptr)->in_use = false;
}

void remove_uncommitted_files() {
  using Registration = AtomicFile::Registration;
  for (Registration* entry = Registration::head; entry != nullptr; entry = entry->next) {
    Registration::State state = Registration::kPending;
    if (!entry->state.compare_exchange_strong(state, Registration::kRemoving)) continue;
    unlink(entry->path.c_str());
    entry->state = Registration::kRemoved;
  }
}

Done write_text(const std::string& path, const std::string& text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  file->write(text.data(), text.size());
  return file->commit();
}

bool written_as_it_comes(const std::string& path) {
  return named_descriptor(path) >= 0 || is_device(path);
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  if (path.empty()) return Error{tr("no file name given to write to")};
  AtomicFile file;
  file.path_ = path;
  if (written_as_it_comes(path)) {
    const int fd = named_descriptor(path);
    file.fd_ = fd >= 0 ? fcntl(fd, F_DUPFD_CLOEXEC, 0) : open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file.fd_ < 0) return failure(path, errno);
    file.buffer_.reserve(kBufferBytes);
    return file;
  }
  if (path.back() == '/' || is_folder(path)) return failure(path, EISDIR);
  file.target_path_ = resolve_links(path);
  for (int attempt = 0; attempt < kNameAttempts && file.fd_ < 0; ++attempt) {
    file.temporary_path_ = temporary_name(file.target_path_);
    file.fd_ = open(file.temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file.fd_ < 0 && errno != EEXIST) break;
  }
  if (file.fd_ < 0) {
    file.temporary_path_.clear();  // not ours to remove
    return failure(path, errno);
  }
  file.registration_ = enroll(file.temporary_path_);
  file.buffer_.reserve(kBufferBytes);
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept { *this = std::move(other); }

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  path_ = std::move(other.path_);
  target_path_ = std::move(other.target_path_);
  temporary_path_ = std::move(other.temporary_path_);
  buffer_ = std::move(other.buffer_);
  registration_ = std::exchange(other.registration_, nullptr);
  fd_ = std::exchange(other.fd_, -1);
  error_number_ = other.error_number_;
  return *this;
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() {
  if (fd_ >= 0) close(std::exchange(fd_, -1));
  if (registration_ == nullptr) return;
  if (registration_->state == Registration::kPending) unlink(temporary_path_.c_str());
  release();
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  assert(fd_ >= 0);
  const char* const from = static_cast<const char*>(data);
  if (buffer_.size() + bytes > kBufferBytes) flush();
  if (bytes >= kBufferBytes) {
    if (error_number_ == 0) error_number_ = write_all(fd_, from, bytes);
  } else {
    buffer_.append(from, bytes);
  }
}

void AtomicFile::flush() {
  if (error_number_ == 0) error_number_ = write_all(fd_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

Result<std::string> AtomicFile::readable_path() {
  assert(fd_ >= 0 && !temporary_path_.empty());
  flush();
  if (error_number_ != 0) return failure(path_, error_number_);
  return temporary_path_;
}

Done AtomicFile::commit() {
  assert(fd_ >= 0);
  flush();
  // A full disk of a network file system may be reported only here.
  if (close(std::exchange(fd_, -1)) != 0 && error_number_ == 0) error_number_ = errno;
  if (error_number_ == 0 && registration_ != nullptr) {
    if (rename(temporary_path_.c_str(), target_path_.c_str()) == 0) {
      release();
    } else {
      const int why = errno;
      const bool removed = registration_->state != Registration::kPending;
      error_number_ = removed ? ECANCELED : why;  // by remove_uncommitted_files()
    }
  }
  discard();
  if (error_number_ != 0) return failure(path_, error_number_);
  return std::monostate{};
}

}  // namespace kerf
