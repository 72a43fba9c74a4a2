// Where the interpreter opens files: it may read any, and write beside its parameters only. An
// INI's LOG_FILE would otherwise be written, which is the log of the machine that runs on it.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <string_view>

#include "interp_bridge/kerf_interp/recording.h"

namespace {

bool beside_parameters(std::string_view path) {
  const std::string& parameters = kerf::interp::recording().world.parameter_file;
  const std::string_view folder =
      std::string_view(parameters).substr(0, parameters.find_last_of('/') + 1);
  return !folder.empty() && path.substr(0, folder.size()) == folder &&
         path.find('/', folder.size()) == path.npos;
}

FILE* open_guarded(const char* path, std::string_view mode) {
  const bool both = mode.find('+') != mode.npos;
  const bool writes = both || mode.front() != 'r';
  int flags = both ? O_RDWR : writes ? O_WRONLY : O_RDONLY;
  if (mode.front() == 'w') flags |= O_CREAT | O_TRUNC;
  if (mode.front() == 'a') flags |= O_CREAT | O_APPEND;
  if (writes && !beside_parameters(path)) path = "/dev/null";
  const int fd = ::open(path, flags | O_CLOEXEC, 0666);
  if (fd < 0) return nullptr;
  FILE* const file = fdopen(fd, std::string(mode).c_str());
  if (file == nullptr) close(fd);
  return file;
}

}  // namespace

extern "C" {
/// Found by librs274 before those of the C library.
FILE* fopen(const char* path, const char* mode) { return open_guarded(path, mode); }
FILE* fopen64(const char* path, const char* mode) { return open_guarded(path, mode); }
}
