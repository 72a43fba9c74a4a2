#include "twin/batch/batch_pages.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/small_file.h"
#include "base/translate.h"
#include "twin/report/finding_lists.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxJunitBytes = 64U << 20U;

constexpr std::array<const char*, kBatchVerdicts> kShownVerdicts{
    tr_noop("good"),          tr_noop("errors found"), tr_noop("data lost"),
    tr_noop("bad options"),   tr_noop("not finished"), tr_noop("out of time"),
    tr_noop("out of memory"), tr_noop("crashed")};

std::array<std::size_t, kBatchVerdicts> counts_of(const BatchEnd& end) {
  std::array<std::size_t, kBatchVerdicts> counts{};
  for (const BatchResult& result : end.results) ++counts[static_cast<std::size_t>(result.verdict)];
  return counts;
}

/// The suite of a run that has left no list.
std::string suite_without_run(const BatchResult& result, const std::string& version) {
  ListedProgram listed;
  listed.path = result.program;
  listed.total_s = result.wall_s;
  Diagnostic d;
  d.message = fmt::format("{}: {}", shown_verdict(result.verdict), result.message);
  listed.faults.push_back(std::move(d));
  return junit_text(std::span(&listed, 1), version);
}

/// As a machinist reads it: "1:02:03".
std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string link(const std::string& path, const std::string& inner) {
  return path.empty() ? inner : fmt::format("<a href=\"{}\">{}</a>", xml_text(path), inner);
}

/// The name, and above it in small print the folder.
std::string program_cell(const BatchResult& r) {
  const std::size_t at = r.program.rfind('/');
  const std::string folder = at == r.program.npos ? "" : r.program.substr(0, at + 1);
  const std::string name = r.program.substr(folder.size());
  const std::string above =
      folder.empty() ? "" : fmt::format("<span class=f>{}</span>", xml_text(folder));
  return above + link(r.page, xml_text(name));
}

std::string row_of(const BatchResult& r) {
  const std::string picture =
      r.picture.empty()
          ? std::string()
          : fmt::format("<img src=\"{}\" alt=\"\" loading=\"lazy\">", xml_text(r.picture));
  std::string row = fmt::format(
      "<tr class=\"{}\"><td>{}</td><td class=p>{}</td><td class=v>{}</td>", to_string(r.verdict),
      link(r.page, picture), program_cell(r), xml_text(shown_verdict(r.verdict)));
  row += fmt::format("<td class=n>{}</td><td class=n>{}</td>", r.errors, r.warnings);
  row += fmt::format("<td class=n>{}</td>", r.time_s ? clock_text(*r.time_s) : "");
  row += fmt::format("<td class=n>{}</td>",
                     r.removed_mm3 ? fmt::format("{:.1f}", *r.removed_mm3 / 1000) : "");
  row += fmt::format("<td class=n>{:.1f}</td><td class=n>{:.0f}</td>", r.wall_s, r.peak_rss_mb);
  row += fmt::format("<td class=m>{}</td><td>{} {}</td></tr>\n", xml_text(r.message),
                     link(r.report, "JSON"), link(r.said, xml_text(tr("output"))));
  return row;
}

constexpr const char* kStyle =
    "body{font:15px/1.4 sans-serif;margin:1.5em;color:#222;background:#fff}\n"
    "table{border-collapse:collapse;width:100%}\n"
    "th,td{padding:.3em .6em;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}\n"
    "th{position:sticky;top:0;background:#fff}\n"
    ".n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}\n"
    "img{width:9em;display:block}\n"
    // Names and folders are long, and have no blanks.
    "td{overflow-wrap:anywhere}.f{display:block;color:#666;font-size:.85em}\n"
    ".p{min-width:15em}.m{min-width:12em}\n"
    "@media(max-width:60em){body{margin:.5em;font-size:13px}img{width:6em}.p,.m{min-width:9em}\n"
    "th,td{padding:.3em .3em}}\n"
    ".v{white-space:nowrap;font-weight:bold}\n"
    ".good .v{color:#17692f}.findings .v{color:#b3261e}\n"
    ".lossy .v,.usage .v{color:#8a5a00}\n"
    ".failed .v,.out-of-time .v,.out-of-memory .v,.crashed .v{color:#7a1fa2}\n"
    "@media print{th{position:static}}\n";

}  // namespace

std::string shown_verdict(BatchVerdict verdict) {
  return tr(kShownVerdicts[static_cast<std::size_t>(verdict)]);
}

std::string batch_summary_json(const BatchEnd& end, std::size_t programs,
                               const std::string& version) {
  Json out;
  out["schema"] = "kerf-batch/1";
  out["version"] = version;
  out["partial"] = end.results.size() < programs;
  out["programs"] = programs;
  out["done"] = end.results.size();
  const auto counts = counts_of(end);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    out["verdicts"][to_string(static_cast<BatchVerdict>(i))] = counts[i];
  }
  std::uint64_t errors = 0, warnings = 0;
  for (const BatchResult& result : end.results) {
    errors += result.errors;
    warnings += result.warnings;
  }
  out["errors"] = errors;
  out["warnings"] = warnings;
  out["results"] = Json::array();
  for (const BatchResult& result : end.results) out["results"].push_back(summary_json(result));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string batch_junit(const BatchEnd& end, const std::string& out, const std::string& version) {
  std::vector<std::string> texts;
  for (const BatchResult& result : end.results) {
    std::string text;
    if (!result.junit.empty()) {
      Result<std::string> read =
          read_small_file((std::filesystem::path(out) / result.junit).string(), kMaxJunitBytes);
      if (read) text = std::move(*read);
    }
    // One that was ended may have left a list that does not say so.
    const bool was_ended = result.verdict >= BatchVerdict::kOutOfTime;
    if (was_ended || !join_junit(std::span(&text, 1), version)) {
      text = suite_without_run(result, version);
    }
    texts.push_back(std::move(text));
  }
  return join_junit(texts, version).value_or(std::string());
}

std::string batch_counts_text(const BatchEnd& end, std::size_t programs) {
  std::string text = trf("{} of {} programs", end.results.size(), programs);
  const auto counts = counts_of(end);
  std::string_view between = ": ";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    text += fmt::format("{}{} {}", between, counts[i], shown_verdict(static_cast<BatchVerdict>(i)));
    between = ", ";
  }
  return text;
}

std::string batch_index_html(const BatchEnd& end, std::size_t programs,
                             const std::string& version) {
  const std::string counts = xml_text(batch_counts_text(end, programs));
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html>\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>kerf: {}</title>\n"
      "<style>\n{}</style>\n</head>\n<body>\n<h1>{}</h1>\n<table>\n<thead><tr>",
      counts, kStyle, counts);
  for (const char* const head :
       {"", tr("Program"), tr("Result"), tr("Errors"), tr("Warnings"), tr("Machine time"),
        tr("Removed, cm3"), tr("Run, s"), tr("Memory, MB"), tr("First fault"), tr("Files")}) {
    page += fmt::format("<th>{}</th>", xml_text(head));
  }
  page += "</tr></thead>\n<tbody>\n";
  for (const BatchResult& result : end.results) page += row_of(result);
  return page +
         fmt::format("</tbody>\n</table>\n<p>kerf {}</p>\n</body>\n</html>\n", xml_text(version));
}

}  // namespace kerf
