#include "twin/process/turning/turning_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/timing/spindle_speed.h"
#include "stock/turning/tap.h"
#include "stock/turning/turned_surface.h"
#include "twin/machine/planned_pieces.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/engagement_log.h"
#include "twin/process/finding_at.h"
#include "twin/process/tool_tells.h"
#include "twin/process/turning/tool_outlines.h"
#include "twin/process/turning/tool_plates.h"

namespace kerf {
namespace {

/// Motion::unknown_to: X, Y and Z.
constexpr std::uint8_t kAllUnknown = 7;

/// In the mean of the time. Under G96 the speed follows the diameter, and under G95 the tool is
/// the longer at a place the slower the bar turns there.
double mean_rpm(const Motion& m) {
  if (m.from_mm.x == m.to_mm.x && m.kind != MotionKind::kArc) return spindle_rpm_at(m, 0);
  constexpr int kPlaces = 32;
  double sum = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double rpm = spindle_rpm_at(m, (k + 0.5) / kPlaces);
    if (rpm <= 0) return 0;
    sum += m.feed_per_rev ? 1 / rpm : rpm;
  }
  return m.feed_per_rev ? kPlaces / sum : sum / kPlaces;
}

}  // namespace

TurningStage::TurningStage(ProcessSite& site)
    : site_(site),
      stock_(site.stock),
      resolver_(site.tools),
      log_(site.log),
      changes_(log_),
      checks_(stock_, log_),
      holding_(log_),
      fixtures_(log_),
      rings_(log_),
      parts_(stock_, log_),
      holders_(*stock_.turned(), log_),
      depths_(*stock_.turned(), log_),
      noses_(*stock_.turned(), log_),
      speeds_(log_),
      stops_(*stock_.turned(), log_),
      threads_(*stock_.turned(), log_),
      loads_(log_),
      fallen_before_(stock_.turned()->part().freed().size()) {}

void TurningStage::check_by(const CheckOptions& options) {
  checks_.set_options(options);
  loads_.set_wish(options.cutting);
  const CollisionWishes& wishes = options.collisions;
  if (wishes.held_by) {
    holding_.set_wishes(wishes);
    rings_.set_obstacles(obstacles_of(*wishes.held_by), wishes);
  }
  fixtures_.set_obstacles(obstacles_of(wishes.fixtures), wishes);
  parts_.set_blank_guessed(options.blank_guessed);
  parts_.set_clearance(wishes.clearance_mm);
  holders_.set_clearance(wishes.clearance_mm);
}

void TurningStage::begin_reporting() {
  checks_.forget();
  changes_.forget_events();
  holding_.begin_reporting();
  fixtures_.begin_reporting();
  rings_.begin_reporting();
  parts_.begin_reporting();
  holders_.begin_reporting();
  noses_.forget();
  threads_.forget();
  loads_.forget();
  uses_.clear();
  fallen_.clear();
  fallen_before_ = stock_.turned()->part().freed().size();
  unmount();
  mill_turn_told_ = unmilled_told_ = threads_told_ = fixtures_told_ = floating_told_ = false;
}

void TurningStage::go_on_from(const Process& process) {
  const auto& other = static_cast<const TurningStage&>(process);
  fallen_ = other.fallen_;
  fallen_before_ = other.fallen_before_;
}

void TurningStage::finish(bool whole) {
  changes_.finish(whole && !site_.cut_short);
  if (whole && !site_.progress.is_stopped()) {
    checks_.finish();
    holding_.finish();
    fixtures_.finish();
    rings_.finish();
    parts_.finish();
    holders_.finish();
    threads_.end();
    noses_.finish();
    report_nothing_cut();
  }
  // Feeds between two samples tremble: of a watched machine only means count (LoadWatch).
  if (!site_.watched) loads_.finish();
  for (ToolUse& use : uses_) {
    if (!site_.watched) use.loads = loads_.loads_of(use.number, use.shape);
    if (use.peak_mm3_per_s == 0) close_window(use);
  }
}

void TurningStage::take(const Motion& m, const TimedStep& step, std::span<const PathPiece> path) {
  path_ = path;
  checks_.note_block(m.source);
  tap_lead_mm_ = site_.watched ? 0 : floating_.lead_mm(m);
  if (!site_.watched && cutter()) stops_.check_stop(m, step, *edges_, mounted_->number);
  if (m.kind == MotionKind::kToolChange || m.tool != spindle_tool_) {
    spindle_tool_ = m.tool;
    unmount();
  }
  if (m.kind == MotionKind::kToolChange && !site_.watched) {
    changes_.feeds(m, step, m.tool);  // its T word may be another than the one that waited
    changes_.end_tool();
  }
  if (!stands(m)) checks_.end_standing();
  if (is_traverse(m)) {
    take_traverse(m, step);
    behind_feed_ = false;
  }
  if (is_feed(m)) {
    take_feed(m, step);
    behind_feed_ = true;
  }
  // The tool is known now: a driven one has a speed of its own.
  if (!is_driven()) speeds_.check(m, step, checks_.options().spindle_max_rpm);
}

/// Told to stop, or to turn at no speed. What nobody tells of a machine that is watched cannot be
/// found wrong.
bool TurningStage::stands(const Motion& m) const {
  // A driven tool has a spindle of its own (M3 $1), or on small machines the only one.
  if (is_driven() && (m.torch.spindles_on & ~1U) != 0) return false;
  if (m.spindle == SpindleState::kStopped) return true;
  return m.spindle_rpm == 0 && (m.speed_said || !site_.watched);
}

bool TurningStage::mount_for(const Motion& m) {
  if (mounted_) return mounted_->cutter.has_value();
  mounted_ = &resolver_.mount(m.tool, m.source.file == 0 ? m.source.line : 0);
  use_ = place_of_use(uses_, *mounted_, m, log_);
  if (mounted_->cutter && !is_driven()) loads_.mount(*mounted_->cutter, mounted_->number);
  mount_checks();
  return mounted_->cutter.has_value();
}

void TurningStage::mount_checks() {
  if (!mounted_->cutter) return;
  const Cutter& cutter = *mounted_->cutter;
  if (is_driven()) {
    const std::vector<ToolBody> bodies = tool_bodies(cutter, {}, 0);
    if (rings_.active()) rings_.mount(carried_bodies(bodies), mounted_->number, mounted_->guessed);
    if (fixtures_.active())
      fixtures_.mount(carried_bodies(bodies), mounted_->number, mounted_->guessed);
    parts_.mount(cutter, mounted_->number, {}, 0);
    uses_[use_].shank_checked = parts_.checks_shank();
    uses_[use_].holder_checked = parts_.checks_holder();
    edges_ = cutter;
    return;
  }
  if (holding_.active()) holding_.mount(cutter, mounted_->number, mounted_->guessed);
  if (fixtures_.active())
    fixtures_.mount(standing_bodies(cutter), mounted_->number, mounted_->guessed);
  holders_.mount(cutter, mounted_->number);
  uses_[use_].holder_checked = holders_.active();
  depths_.mount(cutter);
  noses_.mount(cutter, mounted_->number);
  threads_.mount(cutter);
  edges_ = holders_.active()
               ? Cutter::from_insert(cutter.spec(), outlines_of(cutter).cutter, cutter.insert_tip())
               : cutter;
}

void TurningStage::unmount() {
  mounted_ = nullptr;
  edges_.reset();
  checks_.end_tool();
  holding_.unmount();
  fixtures_.unmount();
  rings_.unmount();
  parts_.unmount();
  holders_.unmount();
  depths_.unmount();
  noses_.unmount();
  speeds_.end_tool();
  stops_.end_tool();
  threads_.end();
}

std::vector<CollisionPair> TurningStage::collisions() const {
  std::vector<CollisionPair> rows = holding_.table();
  for (const FixtureChecks* checks : {&rings_, &fixtures_})
    for (CollisionPair& row : checks->table()) rows.push_back(std::move(row));
  for (const std::vector<CollisionPair>* table : {&holders_.table(), &parts_.table()})
    rows.insert(rows.end(), table->begin(), table->end());
  return rows;
}

bool TurningStage::divide(const Motion& m, std::vector<CutMove>& moves) {
  moves.clear();
  ends_.clear();
  return site_.moves.append(m, *mounted_->cutter, 0, moves, &ends_);
}

TurnedMove TurningStage::turned(const Motion& m, const TimedStep& step) const {
  return {m, step, *mounted_->cutter, *edges_, moves_, mounted_->number, mounted_->guessed, ends_};
}

void TurningStage::take_traverse(const Motion& m, const TimedStep& step) {
  // As in milling: the tool of such a move is not known for sure.
  if (!mounted_ && m.tool == 0 && !resolver_.has_arguments()) return;
  if (m.to_machine_place || m.unknown_to == kAllUnknown) return;
  if (!mount_for(m) || !m.start_known || report_unmilled(m, step) || !divide(m, moves_)) return;
  const TurnedMove move = turned(m, step);
  check_bodies(move);
  if (!checks_.may_touch(move)) {
    checks_.clear_traverse();
    return;
  }
  checks_.check_traverse(move, behind_feed_);
  cut(m, step);
}

void TurningStage::take_feed(const Motion& m, const TimedStep& step) {
  if (m.start_known && stands_still(m)) return;
  ++feed_moves_;
  feeds_placed_ = feeds_placed_ || m.start_known;
  if (!mount_for(m)) {
    report_undefined(m, step);
    return;
  }
  uses_[use_].feed_mm += step.length_mm;
  if (!m.start_known) return;
  if (!site_.watched) changes_.feeds(m, step, mounted_->number);
  if (m.kind != MotionKind::kThread || !is_driven()) site_.feeds.note(m, step);
  if (report_unmilled(m, step)) return;
  if (!is_driven()) {
    report_mill_turn(m, step);
    checks_.check_plane(m, step);
    report_floating_tap(m, step);
  }
  if (!divide(m, moves_)) return;
  const TurnedMove move = turned(m, step);
  check_bodies(move);
  if (!checks_.may_touch(move)) {
    // One that goes on from it does so with the turn, and is part of the same pass.
    if (m.kind == MotionKind::kThread) {
      if (!is_driven()) threads_.note(move);
      cut(m, step);
    }
    return;
  }
  if (!is_driven()) {
    threads_.note(move);
    stops_.check_drill(move);
    depths_.note(move);
  }
  if (stands(m)) checks_.check_standing(move);
  cut(m, step);
}

/// What a tool must not touch, and what of it must touch nothing.
void TurningStage::check_bodies(const TurnedMove& move) {
  const CheckedMove bodies{move.motion, move.step,         move.cutter, move.moves,
                           move.tool,   move.tool_guessed, move.ends};
  if (is_driven()) return check_driven(bodies);
  if (holding_.active()) holding_.check(move);
  if (fixtures_.active()) fixtures_.check(bodies);
  if (holders_.active()) holders_.check(move, checks_.options().blank_guessed);
}

/// Where C turns the workpiece, what is far above the flutes needs shorter pieces than these.
CheckedMove TurningStage::finer(const CheckedMove& cut) {
  CheckedMove move = cut;
  const double reach_mm = std::max(parts_.reach_mm(), rings_.reach_mm());
  const ToolPath* const path = site_.moves.live_path(cut.cutter);
  if (!path || reach_mm <= MotionMoves::reach_mm(cut.cutter)) return move;
  finer_.clear();
  finer_ends_.clear();
  if (path->moves_of(cut.motion, reach_mm, 0, finer_, &finer_ends_)) {
    move.moves = finer_;
    move.ends = finer_ends_;
  }
  return move;
}

void TurningStage::check_driven(const CheckedMove& cut) {
  const CheckedMove move = finer(cut);
  check_driven_parts(move);
  if (!rings_.active() && !fixtures_.active()) return;
  if (site_.kinematics && LivePaths::is_described(*site_.kinematics)) {
    // What holds the workpiece is round, and turns with it.
    if (rings_.active()) rings_.check(move);
    if (!fixtures_.active() || std::exchange(fixtures_told_, true)) return;
    Finding finding = finding_at(FindingId::kNotSimulated, Severity::kNote, move.motion, move.step);
    finding.tool = move.tool;
    finding.text =
        tr("on a machine that is described by its links driven tools are not held against "
           "fixtures, which stand still while the workpiece turns");
    log_.add(std::move(finding));
    return;
  }
  // As the lathe has it: the tool keeps its direction, whatever C does.
  CutMove here = cut_move_from(move.motion, 0);
  here.axis_from = here.axis_to =
      *move.cutter.live() == LiveAxis::kX ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  CheckedMove still = move;
  still.moves = std::span(&here, 1);
  still.ends = {};
  if (rings_.active()) rings_.check(still);
  if (fixtures_.active()) fixtures_.check(still);
}

/// Shank and holder against the workpiece.
void TurningStage::check_driven_parts(const CheckedMove& move) {
  if (parts_.may_matter(move.moves)) {
    parts_.check(move);
  } else {
    parts_.pass(move.motion);
  }
}

/// Once: a feed of a tool that is not driven beside the plane of the axis, or while the workpiece
/// is turned as an axis, is no turning.
void TurningStage::report_mill_turn(const Motion& m, const TimedStep& step) {
  constexpr double kOff_mm = 1e-6;
  const bool beside =
      m.kind != MotionKind::kArc && std::max(std::abs(m.from_mm.y), std::abs(m.to_mm.y)) > kOff_mm;
  const bool turns = m.from_abc_deg != m.to_abc_deg;
  if (mill_turn_told_ || (!beside && !turns)) return;
  mill_turn_told_ = true;
  tell_not_modelled(
      m, step,
      beside ? tr("the tool cuts beside Y0: it is cut as if it were at Y0")
             : tr("the workpiece is turned as an axis while it is cut: it is cut as if it turned "
                  "all round"),
      mounted_->cutter->insert()
          ? tr("what is turned is right; --as-mill is for programs that only mill")
          : tr("a driven tool says so in its shape: live=z (it lies along Z) or live=x; --as-mill "
               "is for programs that only mill"));
}

/// A driven tool that kerf cannot follow on this machine: true, told once, and its moves do not
/// cut.
bool TurningStage::report_unmilled(const Motion& m, const TimedStep& step) {
  if (!is_driven()) return false;
  const bool main_turns = (m.torch.spindles_on & 1U) != 0 && (m.torch.spindles_on & ~1U) != 0;
  if (site_.moves.mills() && !main_turns) return false;
  if (!is_feed(m) || std::exchange(unmilled_told_, true)) return true;
  if (main_turns) {
    tell_not_modelled(m, step,
                      tr("a driven tool cuts while the main spindle turns as well (turn-milling): "
                         "its moves are not cut"),
                      tr("M5 $0 comes before milling; M3 $0 alone turns the driven tool itself"));
  } else {
    tell_not_modelled(m, step,
                      tr("a driven tool on a machine whose kinematics are switched: how they hold "
                         "the workpiece is not known, and its moves are not cut"),
                      tr("machine.kinematics: links says how the machine moves"));
  }
  return true;
}

/// Once, when a part has been milled and has threads.
void TurningStage::report_lost_threads(const Motion& m, const TimedStep& step) {
  const TurningStock& turned = *stock_.turned();
  const bool is_milled = !is_turned_alone(stock_);
  if (threads_told_ || !is_milled || turned.part().threads().empty()) return;
  threads_told_ = true;
  Finding finding = finding_at(FindingId::kNotSimulated, Severity::kNote, m, step);
  finding.tool = m.tool;
  finding.text =
      tr("the part has threads and is milled: pictures, meshes and what driven tools meet have the "
         "threads as plain cylinders and cones");
  log_.add(std::move(finding));
}

/// Once, of a tool on the axis that is fed into a hole, and out of it with the spindle reversed,
/// and leaves no thread.
void TurningStage::report_floating_tap(const Motion& m, const TimedStep& step) {
  if (m.kind != MotionKind::kFeed || mounted_->cutter->insert()) return;
  const double way_mm = m.to_mm.z - m.from_mm.z;
  const bool reversed = m.spindle != SpindleState::kStopped && in_by_ != SpindleState::kStopped &&
                        m.spindle != in_by_;
  const bool is_tapped =
      tap_lead_mm_ != 0 &&
      tap_tools(2 * mounted_->cutter->radius_mm(), std::abs(tap_lead_mm_), way_mm).has_value();
  if (way_mm > 0 && reversed && !is_tapped && m.from_mm == in_to_mm_ &&
      !std::exchange(floating_told_, true)) {
    Finding finding = finding_at(FindingId::kNotSimulated, Severity::kNote, m, step);
    finding.tool = m.tool;
    finding.text =
        tr("a tap in a chuck that floats (G84): the part has the hole that its diameter sweeps, "
           "without a thread");
    finding.hint =
        tr("its pitch is the feed divided by the speed of the spindle, or G95's F; G33.1 taps in "
           "step with the spindle");
    log_.add(std::move(finding));
  }
  in_by_ = way_mm < 0 ? m.spindle : SpindleState::kStopped;
  in_to_mm_ = m.to_mm;
}

void TurningStage::tell_not_modelled(const Motion& m, const TimedStep& step, std::string text,
                                     std::string hint) {
  Finding finding = finding_at(FindingId::kNotModelled, Severity::kError, m, step);
  finding.tool = m.tool;
  finding.text = std::move(text);
  finding.hint = std::move(hint);
  log_.add(std::move(finding));
}

void TurningStage::report_undefined(const Motion& m, const TimedStep& step) {
  ToolUse& use = uses_[use_];
  const bool first = use.origin.empty();
  undefined_ = true;
  use.feed_mm += step.length_mm;
  if (!first) return;
  use.origin = mounted_->origin.empty() ? tr("nothing") : mounted_->origin;
  tell_undefined(*mounted_, m, step, log_);
}

/// The programmed move, or what the machine makes of it. A thread keeps its turns.
void TurningStage::cut(const Motion& m, const TimedStep& step) {
  if (site_.progress.stop_now()) return;
  TurnCut whole;
  if (m.kind == MotionKind::kThread || tap_lead_mm_ != 0) {
    cut_piece(m, step, whole);
  } else {
    for_each_piece(m, step, path_, [&](const Motion& piece, const TimedStep& part) {
      cut_piece(piece, part, whole);
    });
  }
  note_fallen(m, step);
  report_lost_threads(m, step);
  touched_ = touched_ || whole.removed_mm3 > 0;
  if (!is_feed(m) || is_driven()) return;
  const TurnedMove move = turned(m, step);
  if (holders_.active()) holders_.measure(move);
  checks_.check_sides(move, whole);
  checks_.check_centre(move, whole);
  depths_.check(move, whole, checks_.options().blank_guessed);
  noses_.note(move, whole);
}

void TurningStage::cut_piece(const Motion& m, const TimedStep& step, TurnCut& whole) {
  if (!divide(m, pieces_)) return;
  const std::uint64_t id =
      site_.labels ? site_.labels->number_of({mounted_->number, m.source}) : next_id_++;
  for (CutMove& move : pieces_) {
    move.id = id;
    if (tap_lead_mm_ != 0) move.lead_mm = tap_lead_mm_;
  }
  reports_.clear();
  stock_.cut(*mounted_->cutter, pieces_, reports_);
  ToolUse& use = uses_[use_];
  const TurnCut piece = sum_of_piece();
  const double way_mm = path_length_mm(m);
  // How far a driven tool is in material nobody measures: all of the move, if it cuts at all.
  const double share = is_driven()  ? (piece.removed_mm3 > 0 ? 1 : 0)
                       : way_mm > 0 ? std::min(1.0, piece.way_mm / way_mm)
                                    : 1;
  const double cut_s = step.duration_s * share;
  if (site_.labels) site_.labels->note(id, piece.removed_mm3, step.duration_s);
  site_.note_cut(site_.motion, piece.removed_mm3, piece.depth_mm);
  use.removed_mm3 += piece.removed_mm3;
  if (is_feed(m)) {
    use.max_depth_mm = std::max(use.max_depth_mm, piece.depth_mm);
    add_cutting(use, cut_s, piece.removed_mm3);
  }
  whole.extend(piece);
  if (site_.engagement && !site_.holding && is_feed(m)) note_engagement(m, step, piece);
}

/// Threads are fed by their lead, and driven tools mill: of neither is it measured. Beside a
/// machine without its program a threading tool seems to turn what it threads.
void TurningStage::note_engagement(const Motion& m, const TimedStep& step, const TurnCut& piece) {
  if (!engagement_begun_) site_.engagement->begin(stock_);
  engagement_begun_ = true;
  TurnedWay way;
  way.length_mm = path_length_mm(m);
  const bool threads = m.kind == MotionKind::kThread || tap_lead_mm_ != 0 ||
                       (site_.watched && threads_.is_threading_tool());
  if (threads || is_driven()) {
    if (piece.removed_mm3 <= 0) return;
    site_.engagement->add_unmeasured(way.length_mm);
    TurnLoads::tell_unmeasured(mounted_->number, m.source, step.start_s, step.duration_s,
                               site_.loads);
    return;
  }
  way.seconds = step.duration_s;
  way.cut_mm = std::min(piece.way_mm, way.length_mm);
  way.depth_mm = piece.depth_mm;
  way.removed_mm3 = piece.removed_mm3;
  const double rpm = mean_rpm(m);
  const bool turns = m.spindle != SpindleState::kStopped && rpm > 0 && step.duration_s > 0;
  if (turns) way.feed_mm_per_rev = way.length_mm / (step.duration_s / 60 * rpm);
  // Under G95 the axes follow the spindle: no turn takes more than is written.
  if (m.feed_per_rev && m.feed_mm_per_min > 0)
    way.feed_mm_per_rev = std::min(way.feed_mm_per_rev, m.feed_mm_per_min);
  const double sine = piece.edge_mm > 0 ? piece.edge_across_mm / piece.edge_mm : 0;
  way.chip_mm = way.feed_mm_per_rev * sine;
  site_.engagement->add_turned(mounted_->number, *mounted_->cutter, way);
  if (site_.recorder) site_.recorder->on_turned(site_.motion, way);
  // A tool in the air takes nothing, whatever its edge.
  if (turns && (sine > 0 || way.cut_mm <= 0)) take_load(m, step, way, sine);
}

/// Where the workpiece is widest on the way: there it takes most torque, and no less power.
void TurningStage::take_load(const Motion& m, const TimedStep& step, const TurnedWay& way,
                             double sine) {
  const double from_mm = std::abs(m.from_mm.x), to_mm = std::abs(m.to_mm.x);
  const double widest_mm = std::max(from_mm, to_mm), bar_mm = stock_.bounds_mm().max.x;
  TurnLoads::Part part;
  part.way = way;
  part.sine = std::min(sine, 1.0);
  part.radius_mm = std::min(widest_mm, bar_mm);
  // What begins or ends beside the bar turns as fast there as it does where it meets it.
  const double share = widest_mm > bar_mm && from_mm != to_mm
                           ? (bar_mm - from_mm) / (to_mm - from_mm)
                       : from_mm >= to_mm ? 0
                                          : 1;
  part.rpm = spindle_rpm_at(m, std::clamp(share, 0.0, 1.0));
  // A feed a minute is most of a turn where it turns slowest.
  if (!m.feed_per_rev && part.rpm > 0)
    part.way.feed_mm_per_rev = way.length_mm / (step.duration_s / 60 * part.rpm);
  part.source = m.source;
  part.start_s = step.start_s;
  part.from_mm = m.from_mm;
  loads_.take(part, site_.loads);
}

/// Of what has just been cut.
TurnCut TurningStage::sum_of_piece() const {
  TurnCut piece;
  if (is_driven()) {
    for (const CutReport& report : reports_) {
      piece.removed_mm3 += report.removed_mm3;
      piece.depth_mm = std::max(piece.depth_mm, report.depth_mm);
    }
    return piece;
  }
  for (const TurnCut& cut : stock_.turned()->last_cuts()) piece.extend(cut);
  return piece;
}

void TurningStage::note_fallen(const Motion& m, const TimedStep& step) {
  const std::vector<TurnedPiece>& freed = stock_.turned()->part().freed();
  while (fallen_before_ + fallen_.size() < freed.size()) {
    fallen_.push_back(
        {freed[fallen_before_ + fallen_.size()], m.source, step.start_s + step.duration_s, m.tool});
  }
}

/// A whole program over a blank that is known to be one.
void TurningStage::report_nothing_cut() {
  // A guessed blank lies where the program works: missing it says nothing of the program.
  const bool judged = site_.blank == BlankKind::kGiven || site_.blank == BlankKind::kSaved;
  if (!judged || touched_ || undefined_) return;
  Finding finding;
  finding.id = FindingId::kNothingCut;
  finding.severity =
      site_.blank == BlankKind::kGiven && feeds_placed_ ? Severity::kError : Severity::kWarning;
  if (feed_moves_ == 0) {
    finding.text = tr("nothing is cut: the program has no feed move");
  } else if (!feeds_placed_) {
    finding.text = tr("nothing is cut: nothing has said where the feed moves are");
  } else {
    finding.text =
        tr("nothing is cut: no feed move touches the workpiece; is the blank given in the "
           "coordinates that the program writes?");
  }
  log_.add(std::move(finding));
}

}  // namespace kerf
