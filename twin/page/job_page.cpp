#include "twin/page/job_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/translate.h"
#include "twin/page/report_page.h"
#include "twin/page/section_text.h"
#include "twin/report/compare_report.h"
#include "twin/report/report_words.h"

namespace kerf {
namespace {

std::string head_text(const JobPage& job) {
  double machining_s = 0, setup_s = 0;
  std::size_t errors = 0, warnings = 0;
  for (const JobPage::Setup& setup : job.setups) {
    machining_s += setup.machining_s;
    setup_s += setup.setup_s;
    errors += setup.errors;
    warnings += setup.warnings;
  }
  const char* const verdict = errors > 0     ? "verdict error"
                              : warnings > 0 ? "verdict warning"
                                             : "verdict";
  std::string out =
      fmt::format("<header><h1>{}</h1>\n<p><span class=\"{}\">{}</span></p>\n", xml_text(job.path),
                  verdict, xml_text(verdict_text(errors, warnings)));
  if (!job.not_run.empty()) {
    out += fmt::format("<p><b>{}</b></p>\n",
                       xml_text(trf("Partial. Not run: {}", fmt::join(job.not_run, ", "))));
  }
  out += "<dl class=\"facts\">\n";
  const auto fact = [&out](const char* name, const std::string& value) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_text(name), xml_text(value));
  };
  fact(tr("Time"), duration_text(machining_s + setup_s));
  fact(tr("of that machining"), duration_text(machining_s));
  fact(tr("setting up"), duration_text(setup_s));
  return out + "</dl></header>\n";
}

std::string setup_list(const JobPage& job) {
  std::string out = fmt::format("<section><h2>{}</h2>\n<table><thead><tr>", xml_text(tr("Setups")));
  for (const char* const heading : {tr("Setup"), tr("Program"), tr("How it lies"), tr("Findings")})
    out += fmt::format("<th>{}</th>", xml_text(heading));
  for (const char* const heading : {tr("Setting up"), tr("Machining")})
    out += fmt::format("<th class=\"n\">{}</th>", xml_text(heading));
  out += "</tr></thead><tbody>\n";
  for (std::size_t n = 0; n < job.setups.size(); ++n) {
    const JobPage::Setup& setup = job.setups[n];
    const std::string heading = xml_text(setup.heading);
    const std::string lies = setup.lies.empty() ? (n == 0 ? tr("as the blank") : tr("as before"))
                                                : in_unit(setup.lies, job.units);
    out += setup.article.empty()
               ? fmt::format("<tr><td>{}</td>", heading)
               : fmt::format("<tr><td><a href=\"#{}\">{}</a></td>", JobPage::anchor(n), heading);
    for (const std::string& cell :
         {setup.program, lies, verdict_text(setup.errors, setup.warnings)})
      out += fmt::format("<td>{}</td>", xml_text(cell));
    for (const double time_s : {setup.setup_s, setup.machining_s})
      out += fmt::format("<td class=\"n\">{}</td>", xml_text(duration_text(time_s)));
    out += "</tr>\n";
  }
  return out + "</tbody></table></section>\n";
}

std::string tool_list(const JobPage& job) {
  SectionText out(tr("Tools over all setups"), job.units);
  out.table({{tr("Tool")},
             {tr("Shape")},
             {tr("Setups")},
             {tr("Cutting"), true},
             {tr("Way"), true},
             {tr("Removed"), true}});
  for (const JobPage::Tool& tool : job.tools) {
    if (tool.use.shape.empty()) continue;
    out.row({fmt::format("T{}", tool.use.number), tool.use.shape,
             fmt::format("{}", fmt::join(tool.setups, ", ")), duration_text(tool.use.cut_s),
             distance_text(tool.use.feed_mm), volume_text(tool.use.removed_mm3)});
  }
  out.end_table();
  return std::move(out).done();
}

}  // namespace

std::string JobPage::anchor(std::size_t setup) { return fmt::format("setup-{}", setup + 1); }

std::string job_page(const JobPage& job) {
  std::string body = "<div class=\"index\">\n" + head_text(job) + setup_list(job) + tool_list(job);
  if (job.comparison) {
    SectionText compared(tr("Against the design"), job.units);
    compared.pre(compare_text(*job.comparison));
    body += std::move(compared).done();
  }
  if (!job.command.empty()) {
    SectionText again(tr("How to make it again"), job.units);
    again.raw(fmt::format("<pre>{}</pre>\n", xml_text(job.command)));
    body += std::move(again).done();
  }
  body += "</div>\n";
  for (const JobPage::Setup& setup : job.setups) body += setup.article;
  return page_of(job.path, job.version, body);
}

}  // namespace kerf
