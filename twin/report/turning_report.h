// twin/report/turning_report.h - what became of a workpiece that turns.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/process/process.h"

namespace kerf {

class StockModel;

struct TurningReport {
  double density_kg_per_m3 = 0;
  std::vector<FallenPiece> pieces;  ///< that have come off, in order
  double length_mm = 0;             ///< of what is left
  double diameter_mm = 0;           ///< greatest, of what is left
  double milled_cell_mm = 0;        ///< 0: no driven tool has cut
};

/// Of a model that has turned(). Length, diameter and pieces are those of the profile, whatever has
/// been milled.
TurningReport turning_report(const StockModel& stock, const Process& process,
                             double density_kg_per_m3);

/// length_mm, diameter_mm, milled_cell_mm (if it was milled), density_kg_per_m3, pieces:
/// volume_mm3, weight_kg, z_mm, diameter_mm, bore_mm, file, line, time_s, tool.
nlohmann::ordered_json turning_json(const TurningReport& report,
                                    const std::vector<std::string>& files);
/// Lines for the page of text; the first kPiecesShown pieces.
std::string turning_text(const TurningReport& report);
inline constexpr std::size_t kPiecesShown = 20;

}  // namespace kerf
