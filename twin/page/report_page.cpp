#include "twin/page/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "base/small_file.h"
#include "base/translate.h"
#include "twin/findings/finding_json.h"
#include "twin/page/base64.h"
#include "twin/page/load_section.h"
#include "twin/page/page_assets.h"
#include "twin/page/page_mesh.h"
#include "twin/page/page_sections.h"
#include "twin/report/finding_lists.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

/// Lines before and behind the one that a finding names.
constexpr std::uint32_t kNeighbours = 4;
constexpr std::size_t kMostSource_bytes = std::size_t{64} << 20;
constexpr std::size_t kMostLine = 200;

std::string base64_of(const std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (const std::uint16_t value : values) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
  }
  return base64(bytes);
}

/// Three bytes each: there are fewer than 16 million corners.
std::string base64_of(const std::vector<std::uint32_t>& values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * values.size());
  for (const std::uint32_t value : values) {
    for (int shift = 0; shift < 24; shift += 8)
      bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xff));
  }
  return base64(bytes);
}

Json mesh_json(const PageMesh& mesh) {
  Json out;
  out["min"] = vector_json(mesh.box_mm.min);
  out["max"] = vector_json(mesh.box_mm.max);
  out["places"] = base64_of(mesh.places);
  out["triangles"] = base64_of(mesh.triangles);
  if (!mesh.groups.empty()) out["groups"] = base64(mesh.groups);
  if (!mesh.deviations.empty()) out["deviations"] = base64(mesh.deviations);
  return out;
}

/// Colours and names, by class.
Json deviation_json(const PageOptions& options) {
  const double once = options.design.tolerance_mm, twice = 2 * once;
  const std::array<std::string, kDeviationClasses> names{
      trf("gouge, beyond {:.3g} mm", twice), trf("gouge, {:.3g} to {:.3g} mm", once, twice),
      trf("within {:.3g} mm", once), trf("excess, {:.3g} to {:.3g} mm", once, twice),
      trf("excess, beyond {:.3g} mm", twice)};
  Json out;
  out["colors"] = options.design.colors;
  out["names"] = Json::array();
  for (const std::string& name : names) out["names"].push_back(in_unit(name, options.units));
  return out;
}

Json places_json(const Report& report) {
  Json out = Json::array();
  const auto& kept = report.findings.kept();
  for (std::size_t i = 0; i < std::min(kept.size(), kMostOnPage); ++i) {
    const Diagnostic d = diagnostic_of(kept[i], report.program.files);
    Json item;
    item["severity"] = to_string(kept[i].severity);
    item["file"] = d.file;
    item["line"] = d.line;
    item["place"] = kept[i].position_mm ? vector_json(*kept[i].position_mm) : Json(nullptr);
    out.push_back(std::move(item));
  }
  return out;
}

std::string file_of(const Report& report, const SourceRef& source) {
  const auto& files = report.program.files;
  return source.file < files.size() ? files[source.file] : std::string();
}

/// [file, line, place], the files by their place in "files".
Json spots_json(const std::vector<PageSpot>& spots) {
  Json out = Json::array();
  for (const PageSpot& spot : spots) {
    Json place = nullptr;
    if (spot.place_mm) {
      place = Json::array();
      // A page has thousands of them; nobody sees a micrometre.
      for (int axis = 0; axis < 3; ++axis)
        place.push_back(std::round(1000 * (*spot.place_mm)[axis]) / 1000);
    }
    out.push_back(Json::array({spot.source.file, spot.source.line, std::move(place)}));
  }
  return out;
}

/// The lines that findings and `spots` name, and their neighbours, and those of `columns` alone: by
/// file, by number.
Json sources_json(const Report& report, const std::vector<PageSpot>& spots,
                  const std::vector<PageSpot>& columns) {
  std::map<std::string, std::set<std::uint32_t>> wanted;
  const auto want = [&](const std::string& file, std::uint32_t line, std::uint32_t around) {
    if (line == 0 || file.empty()) return;
    for (std::uint32_t n = line > around ? line - around : 1; n <= line + around; ++n)
      wanted[file].insert(n);
  };
  for (const PageSpot& spot : spots)
    want(file_of(report, spot.source), spot.source.line, kNeighbours);
  for (const PageSpot& spot : columns) want(file_of(report, spot.source), spot.source.line, 0);
  const auto& kept = report.findings.kept();
  for (std::size_t i = 0; i < std::min(kept.size(), kMostOnPage); ++i) {
    const Diagnostic d = diagnostic_of(kept[i], report.program.files);
    want(d.file, static_cast<std::uint32_t>(d.line), kNeighbours);
  }
  Json out = Json::object();
  for (const auto& [file, lines] : wanted) {
    const Result<std::string> text = read_small_file(file, kMostSource_bytes);
    if (!text) continue;
    Json rows = Json::object();
    std::istringstream in(*text);
    std::string line;
    for (std::uint32_t number = 1; std::getline(in, line) && number <= *lines.rbegin(); ++number) {
      if (!lines.contains(number)) continue;
      if (line.ends_with('\r')) line.pop_back();
      if (line.size() > kMostLine) line.resize(kMostLine);
      rows[fmt::format("{}", number)] = line;
    }
    out[file] = std::move(rows);
  }
  return out;
}

/// JSON within an element of a page: no "<" is left that could end it; what is no UTF-8 is U+FFFD.
std::string embedded(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string view_section(const PageMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  const auto button = [](const char* look, const char* text) {
    return fmt::format("<button type=\"button\" data-look=\"{}\">{}</button>", look,
                       xml_text(text));
  };
  const auto option = [](const char* value, const char* text) {
    return fmt::format("<option value=\"{}\">{}</option>", value, xml_text(text));
  };
  std::string out =
      fmt::format("<div><div class=\"view\"><noscript><p class=\"none\">{}</p></noscript></div>\n",
                  xml_text(tr("The part is drawn by a script, which this browser does not run.")));
  out += "<div class=\"tools\">" + button("iso", tr("oblique")) + button("top", tr("top")) +
         button("front", tr("front")) + button("right", tr("right")) + button("reset", tr("all"));
  out += fmt::format("<label>{} <select class=\"color\">", xml_text(tr("colours")));
  if (!mesh.deviations.empty()) out += option("deviation", tr("against the design"));
  if (!mesh.groups.empty()) out += option("tool", tr("by tool"));
  out += option("height", tr("by height")) + option("plain", tr("plain")) + "</select></label>";
  out += fmt::format("<label>{} <select class=\"section\">", xml_text(tr("cut open")));
  out += option("-1", tr("no")) + option("0", "X") + option("1", "Y") + option("2", "Z");
  out +=
      "</select><input class=\"share\" type=\"range\" min=\"0\" max=\"1000\" value=\"500\" "
      "disabled></label></div>\n<div class=\"legend\"></div>";
  out += fmt::format("<p class=\"soft\">{}</p></div>\n",
                     xml_text(tr("Drag to turn, with Shift or the right button to shift, wheel "
                                 "for nearer. A mark is a finding.")));
  return out;
}

std::string mesh_text(const PageMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  return trf("{} triangles for {}; {} corners of the full surface are {:.3f} mm from it at most",
             mesh.triangles.size() / 3, mesh.full_triangles, mesh.measured, mesh.deviation_mm);
}

}  // namespace

std::string report_page(const Report& report, const StockModel* stock, const PageOptions& options) {
  return page_of(report.program_path.empty() ? "kerf" : report.program_path, report.version,
                 page_article(report, stock, options));
}

std::string page_of(const std::string& title, const std::string& version, const std::string& body) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"kerf "
      "{}\">\n<title>{}</title>\n<style>\n{}</style></head>\n"
      "<body><main>\n",
      language(), xml_text(version), xml_text(title), page_assets::page_css);
  out += body;
  out += fmt::format("</main>\n<script>\n{}</script>\n</body></html>\n", page_assets::page_js);
  return out;
}

std::string page_article(const Report& report, const StockModel* stock,
                         const PageOptions& options) {
  PageMesh mesh;
  if (stock) {
    PageMeshOptions wanted;
    wanted.most_triangles = options.most_triangles;
    wanted.group_of = options.group_of;
    wanted.design = options.design.part;
    wanted.tolerance_mm = options.design.tolerance_mm;
    mesh = page_mesh(*stock, wanted);
  }
  const bool has_view = !mesh.triangles.empty();
  Json data;
  data["inch"] = options.units == LengthUnit::kInch;
  data["findings"] = places_json(report);
  data["files"] = report.program.files;
  data["texts"] = {{"view", tr("the part in 3D")},
                   {"uncut", tr("not cut")},
                   {"none", tr("This browser has no WebGL: the part is not drawn.")}};
  if (has_view) {
    const Box blank = report.stock ? report.stock->bounds_mm : mesh.box_mm;
    data["mesh"] = mesh_json(mesh);
    data["box"] = Json::array({vector_json(blank.min), vector_json(blank.max)});
    data["lathe"] = report.turning.has_value();
    data["groups"] = Json::array();
    for (const PageGroup& group : options.groups)
      data["groups"].push_back(
          {{"name", in_unit(group.name, options.units)}, {"color", group.color}});
    if (!mesh.deviations.empty()) data["deviation"] = deviation_json(options);
  } else {
    data["mesh"] = nullptr;
  }
  std::string out = options.anchor.empty()
                        ? std::string("<article>\n")
                        : fmt::format("<article id=\"{}\">\n", xml_text(options.anchor));
  out += head_section(report, options);
  out += fmt::format("<section><h2>{}</h2>\n", xml_text(tr("Part and findings")));
  out += has_view ? "<div class=\"split\">" + view_section(mesh) + "<div>" : "<div><div>";
  out +=
      finding_list(report, options.units) + "<pre class=\"program\"></pre></div></div></section>\n";
  out += setup_section(report, options, has_view);
  out += tool_section(report, options.units);
  PageSpots spots;
  out += load_section(report, options.units, spots);
  out += collision_section(report, options.units);
  out += compare_section(report, options.units);
  out += part_section(report, options.units);
  out += curve_section(options.curves, options.units);
  out += exactness_section(report, options, mesh_text(mesh));
  data["sources"] = sources_json(report, spots.all(), options.curves.spots);
  data["spots"] = spots_json(spots.all());
  data["columns"] = spots_json(options.curves.spots);
  out +=
      fmt::format("<script class=\"kerf-data\" type=\"application/json\">{}</script>\n</article>\n",
                  embedded(data));
  return out;
}

}  // namespace kerf
