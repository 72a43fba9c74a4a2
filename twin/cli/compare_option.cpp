#include "twin/cli/compare_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "stock/turning/turned_surface.h"
#include "twin/cli/program_options.h"
#include "twin/compare/design_fit.h"
#include "twin/compare/rest_machining.h"
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

/// How much of two spans along Z is in both, of what is in either.
double share_in_both(double low_a, double high_a, double low_b, double high_b) {
  const double both = std::min(high_a, high_b) - std::max(low_a, low_b);
  const double either = std::max(high_a, high_b) - std::min(low_a, low_b);
  return either > 0 ? std::max(0.0, both) / either : 0;
}

/// The tools of the program, and others that were described.
std::vector<RestTool> rest_tools(const CompareRequest& request, const Report& report) {
  std::vector<RestTool> tools;
  const auto add = [&](RestTool tool) {
    const auto is_same = [&](const RestTool& other) {
      return other.number == tool.number && other.shape == tool.shape;
    };
    if (tool.shape.empty() || std::ranges::any_of(tools, is_same)) return;
    tools.push_back(std::move(tool));
  };
  for (const ToolUse& use : report.tools) {
    RestTool tool;
    tool.number = use.number;
    tool.shape = use.shape;
    tool.guessed = use.guessed;
    tool.used = true;
    add(std::move(tool));
  }
  for (const RestTool& tool : request.described) add(tool);
  return tools;
}

void add_rest(const CompareRequest& request, const StockModel& body, const DesignPart& design,
              Report& report, Diagnostics& diagnostics) {
  if (const char* const why = why_no_rest(body)) {
    Diagnostic d;
    d.severity = Severity::kWarning;
    d.message = trf("--rest: {}; nothing is looked for", tr(why));
    diagnostics.push_back(std::move(d));
    return;
  }
  report.rest = find_rest(body, design, request.rest_mm, rest_tools(request, report));
  report.timing.total_s += report.rest->seconds;
}

/// The piece that has come off a workpiece that turns and is more like the design than what the
/// chuck still holds, if there is one.
void take_piece(const StockModel& stock, const Box& design_mm, bool anywhere, Compared& compared) {
  const StockModel& bare = stock.bare();
  if (!is_turned_alone(bare) || design_mm.empty()) return;
  const auto likeness = [&](double low_z, double high_z) {
    const double low = anywhere ? 0 : design_mm.min.z;
    const double shift = anywhere ? -low_z : 0;
    return share_in_both(low_z + shift, high_z + shift, low, low + design_mm.size().z);
  };
  const TurnedPart& left = bare.turned()->part();
  double low_z = 0, high_z = 0;
  bool is_first = true;
  for (const std::vector<Vec2>& ring : left.profile()) {
    for (const Vec2& p : ring) {  // x is along Z
      low_z = is_first ? p.x : std::min(low_z, p.x);
      high_z = is_first ? p.x : std::max(high_z, p.x);
      is_first = false;
    }
  }
  double most = is_first ? 0 : likeness(low_z, high_z);
  std::size_t number = 0;
  const TurnedPart* part = nullptr;
  for (const TurnedPiece& piece : left.freed()) {
    ++number;
    const double like = piece.part ? likeness(piece.low_z_mm, piece.high_z_mm) : 0;
    if (like <= most) continue;
    most = like;
    part = piece.part.get();
    compared.piece_number = number;
  }
  if (part) compared.piece = std::make_shared<const TurningStock>(*part);
}

}  // namespace

CompareRequest understand_compare(OptionReader& reader,
                                  const std::vector<ToolShapeArgument>& described) {
  CompareRequest request;
  request.path = reader.text("--compare");
  request.tolerance_mm = reader.length_mm("--tolerance", request.tolerance_mm);
  read_place(reader, request.placement);
  if (reader.word("--compare-unit") == 1) request.mm_per_unit = kMmPerInch;
  const bool can_fit = reader.command() != kView;
  if (can_fit) {
    request.is_fitted = reader.is_yes("--compare-fit");
    request.rest_mm = reader.length_mm("--rest");
    for (const ToolShapeArgument& tool : described) {
      RestTool known;
      known.number = tool.tool;
      known.shape = tool.cutter.spec();
      request.described.push_back(std::move(known));
    }
    if (request.is_wanted() && !reader.choose("--rest").is_said() &&
        reader.choose("--rest-png").is_said())
      reader.fault("--rest-png", tr("there is no --rest LENGTH, how thick it has to be"));
  }
  if (request.is_wanted()) return request;
  for (const char* option : {"--tolerance", "--compare-at", "--compare-unit", "--compare-fit",
                             "--compare-png", "--rest", "--rest-png"}) {
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

Compared compare_finished(const CompareRequest& request, const DesignFile& file,
                          const StockModel* stock, const CutHistory& history, Report& report,
                          Diagnostics& diagnostics) {
  if (stock == nullptr) {
    Diagnostic d;
    d.message = tr("--compare: stopped before there was a workpiece; nothing is compared");
    diagnostics.push_back(std::move(d));
    return {};
  }
  DesignPlacement placement = request.placement;
  std::optional<double> residue_mm;
  Diagnostics unheard;  // the same is said of it where it lies in the end
  Compared compared;
  take_piece(*stock, file.placed(placement, unheard).box_mm(), request.is_fitted, compared);
  const StockModel& body = compared.piece ? *compared.piece : *stock;
  if (request.is_fitted) {
    const DesignPart as_read = file.placed({}, unheard);
    const std::optional<DesignFit> fit = fit_design_in_blank(
        as_read, body.bounds_mm(), fit_points(body, kFitPoints), request.placement);
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
  compared.design = std::make_shared<const DesignPart>(file.placed(placement, diagnostics));
  doubt_place(*compared.design, file.path, stock->bounds_mm(), request.tolerance_mm, diagnostics);
  Comparison comparison = compare_stock(body, *compared.design, {request.tolerance_mm}, history);
  comparison.piece = compared.piece_number;
  comparison.design = file.path;
  comparison.placement = placement.text();
  comparison.fit_residue_mm = residue_mm;
  std::vector<int> guessed;
  for (const ToolUse& use : report.tools)
    if (use.guessed) guessed.push_back(use.number);
  add_compare_findings(comparison, guessed, report.findings);
  report.timing.total_s += comparison.seconds;
  report.comparison = std::move(comparison);
  if (request.rest_mm > 0) add_rest(request, body, *compared.design, report, diagnostics);
  return compared;
}

}  // namespace kerf
