// twin/scene/cut_colors.h - colours of the workpiece by the moves of a program.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "twin/playback/program_track.h"
#include "viewer/scene.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// Ten colours that are told apart well, also by those who see red and green alike.
std::uint32_t color_of_number(std::size_t number);

/// From little to much, of rising brightness.
inline constexpr std::size_t kRisingColors = 6;
std::span<const std::uint32_t, kRisingColors> rising_colors();

/// A tool of the program, for marks and legends.
struct NamedTool {
  int number = 0;
  std::string name;
};

/// "T3 ball 6".
std::string legend_text(const NamedTool& tool);
/// For ColorBy::kLineRange: of cuts by this line, and what the colour of the lines asked for means.
std::uint32_t color_of_line(const ColorCommand& wanted, const SourceRef& source);
ColorLegendEntry line_range_entry(const ColorCommand& wanted);

/// For ColorBy::kRemovalRate: gives each of the first colours in `of_move` that of its rate (mm3/s;
/// those of 0 stay) in six classes of equally many, and adds what they mean to the legend.
void color_by_rate(std::span<const float> rates, CutColors& colors);

/// For kTool, kRemovalRate and kLineRange; null for the others. `removed_mm3`: by motion, as far as
/// the program has been cut; what lies beyond counts as unknown.
std::shared_ptr<CutColors> cut_colors(const ColorCommand& wanted, const ProgramTrack& track,
                                      const std::vector<NamedTool>& tools,
                                      const std::vector<float>& removed_mm3);

}  // namespace kerf
