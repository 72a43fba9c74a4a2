#include "twin/batch/batch_result.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxReportBytes = 256U << 20U;
constexpr std::size_t kMaxSaidBytes = 64U << 10U;
/// What `kerf run` writes, below its folder.
constexpr const char *kReportName = "report.json", *kPageName = "report.html",
                     *kPictureName = "part.png", *kJunitName = "junit.xml", *kSaidName = "said.txt";

constexpr std::array<const char*, kBatchVerdicts> kVerdictNames{
    "good", "findings", "lossy", "usage", "failed", "out-of-time", "out-of-memory", "crashed"};

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::string text_in(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::optional<double> number_in(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

std::uint64_t count_in(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number_unsigned() ? at->get<std::uint64_t>() : 0;
}

/// FNV-1a: enough to tell names apart.
std::uint32_t short_hash(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

/// The first error of what a run has printed; else its first words.
std::string first_fault(std::string_view text) {
  const std::string mark = fmt::format(" {}: ", tr(to_string(Severity::kError)));
  std::string first;
  while (!text.empty()) {
    const std::string_view line = trim(take_line(text));
    if (contains(line, mark)) return std::string(line);
    if (first.empty()) first = line;
  }
  return first;
}

void take_findings(const Json& report, BatchResult& result) {
  const auto findings = report.find("findings");
  if (findings == report.end() || !findings->is_array()) return;
  const auto program = report.find("program");
  const std::string path =
      program != report.end() && program->is_object() ? text_in(*program, "path") : "";
  for (const Json& finding : *findings) {
    if (!finding.is_object()) continue;
    const std::string severity = text_in(finding, "severity");
    ++(severity == "error"     ? result.errors
       : severity == "warning" ? result.warnings
                               : result.notes);
    if (severity != "error" || !result.message.empty()) continue;
    const std::uint64_t line = count_in(finding, "line");
    const std::string message = text_in(finding, "message");
    const std::string file = text_in(finding, "file");
    if (line == 0)
      result.message = message;
    else if (file.empty() || file == path)
      result.message = trf("line {}: {}", line, message);
    else  // a subroutine's
      result.message = fmt::format("{}:{}: {}", file, line, message);
  }
}

/// Leaves what the report does not say.
void take_report(const std::string& path, BatchResult& result) {
  const Result<std::string> text = read_small_file(path, kMaxReportBytes);
  if (!text) return;
  const Json report = Json::parse(*text, nullptr, false);
  if (!report.is_object()) return;
  take_findings(report, result);
  result.findings = count_in(report, "findings_total");
  if (const auto at = report.find("motion"); at != report.end() && at->is_object()) {
    result.time_s = number_in(*at, "duration_s");
  }
  if (const auto at = report.find("stock"); at != report.end() && at->is_object()) {
    result.removed_mm3 = number_in(*at, "removed_mm3");
    result.digest = text_in(*at, "digest");
  }
  if (result.message.empty()) result.message = text_in(report, "partial_reason");
}

BatchVerdict verdict_of(const ProcessEnd& end, std::string_view said) {
  if (end.out_of_time) return BatchVerdict::kOutOfTime;
  // The words of main(), and those of the library where a thread of it finds no memory.
  const bool no_memory =
      contains(said, tr("kerf: error: out of memory\n")) || contains(said, "std::bad_alloc");
  if (end.exit_code != kExitGood && no_memory) return BatchVerdict::kOutOfMemory;
  switch (end.exit_code) {
    case kExitGood:
      return BatchVerdict::kGood;
    case kExitFindings:
      return BatchVerdict::kFindings;
    case kExitUsage:
      return BatchVerdict::kUsage;
    case kExitLossy:
      return BatchVerdict::kLossy;
    default:
      return end.signal != 0 ? BatchVerdict::kCrashed : BatchVerdict::kFailed;
  }
}

/// What does not depend on how long the run took, or where its files are.
Json lasting_json(const BatchResult& r) {
  Json out;
  out["program"] = r.program;
  out["hash"] = r.hash;
  out["verdict"] = to_string(r.verdict);
  out["exit_code"] = r.exit_code;
  out["errors"] = r.errors;
  out["warnings"] = r.warnings;
  out["notes"] = r.notes;
  out["findings"] = r.findings;
  out["time_s"] = or_null(r.time_s);
  out["removed_mm3"] = or_null(r.removed_mm3);
  out["digest"] = or_null(r.digest);
  out["message"] = or_null(r.message);
  return out;
}

}  // namespace

const char* to_string(BatchVerdict verdict) {
  return kVerdictNames[static_cast<std::size_t>(verdict)];
}

ExitCode exit_code_of(BatchVerdict verdict) {
  switch (verdict) {
    case BatchVerdict::kGood:
      return kExitGood;
    case BatchVerdict::kFindings:
      return kExitFindings;
    case BatchVerdict::kUsage:
      return kExitUsage;
    case BatchVerdict::kLossy:
      return kExitLossy;
    default:
      return kExitFailure;
  }
}

Json summary_json(const BatchResult& r) {
  Json out = lasting_json(r);
  out["report"] = or_null(r.report);
  return out;
}

std::string line_of(const BatchResult& r) {
  Json out = lasting_json(r);
  out["wall_s"] = std::round(r.wall_s * 1000) / 1000;
  out["peak_rss_mb"] = std::round(r.peak_rss_mb * 10) / 10;
  out["each_seconds"] = r.bounds.seconds;
  out["each_memory_mb"] = r.bounds.memory_mb;
  out["report"] = or_null(r.report);
  out["page"] = or_null(r.page);
  out["picture"] = or_null(r.picture);
  out["junit"] = or_null(r.junit);
  out["said"] = or_null(r.said);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<BatchResult> result_of_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  BatchResult r;
  r.program = text_in(json, "program");
  r.hash = text_in(json, "hash");
  const std::string verdict = text_in(json, "verdict");
  const auto* const name = std::find(kVerdictNames.begin(), kVerdictNames.end(), verdict);
  if (r.program.empty() || r.hash.empty() || name == kVerdictNames.end()) return std::nullopt;
  r.verdict = static_cast<BatchVerdict>(name - kVerdictNames.begin());
  r.exit_code = static_cast<int>(number_in(json, "exit_code").value_or(-1));
  r.errors = count_in(json, "errors");
  r.warnings = count_in(json, "warnings");
  r.notes = count_in(json, "notes");
  r.findings = count_in(json, "findings");
  r.time_s = number_in(json, "time_s");
  r.removed_mm3 = number_in(json, "removed_mm3");
  r.digest = text_in(json, "digest");
  r.message = text_in(json, "message");
  r.wall_s = number_in(json, "wall_s").value_or(0);
  r.peak_rss_mb = number_in(json, "peak_rss_mb").value_or(0);
  r.bounds.seconds = number_in(json, "each_seconds").value_or(0);
  r.bounds.memory_mb = number_in(json, "each_memory_mb").value_or(0);
  r.report = text_in(json, "report");
  r.page = text_in(json, "page");
  r.picture = text_in(json, "picture");
  r.junit = text_in(json, "junit");
  r.said = text_in(json, "said");
  return r;
}

std::string folder_of(const std::string& program) {
  std::string name = fs::path(program).stem().string().substr(0, 60);
  for (char& c : name) {
    if (!is_letter(c) && !is_digit(c) && c != '.' && c != '_') c = '-';
  }
  return fmt::format("programs/{}-{:08x}", name, short_hash(program));
}

std::vector<std::string> output_words(const std::string& out, const std::string& program) {
  const fs::path folder = fs::path(out) / folder_of(program);
  std::vector<std::string> words;
  for (const auto& [option, name] :
       {std::pair("--json=", kReportName), std::pair("--html=", kPageName),
        std::pair("--png=", kPictureName), std::pair("--junit=", kJunitName)}) {
    words.push_back(option + (folder / name).string());
  }
  return words;
}

BatchResult result_of_run(const std::string& out, const std::string& program,
                          const std::string& hash, const ProcessBounds& bounds,
                          const ProcessEnd& end) {
  BatchResult result;
  result.program = program;
  result.hash = hash;
  result.exit_code = end.exit_code;
  result.wall_s = end.wall_s;
  result.peak_rss_mb = end.peak_rss_mb;
  result.bounds = bounds;
  const std::string folder = folder_of(program);
  const auto there = [&](const char* name) {
    std::error_code ignored;
    const std::string path = folder + "/" + name;
    return fs::exists(fs::path(out) / path, ignored) ? path : std::string();
  };
  result.report = there(kReportName);
  result.page = there(kPageName);
  result.picture = there(kPictureName);
  result.junit = there(kJunitName);
  result.said = there(kSaidName);
  std::ifstream in(fs::path(out) / folder / kSaidName, std::ios::binary);
  const std::string said = read_up_to(in, kMaxSaidBytes);
  result.verdict = verdict_of(end, said);
  if (!result.report.empty()) take_report((fs::path(out) / result.report).string(), result);
  switch (result.verdict) {
    case BatchVerdict::kGood:
      result.message.clear();
      break;
    case BatchVerdict::kOutOfTime:
      result.message = trf("not finished after {} s", number_text(bounds.seconds));
      break;
    case BatchVerdict::kOutOfMemory:
      result.message = bounds.memory_mb > 0
                           ? trf("it wants more than {} MB", number_text(bounds.memory_mb))
                           : std::string(tr("out of memory"));
      break;
    case BatchVerdict::kCrashed:
      result.message = trf("ended by signal {}", end.signal);
      break;
    default:
      if (result.message.empty()) result.message = first_fault(said);
  }
  return result;
}

bool still_holds(const BatchResult& result, const std::string& out, const std::string& hash,
                 const ProcessBounds& bounds) {
  if (result.hash != hash) return false;
  for (const std::string* name :
       {&result.report, &result.page, &result.picture, &result.junit, &result.said}) {
    std::error_code ignored;
    if (!name->empty() && !fs::exists(fs::path(out) / *name, ignored)) return false;
  }
  switch (result.verdict) {
    case BatchVerdict::kOutOfTime:
      return result.bounds.seconds == bounds.seconds;
    case BatchVerdict::kOutOfMemory:
      return result.bounds.memory_mb == bounds.memory_mb;
    case BatchVerdict::kCrashed:
    case BatchVerdict::kFailed:
    case BatchVerdict::kUsage:
      // A program that stops at an error leaves them all. Where one is missing, the cause may have
      // been the disk.
      return !result.report.empty() && !result.page.empty() && !result.picture.empty();
    default:
      return true;
  }
}

}  // namespace kerf
