#define XXH_INLINE_ALL
#include "interp_bridge/record_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace kerf {

class ContentsHasher {
 public:
  ContentsHasher() { XXH3_128bits_reset(&state_); }
  void add(const void* data, std::size_t bytes) { XXH3_128bits_update(&state_, data, bytes); }
  std::array<std::uint64_t, 2> value() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return {hash.low64, hash.high64};
  }

 private:
  XXH3_state_t state_;
};

namespace {

namespace fs = std::filesystem;
using Hash = std::array<std::uint64_t, 2>;

constexpr std::string_view kMagic = "kerfmem1";
constexpr std::string_view kEnding = ".records";
constexpr std::size_t kPieceBytes = std::size_t{256} * 1024;
constexpr std::size_t kTrailerBytes = 4 * sizeof(std::uint64_t);
/// Rows of files and keys are short: what claims more is none of ours.
constexpr std::uint64_t kMostHeadBytes = std::uint64_t{64} << 20;
/// One entry may not push out all others.
constexpr std::uint64_t kLargestShare = 4;
/// Clocks of file systems are this coarse: what changed so shortly before a run may change again
/// without a sign.
constexpr std::int64_t kClockTick_ns = 20'000'000;
constexpr std::int64_t kLeftBehind_ns = 3'600'000'000'000;
/// Each is looked at when another comes, which takes a microsecond or two.
constexpr std::size_t kMostEntries = 1000;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// All of `bytes`, or false.
bool read_at(int fd, std::uint64_t at, void* data, std::size_t bytes) {
  auto* to = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t got = pread(fd, to, bytes, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    at += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

std::optional<Hash> hash_of(int fd, std::uint64_t bytes) {
  ContentsHasher hasher;
  std::vector<char> piece(std::min<std::uint64_t>(bytes, kPieceBytes));
  for (std::uint64_t at = 0; at < bytes;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes - at, piece.size()));
    if (!read_at(fd, at, piece.data(), part)) return std::nullopt;
    hasher.add(piece.data(), part);
    at += part;
  }
  return hasher.value();
}

std::int64_t ns_of(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

void append(std::string& out, const void* data, std::size_t bytes) {
  out.append(static_cast<const char*>(data), bytes);
}

/// Takes numbers and texts off the front of bytes; false when they do not suffice.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}
  template <typename T>
  bool take(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }
  bool take(std::string& text, std::uint64_t bytes) {
    if (rest_.size() < bytes) return false;
    text = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return true;
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

bool are_in_force(std::string_view rows) {
  Taker taker(rows);
  while (!taker.empty()) {
    std::uint8_t found = 0;
    FileContents then;
    std::uint64_t path_bytes = 0;
    std::string path;
    if (!taker.take(found) || !taker.take(then.size) || !taker.take(then.hash) ||
        !taker.take(path_bytes) || !taker.take(path, path_bytes)) {
      return false;
    }
    const std::optional<FileContents> now = contents_of(path);
    if (found != 0 ? now != then : access(path.c_str(), F_OK) == 0) return false;
  }
  return true;
}

/// Nothing: it cannot be told that it has not changed since `begun_ns`.
std::optional<std::string> row_of(const FileRead& read, std::int64_t begun_ns) {
  FileContents contents;
  if (read.found) {
    struct stat info {};
    const std::optional<FileContents> now = contents_of(read.path);
    if (!now || stat(read.path.c_str(), &info) != 0) return std::nullopt;
    const std::int64_t changed_ns = std::max(ns_of(info.st_mtim), ns_of(info.st_ctim));
    if (changed_ns > begun_ns - kClockTick_ns) return std::nullopt;
    contents = *now;
  } else if (access(read.path.c_str(), F_OK) == 0) {
    return std::nullopt;
  }
  std::string row;
  const std::uint8_t found = read.found ? 1 : 0;
  const std::uint64_t path_bytes = read.path.size();
  append(row, &found, sizeof found);
  append(row, &contents.size, sizeof contents.size);
  append(row, &contents.hash, sizeof contents.hash);
  append(row, &path_bytes, sizeof path_bytes);
  return row + read.path;
}

/// Removes the entries that were used longest ago, and what writers that were killed have left.
void tidy(const std::string& folder, std::uint64_t most_bytes) {
  struct Entry {
    std::int64_t used_ns;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code error;
  timespec clock{};
  clock_gettime(CLOCK_REALTIME, &clock);
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    struct stat info {};
    if (name.find(kEnding) == name.npos || lstat(at->path().c_str(), &info) != 0 ||
        !S_ISREG(info.st_mode)) {
      continue;
    }
    const std::int64_t used_ns = ns_of(info.st_mtim);
    if (name.front() == '.') {
      std::error_code gone;
      if (ns_of(clock) - used_ns > kLeftBehind_ns) fs::remove(at->path(), gone);
      continue;
    }
    entries.push_back({used_ns, static_cast<std::uint64_t>(info.st_size), at->path()});
    total += entries.back().bytes;
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.used_ns < b.used_ns; });
  std::size_t left = entries.size();
  for (const Entry& entry : entries) {
    if (total <= most_bytes && left <= kMostEntries) break;
    std::error_code gone;
    fs::remove(entry.path, gone);
    total -= entry.bytes;
    --left;
  }
}

/// Its owner is this user, and others cannot write to it.
bool is_own(const struct stat& info, mode_t others = S_IWGRP | S_IWOTH) {
  return info.st_uid == geteuid() && (info.st_mode & others) == 0;
}

bool make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(fs::path(folder).parent_path(), error);
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) return false;
  struct stat info {};
  return stat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && is_own(info);
}

}  // namespace

std::optional<FileContents> contents_of(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (file.get() < 0 || fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode)) {
    return std::nullopt;
  }
  const auto size = static_cast<std::uint64_t>(info.st_size);
  const std::optional<Hash> hash = hash_of(file.get(), size);
  if (!hash) return std::nullopt;
  return FileContents{size, *hash};
}

std::string record_cache_folder() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  // A relative one is to be ignored, says the specification.
  if (cache != nullptr && *cache == '/') return std::string(cache) + "/kerf/interp";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return std::string(home) + "/.cache/kerf/interp";
  return {};
}

CachedRecords::CachedRecords(CachedRecords&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), at_(other.at_), end_(other.end_) {}

CachedRecords& CachedRecords::operator=(CachedRecords&& other) noexcept {
  std::swap(fd_, other.fd_);
  at_ = other.at_;
  end_ = other.end_;
  return *this;
}

CachedRecords::~CachedRecords() {
  if (fd_ >= 0) close(fd_);
}

std::size_t CachedRecords::read(std::span<char> room) {
  const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(room.size(), end_ - at_));
  if (!read_at(fd_, at_, room.data(), bytes)) return 0;
  at_ += bytes;
  return bytes;
}

RecordStore::RecordStore(AtomicFile file, std::string folder, std::uint64_t most_bytes)
    : file_(std::move(file)),
      folder_(std::move(folder)),
      most_bytes_(most_bytes),
      hash_(std::make_unique<ContentsHasher>()) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  begun_ns_ = ns_of(now);
}

RecordStore::RecordStore(RecordStore&& other) noexcept = default;
RecordStore& RecordStore::operator=(RecordStore&&) noexcept = default;
RecordStore::~RecordStore() = default;

void RecordStore::put(const void* data, std::size_t bytes) {
  hash_->add(data, bytes);
  file_.write(data, bytes);
}

void RecordStore::write(std::span<const char> records) {
  records_bytes_ += records.size();
  if (records_bytes_ <= most_bytes_ / kLargestShare) put(records.data(), records.size());
}

void RecordStore::commit(const std::vector<FileRead>& reads) {
  if (records_bytes_ > most_bytes_ / kLargestShare) return;
  std::string rows;
  for (const FileRead& read : reads) {
    const std::optional<std::string> row = row_of(read, begun_ns_);
    if (!row) return;
    rows += *row;
  }
  const std::uint64_t rows_bytes = rows.size();
  put(rows.data(), rows.size());
  put(&records_bytes_, sizeof records_bytes_);
  put(&rows_bytes, sizeof rows_bytes);
  const Hash hash = hash_->value();
  file_.write(&hash, sizeof hash);
  if (!file_.failed() && file_.commit()) tidy(folder_, most_bytes_);
}

std::string RecordCache::path_of(std::string_view key) const {
  ContentsHasher hasher;
  hasher.add(key.data(), key.size());
  const Hash hash = hasher.value();
  return fmt::format("{}/{:016x}{:016x}{}", folder_, hash[1], hash[0], kEnding);
}

std::optional<CachedRecords> RecordCache::find(std::string_view key) const {
  Descriptor file(open(path_of(key).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat info {};
  if (file.get() < 0 || fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) ||
      !is_own(info, S_IWOTH)) {
    return std::nullopt;
  }
  const std::uint64_t head_bytes = kMagic.size() + sizeof(std::uint64_t) + key.size();
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size < head_bytes + kTrailerBytes) return std::nullopt;
  std::string head(head_bytes, '\0');
  struct {
    std::uint64_t records_bytes = 0, rows_bytes = 0;
    Hash hash{};
  } trailer;
  static_assert(sizeof trailer == kTrailerBytes);
  if (!read_at(file.get(), 0, head.data(), head.size()) ||
      !read_at(file.get(), size - kTrailerBytes, &trailer, sizeof trailer)) {
    return std::nullopt;
  }
  const std::uint64_t key_bytes = key.size();
  std::string expected(kMagic);
  append(expected, &key_bytes, sizeof key_bytes);
  expected += key;
  const std::uint64_t rest = size - kTrailerBytes - head_bytes;
  if (head != expected || trailer.rows_bytes > std::min(rest, kMostHeadBytes) ||
      trailer.records_bytes != rest - trailer.rows_bytes ||
      hash_of(file.get(), size - sizeof(Hash)) != trailer.hash) {
    return std::nullopt;
  }
  std::string rows(trailer.rows_bytes, '\0');
  if (!read_at(file.get(), head_bytes + trailer.records_bytes, rows.data(), rows.size()) ||
      !are_in_force(rows)) {
    return std::nullopt;
  }
  futimens(file.get(), nullptr);  // used now
  return CachedRecords(file.release(), head_bytes, trailer.records_bytes);
}

std::optional<RecordStore> RecordCache::begin(std::string_view key) const {
  if (!make_folder(folder_)) return std::nullopt;
  Result<AtomicFile> file = AtomicFile::create(path_of(key));
  if (!file) return std::nullopt;
  RecordStore store(std::move(*file), folder_, most_bytes_);
  const std::uint64_t key_bytes = key.size();
  store.put(kMagic.data(), kMagic.size());
  store.put(&key_bytes, sizeof key_bytes);
  store.put(key.data(), key.size());
  return store;
}

}  // namespace kerf
