#include "twin/report/sheet_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/translate.h"
#include "stock/plane/outline_file.h"
#include "stock/sheet/sheet.h"
#include "twin/findings/finding_json.h"

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
    PlaneOutline outline;
    for (std::size_t inner = 0; inner < pieces.size(); ++inner) {
      if (!box_holds(pieces[outer], pieces[inner])) continue;
      if (outline.rings.empty()) outline = sheet.outline_of(pieces[outer].number);
      // A corner of the inner one: in the rings that turn left it is round by, holes left aside.
      const PlaneOutline within = sheet.outline_of(pieces[inner].number);
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

SheetPart part_of(const SheetPiece& piece, std::span<const FreedPiece> freed, double density) {
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

}  // namespace

double SheetReport::parts_mm2() const {
  double sum = 0;
  for (const SheetPart& part : parts) sum += part.area_mm2;
  return sum;
}

namespace {

SheetReport report_of(const Sheet& sheet, std::span<const FreedPiece> freed_pieces,
                      double density) {
  SheetReport report;
  report.freed.assign(freed_pieces.begin(), freed_pieces.end());
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

}  // namespace

SheetReport sheet_report(const Sheet& sheet, const Process& process, double density) {
  SheetReport report = report_of(sheet, process.freed(), density);
  report.sums = process.sums();
  return report;
}

Json sheet_json(const SheetReport& report, const std::vector<std::string>& files) {
  Json out;
  if (report.sums) report.sums->add_json(out);
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
  std::string out = report.sums ? report.sums->text() : std::string();
  out += trf("          {}, {} ({:.1f} % of the blank); {}; {} left\n",
             trnf("{} part", "{} parts", report.parts.size()), area_text(report.parts_mm2()),
             100 * report.yield(), trnf("{} slug", "{} slugs", report.slugs.size()),
             area_text(report.remaining_mm2));
  for (std::size_t i = 0; i < std::min(report.parts.size(), kPartsShown); ++i) {
    const SheetPart& part = report.parts[i];
    const Vec2 size = part.max_mm - part.min_mm;
    out += trf("          part {:<4} {}, {:.1f} x {:.1f} mm, {:.3f} kg, {}\n", part.number,
               area_text(part.area_mm2), size.x, size.y, part.weight_kg,
               free_since({part.number, part.freed_by, 0, part.freed_before}));
  }
  if (report.parts.size() > kPartsShown) {
    out += trf("          and {} more\n", report.parts.size() - kPartsShown);
  }
  return out;
}

std::string sheet_run_text(const SheetReport& report) {
  const std::string done = report.sums ? report.sums->run_text() : std::string();
  return trf("sheet: {}; {}, {}; {}; {} left\n", done,
             trnf("{} part", "{} parts", report.parts.size()), area_text(report.parts_mm2()),
             trnf("{} slug", "{} slugs", report.slugs.size()), area_text(report.remaining_mm2));
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
  PlaneOutline rest;
  for (const SheetPiece& piece : sheet.pieces()) {
    if (!piece.is_main()) continue;
    PlaneOutline outline = sheet.outline_of(piece.number);
    std::move(outline.rings.begin(), outline.rings.end(), std::back_inserter(rest.rings));
  }
  using Writer = Done (*)(const PlaneOutline&, double, const std::string&);
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
