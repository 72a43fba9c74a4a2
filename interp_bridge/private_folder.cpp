#include "interp_bridge/private_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

std::mutex g_living_mutex;
/// Never destroyed: threads may still end when the process does.
std::set<std::string>& living() {
  static auto* const paths = new std::set<std::string>;
  return *paths;
}

}  // namespace

Result<PrivateFolder> PrivateFolder::create() {
  const char* const tmpdir = std::getenv("TMPDIR");
  std::error_code failed;
  const std::string parent =
      std::filesystem::absolute(tmpdir != nullptr && *tmpdir != 0 ? tmpdir : "/tmp", failed)
          .string();
  std::string path = parent + "/kerf-XXXXXX";
  if (mkdtemp(path.data()) == nullptr) {
    return Error{trf("cannot make a folder under {}: {}", parent, std::strerror(errno))};
  }
  const std::lock_guard lock(g_living_mutex);
  living().insert(path);
  return PrivateFolder(std::move(path));
}

PrivateFolder::PrivateFolder(PrivateFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

PrivateFolder& PrivateFolder::operator=(PrivateFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

PrivateFolder::~PrivateFolder() {
  if (path_.empty()) return;
  std::error_code ignored;  // nobody is left to be told
  std::filesystem::remove_all(path_, ignored);
  const std::lock_guard lock(g_living_mutex);
  living().erase(path_);
}

void remove_private_folders() {
  const std::lock_guard lock(g_living_mutex);
  for (const std::string& path : living()) {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
}

}  // namespace kerf
