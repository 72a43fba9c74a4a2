// base/atomic_file.h - a file that appears whole or not at all.
#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace kerf {

/// Writes to `path` under a temporary name (".NAME.XXXXXX" beside it), and renames on commit(). The destructor removes
/// what was not committed; so does remove_uncommitted_files() from a signal-driven exit. "-" is stdout and is written as
/// it comes. Buffered (1 MB). Not for several threads at once.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::string& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  /// Errors are kept and reported by commit().
  void write(const void* data, std::size_t bytes);
  /// Flushes, closes, renames. Error: "writing part.stl: No space left on device"; the temporary file is then gone.
  Done commit();

 private:
  AtomicFile() = default;
  std::string path_;
  std::string temporary_path_;
  int fd_ = -1;
  int error_number_ = 0;
  std::string buffer_;
};

}  // namespace kerf
