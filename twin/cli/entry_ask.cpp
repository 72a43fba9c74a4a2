#include "twin/cli/entry_ask.h"

#include <fmt/format.h>
#include <poll.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/small_file.h"
#include "base/translate.h"
#include "interp_bridge/private_folder.h"
#include "twin/batch/bounded_process.h"
#include "twin/batch/option_table.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Of a report, whose findings are bounded.
constexpr std::size_t kLargestReport = 64'000'000;
/// How soon a question that nobody waits for any more is dropped.
constexpr int kLook_ms = 50;

std::string text_in(const std::string& path) {
  Result<std::string> text = read_small_file(path, kLargestReport);
  return text ? std::move(*text) : std::string();
}

EntryWayShown way_of(const Json& way) {
  EntryWayShown shown;
  shown.is_clear = way.at("clear").get<bool>();
  for (const Json& point : way.at("points_mm")) {
    shown.points_mm.emplace_back(point.at(0).get<double>(), point.at(1).get<double>(),
                                 point.at(2).get<double>());
  }
  return shown;
}

EntryAnswer in_trouble(int line, std::string why) {
  EntryAnswer answer;
  answer.line = line;
  answer.trouble = std::move(why);
  return answer;
}

/// Waits for the process; nothing: nobody waits any more.
std::optional<EntryAnswer> run_of(int line, const std::vector<std::string>& words,
                                  const std::string& folder, LengthUnit unit,
                                  const std::stop_token& stop) {
  Result<BoundedProcess> process = BoundedProcess::start(words, folder + "/said", {});
  if (!process) return in_trouble(line, process.error());
  while (!process->look(BoundedProcess::Clock::now())) {
    if (stop.stop_requested()) return std::nullopt;
    pollfd ended{process->ended_fd(), POLLIN, 0};
    poll(&ended, 1, kLook_ms);
  }
  if (auto answer = entry_answer(line, text_in(folder + "/report.json"), unit)) return answer;
  const std::string said = text_in(folder + "/said");
  return in_trouble(line, said.empty() ? tr("it cannot be told") : said.substr(0, said.find('\n')));
}

}  // namespace

std::optional<EntryAnswer> entry_answer(int line, const std::string& json, LengthUnit unit) {
  const Json report = Json::parse(json, nullptr, false);
  if (report.is_discarded() || !report.is_object() || !report.contains("entry")) {
    return std::nullopt;
  }
  EntryAnswer answer;
  answer.line = line;
  try {
    const Json& entry = report.at("entry");
    for (const Json& text : entry.at("text")) {
      answer.text.push_back(in_unit(text.get<std::string>(), unit));
    }
    answer.safe = way_of(entry.at("safe"));
    if (entry.contains("drive")) answer.drive = way_of(entry.at("drive"));
    for (const Json& earlier : entry.at("earlier")) {
      answer.earlier.push_back({earlier.at("line").get<int>(), earlier.at("costs_s").get<double>(),
                                earlier.at("changes_tool").get<bool>()});
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return answer;
}

void EntryAsk::answer(EntryAnswer answer) {
  SceneUpdate update;
  update.entry = std::make_shared<const EntryAnswer>(std::move(answer));
  mailbox_.publish(std::move(update));
}

void EntryAsk::forget() {
  thread_ = {};
  answer({});
}

void EntryAsk::refuse(int line, std::string why) {
  thread_ = {};
  answer(in_trouble(line, std::move(why)));
}

void EntryAsk::ask(int line, const std::string& program, const WrittenOptions& options,
                   LengthUnit unit, std::shared_ptr<const StockModel> now) {
  thread_ = {};  // stops and joins it
  EntryAnswer waiting;
  waiting.line = line;
  waiting.is_busy = true;
  answer(std::move(waiting));
  std::vector<std::string> words{"run"};
  for (std::string& word : run_words(options)) words.push_back(std::move(word));
  thread_ = std::jthread([this, line, program, unit, words, now](const std::stop_token& stop) {
    Result<PrivateFolder> folder = PrivateFolder::create();
    if (!folder) return answer(in_trouble(line, folder.error()));
    std::vector<std::string> all = words;
    if (now) {
      const std::string state = folder->path() + "/now.state";
      if (const Done saved = now->save(state); !saved)
        return answer(in_trouble(line, saved.error()));
      all.push_back("--stock=state:" + state);
    }
    all.insert(all.end(), {"--quiet", "--enter", fmt::format("--from-line={}", line),
                           "--json=" + folder->path() + "/report.json", program});
    if (auto told = run_of(line, all, folder->path(), unit, stop)) answer(std::move(*told));
  });
}

}  // namespace kerf
