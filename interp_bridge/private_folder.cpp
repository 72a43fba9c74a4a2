#include "interp_bridge/private_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace kerf {

Result<PrivateFolder> PrivateFolder::create() {
  const char* const tmpdir = std::getenv("TMPDIR");
  std::error_code failed;
  const std::string parent =
      std::filesystem::absolute(tmpdir != nullptr && *tmpdir != 0 ? tmpdir : "/tmp", failed)
          .string();
  std::string path = parent + "/kerf-XXXXXX";
  if (mkdtemp(path.data()) == nullptr) {
    return Error{fmt::format("cannot make a folder under {}: {}", parent, std::strerror(errno))};
  }
  return PrivateFolder(std::move(path));
}

PrivateFolder::PrivateFolder(PrivateFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

PrivateFolder& PrivateFolder::operator=(PrivateFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;  // nobody is left to be told
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace kerf
