// interp_bridge/record_cache.h - records of programs that were interpreted before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/atomic_file.h"

namespace kerf {

class ContentsHasher;

/// Size and hash of a file's contents.
struct FileContents {
  std::uint64_t size = 0;
  std::array<std::uint64_t, 2> hash{};
  bool operator==(const FileContents&) const = default;
};
/// Nothing: it is no regular file, or cannot be read. Reads all of it, about 5 GB/s.
std::optional<FileContents> contents_of(const std::string& path);

/// A file that the interpreter has opened, or has looked for in vain.
struct FileRead {
  std::string path;  ///< absolute
  bool found = false;
};

/// Where records are kept if nothing else is said: $XDG_CACHE_HOME/kerf/interp, or
/// ~/.cache/kerf/interp. Empty: neither is known.
std::string record_cache_folder();

/// An entry that has been found whole and in force; its records, in order.
class CachedRecords {
 public:
  CachedRecords(CachedRecords&& other) noexcept;
  CachedRecords& operator=(CachedRecords&& other) noexcept;
  ~CachedRecords();
  /// Bytes put into `room`; 0 at the end.
  std::size_t read(std::span<char> room);

 private:
  friend class RecordCache;
  CachedRecords(int fd, std::uint64_t from, std::uint64_t bytes)
      : fd_(fd), at_(from), end_(from + bytes) {}
  int fd_;
  std::uint64_t at_, end_;
};

/// An entry that is being written; without commit() nothing is left of it.
class RecordStore {
 public:
  RecordStore(RecordStore&& other) noexcept;
  RecordStore& operator=(RecordStore&&) noexcept;
  ~RecordStore();
  void write(std::span<const char> records);
  /// `reads`: what the records hang on besides the key. Left undone if one of these files has
  /// changed since the run began, or if the entry is larger than a quarter of the cache.
  void commit(const std::vector<FileRead>& reads);

 private:
  friend class RecordCache;
  RecordStore(AtomicFile file, std::string folder, std::uint64_t most_bytes);
  void put(const void* data, std::size_t bytes);

  AtomicFile file_;
  std::string folder_;
  std::uint64_t most_bytes_;
  std::uint64_t records_bytes_ = 0;
  std::int64_t begun_ns_;
  std::unique_ptr<ContentsHasher> hash_;
};

/// A folder of entries, one a file, named by a hash of the key. What makes an entry count: it
/// belongs to this user, in a folder that nobody else may write to, its last bytes are the hash of
/// all others, it has the very key, and each file that it hangs on has the contents that it had (or
/// is missing still). Anything else is as if there were no entry; so are files that cannot be read,
/// a full disk, a folder that cannot be made. An entry appears whole, by renaming; several
/// processes may use a folder at once. Those that were used longest ago go first when there are too
/// many bytes.
///
///     "kerfmem1", u64 bytes of the key, key, records, rows of files (u8 found, u64 size, 2 x u64
///     hash, u64 bytes of the path, path), u64 bytes of the records, u64 bytes of the rows, 2 x u64
///     hash (XXH3, 128 bits). In the byte order of the machine.
class RecordCache {
 public:
  RecordCache(std::string folder, std::uint64_t most_bytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}
  std::optional<CachedRecords> find(std::string_view key) const;
  /// Nothing: the folder cannot be used.
  std::optional<RecordStore> begin(std::string_view key) const;

 private:
  std::string path_of(std::string_view key) const;
  std::string folder_;
  std::uint64_t most_bytes_;
};

}  // namespace kerf
