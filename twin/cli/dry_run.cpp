#include "twin/cli/dry_run.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/exit_code.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "twin/batch/option_table.h"
#include "twin/findings/finding_table.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

/// Of a process that fails: its first line says why.
constexpr std::size_t kLongestTrouble = 300;

/// Of a report, whose findings are bounded.
constexpr std::size_t kLargestFile = 64'000'000;

/// Empty: there is none.
std::string content_of(const std::string& path) {
  Result<std::string> text = read_small_file(path, kLargestFile);
  return text ? std::move(*text) : std::string();
}

/// What this thread starts meanwhile runs when nobody else wants the processor.
class IdlePriority {
 public:
  IdlePriority() : before_(sched_getscheduler(0)) { set(SCHED_IDLE); }
  ~IdlePriority() { set(before_); }
  IdlePriority(const IdlePriority&) = delete;
  IdlePriority& operator=(const IdlePriority&) = delete;

 private:
  static void set(int policy) {
    sched_param none{};
    // Where the system refuses, it is the priority that kerf shadow has.
    static_cast<void>(sched_setscheduler(0, policy, &none));
  }
  int before_;
};

std::optional<FindingId> id_named(const std::string& name) {
  for (const FindingRow& row : finding_table()) {
    if (row.name == name) return row.id;
  }
  return std::nullopt;
}

std::optional<Finding> finding_of(const Json& item) {
  Finding finding;
  const std::string severity = item.value("severity", "");
  if (severity != "error" && severity != "warning") return std::nullopt;
  const std::optional<FindingId> id = id_named(item.value("id", ""));
  if (!id) return std::nullopt;
  finding.id = *id;
  finding.severity = severity == "error" ? Severity::kError : Severity::kWarning;
  finding.file = item.value("file", "");
  finding.source.line = item.value("line", 0U);
  if (item.contains("time_s") && item["time_s"].is_number()) {
    finding.time_s = item["time_s"].get<double>();
  }
  // Depth and place are in it.
  finding.text = trf("dry run: {}", item.value("message", ""));
  return finding;
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string line_of(const DryRunResult& result) {
  const std::string name = std::filesystem::path(result.program).filename().string();
  if (!result.is_done) return trf("{}: dry run: {}", name, result.trouble);
  const std::string time = time_text(std::max(0.0, result.duration_s));
  if (result.errors + result.warnings == 0) {
    return trf("{}: dry run: no findings, {}", name, time);
  }
  return trf("{}: dry run: errors: {}, warnings: {}, {}", name, result.errors, result.warnings,
             time);
}

std::optional<DryRunResult> dry_run_result(const std::string& program, const std::string& json) {
  const Json report = Json::parse(json, nullptr, false);
  if (report.is_discarded() || !report.is_object() ||
      report.value("schema", Json()) != "kerf-report/1") {
    return std::nullopt;
  }
  DryRunResult result;
  result.program = program;
  try {
    result.duration_s = report.at("motion").at("duration_s").get<double>();
    for (const Json& item : report.at("findings")) {
      std::optional<Finding> finding = finding_of(item);
      if (!finding) continue;
      ++(finding->severity == Severity::kError ? result.errors : result.warnings);
      result.findings.push_back(std::move(*finding));
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  result.is_done = true;
  return result;
}

Result<DryRun> DryRun::start(const std::string& program, const WrittenOptions& options) {
  Result<PrivateFolder> made = PrivateFolder::create();
  if (!made) return Error{made.error()};
  DryRun run(program, std::move(*made));
  const std::string& folder = run.folder_.path();
  std::vector<std::string> words{"run"};
  for (std::string& word : run_words(options)) words.push_back(std::move(word));
  words.insert(words.end(), {"--quiet", "--json=" + folder + "/report.json", program});
  const IdlePriority idle;
  Result<BoundedProcess> process = BoundedProcess::start(words, folder + "/said", {});
  if (!process) return Error{process.error()};
  run.process_ = std::move(*process);
  return run;
}

std::optional<DryRunResult> DryRun::look() {
  if (!process_) return std::nullopt;
  const std::optional<ProcessEnd> end = process_->look(BoundedProcess::Clock::now());
  if (!end) return std::nullopt;
  process_.reset();
  std::optional<DryRunResult> result =
      dry_run_result(program_, content_of(folder_.path() + "/report.json"));
  const bool has_ended = end->exit_code == kExitGood || end->exit_code == kExitFindings ||
                         end->exit_code == kExitLossy;
  if (!result) result.emplace().program = program_;
  result->is_done = result->is_done && has_ended;
  // More findings than a report keeps.
  if (end->exit_code == kExitFindings) result->errors = std::max(result->errors, 1);
  if (result->is_done) return result;
  const std::string said = content_of(folder_.path() + "/said");
  result->trouble = said.substr(0, std::min(said.find('\n'), kLongestTrouble));
  if (result->trouble.empty()) {
    result->trouble = end->signal != 0 ? trf("ended by signal {}", end->signal)
                                       : trf("ended with exit code {}", end->exit_code);
  }
  return result;
}

}  // namespace kerf
