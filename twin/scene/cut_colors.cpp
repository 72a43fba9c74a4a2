#include "twin/scene/cut_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace kerf {
namespace {

/// 0xAABBGGRR.
constexpr std::uint32_t rgb(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return 0xff000000u | blue << 16 | green << 8 | red;
}

/// After Paul Tol's qualitative "muted" scheme and Okabe and Ito's, which were made to be told
/// apart by everyone.
constexpr std::array<std::uint32_t, 10> kNumbered{
    rgb(86, 160, 210),  rgb(225, 155, 45),  rgb(50, 165, 125), rgb(205, 110, 165),
    rgb(230, 215, 85),  rgb(120, 105, 190), rgb(200, 90, 60),  rgb(130, 190, 95),
    rgb(100, 200, 205), rgb(165, 125, 90)};
constexpr std::uint32_t kChosen = rgb(240, 150, 40);
constexpr std::uint32_t kNotChosen = rgb(150, 150, 155);
/// Told apart, with value_colors()'s other two, by who lacks one kind of cone as well: 13 or more
/// in CIE 1976 (after Machado, Oliveira and Fernandes 2009).
constexpr std::array<std::uint32_t, kRisingColors> kRising{rgb(72, 40, 120),  rgb(62, 83, 160),
                                                           rgb(38, 130, 142), rgb(53, 170, 120),
                                                           rgb(150, 205, 70), rgb(250, 230, 70)};

void by_tool(const ProgramTrack& track, const std::vector<NamedTool>& tools, CutColors& colors) {
  std::map<int, std::size_t> places;
  for (const NamedTool& tool : tools) places.emplace(tool.number, places.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const auto place = places.emplace(track.tool(i), places.size()).first;
    colors.of_move[i] = color_of_number(place->second);
  }
  for (const NamedTool& tool : tools) {
    const auto place = places.find(tool.number);
    colors.legend.push_back({color_of_number(place->second), legend_text(tool)});
  }
}

void by_lines(const ColorCommand& wanted, const ProgramTrack& track, CutColors& colors) {
  for (std::size_t i = 0; i < track.size(); ++i) {
    colors.of_move[i] = color_of_line(wanted, track.source(i));
  }
  colors.legend = {line_range_entry(wanted)};
}

void by_rate(const ProgramTrack& track, const std::vector<float>& removed_mm3, CutColors& colors) {
  std::vector<float> rates(std::min(track.size(), removed_mm3.size()), 0.0f);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double duration_s = track.end_s(i) - track.start_s(i);
    if (duration_s > 0) rates[i] = removed_mm3[i] / static_cast<float>(duration_s);
  }
  std::fill(colors.of_move.begin(), colors.of_move.end(), colors.other);
  color_by_rate(rates, colors);
}

}  // namespace

/// Bounds of the classes are rounded to two digits for reading.
void color_by_rate(std::span<const float> rates, CutColors& colors) {
  std::vector<float> sorted;
  for (const float rate : rates) {
    if (rate > 0) sorted.push_back(rate);
  }
  if (sorted.empty()) return;
  std::sort(sorted.begin(), sorted.end());
  std::array<float, kRising.size()> upper{};
  for (std::size_t k = 0; k < kRising.size(); ++k) {
    const float bound = sorted[(sorted.size() - 1) * (k + 1) / kRising.size()];
    const float digit = std::pow(10.0f, std::floor(std::log10(bound)) - 1);
    upper[k] = std::ceil(bound / digit) * digit;
  }
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (rates[i] <= 0) continue;
    const auto found = std::lower_bound(upper.begin(), upper.end() - 1, rates[i]);
    colors.of_move[i] = kRising[static_cast<std::size_t>(found - upper.begin())];
  }
  for (std::size_t k = 0; k < kRising.size(); ++k) {
    if (k > 0 && upper[k] == upper[k - 1]) continue;
    colors.legend.push_back({kRising[k], fmt::format("<= {:.3g} mm\u00b3/s", upper[k]), upper[k]});
  }
}

std::span<const std::uint32_t, kRisingColors> rising_colors() { return kRising; }

std::uint32_t color_of_number(std::size_t number) { return kNumbered[number % kNumbered.size()]; }

std::string legend_text(const NamedTool& tool) {
  return fmt::format("T{} {}", tool.number, tool.name);
}

std::uint32_t color_of_line(const ColorCommand& wanted, const SourceRef& source) {
  const auto line = static_cast<std::int64_t>(source.line);
  const bool chosen = source.file == 0 && line >= wanted.first_line && line <= wanted.last_line;
  return chosen ? kChosen : kNotChosen;
}

ColorLegendEntry line_range_entry(const ColorCommand& wanted) {
  return {kChosen, fmt::format("{} - {}", wanted.first_line, wanted.last_line)};
}

std::shared_ptr<CutColors> cut_colors(const ColorCommand& wanted, const ProgramTrack& track,
                                      const std::vector<NamedTool>& tools,
                                      const std::vector<float>& removed_mm3) {
  auto colors = std::make_shared<CutColors>();
  colors->mode = wanted.mode;
  colors->of_move.resize(track.size());
  switch (wanted.mode) {
    case ColorBy::kTool:
      by_tool(track, tools, *colors);
      break;
    case ColorBy::kRemovalRate:
      by_rate(track, removed_mm3, *colors);
      break;
    case ColorBy::kLineRange:
      by_lines(wanted, track, *colors);
      break;
    default:
      return nullptr;
  }
  return colors;
}

}  // namespace kerf
