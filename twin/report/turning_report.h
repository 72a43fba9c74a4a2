// twin/report/turning_report.h - what became of a workpiece that turns.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "stock/turning/thread_gauge.h"
#include "stock/turning/turned_features.h"
#include "twin/process/process.h"

namespace kerf {

class StockModel;

/// What is measured of a turned part.
struct TurnedFacts {
  std::vector<TurnedFeature> features;
  std::vector<MeasuredThread> threads;
};

struct TurningReport {
  double density_kg_per_m3 = 0;
  std::vector<FallenPiece> pieces;       ///< that have come off, in order
  std::vector<TurnedFacts> piece_facts;  ///< of each of them
  TurnedFacts facts;                     ///< of what is left
  double length_mm = 0;                  ///< of what is left
  double diameter_mm = 0;                ///< greatest, of what is left
  double milled_cell_mm = 0;             ///< 0: no driven tool has cut
};

/// Of a model that has turned(). Length, diameter and pieces are those of the profile, whatever has
/// been milled.
TurningReport turning_report(const StockModel& stock, const Process& process,
                             double density_kg_per_m3);

/// length_mm, diameter_mm, milled_cell_mm (if it was milled), density_kg_per_m3, surfaces, threads,
/// pieces: volume_mm3, weight_kg, z_mm, diameter_mm, bore_mm, surfaces, threads, file, line,
/// time_s, tool. Surfaces (features_of()) have kind (cylinder, face, taper, radius, groove),
/// inside, z_mm, diameter_mm, and angle_deg, radius_mm, depth_mm where they have such; threads
/// (measure_threads()) internal, hand, starts, pitch_mm, lead_mm, major_mm, minor_mm,
/// pitch_diameter_mm, angle_deg, taper, z_mm of the full form, run_out_mm at either end.
nlohmann::ordered_json turning_json(const TurningReport& report,
                                    const std::vector<std::string>& files);
/// Lines for the page of text; the first kPiecesShown pieces, and of the last of them (or of what
/// is left, if there is none) the first kSurfacesShown surfaces, and its threads.
std::string turning_text(const TurningReport& report);
inline constexpr std::size_t kPiecesShown = 20, kSurfacesShown = 20;
/// Smaller ones are slivers: neither shown nor written (JSON has them).
inline constexpr double kLeastPiece_mm3 = 1;

}  // namespace kerf
