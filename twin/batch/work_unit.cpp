#include "twin/batch/work_unit.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/small_file.h"
#include "base/translate.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxUnitBytes = 64U << 20U;
/// How long a stop request may stay unseen.
constexpr int kLookMs = 50;

/// Cores that Slurm has lent this task; 0: it says nothing.
int lent_cores() {
  const char* const text = std::getenv("SLURM_CPUS_PER_TASK");
  return text ? std::clamp(std::atoi(text), 0, 8) : 0;
}

}  // namespace

std::string text_of(const WorkUnit& unit) {
  Json json;
  json["folder"] = unit.folder;
  json["out"] = unit.out;
  json["program"] = unit.program;
  json["hash"] = unit.hash;
  json["words"] = unit.words;
  json["each_seconds"] = unit.bounds.seconds;
  json["each_memory_mb"] = unit.bounds.memory_mb;
  json["threads"] = unit.threads;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<WorkUnit> unit_of_text(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    WorkUnit unit;
    json.at("folder").get_to(unit.folder);
    json.at("out").get_to(unit.out);
    json.at("program").get_to(unit.program);
    json.at("hash").get_to(unit.hash);
    json.at("words").get_to(unit.words);
    json.at("each_seconds").get_to(unit.bounds.seconds);
    json.at("each_memory_mb").get_to(unit.bounds.memory_mb);
    json.at("threads").get_to(unit.threads);
    if (!unit.program.empty()) return unit;
  } catch (const Json::exception&) {
  }
  return Error{tr("this is no unit of a batch")};
}

Result<BoundedProcess> start_unit(const WorkUnit& unit) {
  const fs::path folder = fs::path(unit.out) / folder_of(unit.program);
  std::error_code error;
  fs::remove_all(folder, error);  // what is there is of another run
  if (!error) fs::create_directories(folder, error);
  if (error) return Error{trf("{}: {}", folder.string(), error.message())};
  std::vector<std::string> words{"run",
                                 unit.program.front() == '-' ? "./" + unit.program : unit.program};
  words.insert(words.end(), unit.words.begin(), unit.words.end());
  const auto says_threads = [](const std::string& w) { return w.starts_with("--threads="); };
  if (std::none_of(words.begin(), words.end(), says_threads)) {
    words.push_back("--threads=" + std::to_string(unit.threads));
  }
  for (std::string& word : output_words(unit.out, unit.program)) words.push_back(std::move(word));
  return BoundedProcess::start(words, (folder / "said.txt").string(), unit.bounds);
}

BatchResult result_of_unit(const WorkUnit& unit, const ProcessEnd& end) {
  return result_of_run(unit.out, unit.program, unit.hash, unit.bounds, end);
}

std::string result_name(const std::string& unit_path) {
  return fs::path(unit_path).replace_extension(".result").string();
}

Done run_unit_file(const std::string& path, const std::stop_token& stop) {
  std::error_code error;
  const std::string whole = fs::absolute(path, error).string();
  const Result<std::string> text = read_small_file(whole, kMaxUnitBytes);
  if (!text) return Error{text.error()};
  Result<WorkUnit> unit = unit_of_text(*text);
  if (!unit) return Error{trf("{}: {}", path, unit.error())};
  fs::current_path(unit->folder, error);
  if (error) return Error{trf("{}: {}", unit->folder, error.message())};
  if (const int cores = lent_cores(); cores > 0) unit->threads = cores;
  Result<BoundedProcess> process = start_unit(*unit);
  if (!process) return Error{process.error()};
  while (true) {
    if (stop.stop_requested()) process->stop();
    const auto now = BoundedProcess::Clock::now();
    if (const std::optional<ProcessEnd> end = process->look(now)) {
      if (end->stopped) return Error{trf("{}: interrupted", unit->program)};
      return write_text(result_name(whole), line_of(result_of_unit(*unit, *end)));
    }
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(process->next_look() - now).count();
    pollfd ended{process->ended_fd(), POLLIN, 0};
    poll(&ended, 1, static_cast<int>(std::clamp<long>(left, 0, kLookMs)));
  }
}

}  // namespace kerf
