#include "twin/cli/served_page.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/translate.h"
#include "twin/cli/console.h"

namespace kerf {

Result<std::string> ServedPage::open(const ServeAddress& address) {
  PageServerOptions options;
  options.address = address;
  if (!address.is_loopback()) options.token = new_access_token();
  scene_.set_state(state_members(waiting_moment({})));  // until there is more to be shown
  Result<std::unique_ptr<PageServer>> server = PageServer::start(options, scene_);
  if (!server) return Error{server.error()};
  server_ = std::move(*server);
  return server_->link();
}

bool open_and_tell(ServedPage& page, const ServeAddress& address) {
  const Result<std::string> link = page.open(address);
  if (link) {
    print_text(stderr, trf("kerf: the page is at {}\n", *link));
  } else {
    Diagnostic d;
    d.message = fmt::format("--serve: {}", link.error());
    d.hint = tr("it must be an address of this computer and a port that nobody has; port 0 is any");
    print_diagnostic(stderr, d);
  }
  flush_console();
  return static_cast<bool>(link);
}

ShopBroadcastOptions broadcast_options(const LiveRequest& request, const LiveSession& session) {
  ShopBroadcastOptions options;
  const bool has_program = request.options.program && request.options.program->path != "-";
  options.source_name = session.source_name();
  options.title = has_program
                      ? std::filesystem::path(request.options.program->path).filename().string()
                      : options.source_name;
  options.blank_mm = session.stock()->bounds_mm();
  options.turns = session.stock()->turned() != nullptr;
  options.stock = session.stock()->snapshot();
  return options;
}

}  // namespace kerf
