// twin/cli/served_page.h - what --serve starts.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "twin/cli/live_options.h"
#include "twin/serve/live_broadcast.h"
#include "twin/serve/page_server.h"
#include "twin/serve/served_scene.h"

namespace kerf {

/// The scene, and the server that shows it until this object ends: longer than any session.
class ServedPage {
 public:
  /// The link to be opened; of an address that others reach with a new token. Error: a port that is
  /// taken, an address that this computer does not have.
  Result<std::string> open(const ServeAddress& address);
  ServedScene& scene() { return scene_; }

 private:
  ServedScene scene_;
  std::unique_ptr<PageServer> server_;
};

/// Opens it and prints the link, --quiet or not: whoever is to look on needs it. False: the address
/// cannot be had, which is told.
bool open_and_tell(ServedPage& page, const ServeAddress& address);

ShopBroadcastOptions broadcast_options(const LiveRequest& request, const LiveSession& session);

}  // namespace kerf
