#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/report/call_sites.h"
#include "twin/report/finding_lists.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSarifSchema =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";
constexpr const char* kRootName = "%SRCROOT%";
constexpr const char* kFingerprint = "kerf/v1";
/// Of a line as it stands in a fingerprint: a line that is longer is no line of a program.
constexpr std::size_t kLongestLine_bytes = 1024;

const char* level_of(Severity severity) { return to_string(severity); }

/// A path as part of a URI: what is not plain is written %XX.
std::string uri_path(std::string_view path) {
  std::string out;
  for (const char c : path) {
    const bool plain = is_letter(c) || is_digit(c) || contains("-._~/", std::string_view(&c, 1));
    if (plain) {
      out += c;
    } else {
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return out;
}

/// Where a file is: below the folder, or somewhere else.
Json artifact_of(const std::string& file, const std::string& folder) {
  const std::filesystem::path root(folder);
  const std::filesystem::path whole = (root / file).lexically_normal();
  const std::filesystem::path below = whole.lexically_relative(root);
  const bool outside = below.empty() || *below.begin() == "..";
  if (outside) return {{"uri", "file://" + uri_path(whole.string())}};
  return {{"uri", uri_path(below.string())}, {"uriBaseId", kRootName}};
}

/// The words of a line: no N word, no comments, no blanks, in capitals. A line of comments alone
/// is taken as it is.
std::string words_of_line(std::string_view line) {
  std::string out;
  int depth = 0;
  for (const char c : line) {
    if (depth == 0 && c == ';') break;
    if (c == '(') ++depth;
    if (depth == 0 && !is_space(c)) out += to_upper(c);
    if (c == ')' && depth > 0) --depth;
  }
  if (out.starts_with('N')) {
    const std::size_t end = out.find_first_not_of("0123456789.", 1);
    if (end != 1) out.erase(0, std::min(end, out.size()));
  }
  return out.empty() ? std::string(trim(line)) : out;
}

/// 64 bits of FNV-1a: no secret, but the same for ever.
std::string hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return fmt::format("{:016x}", hash);
}

/// Lines of programs that findings name, read once a file.
class NamedLines {
 public:
  void want(const std::string& file, int line) {
    if (line > 0) wanted_[file].insert(line);
  }
  void read() {
    for (const auto& [file, lines] : wanted_) read_file(file, lines);
  }
  std::string_view at(const std::string& file, int line) const {
    const auto found = lines_.find({file, line});
    return found == lines_.end() ? std::string_view() : std::string_view(found->second);
  }

 private:
  void read_file(const std::string& file, const std::set<int>& lines) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return;
    std::ifstream in(file, std::ios::binary);
    std::string text;
    int number = 0;
    for (auto next = lines.begin(); next != lines.end() && std::getline(in, text);) {
      if (++number != *next) continue;
      lines_[{file, number}] = text.substr(0, kLongestLine_bytes);
      ++next;
    }
  }

  std::map<std::string, std::set<int>> wanted_;
  std::map<std::pair<std::string, int>, std::string> lines_;
};

/// A finding with what is said of it.
struct Listed {
  const Finding* finding;
  Diagnostic said;
  const ListedProgram* program;
};

/// All of them, or as many of the worst as may be, in their order.
std::vector<Listed> worst_of(std::span<const ListedProgram> programs, std::size_t most) {
  std::vector<Listed> all;
  for (const ListedProgram& program : programs) {
    for (const Finding& finding : program.findings.kept()) {
      all.push_back({&finding, diagnostic_of(finding, program.files), &program});
      if (all.back().said.file.empty()) all.back().said.file = program.path;
    }
  }
  if (all.size() <= most) return all;
  std::stable_sort(all.begin(), all.end(), [](const Listed& a, const Listed& b) {
    return a.finding->severity > b.finding->severity;
  });
  all.resize(most);
  return all;
}

Json rule_of(const FindingRow& row) {
  Json rule;
  rule["id"] = row.name;
  rule["shortDescription"] = {{"text", tr(row.meaning)}};
  const std::string remedy = *row.remedy == '\0' ? "" : tr(row.remedy);
  rule["help"] = {{"text", remedy.empty() ? tr(row.meaning) : remedy}};
  rule["defaultConfiguration"] = {{"level", level_of(row.usual)}};
  const FindingTopicRow& topic = finding_topics()[static_cast<std::size_t>(row.topic)];
  rule["properties"] = {{"tags", Json::array({topic.name})}};
  return rule;
}

Json properties_of(const Finding& finding) {
  Json out = Json::object();
  if (finding.position_mm) out["position_mm"] = vector_json(*finding.position_mm);
  if (finding.depth_mm) out["depth_mm"] = rounded(*finding.depth_mm);
  if (finding.tool) out["tool"] = *finding.tool;
  if (finding.time_s) out["time_s"] = rounded(*finding.time_s);
  if (finding.has_bodies()) out["bodies"] = finding.bodies;
  return out;
}

/// Lines of subroutines are little without those that call them.
Json related_locations(const std::vector<CallSite>& callers, const std::string& folder) {
  Json out = Json::array();
  for (const CallSite& caller : callers) {
    Json place{{"artifactLocation", artifact_of(caller.file, folder)},
               {"region", {{"startLine", caller.line}}}};
    out.push_back({{"physicalLocation", std::move(place)},
                   {"message", {{"text", trf("o<{}> is called here", caller.name)}}}});
  }
  return out;
}

Json result_of(const Listed& listed, std::size_t rule, const std::string& folder,
               std::string_view line, std::map<std::string, int>& seen) {
  const Finding& finding = *listed.finding;
  const char* const id = to_string(finding.id);
  Json out;
  out["ruleId"] = id;
  out["ruleIndex"] = rule;
  out["level"] = level_of(finding.severity);
  const std::string hint =
      listed.said.hint.empty() ? "" : fmt::format("\n{}", trf("hint: {}", listed.said.hint));
  out["message"] = {{"text", message_of(finding) + hint}};
  Json place;
  std::string uri;
  if (!listed.said.file.empty()) {
    place["artifactLocation"] = artifact_of(listed.said.file, folder);
    uri = place["artifactLocation"]["uri"];
    Json region{{"startLine", std::max(listed.said.line, 1)}};
    if (!line.empty()) region["snippet"] = {{"text", std::string(trim(line))}};
    place["region"] = std::move(region);
    out["locations"] = Json::array({Json{{"physicalLocation", std::move(place)}}});
  }
  const std::string key = fmt::format("{}|{}|{}|{}", id, uri, finding.tool.value_or(-1),
                                      line.empty() ? "" : words_of_line(line));
  const int ordinal = ++seen[key];
  out["partialFingerprints"] = {{kFingerprint, hash_of(fmt::format("{}|{}", key, ordinal))}};
  Json properties = properties_of(finding);
  if (!properties.empty()) out["properties"] = std::move(properties);
  return out;
}

Json notification(Severity severity, const std::string& text) {
  return {{"level", level_of(severity)}, {"message", {{"text", text}}}};
}

Json invocation_of(std::span<const ListedProgram> programs, std::size_t listed,
                   const std::string& folder) {
  Json notes = Json::array();
  bool whole = true;
  std::uint64_t total = 0;
  for (const ListedProgram& program : programs) {
    total += program.findings.total();
    if (!program.partial_reason.empty()) {
      whole = false;
      notes.push_back(notification(Severity::kError, trf("{}: not run to its end: {}", program.path,
                                                         program.partial_reason)));
    }
    for (const Diagnostic& fault : program.faults) {
      whole = whole && fault.severity != Severity::kError;
      notes.push_back(notification(fault.severity, fault.message));
    }
  }
  if (total > listed) {
    notes.push_back(notification(
        Severity::kWarning,
        trf("{} findings in all; {} are left out of this list", total, total - listed)));
  }
  Json out;
  out["executionSuccessful"] = whole;
  out["workingDirectory"] = {{"uri", "file://" + uri_path(folder) + "/"}};
  if (!notes.empty()) out["toolExecutionNotifications"] = std::move(notes);
  return out;
}

}  // namespace

std::string sarif_text(std::span<const ListedProgram> programs, const std::string& version,
                       const std::string& folder, std::size_t most) {
  const std::vector<Listed> listed = worst_of(programs, most);
  NamedLines lines;
  for (const Listed& one : listed) lines.want(one.said.file, one.said.line);
  lines.read();
  std::map<FindingId, std::size_t> rules;
  Json rule_list = Json::array(), results = Json::array();
  std::map<std::string, int> seen;
  CallSites call_sites;
  for (const Listed& one : listed) {
    const auto [rule, is_new] = rules.try_emplace(one.finding->id, rules.size());
    if (is_new) rule_list.push_back(rule_of(row_of(one.finding->id)));
    results.push_back(
        result_of(one, rule->second, folder, lines.at(one.said.file, one.said.line), seen));
    const std::vector<CallSite> callers =
        call_sites.of(one.program->files, one.said.file, one.said.line);
    if (!callers.empty()) results.back()["relatedLocations"] = related_locations(callers, folder);
  }
  Json driver;
  driver["name"] = "kerf";
  driver["version"] = version;
  driver["rules"] = std::move(rule_list);
  Json run;
  run["tool"] = {{"driver", std::move(driver)}};
  run["language"] = language();
  run["originalUriBaseIds"] = {{kRootName, {{"uri", "file://" + uri_path(folder) + "/"}}}};
  run["invocations"] = Json::array({invocation_of(programs, listed.size(), folder)});
  run["results"] = std::move(results);
  Json out;
  out["$schema"] = kSarifSchema;
  out["version"] = "2.1.0";
  out["runs"] = Json::array({std::move(run)});
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kerf
