#include "twin/report/turning_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "stock/turning/turned_surface.h"
#include "twin/findings/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

double weight_kg(const TurnedPiece& piece, double density_kg_per_m3) {
  return piece.volume_mm3 * 1e-9 * density_kg_per_m3;
}

TurnedFacts facts_of(const TurnedPart& part) { return {features_of(part), measure_threads(part)}; }

const char* name_of(TurnedFeature::Kind kind) {
  switch (kind) {
    case TurnedFeature::Kind::kCylinder:
      return "cylinder";
    case TurnedFeature::Kind::kFace:
      return "face";
    case TurnedFeature::Kind::kTaper:
      return "taper";
    case TurnedFeature::Kind::kRadius:
      return "radius";
    case TurnedFeature::Kind::kGroove:
      return "groove";
  }
  return "";
}

Json surfaces_json(const std::vector<TurnedFeature>& features) {
  using Kind = TurnedFeature::Kind;
  Json out = Json::array();
  for (const TurnedFeature& f : features) {
    Json item;
    item["kind"] = name_of(f.kind);
    item["inside"] = f.is_inside;
    item["z_mm"] = {rounded(f.low_z_mm), rounded(f.high_z_mm)};
    item["diameter_mm"] = {rounded(f.low_d_mm), rounded(f.high_d_mm)};
    if (f.kind == Kind::kTaper) item["angle_deg"] = rounded(f.angle_deg);
    if (f.kind == Kind::kRadius) item["radius_mm"] = rounded(f.radius_mm);
    if (f.kind == Kind::kGroove) item["depth_mm"] = rounded(f.depth_mm());
    out.push_back(std::move(item));
  }
  return out;
}

Json threads_json(const std::vector<MeasuredThread>& threads) {
  Json out = Json::array();
  for (const MeasuredThread& t : threads) {
    Json item;
    item["internal"] = t.is_internal;
    item["hand"] = t.is_right_hand ? "right" : "left";
    item["starts"] = t.starts;
    item["pitch_mm"] = rounded(t.pitch_mm());
    item["lead_mm"] = rounded(t.lead_mm);
    item["major_mm"] = rounded(t.major_mm);
    item["minor_mm"] = rounded(t.minor_mm);
    item["pitch_diameter_mm"] = rounded(t.pitch_diameter_mm);
    item["angle_deg"] = rounded(t.angle_rad * 180 / kPi);
    item["taper"] = rounded(t.taper);
    item["z_mm"] = {rounded(t.low_z_mm), rounded(t.high_z_mm)};
    item["run_out_mm"] = {rounded(t.low_run_out_mm), rounded(t.high_run_out_mm)};
    out.push_back(std::move(item));
  }
  return out;
}

std::string text_of(const TurnedFeature& f) {
  using Kind = TurnedFeature::Kind;
  const std::string z = f.low_z_mm == f.high_z_mm
                            ? fmt::format("Z{:.3f}", f.high_z_mm + 0.0)
                            : fmt::format("Z{:.3f} .. {:.3f}", f.high_z_mm + 0.0, f.low_z_mm + 0.0);
  switch (f.kind) {
    case Kind::kCylinder:
      return trf("{}: {} {:.3f} mm", z, f.is_inside ? tr("bore") : tr("diameter"), f.low_d_mm);
    case Kind::kFace:
      return trf("{}: face, diameter {:.3f} to {:.3f} mm", z, f.low_d_mm, f.high_d_mm);
    case Kind::kTaper:
      return trf("{}: taper of {:.2f} degrees, diameter {:.3f} to {:.3f} mm", z, f.angle_deg,
                 f.low_d_mm, f.high_d_mm);
    case Kind::kRadius:
      return trf("{}: radius {:.3f} mm", z, f.radius_mm);
    case Kind::kGroove:
      return trf("{}: groove {:.3f} mm wide, {:.3f} mm deep, to diameter {:.3f} mm", z,
                 f.width_mm(), f.depth_mm(), f.is_inside ? f.high_d_mm : f.low_d_mm);
  }
  return {};
}

std::string text_of(const MeasuredThread& t) {
  std::string out = trf(
      "Z{:.2f} .. {:.2f}: {} thread, pitch {:.4g} mm, major {:.3f} mm, pitch diameter {:.3f} mm, "
      "minor {:.3f} mm",
      t.high_z_mm + 0.0, t.low_z_mm + 0.0, t.is_internal ? tr("inner") : tr("outer"), t.pitch_mm(),
      t.major_mm, t.pitch_diameter_mm, t.minor_mm);
  if (t.starts > 1) out += trf(", {} starts", t.starts);
  if (!t.is_right_hand) out += tr(", left-hand");
  return out;
}

std::string text_of(const TurnedFacts& facts) {
  std::string out;
  const std::size_t shown = std::min(facts.features.size(), kSurfacesShown);
  for (std::size_t i = 0; i < shown; ++i)
    out += fmt::format("          {}\n", text_of(facts.features[i]));
  if (facts.features.size() > shown)
    out += trf("          and {} more\n", facts.features.size() - shown);
  for (const MeasuredThread& thread : facts.threads)
    out += fmt::format("          {}\n", text_of(thread));
  return out;
}

}  // namespace

TurningReport turning_report(const StockModel& stock, const Process& process,
                             double density_kg_per_m3) {
  TurningReport report;
  const TurningStock& turned = *stock.turned();
  report.density_kg_per_m3 = density_kg_per_m3;
  // It has cells once a driven tool has cut.
  if (!is_turned_alone(stock)) report.milled_cell_mm = stock.cell_mm();
  report.pieces.assign(process.fallen().begin(), process.fallen().end());
  for (const FallenPiece& fallen : report.pieces) {
    report.piece_facts.push_back(fallen.piece.part ? facts_of(*fallen.piece.part) : TurnedFacts());
  }
  report.facts = facts_of(turned.part());
  Box left;
  for (const std::vector<Vec2>& ring : turned.part().profile()) {
    for (const Vec2& p : ring) left.extend(Vec3(p.x, p.y, 0));
  }
  if (left.empty()) return report;
  report.length_mm = left.max.x - left.min.x;
  report.diameter_mm = 2 * left.max.y;
  return report;
}

Json turning_json(const TurningReport& report, const std::vector<std::string>& files) {
  Json out;
  out["length_mm"] = rounded(report.length_mm);
  out["diameter_mm"] = rounded(report.diameter_mm);
  if (report.milled_cell_mm > 0) out["milled_cell_mm"] = rounded(report.milled_cell_mm);
  out["density_kg_per_m3"] = rounded(report.density_kg_per_m3);
  out["surfaces"] = surfaces_json(report.facts.features);
  out["threads"] = threads_json(report.facts.threads);
  Json pieces = Json::array();
  for (std::size_t i = 0; i < report.pieces.size(); ++i) {
    const FallenPiece& fallen = report.pieces[i];
    const TurnedPiece& piece = fallen.piece;
    Json item;
    item["volume_mm3"] = rounded(piece.volume_mm3);
    item["weight_kg"] = rounded(weight_kg(piece, report.density_kg_per_m3));
    item["z_mm"] = {rounded(piece.low_z_mm), rounded(piece.high_z_mm)};
    item["diameter_mm"] = rounded(2 * piece.high_r_mm);
    item["bore_mm"] = rounded(2 * piece.low_r_mm);
    item["surfaces"] = surfaces_json(report.piece_facts[i].features);
    item["threads"] = threads_json(report.piece_facts[i].threads);
    if (fallen.source.file < files.size()) item["file"] = files[fallen.source.file];
    item["line"] = fallen.source.line;
    item["time_s"] = rounded(fallen.time_s);
    item["tool"] = fallen.tool;
    pieces.push_back(std::move(item));
  }
  out["pieces"] = std::move(pieces);
  return out;
}

std::string turning_text(const TurningReport& report) {
  std::string out = trf("part      {:.2f} mm long, diameter {:.2f} mm at most\n", report.length_mm,
                        report.diameter_mm);
  if (report.milled_cell_mm > 0)
    out += trf("          milled by driven tools, in cells of {:g} mm\n", report.milled_cell_mm);
  const auto last = std::find_if(
      report.pieces.rbegin(), report.pieces.rend(),
      [](const FallenPiece& fallen) { return fallen.piece.volume_mm3 >= kLeastPiece_mm3; });
  if (last == report.pieces.rend()) out += text_of(report.facts);
  for (std::size_t i = 0; i < std::min(report.pieces.size(), kPiecesShown); ++i) {
    const FallenPiece& fallen = report.pieces[i];
    const TurnedPiece& piece = fallen.piece;
    if (piece.volume_mm3 < kLeastPiece_mm3) continue;
    out +=
        trf("piece     off in line {}: {:.2f} mm long, diameter {:.2f} mm, {:.2f} cm3, {:.3f} kg\n",
            fallen.source.line, piece.high_z_mm - piece.low_z_mm, 2 * piece.high_r_mm,
            piece.volume_mm3 / 1000, weight_kg(piece, report.density_kg_per_m3));
  }
  if (last != report.pieces.rend()) {
    out += text_of(
        report
            .piece_facts[static_cast<std::size_t>(std::distance(last, report.pieces.rend()) - 1)]);
  }
  if (report.pieces.size() > kPiecesShown) {
    out += trf("          and {} more\n", report.pieces.size() - kPiecesShown);
  }
  return out;
}

}  // namespace kerf
