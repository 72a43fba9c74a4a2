#include "machine_io/mtconnect/curl_library.h"

#include <dlfcn.h>

#include <array>
#include <mutex>

#include "base/translate.h"

namespace kerf {
namespace {

/// Of OpenSSL, and of GnuTLS, whichever is there.
constexpr std::array kCurlLibraries{"libcurl.so.4", "libcurl-gnutls.so.4"};
/// curl_multi_poll().
constexpr unsigned kNeededCurl = 0x074200;

template <class Function>
bool find_function(void* library, const char* name, Function& out) {
  out = reinterpret_cast<Function>(dlsym(library, name));
  return out != nullptr;
}

bool find_all(void* library, CurlFunctions& out) {
  return find_function(library, "curl_global_init", out.global_init) &&
         find_function(library, "curl_version_info", out.version_info) &&
         find_function(library, "curl_easy_init", out.easy_init) &&
         find_function(library, "curl_easy_cleanup", out.easy_cleanup) &&
         find_function(library, "curl_easy_reset", out.easy_reset) &&
         find_function(library, "curl_easy_setopt", out.easy_setopt) &&
         find_function(library, "curl_easy_getinfo", out.easy_getinfo) &&
         find_function(library, "curl_easy_strerror", out.easy_strerror) &&
         find_function(library, "curl_multi_init", out.multi_init) &&
         find_function(library, "curl_multi_cleanup", out.multi_cleanup) &&
         find_function(library, "curl_multi_add_handle", out.multi_add_handle) &&
         find_function(library, "curl_multi_remove_handle", out.multi_remove_handle) &&
         find_function(library, "curl_multi_perform", out.multi_perform) &&
         find_function(library, "curl_multi_info_read", out.multi_info_read) &&
         find_function(library, "curl_multi_poll", out.multi_poll);
}

}  // namespace

Result<const CurlFunctions*> open_curl() {
  static std::mutex mutex;
  static CurlFunctions functions{};
  static bool is_open = false;
  const std::lock_guard lock(mutex);
  if (is_open) return &functions;
  std::string why;
  for (const char* const name : kCurlLibraries) {
    // Never closed: it has handlers of its own in other libraries.
    void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      if (why.empty()) why = dlerror();
      continue;
    }
    if (!find_all(library, functions) ||
        functions.version_info(CURLVERSION_NOW)->version_num < kNeededCurl) {
      why = trf("{} is too old; 7.66 or newer is needed", name);
      continue;
    }
    if (functions.global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) {
      why = trf("{} cannot be used", name);
      continue;
    }
    is_open = true;
    return &functions;
  }
  return Error{
      trf("{} (an MTConnect agent is asked by libcurl, of Debian's package libcurl4)", why)};
}

}  // namespace kerf
