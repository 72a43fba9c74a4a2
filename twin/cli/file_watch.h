// twin/cli/file_watch.h - whether files have been changed by somebody else.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kerf {

/// Looks at a few files now and then. Files that are gone count as unchanged until they are there
/// again: editors write a new file in place of the old one.
class FileWatch {
 public:
  /// Between two looks; a change is told after two of them that see the same.
  static constexpr std::chrono::milliseconds kPeriod{200};

  /// Forgets all files.
  void clear() { files_.clear(); }
  /// Watches a file from now on; of one that is watched already the older state counts. Names that
  /// are empty or "-" are not watched.
  void add(const std::string& path);

  /// One of the files is another one now than when it was added, whoever writes to it.
  bool differs() const;
  /// One of the files is another one than when it was added, and nobody has written to it since the
  /// last look. Costs nothing between the looks, some microseconds a file at each.
  bool has_changed();

 private:
  using Clock = std::chrono::steady_clock;
  struct Stamp {
    bool is_there = false;
    std::filesystem::file_time_type written{};
    std::uintmax_t bytes = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct File {
    std::string path;
    Stamp first, last;
  };
  static Stamp stamp_of(const std::string& path);

  std::vector<File> files_;
  Clock::time_point next_look_{};
};

}  // namespace kerf
