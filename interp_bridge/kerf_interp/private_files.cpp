// Where the interpreter opens files: it may read any, and write beside its parameters only. An
// INI's LOG_FILE would otherwise be written, which is the log of the machine that runs on it.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "interp_bridge/kerf_interp/reads.h"
#include "interp_bridge/kerf_interp/recording.h"

namespace {

bool beside_parameters(std::string_view path) {
  const std::string& parameters = kerf::interp::recording().world.parameter_file;
  const std::string_view folder =
      std::string_view(parameters).substr(0, parameters.find_last_of('/') + 1);
  return !folder.empty() && path.substr(0, folder.size()) == folder &&
         path.find('/', folder.size()) == path.npos;
}

/// Python lists its own folders.
bool asks_interpreter(const void* return_address) {
  Dl_info caller{};
  return dladdr(return_address, &caller) == 0 ||
         std::string_view(caller.dli_fname).find("rs274") != std::string_view::npos;
}

FILE* open_guarded(const char* path, std::string_view mode) {
  const bool both = mode.find('+') != mode.npos;
  const bool writes = both || mode.front() != 'r';
  int flags = both ? O_RDWR : writes ? O_WRONLY : O_RDONLY;
  if (mode.front() == 'w') flags |= O_CREAT | O_TRUNC;
  if (mode.front() == 'a') flags |= O_CREAT | O_APPEND;
  if (writes && !beside_parameters(path)) path = "/dev/null";
  const int fd = ::open(path, flags | O_CLOEXEC, 0666);
  if (!writes || both) kerf::interp::note_read(path, fd >= 0);
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
/// Neither is held back, but what is seen by them must be known.
int access(const char* path, int mode) {
  const int result = faccessat(AT_FDCWD, path, mode, 0);
  kerf::interp::note_read(path, result == 0);
  return result;
}
[[gnu::noinline]] DIR* opendir(const char* path) {
  using Open = DIR* (*)(const char*);
  static Open real = nullptr;
  if (real == nullptr) {
    void* const found = dlsym(RTLD_NEXT, "opendir");
    if (found == nullptr) std::abort();
    std::memcpy(&real, &found, sizeof real);
  }
  if (asks_interpreter(__builtin_return_address(0))) kerf::interp::note_hidden();
  return real(path);
}
}
