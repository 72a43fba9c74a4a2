// twin/scene/live_colors.h - colours of a workpiece whose cuts have labels, while they come.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "twin/process/cut_labels.h"
#include "twin/scene/cut_colors.h"
#include "viewer/scene.h"
#include "viewer/viewer_command.h"

namespace kerf {

/// What the cuts of a label have done so far: CutLabel::removed_mm3 and cut_s.
struct LabelUse {
  std::uint32_t cut_id = 0;
  double removed_mm3 = 0;
  double cut_s = 0;
};

/// Labels come with nearly every frame of a machine that is watched, but the table of their colours
/// is the whole workpiece's news. So it is made anew only where it would be wrong: labels beyond it
/// have the colour CutColors::other, which is that of the newest label; it is needed again when a
/// tool or the line range changes, and then at most every kPeriod. Rates of removal change as long
/// as something is cut; theirs are made every kRatePeriod, and the newest label has none yet. One
/// thread.
class LiveColors {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kPeriod{100};
  static constexpr std::chrono::milliseconds kRatePeriod{500};

  /// The program's tools get their colours first, so that they are those of `kerf view`.
  void set_program_tools(std::vector<NamedTool> tools);
  /// The next labels, and the names of tools that are new among them.
  void add(std::span<const CutLabel> labels, std::span<const NamedTool> names);
  /// What labels that were added have done since.
  void update(std::span<const LabelUse> uses);
  /// ColorBy::kTool, kLineRange and kRemovalRate; by others it makes no colours.
  void choose(const ColorCommand& wanted);
  /// Null as long as those that were taken last are right, or may wait.
  std::shared_ptr<const CutColors> take(Clock::time_point now);

  /// Null: it is not one of those that were added.
  const CutLabel* label(std::uint32_t cut_id) const;
  /// As it was added; empty if it was not.
  std::string name_of(int tool) const;

 private:
  void place_tools();
  std::uint32_t color_of(const CutLabel& label) const;
  void color_rates(CutColors& colors) const;
  std::vector<ColorLegendEntry> legend() const;

  std::vector<NamedTool> program_tools_;
  std::vector<NamedTool> seen_tools_;  ///< in the order of their labels
  std::map<int, std::size_t> places_;  ///< of all tools: the numbers of their colours
  std::vector<CutLabel> labels_;
  std::optional<ColorCommand> wanted_;
  bool is_due_ = false;  ///< those that were taken are wrong
  std::uint32_t other_ = 0;
  Clock::time_point taken_at_{};
};

}  // namespace kerf
