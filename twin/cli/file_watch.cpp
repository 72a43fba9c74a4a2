#include "twin/cli/file_watch.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace kerf {

FileWatch::Stamp FileWatch::stamp_of(const std::string& path) {
  std::error_code error;
  Stamp stamp;
  stamp.written = std::filesystem::last_write_time(path, error);
  if (error) return {};
  stamp.bytes = std::filesystem::file_size(path, error);
  if (error) return {};
  stamp.is_there = true;
  return stamp;
}

void FileWatch::add(const std::string& path) {
  if (path.empty() || path == "-") return;
  const auto is_it = [&](const File& file) { return file.path == path; };
  if (std::any_of(files_.begin(), files_.end(), is_it)) return;
  const Stamp now = stamp_of(path);
  files_.push_back({path, now, now});
}

bool FileWatch::differs() const {
  return std::any_of(files_.begin(), files_.end(), [](const File& file) {
    const Stamp stamp = stamp_of(file.path);
    return stamp.is_there && stamp != file.first;
  });
}

bool FileWatch::has_changed() {
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return false;
  next_look_ = now + kPeriod;
  bool has_changed = false, is_quiet = true;
  for (File& file : files_) {
    const Stamp stamp = stamp_of(file.path);
    if (stamp != std::exchange(file.last, stamp)) is_quiet = false;
    if (stamp.is_there && stamp != file.first) has_changed = true;
  }
  return has_changed && is_quiet;
}

}  // namespace kerf
