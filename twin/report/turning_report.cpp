#include "twin/report/turning_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/translate.h"
#include "stock/turning/turning_stock.h"
#include "twin/findings/finding_json.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;

double weight_kg(const TurnedPiece& piece, double density_kg_per_m3) {
  return piece.volume_mm3 * 1e-9 * density_kg_per_m3;
}

}  // namespace

TurningReport turning_report(const StockModel& stock, const Process& process,
                             double density_kg_per_m3) {
  TurningReport report;
  const TurningStock& turned = *stock.turned();
  report.density_kg_per_m3 = density_kg_per_m3;
  // It has cells once a driven tool has cut.
  if (stock.cell_mm() != turned.cell_mm()) report.milled_cell_mm = stock.cell_mm();
  report.pieces.assign(process.fallen().begin(), process.fallen().end());
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
  Json pieces = Json::array();
  for (const FallenPiece& fallen : report.pieces) {
    const TurnedPiece& piece = fallen.piece;
    Json item;
    item["volume_mm3"] = rounded(piece.volume_mm3);
    item["weight_kg"] = rounded(weight_kg(piece, report.density_kg_per_m3));
    item["z_mm"] = {rounded(piece.low_z_mm), rounded(piece.high_z_mm)};
    item["diameter_mm"] = rounded(2 * piece.high_r_mm);
    item["bore_mm"] = rounded(2 * piece.low_r_mm);
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
  for (std::size_t i = 0; i < std::min(report.pieces.size(), kPiecesShown); ++i) {
    const FallenPiece& fallen = report.pieces[i];
    const TurnedPiece& piece = fallen.piece;
    out +=
        trf("piece     off in line {}: {:.2f} mm long, diameter {:.2f} mm, {:.2f} cm3, {:.3f} kg\n",
            fallen.source.line, piece.high_z_mm - piece.low_z_mm, 2 * piece.high_r_mm,
            piece.volume_mm3 / 1000, weight_kg(piece, report.density_kg_per_m3));
  }
  if (report.pieces.size() > kPiecesShown) {
    out += trf("          and {} more\n", report.pieces.size() - kPiecesShown);
  }
  return out;
}

}  // namespace kerf
