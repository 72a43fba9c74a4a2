#include "twin/sheet_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "stock/sheet/outline_file.h"
#include "twin/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastPart_mm2 = 1;

double area_of(const std::vector<Vec2>& ring) {
  double twice = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    twice += ring[j].x * ring[i].y - ring[i].x * ring[j].y;
  }
  return twice / 2;
}

bool is_within(const Vec2& p, const std::vector<Vec2>& ring) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec2 &a = ring[i], &b = ring[j];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

bool box_holds(const SheetPiece& outer, const SheetPiece& inner) {
  return outer.min_mm.x < inner.min_mm.x && outer.min_mm.y < inner.min_mm.y &&
         outer.max_mm.x > inner.max_mm.x && outer.max_mm.y > inner.max_mm.y;
}

/// How many other pieces lie round each.
std::vector<int> depths_of(const Sheet& sheet, const std::vector<SheetPiece>& pieces) {
  std::vector<int> depths(pieces.size(), 0);
  for (std::size_t outer = 0; outer < pieces.size(); ++outer) {
    SheetOutline outline;
    for (std::size_t inner = 0; inner < pieces.size(); ++inner) {
      if (!box_holds(pieces[outer], pieces[inner])) continue;
      if (outline.rings.empty()) outline = sheet.outline_of(pieces[outer].number);
      // A corner of the inner one: in the rings that turn left it is round by, holes left aside.
      const SheetOutline within = sheet.outline_of(pieces[inner].number);
      if (within.rings.empty()) continue;
      const Vec2 corner = within.rings[0][0];
      for (const std::vector<Vec2>& ring : outline.rings) {
        if (area_of(ring) > 0 && is_within(corner, ring)) ++depths[inner];
      }
    }
  }
  return depths;
}

PieceOrigin origin_of(const SourceRef& source, const std::optional<PieceOrigin>& before,
                      const std::vector<std::string>& files) {
  if (before) return *before;
  return {source.file < files.size() ? files[source.file] : std::string(), source.line};
}

SheetPart part_of(const SheetPiece& piece, const std::vector<FreedPiece>& freed, double density) {
  SheetPart part;
  part.number = piece.number;
  part.area_mm2 = piece.area_mm2;
  part.min_mm = piece.min_mm;
  part.max_mm = piece.max_mm;
  part.weight_kg = piece.weight_kg(density);
  const auto by = std::lower_bound(
      freed.begin(), freed.end(), piece.number,
      [](const FreedPiece& entry, std::uint32_t number) { return entry.number < number; });
  if (by != freed.end() && by->number == piece.number) {
    part.freed_by = by->source;
    part.freed_before = by->before;
  }
  return part;
}

Json parts_json(const std::vector<SheetPart>& parts, const std::vector<std::string>& files) {
  Json out = Json::array();
  for (const SheetPart& part : parts) {
    Json item;
    item["number"] = part.number;
    item["area_mm2"] = rounded(part.area_mm2);
    item["bounds_mm"] = Json::array({{rounded(part.min_mm.x), rounded(part.min_mm.y)},
                                     {rounded(part.max_mm.x), rounded(part.max_mm.y)}});
    item["weight_kg"] = rounded(part.weight_kg);
    const PieceOrigin origin = origin_of(part.freed_by, part.freed_before, files);
    item["file"] = origin.file;
    item["line"] = origin.line;
    out.push_back(std::move(item));
  }
  return out;
}

std::string area_text(double mm2) { return fmt::format("{:.2f} cm2", mm2 / 100); }

std::string count_text(std::size_t n, const char* word) {
  return fmt::format("{} {}{}", n, word, n == 1 ? "" : "s");
}

}  // namespace

double SheetReport::parts_mm2() const {
  double sum = 0;
  for (const SheetPart& part : parts) sum += part.area_mm2;
  return sum;
}

namespace {

SheetReport report_of(const Sheet& sheet, const std::vector<FreedPiece>& freed_pieces,
                      double density) {
  SheetReport report;
  report.freed = freed_pieces;
  report.thickness_mm = sheet.thickness_mm();
  report.density_kg_per_m3 = density;
  report.blank_mm2 = sheet.blank_mm3() / sheet.thickness_mm();
  report.kerf_mm2 = report.blank_mm2 - sheet.remaining_mm2();
  std::vector<SheetPiece> freed;
  for (const SheetPiece& piece : sheet.pieces()) {
    if (piece.is_main()) {
      report.remaining_mm2 += piece.area_mm2;
    } else if (piece.area_mm2 >= kLeastPart_mm2) {
      freed.push_back(piece);
    }
  }
  const std::vector<int> depths = depths_of(sheet, freed);
  for (std::size_t i = 0; i < freed.size(); ++i) {
    std::vector<SheetPart>& list = depths[i] % 2 == 0 ? report.parts : report.slugs;
    list.push_back(part_of(freed[i], freed_pieces, density));
  }
  return report;
}

Json punch_json(const PunchTotals& punch) {
  Json out;
  out["hits"] = punch.hits;
  out["nibbled_mm"] = rounded(punch.nibbled_mm);
  out["regrips"] = punch.regrips;
  Json stations = Json::array();
  for (const StationUse& use : punch.stations) {
    stations.push_back(
        {{"station", use.station}, {"name", use.name}, {"shape", use.shape}, {"hits", use.hits}});
  }
  out["stations"] = std::move(stations);
  return out;
}

std::string punch_text(const PunchTotals& punch) {
  std::string out = fmt::format("sheet     {}", count_text(punch.hits, "hit"));
  if (punch.nibbled_mm > 0) out += fmt::format(", {:.1f} mm nibbled", punch.nibbled_mm);
  if (punch.regrips > 0) out += fmt::format(", {}", count_text(punch.regrips, "re-grip"));
  out += '\n';
  for (const StationUse& use : punch.stations) {
    out += fmt::format("          station {:<3} {}, {}{}\n", use.station, use.shape,
                       count_text(use.hits, "hit"),
                       use.name.empty() ? "" : fmt::format(" ({})", use.name));
  }
  return out;
}

}  // namespace

SheetReport sheet_report(const Sheet& sheet, const TorchStage& stage, double density) {
  SheetReport report = report_of(sheet, stage.freed(), density);
  report.cuts = stage.totals();
  return report;
}

SheetReport sheet_report(const Sheet& sheet, const PunchStage& stage, double density) {
  SheetReport report = report_of(sheet, stage.freed(), density);
  report.punch = stage.totals();
  return report;
}

Json sheet_json(const SheetReport& report, const std::vector<std::string>& files) {
  Json out;
  if (report.punch) {
    out["punch"] = punch_json(*report.punch);
  } else {
    out["cut_mm"] = rounded(report.cuts.cut_mm);
    out["pierces"] = report.cuts.pierces;
    out["beam_s"] = rounded(report.cuts.beam_s);
  }
  out["thickness_mm"] = rounded(report.thickness_mm);
  out["density_kg_per_m3"] = rounded(report.density_kg_per_m3);
  out["blank_mm2"] = rounded(report.blank_mm2);
  out["remaining_mm2"] = rounded(report.remaining_mm2);
  out["kerf_mm2"] = rounded(report.kerf_mm2);
  out["parts_mm2"] = rounded(report.parts_mm2());
  out["yield"] = rounded(report.yield());
  out["parts"] = parts_json(report.parts, files);
  out["slugs"] = parts_json(report.slugs, files);
  return out;
}

std::string sheet_text(const SheetReport& report) {
  std::string out =
      report.punch
          ? punch_text(*report.punch)
          : fmt::format("sheet     cut {:.1f} mm, {}, beam on for {:.1f} s\n", report.cuts.cut_mm,
                        count_text(report.cuts.pierces, "pierce"), report.cuts.beam_s);
  out += fmt::format("          {}, {} ({:.1f} % of the blank); {}; {} left\n",
                     count_text(report.parts.size(), "part"), area_text(report.parts_mm2()),
                     100 * report.yield(), count_text(report.slugs.size(), "slug"),
                     area_text(report.remaining_mm2));
  for (std::size_t i = 0; i < std::min(report.parts.size(), kPartsShown); ++i) {
    const SheetPart& part = report.parts[i];
    const Vec2 size = part.max_mm - part.min_mm;
    out += fmt::format("          part {:<4} {}, {:.1f} x {:.1f} mm, {:.3f} kg, {}\n", part.number,
                       area_text(part.area_mm2), size.x, size.y, part.weight_kg,
                       free_since({part.number, part.freed_by, 0, part.freed_before}));
  }
  if (report.parts.size() > kPartsShown) {
    out += fmt::format("          and {} more\n", report.parts.size() - kPartsShown);
  }
  return out;
}

Done save_sheet(const Sheet& sheet, const SheetReport& report,
                const std::vector<std::string>& files, const std::string& path) {
  std::map<std::uint32_t, PieceOrigin> origins;
  for (const FreedPiece& piece : report.freed) {
    if (!piece.before) origins[piece.number] = origin_of(piece.source, piece.before, files);
  }
  return sheet.save(path, origins);
}

std::string part_path(const std::string& path, std::uint32_t part) {
  const std::filesystem::path file(path);
  const std::string name =
      fmt::format("{}-part-{}{}", file.stem().string(), part, file.extension().string());
  return file.parent_path().empty() ? name : (file.parent_path() / name).string();
}

void write_outlines(const Sheet& sheet, const SheetReport& report, const std::string& dxf_path,
                    const std::string& svg_path, std::vector<std::string>& errors) {
  SheetOutline rest;
  for (const SheetPiece& piece : sheet.pieces()) {
    if (!piece.is_main()) continue;
    SheetOutline outline = sheet.outline_of(piece.number);
    std::move(outline.rings.begin(), outline.rings.end(), std::back_inserter(rest.rings));
  }
  using Writer = Done (*)(const SheetOutline&, double, const std::string&);
  const double tolerance_mm = sheet.arc_tolerance_mm();
  const auto write = [&](Writer writer, const std::string& path) {
    if (path.empty()) return;
    const auto note = [&errors](const Done& done) {
      if (!done) errors.push_back(done.error());
    };
    note(writer(rest, tolerance_mm, path));
    if (written_as_it_comes(path)) return;
    for (const SheetPart& part : report.parts) {
      note(writer(sheet.outline_of(part.number), tolerance_mm, part_path(path, part.number)));
    }
  };
  write(write_outline_dxf, dxf_path);
  write(write_outline_svg, svg_path);
}

}  // namespace kerf
