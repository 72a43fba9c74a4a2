// interp_bridge/private_folder.h - a folder that exists as long as its owner.
#pragma once

#include <string>

#include "base/result.h"

namespace kerf {

/// "kerf-XXXXXX" under TMPDIR (or /tmp), for this user alone (mode 0700); removed with all it holds
/// by the destructor. Holds what rs274 would otherwise write into the home directory (.tool.mmap,
/// shared with a running LinuxCNC).
class PrivateFolder {
 public:
  /// Error: "cannot make a folder under /tmp: No space left on device".
  static Result<PrivateFolder> create();
  PrivateFolder(PrivateFolder&& other) noexcept;
  PrivateFolder& operator=(PrivateFolder&& other) noexcept;
  ~PrivateFolder();

  const std::string& path() const { return path_; }

 private:
  explicit PrivateFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;  ///< empty after a move
};

/// Those of all that live, with all they hold: for the way out while they are still in use. Any
/// thread; not from a signal handler.
void remove_private_folders();

}  // namespace kerf
