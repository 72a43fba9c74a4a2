#include "twin/cli/compare_option.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "twin/cli/program_options.h"
#include "twin/compare/design_fit.h"
#include "twin/report/compare_report.h"

namespace kerf {
namespace {

constexpr std::size_t kFitPoints = 20'000;
/// Once round, either way.
constexpr double kMostTurn_deg = 360;

std::optional<Vec3> three_angles(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) return std::nullopt;
  Vec3 out(0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> angle = parse_decimal(parts[static_cast<std::size_t>(axis)]);
    if (!angle || std::abs(*angle) > kMostTurn_deg) return std::nullopt;
    out[axis] = *angle;
  }
  return out;
}

void read_place(OptionReader& reader, DesignPlacement& placement) {
  const ChosenValue value = reader.choose("--compare-at");
  if (!value.is_said()) return;
  const std::string text = value.text;
  const std::size_t colon = text.find(':');
  const std::optional<Vec3> shift = three_lengths(text.substr(0, colon), reader.unit());
  const std::optional<Vec3> turn =
      colon == std::string::npos ? Vec3(0) : three_angles(std::string_view(text).substr(colon + 1));
  if (!shift || !turn) {
    reader.fault(
        "--compare-at",
        trf("'{}' is not allowed; must be X,Y,Z ({}) or X,Y,Z:A,B,C with degrees from -360 "
            "to 360",
            text, name_of(reader.unit())),
        tr("as in --compare-at 10,0,-5:0,0,90: turned about Z, then shifted"));
    return;
  }
  placement = {*shift, *turn};
}

}  // namespace

CompareRequest understand_compare(OptionReader& reader) {
  CompareRequest request;
  request.path = reader.text("--compare");
  request.tolerance_mm = reader.length_mm("--tolerance", request.tolerance_mm);
  read_place(reader, request.placement);
  if (reader.word("--compare-unit") == 1) request.mm_per_unit = kMmPerInch;
  const bool can_fit = reader.command() != kView;
  if (can_fit) request.is_fitted = reader.is_yes("--compare-fit");
  if (request.is_wanted()) return request;
  for (const char* option :
       {"--tolerance", "--compare-at", "--compare-unit", "--compare-fit", "--compare-png"}) {
    if (!can_fit && std::string_view(option).ends_with("-fit")) break;
    if (reader.choose(option).from == ValueFrom::kCommandLine)
      reader.fault(option, tr("there is no --compare DESIGN.stl"));
  }
  return request;
}

std::shared_ptr<const DesignFile> open_design(const CompareRequest& request,
                                              Diagnostics& diagnostics) {
  if (!request.is_wanted()) return nullptr;
  return read_design(request.path, request.mm_per_unit, diagnostics);
}

std::shared_ptr<const DesignPart> placed_design(const CompareRequest& request,
                                                Diagnostics& diagnostics) {
  const std::shared_ptr<const DesignFile> file = open_design(request, diagnostics);
  if (!file) return nullptr;
  return std::make_shared<const DesignPart>(file->placed(request.placement, diagnostics));
}

std::shared_ptr<const DesignPart> compare_finished(const CompareRequest& request,
                                                   const DesignFile& file, const StockModel* stock,
                                                   const CutHistory& history, Report& report,
                                                   Diagnostics& diagnostics) {
  if (stock == nullptr) {
    Diagnostic d;
    d.message = tr("--compare: stopped before there was a workpiece; nothing is compared");
    diagnostics.push_back(std::move(d));
    return nullptr;
  }
  DesignPlacement placement = request.placement;
  std::optional<double> residue_mm;
  if (request.is_fitted) {
    Diagnostics unheard;  // the same is said of it where it lies in the end
    const DesignPart as_read = file.placed({}, unheard);
    const std::optional<DesignFit> fit = fit_design_in_blank(
        as_read, stock->bounds_mm(), fit_points(*stock, kFitPoints), request.placement);
    if (fit) {
      placement = fit->placement;
      residue_mm = fit->residue_mm;
    } else {
      Diagnostic d;
      d.file = file.path;
      d.message =
          tr("--compare-fit: the part does not fit anywhere near; it is compared where it "
             "was given");
      d.hint = tr("--compare-at says where it lies about");
      diagnostics.push_back(std::move(d));
    }
  }
  auto design = std::make_shared<const DesignPart>(file.placed(placement, diagnostics));
  doubt_place(*design, file.path, stock->bounds_mm(), request.tolerance_mm, diagnostics);
  Comparison comparison = compare_stock(*stock, *design, {request.tolerance_mm}, history);
  comparison.design = file.path;
  comparison.placement = placement.text();
  comparison.fit_residue_mm = residue_mm;
  std::vector<int> guessed;
  for (const ToolUse& use : report.tools)
    if (use.guessed) guessed.push_back(use.number);
  add_compare_findings(comparison, guessed, report.findings);
  report.timing.total_s += comparison.seconds;
  report.comparison = std::move(comparison);
  return design;
}

}  // namespace kerf
