// twin/serve/page_server.h - the page for the shop over HTTP: GET alone, nothing of the computer's
// files, nothing that a request could change. By GNU libmicrohttpd: one thread that waits for all
// connections at once, with bounds for their number and memory; 120 kB, in Debian, kept for 15
// years. (cpp-httplib has a thread a connection, which a slow client holds; Boost.Beast is a
// protocol to build a server of.)
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "twin/serve/serve_address.h"
#include "twin/serve/served_scene.h"

namespace kerf {

struct PageServerOptions {
  ServeAddress address;
  std::string token;  ///< empty: none is asked for, and requests must name this computer by itself
};

///     GET /               the page; also /shop.css, /shop.js, /icon.svg
///     GET /scene?..       ServedScene::answer(): epoch, version, mesh, findings as the page has
///                         them; waits up to kMostWait for something new. With "Authorization:
///                         Bearer TOKEN" where there is a token
///
/// Everything else is 404, another method 405, a wrong or no token 401, another Host than this
/// computer where there is no token 403, a body 413. No cookies, no files, no other site.
///
/// Bounds: kMostConnections, kMostOfOneAddress of them from one address, 16 KB of head each; who
/// has not sent the whole of a request, or not taken the whole of an answer, after kPatience is
/// dropped. Its threads are of low priority.
class PageServer {
 public:
  static constexpr unsigned kMostConnections = 128;
  static constexpr unsigned kMostOfOneAddress = 64;
  static constexpr std::size_t kMostHead = std::size_t{16} << 10;
  static constexpr std::chrono::seconds kPatience{10};
  static constexpr std::chrono::milliseconds kMostWait{1000};

  /// Error: the address is none of this computer's, the port is taken. `scene` must outlive it.
  static Result<std::unique_ptr<PageServer>> start(const PageServerOptions& options,
                                                   ServedScene& scene);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// With the port that it has got.
  const ServeAddress& address() const;
  /// "http://192.168.1.5:8734/#TOKEN": what a browser is to open. Of all addresses: this computer's
  /// name. What is behind # is not sent, and so stands in nobody's log.
  std::string link() const;

 private:
  struct Impl;
  explicit PageServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
