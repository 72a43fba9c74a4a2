#include "twin/process/engagement_log.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "stock/zmap/zmap.h"

namespace kerf {
namespace {

/// Cut out of the map at once.
constexpr std::size_t kMapMoves = 512;
/// Names of cuts that a map can tell apart.
constexpr std::size_t kMostCuts = 0xffff'fff0;
/// A rate is one over so much of the tool's diameter of the way, or a whole move.
constexpr double kWindowOfDiameter = 0.25;

}  // namespace

void EngagementLog::begin(const StockModel& stock) {
  passes_.clear();
  tools_.clear();
  turned_.clear();
  tool_of_pass_.clear();
  angles_.assign(1, 0.0f);
  moves_.clear();
  cutter_.reset();
  is_open_ = false;
  window_ = {};
  unmeasured_mm_ = unmeasured_mm3_ = 0;
  heights_.reset();
  if (!with_map_ || stock.turned() != nullptr) return;
  ZMapOptions options;
  BlankBody body;
  body.bounds_mm = stock.bounds_mm();
  options.blank.bodies.push_back(body);
  const Vec3 size = body.bounds_mm.size();
  options.cell_mm = std::max(stock.cell_mm(), std::max(size.x, size.y) / kMostMapCells);
  options.cell_mm = std::min({options.cell_mm, size.x, size.y});
  auto made = ZMap::create(options);
  if (!made) return;
  heights_ = std::move(made.value());
  heights_->keep_cut_ids(true);
}

void EngagementLog::cut_map() {
  if (moves_.empty()) return;
  reports_.clear();
  heights_->cut(*cutter_, moves_, reports_);
  heights_->finish(reports_);
  moves_.clear();
}

void EngagementLog::mount(int tool, const Cutter& cutter) {
  if (listener_ != nullptr) listener_->on_mount(tool, cutter);
  cut_map();
  cutter_.reset();
  if (heights_ && heights_->accepts(cutter)) cutter_ = cutter;
  const auto found = std::find_if(tools_.begin(), tools_.end(), [&](const EngagementOfTool& other) {
    return other.tool == tool && other.shape == cutter.spec();
  });
  tool_ = static_cast<std::uint32_t>(found - tools_.begin());
  if (found != tools_.end()) return;
  EngagementOfTool fresh;
  fresh.tool = tool, fresh.shape = cutter.spec(), fresh.diameter_mm = 2 * cutter.radius_mm();
  tools_.push_back(std::move(fresh));
}

/// Moves that are shorter than half a cell of the map are put together: chords, which it would not
/// tell from them.
bool EngagementLog::goes_on(const CutMove& last, const CutMove& next) const {
  return !last.arc && !next.arc && last.to_mm == next.from_mm &&
         glm::length(next.to_mm - last.from_mm) < 0.5 * heights_->cell_mm();
}

void EngagementLog::end_pass() { is_open_ = false; }

std::uint32_t EngagementLog::add(const Part& part) {
  if (listener_ != nullptr) listener_->on_part(part.look, part.way.length_mm);
  EngagementOfTool& of_tool = tools_[tool_];
  of_tool.feed_mm += part.way.length_mm;
  of_tool.feed_s += part.way.seconds;
  if (!part.look.is_engaged()) {
    of_tool.air_mm += part.way.length_mm;
    of_tool.air_s += part.way.seconds;
    gap_mm_ += part.way.length_mm;
    if (gap_mm_ > of_tool.diameter_mm) is_open_ = false;
    return is_open_ ? static_cast<std::uint32_t>(passes_.size() - 1) : kNoPass;
  }
  if (!is_open_) {
    EngagementPass pass;
    pass.tool = of_tool.tool;
    pass.from = part.source;
    pass.start_s = part.start_s;
    passes_.push_back(pass);
    tool_of_pass_.push_back(tool_);
    ++of_tool.passes;
    is_open_ = true;
  }
  gap_mm_ = 0;
  EngagementPass& pass = passes_.back();
  pass.to = part.source;
  pass.sums.add(part.look, part.way);
  const auto angle = static_cast<float>(part.look.angle_rad);
  if (!moves_.empty() && angles_.back() == angle && goes_on(moves_.back(), *part.move)) {
    moves_.back().to_mm = part.move->to_mm;
  } else if (cutter_ && part.move->is_vertical() && angles_.size() < kMostCuts) {
    moves_.push_back(*part.move);
    moves_.back().id = angles_.size();
    angles_.push_back(angle);
    if (moves_.size() == kMapMoves) cut_map();
  }
  return static_cast<std::uint32_t>(passes_.size() - 1);
}

void EngagementLog::take_back_cut(std::uint32_t pass, const EngagementLook& look,
                                  const EngagedWay& way) {
  if (pass == kNoPass) return;
  passes_[pass].sums.take_back(look, way);
  EngagementOfTool& of_tool = tools_[tool_of_pass_[pass]];
  of_tool.air_mm += way.length_mm;
  of_tool.air_s += way.seconds;
}

void EngagementLog::take_back_air(const EngagedWay& way) {
  EngagementOfTool& of_tool = tools_[tool_];
  for (double* const mm : {&of_tool.feed_mm, &of_tool.air_mm})
    *mm = std::max(0.0, *mm - way.length_mm);
  for (double* const s : {&of_tool.feed_s, &of_tool.air_s}) *s = std::max(0.0, *s - way.seconds);
  unmeasured_mm_ += way.length_mm;
}

void EngagementLog::add_removed(std::uint32_t pass, double mm3, double way_mm, double seconds,
                                double most_mm3, bool is_plunge) {
  if (pass == kNoPass) {
    unmeasured_mm3_ += mm3;
    return;
  }
  EngagementSums& sums = passes_[pass].sums;
  sums.removed_mm3 += mm3;
  if (window_.pass != pass || is_plunge) {
    window_ = {};
    window_.pass = pass;
  }
  window_.mm3 += mm3, window_.most_mm3 += most_mm3;
  window_.mm += way_mm, window_.seconds += seconds;
  const double least_mm = kWindowOfDiameter * tools_[tool_of_pass_[pass]].diameter_mm;
  if ((window_.mm < least_mm && !is_plunge) || window_.seconds <= 0) return;
  sums.rate_most_mm3_per_s =
      std::max(sums.rate_most_mm3_per_s, std::min(window_.mm3, window_.most_mm3) / window_.seconds);
  window_ = {};
}

void EngagementLog::set_scallops(int tool, const std::string& shape, const Scallops& scallops) {
  for (EngagementOfTool& one : tools_) {
    if (one.tool == tool && one.shape == shape) one.scallops = scallops;
  }
}

void EngagementLog::add_turned(int tool, const Cutter& cutter, const TurnedWay& way) {
  auto found = std::find_if(turned_.begin(), turned_.end(), [&](const TurningEngagement& other) {
    return other.tool == tool && other.shape == cutter.spec();
  });
  if (found == turned_.end()) {
    TurningEngagement first;
    first.tool = tool, first.shape = cutter.spec();
    found = turned_.insert(turned_.end(), std::move(first));
  }
  found->add(way);
}

EngagementMap EngagementLog::map() const {
  const std::unique_ptr<StockModel> done = heights_->snapshot();
  const std::shared_ptr<const HeightGrid> grid = done->height_grid();
  EngagementMap out;
  out.bounds_mm = grid->bounds_mm();
  out.nx = grid->nx(), out.ny = grid->ny();
  out.angle_rad.reserve(static_cast<std::size_t>(out.nx) * static_cast<std::size_t>(out.ny));
  for (int j = 0; j < out.ny; ++j) {
    for (int i = 0; i < out.nx; ++i) {
      const Vec3 at(out.bounds_mm.min.x + (i + 0.5) * grid->cell_x_mm(),
                    out.bounds_mm.min.y + (j + 0.5) * grid->cell_y_mm(),
                    static_cast<double>(grid->height(i, j)));
      const std::optional<std::uint32_t> cut = done->cut_id_at(at);
      out.angle_rad.push_back(cut && *cut < angles_.size() ? angles_[*cut] : 0.0f);
    }
  }
  return out;
}

Engagement EngagementLog::result() {
  cut_map();
  // A short pass is one rate.
  for (EngagementPass& pass : passes_) {
    if (pass.sums.rate_most_mm3_per_s == 0)
      pass.sums.rate_most_mm3_per_s = pass.sums.rate_mm3_per_s();
  }
  Engagement out;
  out.tools = tools_;
  for (std::size_t n = 0; n < passes_.size(); ++n)
    out.tools[tool_of_pass_[n]].sums.add(passes_[n].sums);
  std::erase_if(out.tools, [](const EngagementOfTool& tool) { return tool.passes == 0; });
  out.turned = turned_;
  std::erase_if(out.turned, [](const TurningEngagement& tool) { return tool.cut_mm <= 0; });
  out.passes_in_all = passes_.size();
  out.unmeasured_mm = unmeasured_mm_;
  out.unmeasured_mm3 = unmeasured_mm_ > 0 ? unmeasured_mm3_ : 0;
  std::vector<std::size_t> kept(passes_.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  if (kept.size() > Engagement::kMostPasses) {
    std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
      return passes_[a].sums.removed_mm3 > passes_[b].sums.removed_mm3;
    });
    kept.resize(Engagement::kMostPasses);
    std::sort(kept.begin(), kept.end());
  }
  for (const std::size_t n : kept) out.passes.push_back(passes_[n]);
  if (heights_) out.map = map();
  return out;
}

}  // namespace kerf
