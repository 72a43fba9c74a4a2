// base/atomic_file.h - a file that appears whole or not at all.
#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace kerf {

/// Writes to `path` under a temporary name (".NAME.XXXXXX" beside it), and renames on commit().
/// The destructor removes what was not committed; so does remove_uncommitted_files(). A symbolic
/// link stays, and the file that it leads to is replaced. What written_as_it_comes() names is
/// written as the bytes come. Buffered (1 MB). Does not sync: whole after a crash of kerf, not
/// after a power cut. Not for several threads at once.
class AtomicFile {
 public:
  /// Error: "writing out/part.stl: No such file or directory", "writing out: Is a directory".
  static Result<AtomicFile> create(const std::string& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  /// Errors are kept and reported by commit().
  void write(const void* data, std::size_t bytes);
  /// Something was not written; commit() will say what.
  bool failed() const { return error_number_ != 0; }
  /// Where all that was written can be read before commit(), to be looked at first. Error: as of
  /// commit(). Not of what is written as it comes.
  Result<std::string> readable_path();
  /// Flushes, closes, renames. Error: "writing part.stl: No space left on device"; the temporary
  /// file is then gone, and a file that was there before is untouched. Once per file.
  Done commit();

 private:
  struct Registration;  // one entry of the list that remove_uncommitted_files() walks
  AtomicFile() = default;
  static Registration* enroll(const std::string& temporary_path);
  void release();
  void flush();
  void discard();
  friend void remove_uncommitted_files();

  std::string path_;            // as the caller wrote it, for messages
  std::string target_path_;     // where links lead to; empty if written as it comes
  std::string temporary_path_;  // empty if written as it comes
  Registration* registration_ = nullptr;
  int fd_ = -1;
  int error_number_ = 0;
  std::string buffer_;
};

/// A file of text that appears whole or not at all. Error: what could not be written.
Done write_text(const std::string& path, const std::string& text);

/// True for what cannot be replaced under its name: "-" (stdout), what this process has open
/// already
/// (/dev/stdout, /dev/stderr, /dev/fd/N, /proc/self/fd/N: whatever they lead to, a file too),
/// devices and pipes.
bool written_as_it_comes(const std::string& path);

/// Removes the temporary files of all AtomicFiles of this process that are neither committed nor
/// destroyed; their commit() then reports an error. For the way out after Ctrl-C: may be called
/// from any thread and from a signal handler (uses lock-free atomics and unlink() alone).
void remove_uncommitted_files();

}  // namespace kerf
