// Anything as a line of a client, as the arguments of a call, and as a text in one of them.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "twin/mcp/mcp_server.h"
#include "twin/mcp/mcp_tools.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Json = nlohmann::json;
  const std::string text(reinterpret_cast<const char*>(data), size);
  static const std::filesystem::path folder = std::filesystem::canonical("/usr/share");
  static const kerf::McpOptions options{.folder = folder, .bounds = {}, .version = "1"};
  const std::string answer = kerf::mcp_answer_to(options, text);
  // Whole lines of JSON, whatever was said.
  if (!answer.empty() && answer.back() != '\n') std::abort();
  for (std::size_t begin = 0; begin < answer.size();) {
    const std::size_t end = answer.find('\n', begin);
    if (!Json::accept(answer.substr(begin, end - begin))) std::abort();
    begin = end + 1;
  }
  if (kerf::names_outside("stl:/etc/passwd:" + text, folder) == false) std::abort();
  Json arguments = Json::parse(text, nullptr, false);
  if (!arguments.is_object()) arguments = {{"program", text}, {"stock", "stl:" + text}};
  for (const kerf::McpTool& tool : kerf::mcp_tools()) {
    const auto request = kerf::understand_mcp_call(tool, arguments, folder);
    if (!request) continue;
    const std::vector<std::string>& words = request->words;
    const auto is_program = [](const std::string& word) { return word.front() != '-'; };
    // One program, and options of kerf that do not write.
    if (std::count_if(words.begin() + 1, words.end(), is_program) != 1) std::abort();
    for (const std::string_view name :
         {"--json", "--png=", "--out", "--stl", "--config", "--set"}) {
      const auto writes = [&](const std::string& word) { return word.starts_with(name); };
      if (std::any_of(words.begin(), words.end(), writes)) std::abort();
    }
  }
  return 0;
}
