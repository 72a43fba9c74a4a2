#include "twin/program/turning.h"

#include <fmt/format.h>

#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr int kX = 1;
constexpr int kZ = 4;
constexpr int kC = 32;

std::string sign_of_words(const TurningWords& words, const std::string& path) {
  const auto at = [&](std::uint32_t line, const char* what) {
    return fmt::format("{}:{}: {}", path, line, what);
  };
  if (words.diameter_mode != 0) return at(words.diameter_mode, tr("G7, X is a diameter"));
  if (words.threading != 0) return at(words.threading, tr("G76, the threading cycle"));
  if (words.contour_cycle != 0) {
    return at(words.contour_cycle, tr("G70, G71 or G72 with a Q, a cycle along a turned contour"));
  }
  if (!words.only_xz()) return {};
  if (words.surface_speed != 0) {
    return at(words.surface_speed,
              tr("G96, constant surface speed, in a program of X and Z alone in G18"));
  }
  if (words.compensation != 0) {
    return at(words.compensation,
              tr("G41 or G42 in the XZ plane (G18), in a program of X and Z alone"));
  }
  if (words.radius_mode != 0) {
    return at(words.radius_mode, tr("G8, X is a radius, in a program of X and Z alone in G18"));
  }
  if (words.thread != 0) {
    return at(words.thread,
              tr("G33, a feed with the spindle, in a program of X and Z alone in G18"));
  }
  if (words.feed_per_turn != 0) {
    return at(words.feed_per_turn,
              tr("G95, feed per revolution, in a program of X and Z alone in G18"));
  }
  return {};
}

/// A number from 1 to 8 says where the tip of a lathe tool is; 9 is its middle, as of a mill.
std::string sign_of_tools(const TurningWords& words, const std::vector<ToolTableRow>& table) {
  for (const ToolTableRow& row : table) {
    if (row.orientation < 1 || row.orientation > 8 || words.tools.count(row.tool) == 0) continue;
    return trf("tool {} has the orientation Q{} in line {} of the tool table", row.tool,
               row.orientation, row.line);
  }
  return {};
}

std::string sign_of_shapes(const ToolSources& tools) {
  for (const ToolShapeArgument& tool : tools.arguments) {
    if (!tool.cutter.insert()) continue;
    return trf("--tool {}={}, a turning tool", tool.tool, tool.cutter.spec());
  }
  return {};
}

std::string sign_of_blank(const Blank& blank) {
  if (!blank.state_file.empty() && saved_kind(blank.state_file) == StockKind::kTurning) {
    return trf("{}: a turned part", blank.state_file);
  }
  return need_to_turn(blank);
}

}  // namespace

std::string turning_sign(const ProgramOptions& options, const Program* program,
                         const std::vector<ToolTableRow>& table) {
  if (!options.lathe.empty()) return options.lathe;
  if (program == nullptr) return {};
  const TurningWords& words = program->turning_words();
  const int axes = options.machine.axis_mask & ~kC;
  if (!options.machine.ini_path.empty() && axes == (kX | kZ) && words.plane_xz != 0 &&
      !words.other_plane) {
    return trf("{}:{}: G18 on a machine with X and Z alone, by its INI", options.path,
               words.plane_xz);
  }
  std::string sign = sign_of_words(words, options.path);
  return sign.empty() ? sign_of_tools(words, table) : sign;
}

bool note_turning(const ProgramOptions& options, const Program* program,
                  std::optional<StockKind> kind, const std::optional<Blank>& blank,
                  ToolSources& tools, Diagnostics& diagnostics) {
  tools.turning = kind == StockKind::kTurning;
  if (tools.turning || options.as_mill) return true;
  std::string sign = blank ? sign_of_blank(*blank) : std::string();
  if (sign.empty()) sign = sign_of_shapes(tools);
  if (sign.empty()) sign = turning_sign(options, program, tools.table);
  if (sign.empty()) return true;
  if (kind) {
    Diagnostic refusal;
    refusal.message = trf("--model {}: this is for a lathe ({})", stock_model(*kind).name, sign);
    refusal.hint =
        tr("--model turning turns it; --as-mill mills it all the same, with tools that "
           "turn about Z");
    diagnostics.push_back(std::move(refusal));
    return false;
  }
  tools.turning = true;
  tools.turning_sign = std::move(sign);
  return true;
}

}  // namespace kerf
