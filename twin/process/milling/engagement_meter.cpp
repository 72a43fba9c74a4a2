#include "twin/process/milling/engagement_meter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "stock/present_heights.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/milling/scallops.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

constexpr double kFarthestOfWidth = 0.5, kFarthestCells = 8;
constexpr double kClosestOfWidth = 1.0 / 8, kClosestCells = 2;
constexpr int kMostHalvings = 3;
constexpr double kSameOfWidth = 0.05, kSameOfDepth = 0.05, kSameDepth_mm = 0.02;
/// The last look at a move is so many cells before its end: at the end nothing is ahead of it.
constexpr double kBeforeEnd_cells = 2, kLeastPart = 0.25;
/// Looks at short moves cost as much as so many cells that are cut, and may cost this share of
/// them; a move costs some in itself. What is saved up, or borrowed where the way turns and where a
/// pass begins, is so many looks at most.
constexpr double kCellsOfLook = 2500, kCellsOfRoundLook = 100'000, kShareOfCells = 0.25;
/// Of a look, one in brief: by its cells, by rays, and by those of what is pointed; and where it
/// sees nothing.
constexpr double kBrief = 0.15, kBriefRays = 0.4, kPointedRays = 0.6, kOfAir = 0.1;
constexpr double kCellsOfMove = 300, kMostSaved = 4, kMostBorrowed = 8;
/// So many in brief are free, that a short program has them.
constexpr int kFreeLooks = 100;
/// The longest way that a look counts for, of the front's widths, and how far it may turn: cos 30
/// degrees.
constexpr double kMostSpacing = 2, kFarthestSpacing = 4, kSameWay = 0.866;
/// Where air that was seen is asked whether it still is: parts of the greatest radius that can be
/// in material, and directions.
constexpr double kProbedRadii[] = {0.2, 0.5, 0.75, 0.95};
constexpr int kProbedRays = 8;
/// Depths may be short by that.
constexpr double kShortOfDepth_mm = 0.05;
/// Looks along one move at most.
constexpr double kMostNodes = 4096;

Vec3 way_of_short(const CutMove& move) {
  const Vec3 way = move.to_mm - move.from_mm;
  const double length = glm::length(way);
  return length > 0 ? way / length : Vec3(0);
}

/// EngagedWay::down_rad.
double down_of(const CutMove& move, double length_mm) {
  const double down_mm = glm::dot(move.from_mm - move.to_mm, move.axis_from);
  if (down_mm <= 0 || down_mm >= length_mm * (1 - 1e-9)) return 0;
  return std::asin(down_mm / length_mm);
}

/// Along the spindle.
bool is_steep(const CutMove& move) {
  return !move.arc && glm::length(glm::cross(move.to_mm - move.from_mm, move.axis_from)) < 1e-9;
}

}  // namespace

EngagementMeter::EngagementMeter(const StockModel& stock, EngagementLog& log,
                                 std::function<void()> hand_over)
    : stock_(stock),
      log_(log),
      hand_over_(std::move(hand_over)),
      free_looks_(kFreeLooks),
      is_thrifty_(!log.is_heard()) {
  log_.begin(stock);
}

void EngagementMeter::mount(int tool, const Cutter& cutter) {
  log_.mount(tool, cutter);
  ways_.mount(cutter, tool);
  diameter_mm_ = 2 * cutter.radius_mm();
  is_ball_ = is_ball_end(cutter);
  is_flat_ = cutter.height_mm(cutter.radius_mm() * (1 - 1e-9)) <= 0;
  look_cells_ = cutter.height_mm(0.9 * cutter.radius_mm()) <= 0 ? kCellsOfLook : kCellsOfRoundLook;
  const double cell_mm = stock_.cell_mm();
  const bool is_fine_flat = is_flat_ && cutter.radius_mm() >= EngagementScan::kFineCells * cell_mm;
  brief_ = is_fine_flat || EngagementScan::asks_cells(cutter, cell_mm) ? kBrief
           : EngagementScan::is_pointed(cutter, cell_mm)               ? kPointedRays
                                                                       : kBriefRays;
  lift();
  has_held_ = false;
}

void EngagementMeter::lift() {
  log_.end_pass();
  since_mm_ = -1;
}

void EngagementMeter::note(const CutMove& move) {
  has_held_ = !move.arc;
  held_ = move;
}

bool EngagementMeter::is_same(const EngagementLook& a, const EngagementLook& b) const {
  const double deep = std::max(a.deep_mm, b.deep_mm);
  return a.is_plunge == b.is_plunge && a.is_engaged() == b.is_engaged() &&
         std::abs(a.angle_rad - b.angle_rad) <= kSameAngle_rad &&
         std::abs(a.entry_rad - b.entry_rad) <= kSameAngle_rad &&
         std::abs(a.wide_mm - b.wide_mm) <= kSameOfWidth * front_mm_ &&
         std::abs(a.deep_mm - b.deep_mm) <= std::max(kSameDepth_mm, kSameOfDepth * deep);
}

EngagementLook EngagementMeter::look(double at) {
  const double part = upright_ ? 0.5 : at;
  const CutMove& move = upright_ ? (line_ = upright_->line_at(at, until_)) : *move_;
  if (points_ != nullptr)
    return front_.look(*points_, stock_.bounds_mm(), stock_.cell_mm(), *cutter_, move,
                       {part, anticlockwise_});
  EngagementScan::Look ahead;
  ahead.at = part;
  ahead.held = has_held_ ? &held_ : nullptr;
  ahead.anticlockwise = anticlockwise_;
  ahead.owners = owners_, ahead.ways = &ways_;
  ahead.is_brief = is_brief_;
  ahead.behind_mm = is_short_ ? at * length_mm_ : 0;
  // Under its centre it never comes back to where it was lower; and as long as it goes one way
  // nothing before a rim has been nearer, nor before a ball no larger than the arc.
  const bool is_behind =
      upright_ && (is_flat_ || (is_ball_ && upright_->radius_mm() >= 0.5 * diameter_mm_));
  const bool has_turned = upright_ && !turnings_.empty() && at > turnings_.front();
  const bool may_have_cut = upright_ && (has_turned || (upright_->is_hill(0, 1) && !is_behind));
  ahead.own = may_have_cut ? &*upright_ : nullptr;
  ahead.own_part = at;
  return scan_.look_ahead(*heights_, *cutter_, move, ahead);
}

void EngagementMeter::flush() {
  if (to_ <= from_) return;
  const EngagementLook mean = sum_.mean(first_, to_ - from_);
  if (!upright_ || !mean.is_engaged()) {
    tell(mean, from_, to_);
  } else {
    // How steep it goes differs along it.
    const double turn = (to_ - from_) * upright_->sweep_rad();
    const int parts = std::max(1, static_cast<int>(std::ceil(turn / kUprightPart_rad)));
    for (int k = 0; k < parts; ++k) {
      const double step = (to_ - from_) / parts;
      tell(mean, from_ + k * step, k + 1 == parts ? to_ : from_ + (k + 1) * step);
    }
  }
  from_ = to_;
}

/// Of a move that is the same all along.
void EngagementMeter::tell_all(const EngagementLook& look) {
  if (!upright_) return tell(look, 0, 1);
  add(0, 1, look);
  flush();
}

void EngagementMeter::tell(const EngagementLook& mean, double from, double to) {
  const bool is_all = from <= 0 && to >= 1;
  const CutMove part = is_all ? CutMove() : part_of(*move_, from, to);
  const CutMove& of = is_all ? *move_ : part;
  const double length_mm = (to - from) * length_mm_;
  const double down_rad = upright_ ? down_of(of, length_mm) : down_rad_;
  const EngagedWay way{length_mm, (to - from) * duration_s_, down_rad};
  const EngagementLog::Part told{mean, &of, way, source_, start_s_ + from * duration_s_};
  if (hearer_) hearer_(told);
  const std::uint32_t pass = log_.add(told);
  if (pass != EngagementLog::kNoPass) taken_.pass = pass;
  if (!mean.is_engaged()) return;
  taken_.sums.add(mean, way);
  taken_.most_mm3 += most_mm2(mean, way.down_rad) * length_mm;
}

/// No more stands before the tool, seen along its way.
double EngagementMeter::most_mm2(const EngagementLook& look, double down_rad) const {
  const double disc_mm2 = kPi / 4 * look.effective_mm * look.effective_mm;
  if (look.is_plunge) return disc_mm2;
  const double wide_mm = look.wide_mm + look.gaps_mm + stock_.cell_mm();
  if (down_rad == 0) return wide_mm * (look.deep_mm + kShortOfDepth_mm);
  return wide_mm * (look.deep_mm + kShortOfDepth_mm) * std::cos(down_rad) +
         disc_mm2 * std::sin(down_rad);
}

void EngagementMeter::Sum::add(const EngagementLook& look, double share) {
  angle += look.angle_rad * share;
  wide += look.wide_mm * share;
  gaps += look.gaps_mm * share;
  deep += look.deep_mm * share;
  entry += look.entry_rad * share;
  exit += look.exit_rad * share;
  climb += look.climb * share;
  effective += look.effective_mm * share;
  contact += look.contact_mm * share;
}

EngagementLook EngagementMeter::Sum::mean(const EngagementLook& like, double shares) const {
  EngagementLook out = like;
  out.angle_rad = angle / shares;
  out.wide_mm = wide / shares;
  out.gaps_mm = gaps / shares;
  out.deep_mm = deep / shares;
  out.entry_rad = entry / shares;
  out.exit_rad = exit / shares;
  out.climb = climb / shares;
  out.effective_mm = effective / shares;
  out.contact_mm = contact / shares;
  return out;
}

void EngagementMeter::add(double from, double to, const EngagementLook& look) {
  if (to_ <= from_ || !is_same(first_, look)) {
    flush();
    from_ = to_ = from;
    first_ = look;
    sum_ = {};
  }
  sum_.add(look, to - from);
  to_ = to;
}

void EngagementMeter::refine(const Node& from, const Node& to, int halvings) {
  const double middle = 0.5 * (from.at + to.at);
  if (is_same(from.look, to.look) || halvings == 0 ||
      (to.at - from.at) * length_mm_ < 2 * closest_mm()) {
    add(from.at, middle, from.look);
    add(middle, to.at, to.look);
    return;
  }
  const Node between{middle, look(middle)};
  refine(from, between, halvings - 1);
  refine(between, to, halvings - 1);
}

/// What the last look has said is taken for this short move, too.
bool EngagementMeter::counts_still(const CutMove& move) {
  const double cell_mm = stock_.cell_mm();
  saved_cells_ += kShareOfCells * (kCellsOfMove + length_mm_ * diameter_mm_ / (cell_mm * cell_mm));
  saved_cells_ = std::min(saved_cells_, kMostSaved * look_cells_);
  if (since_mm_ < 0 || last_.is_plunge) return false;
  const double way_mm = since_mm_ + length_mm_;
  if (way_mm > kFarthestSpacing * front_mm_) return false;
  if (glm::dot(way_of_short(move), last_ahead_) < kSameWay)
    return is_thrifty_ && saved_cells_ < -kMostBorrowed * look_cells_;
  if (way_mm <= spacing_mm_ || !is_thrifty_) return way_mm <= spacing_mm_;
  // Of a tool that comes in, or whose looks differ, the last one says little.
  const bool is_settled = spacing_mm_ > farthest_mm();
  if (saved_cells_ >= (is_settled ? 0 : -kMostBorrowed * look_cells_)) return false;
  if (free_looks_ == 0) return true;
  --free_looks_;
  saved_cells_ += kBrief * look_cells_;
  return false;
}

/// At one of a few places ahead of the tool, where the move ends. Moves before it may not have been
/// given to the model yet: of what they have removed it is no more than asked too often.
bool EngagementMeter::meets_material(const CutMove& move) const {
  const auto* const present = dynamic_cast<const PresentHeights*>(&stock_.bare());
  const std::optional<HeightGrid> heights =
      present != nullptr ? present->present_heights() : std::nullopt;
  if (!heights) return false;
  const Box& box = heights->bounds_mm();
  const Vec2 ahead(way_of_short(move)), left(-ahead.y, ahead.x);
  const double tip = std::max(std::min(move.from_mm.z, move.to_mm.z), box.min.z) + kSameDepth_mm;
  if (tip >= box.max.z) return false;
  const double reach = ways_.reach_mm(box.max.z - tip);
  for (const double part : kProbedRadii) {
    const double radius = part * reach;
    const double surface = tip + cutter_->height_mm(radius);
    for (int n = 0; n <= kProbedRays; ++n) {
      const double angle = kPi * (static_cast<double>(n) / kProbedRays - 0.5);
      const Vec2 at = Vec2(move.to_mm) - Vec2(box.min) +
                      radius * (std::cos(angle) * ahead + std::sin(angle) * left);
      const auto i = static_cast<int>(std::floor(at.x / heights->cell_x_mm()));
      const auto j = static_cast<int>(std::floor(at.y / heights->cell_y_mm()));
      if (heights->contains(i, j) && static_cast<double>(heights->height(i, j)) > surface)
        return true;
    }
  }
  return false;
}

/// What stands where the move goes.
bool EngagementMeter::find_material(std::optional<HeightGrid>& heights) {
  heights_ = nullptr, points_ = nullptr;
  const StockModel& model = stock_.bare();
  if (const auto* const present = dynamic_cast<const PresentHeights*>(&model)) {
    heights = present->present_heights();
    const bool takes = upright_ ? EngagementScan::takes(*cutter_, upright_->line_at(0, 1))
                                : EngagementScan::takes(*cutter_, *move_);
    if (!heights || !takes) return false;
    heights_ = &*heights;
    owners_ = model.keeps_cut_ids() ? present : nullptr;
    return true;
  }
  points_ = dynamic_cast<const SolidPoints*>(&model);
  if (points_ == nullptr) return false;
  return upright_ ? SolidFront::takes(*cutter_, upright_->line_at(0, 1))
                  : SolidFront::takes(*cutter_, *move_);
}

/// By looks at so many places after its begin, and where these differ between them.
void EngagementMeter::take_along(double from, double to, int places) {
  const double last_at =
      to - std::min(kLeastPart * (to - from), kBeforeEnd_cells * stock_.cell_mm() / length_mm_);
  Node before{from, look(from)};
  for (int k = 1; k <= places; ++k) {
    Node node{k == places ? to : from + (to - from) * k / places, {}};
    node.look = look(std::min(node.at, last_at));
    refine(before, node, kMostHalvings);
    before = node;
  }
  last_ = before.look;
  since_mm_ = -1;
}

/// From one place to the next where it turns back, seen from above.
void EngagementMeter::take_upright(double farthest_mm) {
  double from = 0;
  turnings_.push_back(1);
  for (const double to : turnings_) {
    until_ = to;
    const double apart = std::max((to - from) * length_mm_ / farthest_mm,
                                  (to - from) * upright_->sweep_rad() / kUprightTurn_rad);
    take_along(from, to, static_cast<int>(std::clamp(std::ceil(apart), 1.0, kMostNodes)));
    from = to;
  }
}

/// As wide as the tool is where the blank is highest.
double EngagementMeter::front_of(const CutMove& move) const {
  if (is_flat_ || !move.is_vertical()) return diameter_mm_;
  const double low_mm = std::min(move.from_mm.z, move.to_mm.z);
  const double reach_mm = ways_.reach_mm(stock_.bounds_mm().max.z - low_mm);
  return upright_ || reach_mm <= 0 ? diameter_mm_ : 2 * reach_mm;
}

double EngagementMeter::farthest_mm() const {
  return std::max(kFarthestOfWidth * front_mm_, kFarthestCells * stock_.cell_mm());
}

double EngagementMeter::closest_mm() const {
  return std::max(kClosestOfWidth * front_mm_, kClosestCells * stock_.cell_mm());
}

const EngagementMeter::Taken& EngagementMeter::take(const Feed& feed) {
  const CutMove& move = feed.move;
  cutter_ = &feed.cutter, move_ = &move;
  source_ = feed.source;
  start_s_ = feed.start_s, duration_s_ = feed.duration_s;
  anticlockwise_ = feed.anticlockwise;
  length_mm_ = way_length_mm(move);
  down_rad_ = down_of(move, length_mm_);
  upright_.reset();
  turnings_.clear();
  if (move.arc) upright_ = UprightArc::of(move);
  if (upright_) turnings_ = upright_->turning_parts();
  until_ = 1;
  taken_ = {};
  taken_.measured = true;
  if (length_mm_ <= 0) return taken_;
  from_ = to_ = 0;
  if (!feed.near) {
    tell_all({});
    since_mm_ = -1;
    return taken_;
  }
  const bool steep = is_steep(move);
  front_mm_ = front_of(move);
  const double farthest = farthest_mm();
  const double short_mm = std::max(farthest, kFarthestOfWidth * diameter_mm_);
  is_short_ = length_mm_ < short_mm && turnings_.empty() && !steep;
  if (is_short_ && counts_still(move) && (last_.is_engaged() || !meets_material(move))) {
    since_mm_ += length_mm_;
    tell_all(last_);
    return taken_;
  }
  hand_over_();
  std::optional<HeightGrid> heights;
  if (!find_material(heights)) {
    log_.add_unmeasured(length_mm_);
    lift();
    taken_.measured = false;
    return taken_;
  }
  if (steep) {
    // Straight down it is in material for as long as that is high there.
    const EngagementLook down = look(1);
    const double part = down.is_engaged() ? std::min(1.0, down.deep_mm / length_mm_) : 0;
    add(0, 1 - part, {});
    if (part > 0) add(1 - part, 1, down);
    since_mm_ = -1;
  } else if (is_short_) {
    const EngagementLook before = last_;
    // Often in brief is better than seldom.
    is_brief_ = saved_cells_ < look_cells_;
    last_ = look(0.5);
    const double cost = look_cells_ * (is_brief_ ? brief_ : 1);
    saved_cells_ -= last_.is_engaged() ? cost : kOfAir * cost;
    saved_cells_ = std::max(saved_cells_, -(kMostBorrowed + 1) * look_cells_);
    is_brief_ = false;
    const bool alike = since_mm_ >= 0 && last_.is_engaged() && is_same(before, last_);
    spacing_mm_ = alike ? std::min(2 * spacing_mm_, kMostSpacing * front_mm_) : farthest;
    spacing_mm_ = std::max(spacing_mm_, farthest);
    since_mm_ = 0.5 * length_mm_;
    last_ahead_ = way_of_short(move);
    // What is in the air in the middle may end, or have begun, in material.
    if (last_.is_engaged() || length_mm_ < closest_mm())
      add(0, 1, last_);
    else
      take_along(0, 1, 2);
  } else if (upright_) {
    take_upright(farthest);
  } else {
    take_along(0, 1,
               static_cast<int>(std::clamp(std::ceil(length_mm_ / farthest), 1.0, kMostNodes)));
  }
  flush();
  heights_ = nullptr, points_ = nullptr;
  return taken_;
}

void EngagementMeter::finish() {
  hand_over_();
  const StockModel& model = stock_.bare();
  const auto* const present = dynamic_cast<const PresentHeights*>(&model);
  if (present == nullptr || !model.keeps_cut_ids()) return;
  const std::optional<HeightGrid> heights = present->present_heights();
  if (!heights) return;
  for (const ScallopsOfTool& tool : ScallopScan(*heights, *present, ways_).run())
    log_.set_scallops(tool.tool, tool.shape, tool.crests);
}

}  // namespace kerf
