#include "twin/guess/program_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include "base/translate.h"
#include "stock/cutter/scan.h"
#include "twin/job/blank_choice.h"
#include "twin/job/tool_number.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Motion::unknown_to: X, Y and Z.
constexpr std::uint8_t kAllUnknown = 7;
constexpr double kSheet_mm = 3;
constexpr std::size_t kMostTools = 1000;

Diagnostic missing_error(std::string message, std::string hint) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

std::string hint_of_tool(int number) {
  const std::string as_elsewhere = hint_of_number(number);
  return fmt::format("--tool {}=SHAPE{}{}", number, as_elsewhere.empty() ? "" : "; ", as_elsewhere);
}

/// "Mild Steel 3mm 45A"; 0: the name does not say it.
double thickness_of(const std::string& name) {
  static const std::regex kMm(R"((\d+(\.\d+)?)\s*mm\b)", std::regex::icase);
  std::smatch found;
  if (!std::regex_search(name, found, kMm)) return 0;
  const double mm = std::stod(found[1].str().substr(0, 10));
  return mm >= 0.1 && mm <= 200 ? mm : 0;
}

}  // namespace

SurveyWishes SurveyWishes::of(const SessionOptions& options, const ProgramFront& front) {
  SurveyWishes wishes;
  wishes.margin_mm = options.margin_mm;
  wishes.blank = !front.blank;
  // Who speaks of cells or of cutters does not mean a sheet. Standard input cannot be read again as
  // a sheet's program.
  const bool mills = std::any_of(
      front.tools.arguments.begin(), front.tools.arguments.end(),
      [](const ToolShapeArgument& tool) { return !tool.cutter.spec().starts_with("kerf"); });
  wishes.sheet = options.program.path != "-" && !options.stock.additive && !options.stock.kind &&
                 options.stock.cell_mm == 0 && !mills && !front.tools.turning;
  wishes.tools = !front.tools.describes();
  return wishes;
}

const ResolvedTool* OpenTools::feeding(const Motion& m) {
  if (m.kind == MotionKind::kToolChange || m.tool != tool_) {
    tool_ = m.tool;
    mounted_ = nullptr;
  }
  const bool feed = is_feed(m) && !stands_still(m);
  if (!feed && !is_traverse(m)) return nullptr;
  if (!mounted_) {
    const bool waits = m.to_machine_place || m.unknown_to == kAllUnknown ||
                       (m.tool == 0 && !resolver_.has_arguments());
    if (!feed && waits) return nullptr;
    mounted_ = &resolver_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
  }
  return feed ? mounted_ : nullptr;
}

ProgramSurvey::ProgramSurvey(const SurveyWishes& wishes, const ToolSources& sources)
    : wishes_(wishes),
      tools_(sources),
      blank_(wishes.margin_mm, sources),
      turning_(sources.turning) {}

/// Traverses say from which side a tool leaves.
void ProgramSurvey::add_turned(const Motion& m) {
  const ResolvedTool* const tool = tools_.feeding(m);
  if (tool) {
    if (fed_tools_.size() < kMostTools) fed_tools_.insert(m.tool);
    if (tool->cutter) {
      if (tool->guessed) half_known_.try_emplace(tool->number, tool->guess);
      return;
    }
    if (turned_tools_.size() < kMostTools || turned_tools_.contains(m.tool))
      turned_tools_[m.tool].add(m);
  } else if (is_traverse(m)) {
    const auto known = turned_tools_.find(m.tool);
    if (known != turned_tools_.end()) known->second.add(m);
  }
}

void ProgramSurvey::add(std::span<const Motion> motions, const MotionMoves& moves) {
  if (wishes_.blank) blank_.add(motions, moves);
  for (const Motion& m : motions) {
    if (turning_) {
      add_turned(m);
      continue;
    }
    beam_.add(m);
    spindle_started_ = spindle_started_ || m.spindle != SpindleState::kStopped;
    const ResolvedTool* const tool = tools_.feeding(m);
    if (!tool) continue;
    if (fed_tools_.size() < kMostTools) fed_tools_.insert(m.tool);
    if (tool->cutter) {
      if (tool->guessed) half_known_.try_emplace(tool->number, tool->guess);
      if (!tool->is_size_alone()) continue;
      if (sized_tools_.size() >= kMostTools && !sized_tools_.contains(m.tool)) continue;
      SizedTool& sized = sized_tools_[m.tool];
      sized.diameter_mm = 2 * tool->cutter->radius_mm();
      sized.trace.add(m, moves.is_upright(m));
    } else if (open_tools_.size() < kMostTools || open_tools_.contains(m.tool)) {
      open_tools_[m.tool].add(m, moves.is_upright(m));
    }
  }
}

std::optional<ProgramSurvey::SheetGuess> ProgramSurvey::sheet(
    bool is_qtplasmac, std::span<const TorchMaterial> materials) const {
  if (!wishes_.blank || !wishes_.sheet) return std::nullopt;
  const std::optional<BeamGuess> beam = beam_.guess(is_qtplasmac);
  if (!beam) return std::nullopt;
  SheetGuess out;
  out.beam = *beam;
  const Box& feeds = beam_.feeds_mm();
  const double margin = wishes_.margin_mm + beam->kerf_mm;
  out.sheet.low_mm = {std::floor(feeds.min.x - margin), std::floor(feeds.min.y - margin)};
  out.sheet.high_mm = {std::ceil(feeds.max.x + margin), std::ceil(feeds.max.y + margin)};
  for (int i = 0; i < 2; ++i) {
    if (out.sheet.high_mm[i] <= out.sheet.low_mm[i]) out.sheet.high_mm[i] += 1;
  }
  out.sheet.thickness_mm = kSheet_mm;
  out.reason = beam->reason + tr("; how thick is not known");
  for (const TorchMaterial& material : materials) {
    if (const double mm = thickness_of(material.name); is_qtplasmac && mm > 0) {
      out.sheet.thickness_mm = mm;
      out.reason = trf("{}; as thick as material {} is called", beam->reason, material.number);
    }
  }
  return out;
}

Blank ProgramSurvey::blank() const {
  if (turning_ || blank_.is_round()) return blank_.blank();
  BlankGuess wide = blank_.guess();
  for (const ToolGuess& guess : tools(wide.blank().bounds_mm().max.z)) {
    if (guess.of_known_size) continue;
    const Result<Cutter> cutter = parse_shape(guess.shape);
    if (cutter) wide.widen(open_tools_.at(guess.tool).bounds_mm(), cutter->radius_mm());
  }
  return wide.blank();
}

std::string ProgramSurvey::blank_reason() const {
  if (turning_) return tr("a bar as wide as it is turned");
  if (blank_.is_round()) return tr("a bar about X, since A goes all the way round");
  return trf("the feed moves plus {:g} mm", wishes_.margin_mm);
}

std::vector<ToolGuess> ProgramSurvey::tools(double top_mm) const {
  std::vector<ToolGuess> out;
  for (const auto& [number, trace] : turned_tools_) {
    if (!may_guess(number)) continue;
    ShapeGuess guess = trace.guess(top_mm);
    out.push_back({number, std::move(guess.shape), std::move(guess.reason)});
  }
  for (const auto& [number, trace] : open_tools_) {
    if (!may_guess(number)) continue;
    ShapeGuess guess = trace.guess(top_mm);
    out.push_back({number, std::move(guess.shape), std::move(guess.reason)});
  }
  add_drills(top_mm, out);
  return out;
}

void ProgramSurvey::add_drills(double top_mm, std::vector<ToolGuess>& guesses) const {
  for (const auto& [number, sized] : sized_tools_) {
    if (!sized.trace.only_plunges(top_mm)) continue;
    guesses.push_back({number, fmt::format("drill:{}:118", sized.diameter_mm),
                       tr("only its diameter is known, and it only goes up and down"), true});
  }
}

std::vector<ToolGuess> ProgramSurvey::kerfs(const BeamGuess& beam) const {
  std::vector<ToolGuess> out;
  if (beam.kerf_mm <= 0) return out;
  for (const int number : fed_tools_) {
    out.push_back({number, fmt::format("kerf:{:g}", beam.kerf_mm), tr("nothing says how wide")});
  }
  return out;
}

std::optional<Finding> ProgramSurvey::warning(const Blank& blank, const std::string& reason) const {
  if (!blank_.guess().has_moves()) return std::nullopt;
  return guess_warning(blank, reason);
}

Diagnostics ProgramSurvey::missing() const {
  Diagnostics out;
  if (wishes_.blank) {
    out.push_back(
        missing_error(tr("--no-guess: the blank is not known: no --stock, and no comment of "
                         "the program describes it"),
                      turning_ ? tr("--stock cylinder:0,0,Z0:Z1:DIAMETER")
                               : tr("--stock box:x0,y0,z0:x1,y1,z1")));
  }
  std::set<int> open;
  for (const auto& [number, trace] : open_tools_) open.insert(number);
  for (const auto& [number, trace] : turned_tools_) open.insert(number);
  for (const int number : open) {
    out.push_back(
        number == 0
            ? missing_error(
                  tr("--no-guess: the program cuts with no tool in the spindle, and not one "
                     "--tool says which it is"),
                  "--tool 1=SHAPE")
            : missing_error(trf("--no-guess: nothing is known of tool {}", number),
                            hint_of_tool(number)));
  }
  for (const auto& [number, why] : half_known_) {
    out.push_back(missing_error(trf("--no-guess: tool {} is not known for sure: {}", number,
                                    why.empty() ? tr("only its diameter is") : why),
                                fmt::format("--tool {}=SHAPE", std::max(1, number))));
  }
  return out;
}

Finding guess_warning(const Blank& blank, const std::string& reason) {
  Finding finding;
  finding.id = FindingId::kStockGuessed;
  finding.severity = Severity::kWarning;
  finding.text =
      trf("no blank is given or written in the program; assumed: {} ({}; --stock SPEC says better)",
          describe(blank), reason);
  return finding;
}

}  // namespace kerf
