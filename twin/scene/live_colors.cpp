#include "twin/scene/live_colors.h"

#include <algorithm>
#include <utility>

namespace kerf {

void LiveColors::set_program_tools(std::vector<NamedTool> tools) {
  program_tools_ = std::move(tools);
  place_tools();
  is_due_ = wanted_.has_value();
}

void LiveColors::place_tools() {
  places_.clear();
  for (const auto* tools : {&program_tools_, &seen_tools_}) {
    for (const NamedTool& tool : *tools) places_.emplace(tool.number, places_.size());
  }
}

void LiveColors::add(std::span<const CutLabel> labels, std::span<const NamedTool> names) {
  seen_tools_.insert(seen_tools_.end(), names.begin(), names.end());
  if (!names.empty()) place_tools();
  labels_.insert(labels_.end(), labels.begin(), labels.end());
  if (!wanted_ || wanted_->mode == ColorBy::kRemovalRate) return;
  is_due_ = is_due_ || !names.empty() ||
            std::any_of(labels.begin(), labels.end(),
                        [&](const CutLabel& label) { return color_of(label) != other_; });
}

void LiveColors::update(std::span<const LabelUse> uses) {
  for (const LabelUse& use : uses) {
    labels_[use.cut_id].removed_mm3 = use.removed_mm3;
    labels_[use.cut_id].cut_s = use.cut_s;
  }
  if (wanted_ && wanted_->mode == ColorBy::kRemovalRate && !uses.empty()) is_due_ = true;
}

void LiveColors::choose(const ColorCommand& wanted) {
  wanted_.reset();
  if (wanted.mode == ColorBy::kTool || wanted.mode == ColorBy::kLineRange ||
      wanted.mode == ColorBy::kRemovalRate) {
    wanted_ = wanted;
  }
  is_due_ = wanted_.has_value();
  taken_at_ = {};  // whoever chose is waiting
}

std::shared_ptr<const CutColors> LiveColors::take(Clock::time_point now) {
  if (!is_due_) return nullptr;
  const bool by_rate = wanted_->mode == ColorBy::kRemovalRate;
  if (now - taken_at_ < (by_rate ? kRatePeriod : kPeriod)) return nullptr;
  is_due_ = false;
  taken_at_ = now;
  auto colors = std::make_shared<CutColors>();
  colors->mode = wanted_->mode;
  if (by_rate) {
    color_rates(*colors);
    return colors;
  }
  colors->of_move.reserve(labels_.size());
  for (const CutLabel& label : labels_) colors->of_move.push_back(color_of(label));
  if (!labels_.empty()) colors->other = colors->of_move.back();
  other_ = colors->other;
  colors->legend = legend();
  return colors;
}

void LiveColors::color_rates(CutColors& colors) const {
  std::vector<float> rates;
  rates.reserve(labels_.size());
  for (const CutLabel& label : labels_) {
    rates.push_back(label.cut_s > 0 ? static_cast<float>(label.removed_mm3 / label.cut_s) : 0.0f);
  }
  colors.of_move.assign(labels_.size(), colors.other);
  color_by_rate(rates, colors);
}

std::uint32_t LiveColors::color_of(const CutLabel& label) const {
  if (wanted_->mode == ColorBy::kLineRange) return color_of_line(*wanted_, label.source);
  const auto place = places_.find(label.tool);
  return place == places_.end() ? CutColors{}.other : color_of_number(place->second);
}

std::vector<ColorLegendEntry> LiveColors::legend() const {
  if (wanted_->mode == ColorBy::kLineRange) return {line_range_entry(*wanted_)};
  std::vector<ColorLegendEntry> entries;
  const auto add = [&](const NamedTool& tool) {
    entries.push_back({color_of_number(places_.at(tool.number)), legend_text(tool)});
  };
  for (const NamedTool& tool : program_tools_) add(tool);
  for (const NamedTool& tool : seen_tools_) {
    const bool is_listed =
        std::any_of(program_tools_.begin(), program_tools_.end(),
                    [&](const NamedTool& listed) { return listed.number == tool.number; });
    if (!is_listed) add(tool);
  }
  return entries;
}

const CutLabel* LiveColors::label(std::uint32_t cut_id) const {
  return cut_id < labels_.size() ? &labels_[cut_id] : nullptr;
}

std::string LiveColors::name_of(int tool) const {
  const auto known = std::find_if(seen_tools_.begin(), seen_tools_.end(),
                                  [&](const NamedTool& seen) { return seen.number == tool; });
  return known == seen_tools_.end() ? std::string() : known->name;
}

}  // namespace kerf
