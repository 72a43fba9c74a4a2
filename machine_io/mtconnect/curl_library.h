// machine_io/mtconnect/curl_library.h - libcurl, opened when an agent is asked. For http_get.cpp.
#pragma once

// Its checks of argument types stand in the way of pointers to its functions.
#define CURL_DISABLE_TYPECHECK
// CURLOPT_PROTOCOLS is what a libcurl before 7.85 knows.
#define CURL_DISABLE_DEPRECATION
#include <curl/curl.h>

#include "base/result.h"

namespace kerf {

/// What kerf calls of libcurl.
struct CurlFunctions {
  decltype(&::curl_global_init) global_init;
  decltype(&::curl_version_info) version_info;
  decltype(&::curl_easy_init) easy_init;
  decltype(&::curl_easy_cleanup) easy_cleanup;
  decltype(&::curl_easy_reset) easy_reset;
  CURLcode (*easy_setopt)(CURL*, CURLoption, ...);
  CURLcode (*easy_getinfo)(CURL*, CURLINFO, ...);
  decltype(&::curl_easy_strerror) easy_strerror;
  decltype(&::curl_multi_init) multi_init;
  decltype(&::curl_multi_cleanup) multi_cleanup;
  decltype(&::curl_multi_add_handle) multi_add_handle;
  decltype(&::curl_multi_remove_handle) multi_remove_handle;
  decltype(&::curl_multi_perform) multi_perform;
  decltype(&::curl_multi_info_read) multi_info_read;
  decltype(&::curl_multi_poll) multi_poll;
};

/// kerf is not linked with libcurl, which brings a dozen libraries along: a computer that asks no
/// agent needs none of them. Error: "libcurl.so.4: cannot open shared object file ..", or a version
/// before 7.66. A second call costs nothing.
Result<const CurlFunctions*> open_curl();

}  // namespace kerf
