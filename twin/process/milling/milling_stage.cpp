#include "twin/process/milling/milling_stage.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/block_copy.h"
#include "base/translate.h"
#include "stock/cutter/cutting_shank.h"
#include "twin/machine/planned_pieces.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/kept_moves.h"
#include "twin/process/milling/probe_contact.h"
#include "twin/process/milling/way_profile.h"

namespace kerf {
namespace {

/// Moves handed to the model at once: many enough that the call costs nothing, few enough to stay
/// in the cache.
constexpr std::size_t kMovesPerCut = 4096;
/// Motion::unknown_to: X, Y and Z.
constexpr std::uint8_t kAllUnknown = 7;
/// Of moves that cost much (tilted tools, long ways on fine cells) fewer, so that a stop is seen in
/// time: as many as take about so long.
constexpr double kCut_s = 0.05;
constexpr std::size_t kLeastMovesPerCut = 1;
/// To begin with, while nobody knows: of upright tools.
constexpr std::size_t kFirstMovesPerCut = 64;
/// Of tilted ones at most: moves in the air say nothing of those in the material behind them. An
/// octree takes no more at once.
constexpr std::size_t kMostTiltedMovesPerCut = 512;
/// From one cut to the next at most so many times as many.
constexpr double kGrowth = 4;
/// Of the moves of one motion, to share its time: as far as they go, and as they turn.
double way_of(const CutMove& move) {
  return glm::length(move.to_mm - move.from_mm) + glm::length(move.axis_to - move.axis_from);
}

}  // namespace

MillingStage::MillingStage(ProcessSite& site)
    : site_(site),
      stock_(site.stock),
      resolver_(site.tools),
      log_(site.log),
      checks_(stock_, log_),
      changes_(log_),
      program_(stock_, log_),
      load_meter_(stock_),
      loads_(log_),
      lengths_(stock_.bounds_mm(), log_),
      films_(stock_, log_),
      parts_(stock_, log_),
      fixtures_(log_),
      machine_(stock_.bare(), log_, [this] { complete(); }),
      pieces_(stock_, log_, [this] { complete(); }),
      moves_per_cut_(stock_.takes_tilted_tools() ? kLeastMovesPerCut : kFirstMovesPerCut) {
  moves_.reserve(kMovesPerCut);
  in_flight_.reserve(2 * kMovesPerCut);
  reports_.reserve(2 * kMovesPerCut);
  beside_cells_mm3_ = stock_.bare().beside_cells_mm3();
}

void MillingStage::stop_by(const std::stop_token& stop) {
  checks_.watch_by({stop, [this](double share) { site_.progress.note_search(share); }});
}

void MillingStage::begin_reporting() {
  complete();
  beside_cells_mm3_ = stock_.bare().beside_cells_mm3();
  checks_.forget_events();
  lengths_.forget();
  films_.forget();
  parts_.begin_reporting();
  fixtures_.begin_reporting();
  machine_.forget();
  pieces_.begin_reporting();
  changes_.forget_events();
  program_.forget_events();
  speed_unsaid_.reset();
  uses_.clear();
  shank_told_.clear();
  reversed_told_.clear();
  reversed_down_.clear();
  taps_.clear();
  last_down_.reset();
  loads_.forget();
  engaged_parts_.forget();
  deepest_.clear();
  mounted_ = nullptr;
  drawn_told_ = false;
}

void MillingStage::finish(bool whole) {
  count_walls();
  if (engagement_) engagement_->finish();
  parts_.finish();
  fixtures_.finish();
  machine_.finish();
  pieces_.finish();
  changes_.finish(whole && !site_.cut_short);
  if (whole && !site_.progress.is_stopped()) report_nothing_cut();
  report_coarse_cells();
  for (const auto& [move, tool] : reversed_down_) {
    if (!taps_.contains(move.motion)) report_reversed(move, tool);
  }
  // Feeds between two samples tremble: of a watched machine only means count (LoadWatch).
  engaged_parts_.end_way();
  if (!site_.watched) loads_.finish();
  for (ToolUse& use : uses_) {
    if (!site_.watched) use.loads = loads_.loads_of(use.number, use.shape);
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

/// What a tool has removed in all is what the workpiece has less, walls where they stand: its
/// moves count by cells.
void MillingStage::count_walls() {
  const double beside_mm3 = stock_.bare().beside_cells_mm3();
  if (mounted_ != nullptr && use_ < uses_.size())
    uses_[use_].removed_mm3 += beside_cells_mm3_ - beside_mm3;
  beside_cells_mm3_ = beside_mm3;
}

void MillingStage::take(const Motion& m, const TimedStep& step, std::span<const PathPiece> path) {
  path_ = path;
  watch_program(m, step);
  if (m.kind == MotionKind::kToolChange || m.tool != spindle_tool_) {
    complete();  // with the cutter that made these moves
    count_walls();
    engaged_parts_.end_way();
    checks_.end_spindle_event();
    spindle_tool_ = m.tool;
    mounted_ = nullptr;
    parts_.unmount();
    fixtures_.unmount();
    machine_.unmount();
    if (engagement_) engagement_->lift();
  }
  if (!stands(m) && checks_.spindle_event_open()) {
    complete();  // the depths still to come belong to the event
    checks_.end_spindle_event();
  }
  if (is_traverse(m)) {
    take_traverse(m, step);
  } else if (is_feed(m)) {
    take_feed(m, step);
  } else {
    check_machine(m, step);
  }
}

/// What the spindle carries now.
void MillingStage::mount_parts(const Motion& m) {
  nose_mm_ = m.tool_offset_mm.z;
  parts_.mount(*mounted_->cutter, mounted_->number, spindle_, nose_mm_);
  if (fixtures_.active()) {
    fixtures_.mount(carried_bodies(tool_bodies(*mounted_->cutter, spindle_, nose_mm_)),
                    mounted_->number, mounted_->guessed);
  }
  if (machine_.active()) machine_.set_place(site_.kinematics, site_.frame);
  machine_.mount(*mounted_->cutter, mounted_->number, mounted_->guessed, nose_mm_);
}

/// A tool whose shank cuts.
void MillingStage::mount_shank(const Motion& m) {
  shank_.reset();
  if (!cut_by_shank_ || !mounted_->cutter) return;
  shank_ = with_cutting_shank(*mounted_->cutter);
  if (shank_ || !has_wider_shank(*mounted_->cutter)) return;
  if (!shank_told_.insert(mounted_->number).second) return;
  Finding finding;
  finding.id = FindingId::kNotSimulated;
  finding.severity = Severity::kNote;
  finding.text = tr("the shank is wider than the neck of this cutter: what it touches is not cut");
  finding.source = m.source;
  finding.tool = mounted_->number;
  log_.add(std::move(finding));
}

/// Mounts the tool of this motion if that has not been done since the last change. True if it can
/// cut.
bool MillingStage::mount_for(const Motion& m) {
  if (mounted_) {
    // The offset may come after the tool.
    if (!spindle_.empty() && mounted_->cutter && m.tool_offset_mm.z != nose_mm_) mount_parts(m);
    return mounted_->cutter.has_value();
  }
  mounted_ = &resolver_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
  announce(*mounted_, m);
  mount_shank(m);
  if (mounted_->cutter) mount_parts(m);
  engaged_parts_.set(site_.engagement, site_.loads, site_.recorder);
  if (site_.engagement && !engagement_) {
    engagement_.emplace(stock_, *site_.engagement, [this] { hand_over(); });
    engagement_->hear_by([this](const EngagementLog::Part& part) {
      engaged_parts_.hear({part.look, part.way, part.source, part.start_s, part.move->from_mm,
                           part_rpm_, part_mm_per_min_});
    });
  }
  if (engagement_ && mounted_->cutter) engagement_->mount(mounted_->number, cutting());
  if (engagement_ && mounted_->cutter) loads_.mount(cutting(), mounted_->number);
  uses_[use_].shank_checked = parts_.checks_shank();
  uses_[use_].holder_checked = parts_.checks_holder();
  return mounted_->cutter.has_value();
}

void MillingStage::take_traverse(const Motion& m, const TimedStep& step) {
  // With an empty spindle a comment without a number waits for the first feed move: the traverse
  // may just clear the way for the tool change that the comment announces.
  if (!mounted_ && m.tool == 0 && !resolver_.has_arguments()) {
    check_machine(m, step);
    return;
  }
  if (engagement_) engagement_->lift();
  // Nor does a move to where nobody knows say which tool is in the spindle: many programs begin so.
  if (m.to_machine_place || m.unknown_to == kAllUnknown) return;
  const bool known = mount_for(m);
  check_machine(m, step);
  if (!known || !m.start_known) {
    check_length(m, step, false);
    return;
  }
  if (!divide(m, step)) return;
  const CheckedMove move = checked(m, step);
  check_parts(m, move);
  if (!comes_near(m)) {
    check_length(m, step, false);
    checks_.clear_traverse();
    return;
  }
  complete();
  check_length(m, step, checks_.check_traverse(move));
  if (site_.moves.is_upright(m)) checks_.check_floor(move);
  push(m, step, false);
}

void MillingStage::take_feed(const Motion& m, const TimedStep& step) {
  if (stands_still(m)) return;
  const bool known = mount_for(m);
  check_machine(m, step);
  check_length(m, step, false);
  if (!known) {
    report_undefined(m, step);
    return;
  }
  uses_[use_].feed_mm += step.length_mm;
  if (!m.start_known) return;
  if (!site_.watched) changes_.feeds(m, step, mounted_->number);
  site_.feeds.note(m, step);
  if (!divide(m, step)) return;
  const CheckedMove move = checked(m, step);
  if (!reached_stock_) note_reach(m);
  if (!site_.watched) note_contact(move);
  check_parts(m, move);
  note_depth(m, step);
  if (site_.moves.is_upright(m)) checks_.check_floor(move);
  const bool spindle_off = stands(m);
  if (spindle_off && !checks_.spindle_event_open() && comes_near(m)) check_standing(m, step, move);
  if (is_drill(move.cutter) && !program_.drill_told() && ProgramChecks::goes_sideways(move) &&
      comes_near(m)) {
    complete();
    program_.check_drill(move);
  }
  push(m, step, spindle_off);
}

void MillingStage::check_parts(const Motion& m, const CheckedMove& cut) {
  const bool upright = site_.moves.is_upright(m);
  // What turns is divided so that its flutes are where they should be; what is far above them needs
  // shorter pieces for that.
  const double reach_mm = upright ? 0 : std::max(parts_.reach_mm(), fixtures_.reach_mm());
  if (reach_mm > 0 && reach_mm > MotionMoves::reach_mm(cut.cutter)) {
    finer_.clear();
    finer_ends_.clear();
    if (site_.moves.append_reaching(m, reach_mm, 0, finer_, &finer_ends_)) {
      check_pieces(m, {m, cut.step, cut.cutter, finer_, cut.tool, cut.tool_guessed, finer_ends_},
                   upright);
      return;
    }
  }
  check_pieces(m, cut, upright);
}

void MillingStage::check_pieces(const Motion& m, const CheckedMove& move, bool upright) {
  if (fixtures_.active()) fixtures_.check(move);
  const bool is_seen = upright || stock_.takes_tilted_tools();
  if (!is_seen || !parts_.may_matter(move.moves)) {
    parts_.pass(m);
    return;
  }
  complete();
  parts_.check(move);
}

/// Of all motions, whatever they are cut with.
void MillingStage::check_machine(const Motion& m, const TimedStep& step) {
  if (!machine_.active()) return;
  machine_.set_place(site_.kinematics, site_.frame);
  machine_.check(m, step);
}

std::vector<CollisionPair> MillingStage::collisions() const {
  std::vector<CollisionPair> out = parts_.table();
  for (CollisionPair& row : fixtures_.table()) out.push_back(std::move(row));
  for (CollisionPair& row : machine_.table()) out.push_back(std::move(row));
  return out;
}

void MillingStage::check_length(const Motion& m, const TimedStep& step, bool touches) {
  const double radius_mm = cutter() ? cutter()->radius_mm() : 0;
  lengths_.check(m, step, radius_mm, site_.moves.is_upright(m), touches);
}

ProbeAnswer MillingStage::answer(const ProbeQuestion& question) {
  complete();
  ProbeAnswer unknown;
  const Motion& m = question.motion;
  if (!mount_for(m)) {
    unknown.why = trf("nothing tells the shape of tool {}, the probe: --tool {}=SHAPE does", m.tool,
                      std::max(1, m.tool));
    return unknown;
  }
  divide(m, {});
  if (divided_.size() != 1) {
    unknown.why = tr("the tool or the workpiece turns");
    return unknown;
  }
  return probe_contact(stock_, *mounted_->cutter, divided_[0], question.away);
}

/// What it is cut as. False: it turns so far that it cannot be.
bool MillingStage::divide(const Motion& m, const TimedStep& step) {
  ends_.clear();
  if (site_.moves.is_upright(m, *mounted_->cutter)) {
    divided_.resize(1);
    set_cut_move(divided_[0], m, 0);
    return true;
  }
  divided_.clear();
  const bool done = site_.moves.append(m, *mounted_->cutter, 0, divided_, &ends_);
  if (!done) report_endless_turn(m, step);
  return done;
}

CheckedMove MillingStage::checked(const Motion& m, const TimedStep& step) const {
  return {m, step, *mounted_->cutter, divided_, mounted_->number, mounted_->guessed, ends_};
}

bool MillingStage::comes_near(const Motion& m) const {
  const Cutter& cutter = *mounted_->cutter;
  return site_.moves.is_upright(m) ? checks_.may_touch(m, cutter.radius_mm())
                                   : checks_.may_touch(divided_, cutter);
}

void MillingStage::note_reach(const Motion& m) {
  if (comes_near(m)) {
    reached_stock_ = true;
    return;
  }
  for (const CutMove& move : divided_) {
    feed_bounds_mm_.extend(move.from_mm);
    feed_bounds_mm_.extend(move.to_mm);
  }
  if (divided_.size() == 1) feed_bounds_mm_.extend(bounds_of(m));
}

void MillingStage::note_depth(const Motion& m, const TimedStep& step) {
  Deepest& deepest = deepest_[use_];
  const double tip_z = std::min(m.from_mm.z, m.to_mm.z);
  if (tip_z >= deepest.tip_z_mm || !site_.moves.is_upright(m) || !comes_near(m)) return;
  if (!deepest.cutter) {
    deepest.source = m.source;
    deepest.time_s = step.start_s;
    deepest.cutter = mounted_->cutter;
  }
  deepest.tip_z_mm = tip_z;
}

/// The programmed move, or what the machine makes of it.
void MillingStage::push(const Motion& m, const TimedStep& step, bool spindle_off) {
  if (site_.progress.stop_now()) return;  // while its contacts were looked for
  std::uint64_t id = site_.first_id.value_or(0);
  if (path_.empty()) {
    if (site_.first_id) next_id_ = id;
    push_moves(m, step, spindle_off);
    return;
  }
  for_each_piece(m, step, path_, [&](const Motion& piece, const TimedStep& part) {
    if (site_.progress.is_stopped()) return;
    if (site_.first_id) next_id_ = id++;
    if (!divide(piece, part)) return;
    push_moves(piece, part, spindle_off);
  });
}

/// Those of divide().
void MillingStage::push_moves(const Motion& m, const TimedStep& step, bool spindle_off) {
  const std::uint64_t id =
      site_.labels ? site_.labels->number_of({mounted_->number, m.source}) : next_id_++;
  const bool one = divided_.size() == 1;
  double ways = 0;
  for (std::size_t i = 0; !one && i < divided_.size(); ++i) ways += way_of(divided_[i]);
  static const InFlight kFresh;
  InFlight& flight = flight_;
  copy_block(flight, kFresh);
  flight.duration_s = step.duration_s;
  flight.start_s = step.start_s;
  flight.source = m.source;
  flight.motion = site_.motion;
  flight.use = use_;
  flight.feed = is_feed(m);
  flight.spindle_off = spindle_off;
  flight.reversed = m.spindle == SpindleState::kCounterclockwise;
  const Vec3 way = m.to_mm - m.from_mm;
  flight.straight_down = way.x == 0 && way.y == 0 && way.z < 0;
  note_tap(m);
  note_teeth(m, step, flight);
  measure(m, step, flight);
  if (engagement_) engage(m, step, flight);
  PieceCutter by{m.source, step.start_s, step.duration_s, mounted_->number, 0, mounted_->guessed};
  by.radius_mm = cutting().radius_mm();
  std::size_t pushed = 0;
  for (CutMove& move : divided_) {
    move.id = id;
    if (engagement_) engagement_->note_cut(as_circle(move));
    pieces_.before(cutting(), move, by);
    moves_.push_back(move);
    if (!cut_parts_.empty()) flight.cut_part = cut_parts_[pushed];
    if (!one) {
      const double share =
          ways > 0 ? way_of(move) / ways : 1 / static_cast<double>(divided_.size());
      flight.duration_s = step.duration_s * share;
    }
    in_flight_.push_back(flight);
    flight.parts = 0;
    pieces_.after(move, by);
    ++pushed;
    if (moves_.size() < moves_per_cut_) continue;
    hand_over();
    if (site_.progress.stop_now()) return;
    site_.progress.note_cut(static_cast<double>(pushed) / static_cast<double>(divided_.size()));
  }
}

void MillingStage::hand_over() {
  if (moves_.empty()) return;
  const auto begin = std::chrono::steady_clock::now();
  if (site_.kept) site_.kept->add(cutting(), moves_);
  stock_.cut(cutting(), moves_, reports_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double fits = static_cast<double>(moves_.size()) * kCut_s / std::max(took.count(), 1e-6);
  const double grown = std::min(fits, kGrowth * static_cast<double>(moves_per_cut_));
  const std::size_t most = stock_.takes_tilted_tools() ? kMostTiltedMovesPerCut : kMovesPerCut;
  moves_per_cut_ = static_cast<std::size_t>(
      std::clamp(grown, static_cast<double>(kLeastMovesPerCut), static_cast<double>(most)));
  moves_.clear();
  collect_reports();
}

void MillingStage::complete() {
  hand_over();
  if (in_flight_.empty()) return;
  stock_.finish(reports_);
  collect_reports();
}

void MillingStage::collect_reports() {
  assert(reports_.size() <= in_flight_.size());
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const CutReport& report = reports_[i];
    const InFlight& move = in_flight_[i];
    judge_parts(move, report);
    ToolUse& use = uses_[move.use];
    if (site_.labels) site_.labels->note(report.id, report.removed_mm3, move.duration_s);
    site_.note_cut(move.motion, report.removed_mm3, report.depth_mm);
    if (move.feed && !move.measured) {
      count_feed(use, move, report);
    } else {
      use.gap_mm = std::numeric_limits<double>::infinity();
    }
    // Of a groove that is narrower than a cell only the depth may be known.
    use.max_depth_mm = std::max(use.max_depth_mm, report.depth_mm);
    if (report.film.area_mm2 > 0 && !site_.holding)
      films_.take(report.film, {move.source, move.start_s, use.number});
    if (engagement_ && (report.removed_mm3 > 0 || move.engaged_mm > 0))
      site_.engagement->add_removed(move.pass, report.removed_mm3, move.engaged_mm, move.engaged_s,
                                    move.engaged_mm3, move.straight_down);
    if (report.removed_mm3 <= 0) continue;
    use.removed_mm3 += report.removed_mm3;
    if (move.reversed && move.feed && move.straight_down && !reversed_told_.contains(use.number))
      reversed_down_.emplace_back(move, use.number);
    else if (move.reversed && move.feed)
      report_reversed(move, use.number);
    if (move.feed_per_tooth_mm > 0) count_chip(use.chip, move, report);
    if (move.spindle_off && report.depth_mm > kContactTolerance_mm) {
      checks_.deepen_spindle_event(report.depth_mm);
    }
  }
  in_flight_.erase(in_flight_.begin(),
                   in_flight_.begin() + static_cast<std::ptrdiff_t>(reports_.size()));
  reports_.clear();
}

}  // namespace kerf
