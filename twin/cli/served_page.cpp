#include "twin/cli/served_page.h"

#include <filesystem>
#include <utility>

#include "twin/cli/console.h"

namespace kerf {

Result<std::string> ServedPage::open(const ServeAddress& address) {
  PageServerOptions options;
  options.address = address;
  if (!address.is_loopback()) options.token = new_access_token();
  Result<std::unique_ptr<PageServer>> server = PageServer::start(options, scene_);
  if (!server) return Error{server.error()};
  server_ = std::move(*server);
  return server_->link();
}

LiveBroadcastOptions broadcast_options(const LiveRequest& request, const LiveSession& session) {
  LiveBroadcastOptions options;
  const bool has_program = request.options.program && request.options.program->path != "-";
  options.source_name = session.source_name();
  options.title = has_program
                      ? std::filesystem::path(request.options.program->path).filename().string()
                      : options.source_name;
  options.units = shown_unit();
  options.tools = session.tool_sources();
  options.blank_mm = session.stock()->bounds_mm();
  options.turns = session.stock()->turned() != nullptr;
  options.stock = session.stock()->snapshot();
  return options;
}

}  // namespace kerf
