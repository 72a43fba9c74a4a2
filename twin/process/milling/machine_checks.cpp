#include "twin/process/milling/machine_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/motion_kinds.h"
#include "stock/move_reach.h"
#include "twin/collision/mesh_depth.h"
#include "twin/collision/solid_sweep.h"
#include "twin/job/blank_mesh.h"
#include "twin/motion/motion_geometry.h"
#include "twin/process/finding_at.h"
#include "twin/process/milling/checks.h"

namespace kerf {
namespace {

/// Least distances are followed below this, to a fiftieth: a machine's links are far apart most of
/// the time, and nobody asks by how much.
constexpr double kFollowed_mm = 10;
constexpr double kGrain = 0.02;
constexpr double kLeastGrain_mm = 0.005;
/// Nearer than this may be a contact.
constexpr double kTouchGap_mm = 1e-3;
/// Pairs that have less room than this are looked at one by one.
constexpr double kClose_mm = 5;
/// Of what is left to the others, no more is counted on: bounds on what turns grow with it.
constexpr double kMostFar_mm = 200;
/// Where the links have the tip may be off by rounding of what is written in files.
constexpr double kSamePlace_mm = 0.05;
constexpr double kSameDirection = 1e-4;

/// What counts: a new least distance, or 0, a contact.
double counts_mm(const WorkingPair& pair) {
  const double grain = std::max(kGrain * pair.least_mm, kLeastGrain_mm);
  const double least = std::isfinite(pair.least_mm) ? pair.least_mm - grain : pair.least_mm;
  return std::max(std::min(least, std::max(kFollowed_mm, pair.near_mm)), 0.0);
}

bool is_within_reach(const Motion& m) {
  for (const Vec3* place : {&m.from_mm, &m.to_mm})
    for (int i = 0; i < 3; ++i)
      if (!(std::abs((*place)[i]) < kMoveReach_mm)) return false;
  return m.kind != MotionKind::kArc || std::abs(m.arc.sweep_rad) <= 2 * kPi * kMostMoveTurns;
}

/// How far from where it turns about anything the body is, seen along the chain.
void add_weights(const ToolChain& chain, const AxisValues& at, double reach_mm, const Vec3& end_mm,
                 AxisValues& weights) {
  AxisValues own{};
  double away = reach_mm + kMostFar_mm;
  Vec3 level = end_mm;
  for (auto step = chain.steps().rbegin(); step != chain.steps().rend(); ++step) {
    switch (step->kind) {
      case ToolChain::Kind::kShift:
        level += step->vector;
        break;
      case ToolChain::Kind::kSlide:
        level += step->vector * at[step->input];
        own[step->input] += 1;
        break;
      case ToolChain::Kind::kTurn:
        away += glm::length(level);
        level = Vec3(0.0);
        own[step->input] += kRadPerDeg * away;
        break;
    }
  }
  for (std::size_t i = 0; i < kAxisCount; ++i) weights[i] = std::max(weights[i], own[i]);
}

}  // namespace

MachineChecks::MachineChecks(const StockModel& stock, FindingLog& log,
                             std::function<void()> complete)
    : log_(log), surface_(stock, std::move(complete)) {}

void MachineChecks::set_options(const CheckOptions& options) {
  wishes_ = options.collisions;
  blank_guessed_ = options.blank_guessed;
  blank_ = options.blank;
  if (wishes_.machine) pairs_.set(wishes_, surface_.box_mm());
}

void MachineChecks::set_place(std::shared_ptr<const MachineKinematics> kinematics,
                              const WorkpieceFrame& frame) {
  if (!active() || (placed_ && kinematics_ == kinematics && frame_ == frame)) return;
  placed_ = true;
  moves_are_known_ = kinematics != nullptr;
  kinematics_ = std::move(kinematics);
  frame_ = frame;
  far_mm_ = -1;
  runs_.reset();
  if (!wishes_.machine) {
    wishes_.machine = wishes_.built_in(frame, surface_.box_mm());
    pairs_.set(wishes_, surface_.box_mm());
  }
  Result<MachineKinematics> plain =
      known_machine("trivkins", std::string(kAxisLetters.begin(), kAxisLetters.end()), {}, {});
  Result<MachineRuns> runs =
      MachineRuns::create(moves_are_known_ ? *kinematics_ : std::move(plain.value()), frame);
  if (!runs) {
    give_up(runs.error());
    return;
  }
  runs_ = std::move(runs.value());
  const MachineKinematics& machine = runs_->path().machine();
  const KinematicChain& chain = pairs_.chain();
  const bool by_joints = std::ranges::any_of(chain.links(), [](const ChainLink& link) {
    return link.joint != JointKind::kFixed && link.by_joint;
  });
  if (machine.belts && by_joints) {
    give_up(trf("{} moves two axes with each joint, and links go by joints", machine.module));
    return;
  }
  // The kinematics' own links lie in machine coordinates while all axes are at 0; where these
  // links are then, their tool's origin is.
  const Vec3 zero = chain.workpiece_from_tool({}).origin_mm;
  const Vec3 zero_of_kinematics = machine.chain.workpiece_from_tool({}).origin_mm;
  const Pose link_from_program =
      shift(zero - zero_of_kinematics) * runs_->path().link_from_workpiece();
  program_from_link_ = link_from_program.inverse();
  tool_chain_ = ToolChain(chain, machine.joint_letters);
  pairs_.place(link_from_program, machine.joint_letters);
  check_beside_blank();
}

/// Fixtures that stand on links never move against a workpiece that these carry: once is enough.
void MachineChecks::check_beside_blank() {
  if (blank_guessed_ || std::exchange(beside_told_, true) || !wishes_.fixtures) return;
  SolidPointer blank = solid_of(blank_);
  if (!blank) {
    BlankBody box;
    box.bounds_mm = surface_.box_mm();
    if (box.bounds_mm.empty()) return;
    blank = Solid::of_bodies({&box, 1});
  }
  for (const WorkingBody& body : pairs_.bodies()) {
    if (body.kind != WorkingBody::Kind::kFixture || body.by_program) continue;
    const auto own = std::ranges::find(*wishes_.fixtures, body.name, &Fixture::name);
    if (own->in_blank || wishes_.rules.ignores(body.name, kWorkpieceBody)) continue;
    const std::optional<Pose> pose = pairs_.beside_workpiece(body, program_from_link_);
    if (!pose) continue;
    const double depth = depth_in_blank_mm(*own->solid, *pose, *blank);
    if (depth <= kTouching_mm) continue;
    Finding finding;
    finding.id = FindingId::kFixtureContact;
    finding.severity = Severity::kError;
    finding.text = trf("fixture '{}' on link '{}' stands in the blank", own->name, own->on);
    finding.depth_mm = depth;
    finding.bodies = {own->name, kWorkpieceBody};
    finding.hint =
        tr("machine.work_offset says where the work zero lies in the machine; what is meant to "
           "stand in it has :in-blank");
    log_.add(std::move(finding));
  }
}

void MachineChecks::mount(const Cutter& cutter, int tool, bool guessed, double nose_mm) {
  if (!wishes_.machine) return;
  pairs_.mount(cutter, tool, guessed, nose_mm);
  far_mm_ = -1;
}

void MachineChecks::unmount() {
  if (!wishes_.machine) return;
  for (WorkingPair* pair : pairs_.active()) pair->event.reset();
  open_events_ = 0;
  pairs_.unmount();
  close_.clear();
  far_mm_ = -1;
}

/// Why it does not look any more, once.
void MachineChecks::give_up(const std::string& why) {
  given_up_ = true;
  Finding finding;
  finding.id = FindingId::kMachineCollision;
  finding.severity = Severity::kNote;
  finding.text = trf("collisions of the machine are not looked for: {}", why);
  log_.add(std::move(finding));
}

/// From the tip to the nose. If not, that is told.
bool MachineChecks::knows_length(const Motion& m) {
  const bool is_empty = m.tool == 0 && !pairs_.has_tool();
  if (m.tool_offset_mm != Vec3(0.0) || pairs_.tool_mm() > 0 || is_empty) return true;
  if (std::ranges::find(told_tools_, m.tool) != told_tools_.end()) return false;
  told_tools_.push_back(m.tool);
  Finding finding;
  finding.id = FindingId::kMachineCollision;
  finding.severity = Severity::kNote;
  finding.source = m.source;
  finding.tool = m.tool;
  finding.text = trf(
      "nobody says how long tool {} is: while it is in the spindle, collisions of the machine are "
      "not looked for",
      m.tool);
  finding.hint =
      tr("G43 with a tool table, or the shape of its holder: --tool N=..:holder=er20:stickout=40");
  log_.add(std::move(finding));
  return false;
}

/// The machine on this motion. False: nobody knows where it stands.
bool MachineChecks::prepare(const Motion& m) {
  if (given_up_ || !runs_ || !is_move(m)) return false;
  if (m.to_machine_place || m.unknown_to != 0 || !is_within_reach(m)) return false;
  if (!runs_->knows(m)) {
    give_up(trf("of {} it is not known where its joints stand", runs_->path().machine().module));
    return false;
  }
  if (!knows_length(m)) return false;
  motion_ = &m;
  if (!m.start_known) {
    stands_ = m;
    stands_.kind = MotionKind::kTraverse;
    stands_.start_known = true;
    stands_.from_mm = m.to_mm;
    stands_.from_abc_deg = m.to_abc_deg;
    stands_.from_uvw_mm = m.to_uvw_mm;
    motion_ = &stands_;
  }
  if (pairs_.hang_tool(runs_->tip_from_nose(*motion_, pairs_.tool_mm()))) far_mm_ = -1;
  runs_->follow(*motion_, pairs_.tool_mm(), run_);
  return true;
}

void MachineChecks::check(const Motion& m, const TimedStep& step) {
  if (!active() || !prepare(m)) return;
  ++number_;
  step_ = &step;
  const bool is_quiet = open_events_ == 0 && is_far();
  if (is_quiet && close_.empty()) return;
  end_ = run_.axes_at(1);
  if (!is_quiet && !carries_the_tool(*motion_)) return;
  for (WorkingPair* pair : is_quiet ? close_ : pairs_.active()) look(*pair);
  if (!is_quiet && open_events_ > 0 && is_traverse(m)) end_events();
  if (!is_quiet) renew_far();
}

/// The links are another machine than the kinematics, if the tip is elsewhere: what would be told
/// of them is of no use.
bool MachineChecks::carries_the_tool(const Motion& m) {
  const Pose seen = program_from_link_ * tool_chain_.pose(end_);
  const Pose meant = moves_are_known_ ? runs_->path().pose_at(m, 1) : shift(m.to_mm);
  const Vec3 tip = seen.point(runs_->tip_from_nose(m, pairs_.tool_mm()));
  const Vec3& nose = runs_->path().machine().nose_from_tip;
  const double off_mm = glm::length(tip - meant.origin_mm);
  if (off_mm <= kSamePlace_mm &&
      glm::length(seen.direction(nose) - meant.direction(nose)) <= kSameDirection)
    return true;
  give_up(
      trf("in line {} its links have the tip of the tool {:.3g} mm from where the kinematics "
          "have it (machine.links, machine.kinematics)",
          m.source.line, off_mm));
  return false;
}

bool MachineChecks::is_far() const {
  if (far_mm_ < 0) return false;
  const AxisSpan& span = run_.span();
  double way = 0;
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    if (far_weight_[i] == 0) continue;
    way += far_weight_[i] * std::max(span.high[i] - far_at_[i], far_at_[i] - span.low[i]);
  }
  return way < far_mm_;
}

/// Which pairs are so far apart that they need not be looked at one by one, and how long.
void MachineChecks::renew_far() {
  close_.clear();
  far_at_ = end_;
  far_weight_ = {};
  far_mm_ = kMostFar_mm;
  const AxisSpan here{end_, end_};
  for (WorkingPair* pair : pairs_.active()) {
    if (pair->dead) continue;
    const WorkingBody& body = pairs_.bodies()[pair->moving];
    const Vec3& middle = body.link_from_body.origin_mm;
    const double since = most_way_mm(pair->chain, pair->seen_at, here, middle, body.reach_mm);
    const double room = pair->spare_mm - since - counts_mm(*pair);
    if (pair->overlaps || room < kClose_mm) {
      close_.push_back(pair);
      continue;
    }
    far_mm_ = std::min(far_mm_, room);
    add_weights(pair->chain, end_, body.reach_mm, middle, far_weight_);
  }
}

LinkWay MachineChecks::way_of(const WorkingPair& pair) const {
  return {run_, pair.chain, pairs_.bodies()[pair.still].link_from_body.inverse(),
          pairs_.bodies()[pair.moving].link_from_body};
}

bool MachineChecks::is_apart(WorkingPair& pair, double counts) const {
  if (pair.spare_mm < 0) return false;
  const WorkingBody& body = pairs_.bodies()[pair.moving];
  return pair.spare_mm - most_way_mm(pair.chain, pair.seen_at, run_.span(),
                                     body.link_from_body.origin_mm, body.reach_mm) >
         counts;
}

void MachineChecks::look(WorkingPair& pair) {
  if (pair.dead) return;
  const double counts = pair.with_workpiece ? 0 : counts_mm(pair);
  if (pair.stood && !pair.overlaps && is_apart(pair, counts)) return;
  const LinkWay way = way_of(pair);
  if (!pair.stood) stand(pair, way);
  if (pair.dead) return;
  pair.seen_at = end_;
  pair.spare_mm = gap(pair, way.pose(1), std::numeric_limits<double>::infinity());
  if (pair.overlaps) {
    pair.overlaps = pair.spare_mm <= kContactTolerance_mm;
    return;
  }
  if (is_apart(pair, counts)) return;
  if (pair.event && !is_traverse(*motion_)) {
    // It goes on: all that may be new is that it goes deeper.
    deepen(pair, way);
    return;
  }
  pair.with_workpiece ? look_at_workpiece(pair, way) : look_near(pair, way);
}

/// Where the machine first stands with this pair: what overlaps there was drawn so, or has been set
/// up so, and is no news on each motion.
void MachineChecks::stand(WorkingPair& pair, const LinkWay& way) {
  pair.stood = true;
  const WorkingBody& moving = pairs_.bodies()[pair.moving];
  const WorkingBody& still = pairs_.bodies()[pair.still];
  const Pose pose = way.pose(0);
  bool overlaps = false;
  if (pair.with_workpiece) {
    for (const SolidPointer& solid : moving.solids) {
      const double box_mm = gap_at(*solid, pose, *still.solids[0], WorkpieceSurface::kFarthest_mm);
      overlaps = overlaps || (box_mm <= 0 &&
                              surface_.gap_at(*solid, pose, WorkpieceSurface::kFarthest_mm) <= 0);
    }
  } else {
    overlaps = gap(pair, pose, WorkpieceSurface::kFarthest_mm) <= 0;
    for (const SolidPointer& a : moving.solids)
      for (const SolidPointer& b : still.solids)
        overlaps = overlaps || encloses_any(*b, pose, *a) || encloses_any(*a, pose.inverse(), *b);
  }
  if (!overlaps) return;
  pair.dead = pair.of_links;
  pair.overlaps = !pair.dead;
  Finding finding = finding_of(pair, 0);
  finding.severity = Severity::kNote;
  finding.text =
      pair.dead
          ? trf("{} and {} overlap where the program starts: they are not held against each other",
                pair.sentence_a, pair.sentence_b)
          : trf("{} and {} overlap where the program starts, or where the tool is taken: they are "
                "not held against each other until they are apart",
                pair.sentence_a, pair.sentence_b);
  finding.hint = tr("machine.ignore: [[a, b]] names pairs that may touch");
  log_.add(std::move(finding));
}

/// How far apart they are there; of the workpiece the box of its blank counts.
double MachineChecks::gap(const WorkingPair& pair, const Pose& pose, double cutoff_mm) {
  double least = cutoff_mm;
  for (const SolidPointer& moving : pairs_.bodies()[pair.moving].solids)
    for (const SolidPointer& still : pairs_.bodies()[pair.still].solids)
      least = gap_at(*moving, pose, *still, least);
  return least;
}

void MachineChecks::look_near(WorkingPair& pair, const LinkWay& way) {
  const double counts = counts_mm(pair);
  if (pair.least_mm > 0) {
    std::optional<LeastGap> least;
    double below = std::max(counts, kTouchGap_mm);
    for (const SolidPointer& moving : pairs_.bodies()[pair.moving].solids) {
      for (const SolidPointer& still : pairs_.bodies()[pair.still].solids) {
        const auto near = least_gap(*moving, way, *still, below);
        if (!near) continue;
        least = near;
        below = near->mm;
      }
    }
    if (!least) return;
    if (least->mm < counts) note_least(pair, *least);
    if (least->mm > kTouchGap_mm) return;
  }
  // What grazes has gone a long way before it is as deep as a contact must be.
  if (const auto t = touch(pair, way, kContactTolerance_mm))
    meet(pair, way, pair.event ? *t : touch(pair, way, kContactRounding_mm).value_or(*t));
}

/// Deeper than so much.
std::optional<double> MachineChecks::touch(const WorkingPair& pair, const LinkWay& way,
                                           double thinner_mm) {
  std::optional<double> first;
  for (const SolidPointer& moving : pairs_.bodies()[pair.moving].solids) {
    for (const SolidPointer& still : pairs_.bodies()[pair.still].solids) {
      const auto t = first_touch(*moving, way, *still, thinner_mm);
      if (t && (!first || *t < *first)) first = t;
    }
  }
  return first;
}

/// The blank's box is touched: is there anything of the workpiece?
void MachineChecks::look_at_workpiece(WorkingPair& pair, const LinkWay& way) {
  const std::vector<SolidPointer>& solids = pairs_.bodies()[pair.moving].solids;
  if (!touch(pair, way, kContactTolerance_mm)) return;
  const auto first_by = [&](double thinner_mm) {
    std::optional<double> first;
    for (const SolidPointer& moving : solids) {
      const auto t = surface_.first_touch(*moving, way, thinner_mm);
      if (t && (!first || *t < *first)) first = t;
    }
    return first;
  };
  if (const auto first = first_by(kContactTolerance_mm)) {
    meet(pair, way, pair.event ? *first : first_by(kContactRounding_mm).value_or(*first));
    return;
  }
  pair.spare_mm = WorkpieceSurface::kFarthest_mm;
  for (const SolidPointer& moving : solids)
    pair.spare_mm = surface_.gap_at(*moving, way.pose(1), pair.spare_mm);
}

Finding MachineChecks::finding_of(const WorkingPair& pair, double t) const {
  Finding finding;
  finding.id = pair.id;
  finding.source = motion_->source;
  finding.time_s = step_->time_at(t);
  finding.position_mm =
      moves_are_known_ ? runs_->path().pose_at(*motion_, t).origin_mm : point_at(*motion_, t);
  const CollisionPair& row = pair.row;
  if (row.first.empty()) finding.tool = row.tool;
  finding.bodies = {row.first.empty() ? to_string(row.part) : row.first,
                    row.other.empty() ? kWorkpieceBody : row.other};
  return finding;
}

void MachineChecks::note_least(WorkingPair& pair, const LeastGap& gap) {
  pair.least_mm = gap.mm;
  pair.row.source = motion_->source;
  if (gap.mm < pair.near_mm) pair.nearest = finding_of(pair, gap.t);
}

void MachineChecks::meet(WorkingPair& pair, const LinkWay& way, double t) {
  pair.touched_in = number_;
  if (!pair.event) {
    Finding finding = finding_of(pair, t);
    finding.text = trf("{} touches {}", pair.sentence_a, pair.sentence_b);
    finding.severity = Severity::kError;
    const auto doubt = [&](bool is_one, const char* text) {
      if (!is_one) return;
      finding.severity = Severity::kWarning;
      finding.text += text;
    };
    doubt(wishes_.machine->guessed, tr(" (the machine's shape is a guess)"));
    doubt(pair.guessed_tool, tr(" (of a guessed tool)"));
    doubt(pair.with_workpiece && blank_guessed_, tr(" (of a guessed blank)"));
    if (!pairs_.knows_depth(pair)) finding.text += tr(" (how deep is not measured)");
    pair.event = log_.add(std::move(finding));
    ++open_events_;
    pair.depth_mm = 0;
    if (pair.row.contacts++ == 0) pair.row.source = motion_->source;
  }
  pair.least_mm = 0;
  deepen(pair, way);
}

void MachineChecks::deepen(WorkingPair& pair, const LinkWay& way) {
  const double known = pair.depth_mm;
  const bool has_depth = pairs_.bodies()[pair.moving].has_depth;
  if (pair.with_workpiece && !has_depth) return;
  for (const SolidPointer& moving : pairs_.bodies()[pair.moving].solids) {
    if (pair.with_workpiece) {
      pair.depth_mm = surface_.touch_depth_mm(*moving, way, pair.depth_mm);
      continue;
    }
    for (const SolidPointer& still : pairs_.bodies()[pair.still].solids) {
      if (has_depth) pair.depth_mm = touch_depth_mm(*moving, way, *still, pair.depth_mm);
      pair.depth_mm = mesh_depth_mm(*moving, way, *still, pair.depth_mm);
    }
  }
  if (pair.depth_mm > known) log_.deepen(*pair.event, pair.depth_mm);
}

/// After a traverse.
void MachineChecks::end_events() {
  for (WorkingPair* pair : pairs_.active()) {
    if (!pair->event || pair->touched_in == number_) continue;
    pair->event.reset();
    --open_events_;
  }
}

void MachineChecks::forget() {
  for (const auto& pair : pairs_.all()) {
    pair->event.reset();
    pair->row.contacts = 0;
    pair->least_mm = std::numeric_limits<double>::infinity();
    pair->row.source = {};
  }
  open_events_ = 0;
  far_mm_ = -1;
}

void MachineChecks::finish() {
  for (const auto& pair : pairs_.all()) {
    if (pair->row.contacts > 0 || pair->least_mm >= pair->near_mm) continue;
    Finding near = pair->nearest;
    near.id = FindingId::kNearMiss;
    near.severity = Severity::kNote;
    near.text = trf("{} comes as near as {:.2f} mm to {}", pair->sentence_a, pair->least_mm,
                    pair->sentence_b);
    log_.add(std::move(near));
  }
}

std::vector<CollisionPair> MachineChecks::table() const {
  std::vector<CollisionPair> out;
  for (const auto& pair : pairs_.all()) {
    if (!pair->stood || pair->dead) continue;
    out.push_back(pair->row);
    if (std::isfinite(pair->least_mm)) {
      out.back().least_clearance_mm = pair->least_mm;
    } else if (!pair->with_workpiece) {
      out.back().clearance_above_mm = std::max(kFollowed_mm, pair->near_mm);
    }
  }
  return out;
}

}  // namespace kerf
