#include "twin/cli/program_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/small_file.h"
#include "base/translate.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

constexpr const char* kSchema = "kerf-programs/1";
constexpr std::size_t kLargestFile = 4'000'000;

/// Wherever LinuxCNC was started.
std::string key_of(const std::string& program) {
  std::error_code ignored;
  const std::filesystem::path path = std::filesystem::weakly_canonical(program, ignored);
  return path.empty() ? program : path.string();
}

Json json_of(const std::string& program, const ProgramSetup& setup) {
  Json tools = Json::array();
  for (const auto& [number, shape] : setup.tools)
    tools.push_back({{"number", number}, {"shape", shape}});
  return {{"program", program},   {"stock", setup.stock}, {"cell", setup.cell},
          {"model", setup.model}, {"tools", tools},       {"fixtures", setup.fixtures}};
}

/// Throws Json::exception.
ProgramSetup setup_in(const Json& item) {
  ProgramSetup setup;
  setup.stock = item.at("stock").get<std::string>();
  setup.cell = item.at("cell").get<std::string>();
  setup.model = item.at("model").get<std::string>();
  for (const Json& tool : item.at("tools"))
    setup.tools.emplace_back(tool.at("number").get<int>(), tool.at("shape").get<std::string>());
  setup.fixtures = item.at("fixtures").get<std::vector<std::string>>();
  return setup;
}

using Kept = std::vector<std::pair<std::string, ProgramSetup>>;

Result<Kept> read_kept(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored)) return Kept{};
  const Result<std::string> text = read_small_file(path, kLargestFile);
  if (!text) return Error{text.error()};
  const Json all = Json::parse(*text, nullptr, false);
  Kept kept;
  try {
    if (all.is_discarded() || all.at("schema") != kSchema)
      return Error{trf("{}: not kerf's set-ups of programs ({})", path, kSchema)};
    for (const Json& item : all.at("programs"))
      kept.emplace_back(item.at("program").get<std::string>(), setup_in(item));
  } catch (const Json::exception&) {
    return Error{trf("{}: not kerf's set-ups of programs ({})", path, kSchema)};
  }
  return kept;
}

}  // namespace

ProgramSetup setup_of(const WrittenOptions& options) {
  ProgramSetup setup;
  setup.stock = options.text("--stock");
  setup.cell = options.text("--cell");
  setup.model = options.text("--model");
  for (const std::string& argument : options.texts("--tool")) {
    int number = 0;
    const char* const end = argument.data() + argument.size();
    const auto read = std::from_chars(argument.data(), end, number);
    if (read.ec != std::errc() || read.ptr == end || *read.ptr != '=') continue;
    setup.tools.emplace_back(number, std::string(read.ptr + 1, end));
  }
  setup.fixtures = options.texts("--fixture");
  return setup;
}

void lay_over(const ProgramSetup& setup, WrittenOptions& options) {
  if (!setup.stock.empty()) options.set("--stock", setup.stock);
  if (!setup.cell.empty()) options.set("--cell", setup.cell);
  if (!setup.model.empty()) options.set("--model", setup.model);
  if (!setup.tools.empty()) options.clear("--tool");
  for (const auto& [number, shape] : setup.tools)
    options.add("--tool", fmt::format("{}={}", number, shape));
  if (!setup.fixtures.empty()) options.set_all("--fixture", setup.fixtures);
}

std::vector<JobTool> job_tools(std::vector<JobTool> used, const ProgramSetup& setup) {
  for (JobTool& tool : used) tool.given.clear();
  for (const auto& [number, shape] : setup.tools) {
    auto at = std::find_if(used.begin(), used.end(),
                           [n = number](const JobTool& tool) { return tool.number == n; });
    if (at == used.end()) at = used.insert(at, JobTool{number, "", "", ""});
    at->given = shape;
  }
  std::sort(used.begin(), used.end(),
            [](const JobTool& a, const JobTool& b) { return a.number < b.number; });
  return used;
}

Result<std::optional<ProgramSetup>> SetupMemory::find(const std::string& program) const {
  Result<Kept> kept = read_kept(path_);
  if (!kept) return Error{kept.error()};
  const std::string key = key_of(program);
  for (auto& [path, setup] : *kept) {
    if (path == key) return std::optional<ProgramSetup>(std::move(setup));
  }
  return std::optional<ProgramSetup>();
}

Done SetupMemory::keep(const std::string& program, const ProgramSetup& setup) const {
  if (path_.empty()) return std::monostate{};
  Result<Kept> kept = read_kept(path_);
  if (!kept) return Error{kept.error()};
  const std::string key = key_of(program);
  std::erase_if(*kept, [&](const auto& one) { return one.first == key; });
  if (setup != ProgramSetup{}) kept->insert(kept->begin(), {key, setup});
  if (kept->size() > kMost) kept->resize(kMost);
  Json programs = Json::array();
  for (const auto& [path, one] : *kept) programs.push_back(json_of(path, one));
  const std::string text = Json{{"schema", kSchema}, {"programs", programs}}.dump(
                               2, ' ', false, Json::error_handler_t::replace) +
                           "\n";
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), ignored);
  Result<AtomicFile> file = AtomicFile::create(path_);
  if (!file) return Error{file.error()};
  file->write(text.data(), text.size());
  return file->commit();
}

std::string setup_memory_path() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  // A relative one is to be ignored, says the specification.
  if (state != nullptr && *state == '/') return std::string(state) + "/kerf/programs.json";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home == '/')
    return std::string(home) + "/.local/state/kerf/programs.json";
  return {};
}

}  // namespace kerf
