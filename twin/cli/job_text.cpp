// What a job came to, as JSON and as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/length_unit.h"
#include "base/translate.h"
#include "twin/cli/job_run.h"
#include "twin/findings/finding_json.h"
#include "twin/report/compare_report.h"
#include "twin/report/report_words.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

Json setup_json(const JobResult::Setup& setup, std::size_t number) {
  Json out = setup.report.empty() ? Json::object() : Json::parse(setup.report);
  Json own;
  own["number"] = number;
  own["name"] = setup.name;
  own["time_s"] = rounded(setup.setup_s);
  if (!setup.lies.empty()) own["lies"] = setup.lies;
  if (setup.carried) {
    own["carried"] = {{"from", setup.carried->from},
                      {"to", setup.carried->to},
                      {"bound_mm", setup.carried->bound_mm}};
    if (!setup.carried->note.empty()) own["carried"]["note"] = setup.carried->note;
  }
  out["setup"] = std::move(own);
  return out;
}

Json tool_json(const ToolOfSetups& tool) {
  Json out;
  out["number"] = tool.use.number;
  out["shape"] = tool.use.shape.empty() ? Json(nullptr) : Json(tool.use.shape);
  out["setups"] = tool.setups;
  out["cut_s"] = rounded(tool.use.cut_s);
  out["feed_mm"] = rounded(tool.use.feed_mm);
  out["removed_mm3"] = rounded(tool.use.removed_mm3);
  out["max_depth_mm"] = rounded(tool.use.max_depth_mm);
  out["peak_mm3_per_s"] = rounded(tool.use.peak_mm3_per_s);
  return out;
}

std::string bound_text(double bound_mm) {
  if (bound_mm < 1e-4) return tr("exact");
  return trf("within {:.4f} mm", bound_mm);
}

}  // namespace

std::vector<ToolOfSetups> tools_of(const JobResult& result) {
  std::vector<ToolOfSetups> tools;
  for (std::size_t n = 0; n < result.setups.size(); ++n) {
    for (const ToolUse& use : result.setups[n].tools) {
      auto row = std::ranges::find_if(tools, [&](const ToolOfSetups& tool) {
        return tool.use.number == use.number && tool.use.shape == use.shape;
      });
      if (row == tools.end()) {
        tools.push_back({use, {n + 1}});
        continue;
      }
      row->use.cut_s += use.cut_s;
      row->use.feed_mm += use.feed_mm;
      row->use.removed_mm3 += use.removed_mm3;
      row->use.max_depth_mm = std::max(row->use.max_depth_mm, use.max_depth_mm);
      row->use.peak_mm3_per_s = std::max(row->use.peak_mm3_per_s, use.peak_mm3_per_s);
      row->setups.push_back(n + 1);
    }
  }
  return tools;
}

std::string words_of(const JobTurn& turn) {
  if (turn.touched) return tr("as three points were touched");
  std::string out;
  const auto add = [&out](const std::string& words) { out += (out.empty() ? "" : ", ") + words; };
  if (turn.flip != 0) add(trf("flipped about {}", turn.flip == 'x' ? "X" : "Y"));
  if (turn.rotate_deg != Vec3(0)) {
    add(trf("turned by {:g}, {:g}, {:g} degrees about X, Y, Z", turn.rotate_deg.x,
            turn.rotate_deg.y, turn.rotate_deg.z));
  }
  switch (turn.zero) {
    case JobTurn::Zero::kStays:
      break;
    case JobTurn::Zero::kTop:
      add(tr("Z0 on top"));
      break;
    case JobTurn::Zero::kCorner:
      add(tr("zero at the low corner of its top"));
      break;
    case JobTurn::Zero::kMiddle:
      add(tr("zero in the middle of its top"));
      break;
    case JobTurn::Zero::kPoint:
      add(trf("zero at X{:g} Y{:g} Z{:g} mm", turn.point_mm.x, turn.point_mm.y, turn.point_mm.z));
      break;
  }
  return out;
}

std::string job_json(const JobResult& result, const std::string& path, const std::string& version) {
  Json out;
  out["schema"] = "kerf-job/1";
  out["version"] = version;
  out["job"] = path;
  out["partial"] = !result.not_run.empty() ||
                   std::ranges::any_of(result.setups, [](const auto& s) { return !s.is_whole; });
  if (!result.not_run.empty()) out["not_run"] = result.not_run;
  out["time_s"] = rounded(result.machining_s() + result.setup_s());
  out["machining_s"] = rounded(result.machining_s());
  out["setup_s"] = rounded(result.setup_s());
  std::size_t errors = 0, warnings = 0, notes = 0;
  for (const JobResult::Setup& setup : result.setups) {
    errors += setup.errors;
    warnings += setup.warnings;
    notes += setup.notes;
  }
  out["counts"] = {{"errors", errors}, {"warnings", warnings}, {"notes", notes}};
  out["tools"] = Json::array();
  for (const ToolOfSetups& tool : tools_of(result)) out["tools"].push_back(tool_json(tool));
  if (!result.setups.empty() && result.setups.back().comparison) {
    const JobResult::Setup& last = result.setups.back();
    out["compare"] = compare_json(*last.comparison, last.files);
    for (const auto& made : last.made_before) {
      out["compare"]["regions"][made.region]["made_before"] = {{"setup", made.setup},
                                                               {"name", made.name},
                                                               {"file", made.file},
                                                               {"line", made.line},
                                                               {"tool", made.tool}};
    }
  }
  out["findings"] = Json::array();
  Json setups = Json::array();
  for (std::size_t n = 0; n < result.setups.size(); ++n) {
    setups.push_back(setup_json(result.setups[n], n + 1));
    if (!setups.back().contains("findings")) continue;
    for (Json finding : setups.back()["findings"]) {
      finding["setup"] = n + 1;
      out["findings"].push_back(std::move(finding));
    }
  }
  out["setups"] = std::move(setups);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string job_text(const JobResult& result, LengthUnit units) {
  std::string out = trf("\njob       {} of {} setups run\n", result.setups.size(),
                        result.setups.size() + result.not_run.size());
  out += trf("time      {}: machining {}, set-ups {}\n",
             duration_text(result.machining_s() + result.setup_s()),
             duration_text(result.machining_s()), duration_text(result.setup_s()));
  for (const JobResult::Setup& setup : result.setups) {
    if (!setup.carried || setup.carried->from == setup.carried->to) continue;
    out += trf("carried   from {} to {} for {}, {}\n", setup.carried->from, setup.carried->to,
               setup.words, bound_text(setup.carried->bound_mm));
    if (!setup.carried->note.empty()) out += fmt::format("          {}\n", setup.carried->note);
  }
  const char* head = tr("tools     ");
  for (const ToolOfSetups& tool : tools_of(result)) {
    if (tool.use.shape.empty()) continue;
    out += fmt::format("{}{:<3} {}", head, tool.use.number, tool.use.shape);
    out += trf(" in setup {}: removed {}, cutting {}\n", fmt::join(tool.setups, ", "),
               volume_text(tool.use.removed_mm3), duration_text(tool.use.cut_s));
    head = "          ";
  }
  if (!result.setups.empty() && result.setups.back().comparison)
    out += compare_text(*result.setups.back().comparison);
  if (result.setups.empty()) return in_unit(out, units);
  for (const auto& made : result.setups.back().made_before) {
    const DeviationPlace& worst = result.setups.back().comparison->regions[made.region].worst;
    out += trf(
        "          the gouge at X{:.2f} Y{:.2f} Z{:.2f} mm was made in {}, {}:{} (tool {})\n",
        worst.at_mm.x, worst.at_mm.y, worst.at_mm.z, made.words, made.file, made.line, made.tool);
  }
  return in_unit(out, units);
}

}  // namespace kerf
