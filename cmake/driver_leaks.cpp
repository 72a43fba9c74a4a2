// Linked into executables that draw, under AddressSanitizer alone. A process that has loaded a
// graphics driver is not asked for leaks: drivers keep some of what they allocate, and the check
// itself crashes where their threads are just ending. Other processes of the same executable are
// asked.

#include <dlfcn.h>
#include <link.h>

#include <string_view>

namespace {

/// libEGL, libGL, libGLX: by these OpenGL comes in; kerf loads them when it is about to draw.
int is_driver(dl_phdr_info* library, std::size_t, void*) {
  return std::string_view(library->dlpi_name).find("/libEGL") != std::string_view::npos ||
         std::string_view(library->dlpi_name).find("/libGL") != std::string_view::npos;
}

}  // namespace

extern "C" {

/// Nothing is unloaded, so that at the end of the process it can be seen what was loaded.
int dlclose(void*) { return 0; }

int __lsan_is_turned_off();
int __lsan_is_turned_off() { return dl_iterate_phdr(is_driver, nullptr); }
}
