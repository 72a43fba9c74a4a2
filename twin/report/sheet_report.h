// twin/report/sheet_report.h - what became of a sheet: cuts, parts, what is left.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "interp_bridge/motion.h"
#include "twin/process/process.h"

namespace kerf {

class Sheet;

/// A piece that the program has cut free.
struct SheetPart {
  std::uint32_t number = 0;  ///< SheetPiece::number
  double area_mm2 = 0;
  Vec2 min_mm{0}, max_mm{0};  ///< bounding box
  double weight_kg = 0;
  SourceRef freed_by;
  std::optional<PieceOrigin> freed_before;  ///< in its place, before the sheet was saved
};

struct SheetReport {
  std::shared_ptr<const ProcessSums> sums;  ///< what its process has done
  double thickness_mm = 0;
  double density_kg_per_m3 = 0;
  double blank_mm2 = 0;
  double remaining_mm2 = 0;  ///< of the sheet that is left, parts and slugs not counted
  double kerf_mm2 = 0;       ///< what was cut away
  std::vector<SheetPart> parts;
  /// Pieces within the holes of parts: scrap. (What lies within their holes in turn are parts.)
  std::vector<SheetPart> slugs;
  std::vector<FreedPiece> freed;  ///< all of them, by number

  double parts_mm2() const;
  /// Nesting yield: area of the parts, of the area of the blank.
  double yield() const { return blank_mm2 > 0 ? parts_mm2() / blank_mm2 : 0; }
};

/// Pieces smaller than a square millimetre are slivers of rounding, and neither part nor slug.
/// O(tiles and corners), and O(n^2) box tests for n pieces.
SheetReport sheet_report(const Sheet& sheet, const Process& process, double density_kg_per_m3);

/// cut_mm, pierces, beam_s, thickness_mm, density_kg_per_m3, blank_mm2, remaining_mm2, kerf_mm2,
/// parts_mm2, yield, parts and slugs: number, area_mm2, bounds_mm, weight_kg, file, line. Of a
/// sheet that was punched, instead of the first three, `punch`: hits, nibbled_mm, regrips,
/// stations: each with station, name, shape, hits.
nlohmann::ordered_json sheet_json(const SheetReport& report, const std::vector<std::string>& files);

/// Lines for the page of text; the first kPartsShown parts.
std::string sheet_text(const SheetReport& report);
/// The same in one line, for one of several runs.
std::string sheet_run_text(const SheetReport& report);
inline constexpr std::size_t kPartsShown = 20;

/// The sheet that is left into `path`, each part into a file beside it (part_path()). An empty path
/// writes nothing, and "-" the sheet alone. Each file appears whole or not at all; all that can be
/// are written. Errors are appended.
void write_outlines(const Sheet& sheet, const SheetReport& report, const std::string& dxf_path,
                    const std::string& svg_path, std::vector<std::string>& errors);
/// Into a file from which it can be cut on, with the lines that freed its pieces. `files` as for
/// sheet_json(). Error: what could not be written and why.
Done save_sheet(const Sheet& sheet, const SheetReport& report,
                const std::vector<std::string>& files, const std::string& path);
/// "out/rest.dxf" and 3: "out/rest-part-3.dxf".
std::string part_path(const std::string& path, std::uint32_t part);

}  // namespace kerf
