// twin/mcp/mcp_server.h - a server of the Model Context Protocol for one client: JSON-RPC 2.0 in
// lines. https://modelcontextprotocol.io/specification/2025-06-18
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "twin/batch/bounded_process.h"

namespace kerf {

struct McpOptions {
  std::filesystem::path folder;  ///< the current one, canonical: all that a client may name
  ProcessBounds bounds;          ///< of each call
  std::string version;           ///< of kerf
};

/// Until the client has closed `in_fd`, `out_fd` takes no more, or `stop_fd` can be read. What
/// still runs is then ended, which takes it 3 s at most. Calls run one after another; meanwhile the
/// client is heard. No threads.
void serve_mcp(const McpOptions& options, int in_fd, int out_fd, int stop_fd);

/// What a client's first line is answered at once.
std::string mcp_answer_to(const McpOptions& options, std::string_view line);

}  // namespace kerf
