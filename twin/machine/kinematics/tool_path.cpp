#include "twin/machine/kinematics/tool_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/machine/kinematics/arc_bounds.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Columns of a rotation may be off by rounding, no more.
constexpr double kOrthonormal = 1e-9;
/// Coordinates of a metre carry rounding of this order.
constexpr double kStill_mm = 1e-9;
/// The spindle of one move turns by less: near half a turn the great circle is not defined.
constexpr double kMostTilt_rad = 2.5;
/// No piece is shorter, in t: 1000 turns to 5 um at 100 mm need 1e6 of them.
constexpr double kLeastPiece = 1e-8;
/// Motions of fewer turns are as they are.
constexpr double kFewTurns = 4;
/// Inputs of a chain behind its slides X Y Z: A B C, and U V W from kFirstSlide on.
constexpr std::size_t kFirstTurn = 3;
constexpr std::size_t kFirstSlide = 6;

double angle_between(const Vec3& a, const Vec3& b) {
  return portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Second derivative of point_at() in t.
Vec3 arc_acceleration(const Motion& m, double t) {
  const Vec3 p = point_at(m, t) - m.arc.center_mm;
  const Vec3 out = p - glm::dot(p, m.arc.axis) * m.arc.axis;
  const Vec3 d0 = m.from_mm - m.arc.center_mm;
  const Vec3 d1 = m.to_mm - m.arc.center_mm;
  const double r0 = glm::length(d0 - glm::dot(d0, m.arc.axis) * m.arc.axis);
  const double r1 = glm::length(d1 - glm::dot(d1, m.arc.axis) * m.arc.axis);
  const double radius = glm::length(out);
  const double sweep = m.arc.sweep_rad;
  if (radius <= 0) return Vec3(0.0);
  const Vec3 around = glm::cross(m.arc.axis, out) / radius;
  return -sweep * sweep * out + 2 * (r1 - r0) * sweep * around;
}

Vec3 arc_velocity(const Motion& m, double t) {
  const Vec3 p = point_at(m, t) - m.arc.center_mm;
  const Vec3 out = p - glm::dot(p, m.arc.axis) * m.arc.axis;
  const Vec3 d0 = m.from_mm - m.arc.center_mm;
  const Vec3 d1 = m.to_mm - m.arc.center_mm;
  const double along0 = glm::dot(d0, m.arc.axis);
  const double along1 = glm::dot(d1, m.arc.axis);
  const double growth =
      glm::length(d1 - along1 * m.arc.axis) - glm::length(d0 - along0 * m.arc.axis);
  const double radius = glm::length(out);
  const Vec3 outward = radius > 0 ? out / radius : Vec3(0.0);
  return m.arc.sweep_rad * glm::cross(m.arc.axis, out) + growth * outward +
         (along1 - along0) * m.arc.axis;
}

/// Where X Y Z go in the place of U V W: in the frame that the step has there, against it.
ToolChain::Step in_place_of(const ToolChain::Step& slide) {
  return {slide.kind, slide.input, -slide.vector};
}

bool is_uvw(const ToolChain::Step& step) {
  return step.kind == ToolChain::Kind::kSlide && step.input >= kFirstSlide;
}

/// Missing slides (a lathe has no Y) are filled in; false if the rest is not at right angles.
bool complete_rotation(glm::dmat3& r) {
  for (int i = 0; i < 3; ++i) {
    if (glm::length(r[i]) < kOrthonormal) r[i] = glm::cross(r[(i + 1) % 3], r[(i + 2) % 3]);
  }
  const glm::dmat3 gram = glm::transpose(r) * r;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(gram[i][k] - (i == k ? 1.0 : 0.0)) < kOrthonormal)) return false;
    }
  }
  return glm::determinant(r) > 0;
}

}  // namespace

/// The motion as inputs of a track's chain.
struct ToolPath::Run {
  const Track* track = nullptr;
  const Motion* motion = nullptr;
  ToolChain chain;          ///< of the track, with the tool of this motion
  Vec3 end_mm{0};           ///< tip in the chain's last frame
  Vec3 axis{0, 0, 1};       ///< spindle in it, before last_turn
  Vec3 shift_mm{0};         ///< of the slides
  AxisValues from{}, to{};  ///< inputs, but for those of X Y Z
  InputBounds bounds;
  bool bends = false;        ///< the tip's way is another one than the motion's
  bool single_turn = false;  ///< one joint of them all

  Vec3 slides_at(double t) const {
    const Vec3 tip = t <= 0 ? motion->from_mm : t >= 1 ? motion->to_mm : point_at(*motion, t);
    return track->slides * tip + shift_mm;
  }

  AxisValues inputs_at(double t) const {
    AxisValues out{};
    for (std::size_t i = kFirstTurn; i < kAxisCount; ++i) {
      out[i] = t >= 1 ? to[i] : from[i] + t * (to[i] - from[i]);
    }
    const Vec3 slides = slides_at(t);
    for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(i)] = slides[i];
    return out;
  }

  InputJet jet_at(double t) const {
    InputJet jet;
    jet.value = inputs_at(t);
    const Motion& m = *motion;
    const Vec3 rate = track->slides * (is_arc(m) ? arc_velocity(m, t) : m.to_mm - m.from_mm);
    const Vec3 bend = is_arc(m) ? track->slides * arc_acceleration(m, t) : Vec3(0.0);
    for (int i = 0; i < 3; ++i) {
      jet.rate[static_cast<std::size_t>(i)] = rate[i];
      jet.acceleration[static_cast<std::size_t>(i)] = bend[i];
    }
    for (std::size_t i = kFirstTurn; i < kAxisCount; ++i) jet.rate[i] = to[i] - from[i];
    return jet;
  }

  Pose pose_at(double t) const {
    Pose pose = chain.pose(inputs_at(t));
    pose.origin_mm = pose.point(end_mm);
    pose.rotation = pose.rotation * track->last_turn;
    return track->workpiece_from_chain * pose;
  }
  Vec3 axis_of(const Pose& pose) const { return pose.direction(axis); }
};

/// A tip and a spindle: one end of a move.
struct ToolPath::End {
  Vec3 tip_mm{0};
  Vec3 axis{0, 0, 1};
};

ToolPathTolerance ToolPathTolerance::of_cell(double cell_mm) {
  constexpr double kMost_mm = 0.01;
  const double least = std::min(cell_mm / 10, kMost_mm);
  return {least, least, cell_mm / 5};
}

Result<ToolPath> ToolPath::create(MachineKinematics machine, const WorkpieceFrame& frame,
                                  const ToolPathTolerance& tolerance) {
  ToolPath path;
  path.machine_ = std::move(machine);
  path.frame_ = frame;
  path.tolerance_ = tolerance;
  path.machine_from_workpiece_ = kerf::machine_from_workpiece(frame);
  Result<Pose> placed = path.place_workpiece();
  if (!placed) return Error{placed.error()};
  path.link_from_workpiece_ = placed.value();
  for (const KinematicsType& type : path.machine_.types) {
    path.tracks_.push_back(path.track_of(type));
    for (const ToolChain::Step& step : path.tracks_.back().chain.steps()) {
      const bool turns = step.kind == ToolChain::Kind::kTurn && is_rotary_axis(step.input);
      if (turns) path.tracks_.back().turned_by[step.input - kFirstTurn] = true;
      if (is_uvw(step)) path.tracks_.back().slid_by[step.input - kFirstSlide] = true;
    }
    path.tracks_.back().upright_at_zero = path.is_upright_at_zero(path.tracks_.back());
  }
  return path;
}

/// By how far the tool is aside of X Y Z where the program's A, B, C, U, V, W are 0.
Vec3 ToolPath::shift_of_offset() const {
  Pose at;
  if (!machine_.uvw_by_xyz || frame_.offset_uvw_mm == Vec3(0.0)) return at.origin_mm;
  const ToolChain whole(machine_.chain, machine_.joint_letters);
  for (const ToolChain::Step& step : whole.steps()) {
    if (is_uvw(step)) {
      const double offset_mm = frame_.offset_uvw_mm[static_cast<int>(step.input - kFirstSlide)];
      at.origin_mm += at.direction(in_place_of(step).vector) * offset_mm;
    } else if (step.kind == ToolChain::Kind::kTurn) {
      at = at * turn(step.vector, frame_.offset_abc_deg[step.input - kFirstTurn]);
    }
  }
  return at.origin_mm;
}

/// Where the program's frame lies on the workpiece link when the program's A, B, C, U, V, W are 0.
Result<Pose> ToolPath::place_workpiece() {
  const KinematicsType& type = machine_.type(0);
  if (type.mode != KinematicsMode::kAxes) return shift(shift_of_offset()) * machine_from_workpiece_;
  MachinePosition position;
  const auto place = [&](const Vec3& program) {
    AxisValues axes{program.x,
                    program.y,
                    program.z,
                    frame_.offset_abc_deg[0],
                    frame_.offset_abc_deg[1],
                    frame_.offset_abc_deg[2],
                    frame_.offset_uvw_mm.x,
                    frame_.offset_uvw_mm.y,
                    frame_.offset_uvw_mm.z};
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      position.axes[i] = type.sign[i] * axes[type.source[i]];
    }
    position.joints = joints_of(position.axes, machine_.joint_letters);
    return machine_.chain.workpiece_from_tool(position).origin_mm;
  };
  Pose link_from_program;
  link_from_program.origin_mm = place(Vec3(0.0));
  for (int i = 0; i < 3; ++i) {
    Vec3 one(0.0);
    one[i] = 1.0;
    link_from_program.rotation[i] = place(one) - link_from_program.origin_mm;
  }
  if (!complete_rotation(link_from_program.rotation)) {
    return Error{tr(
        "the machine's X, Y and Z are not at right angles (right-handed): the program's frame has "
        "no place on it")};
  }
  return link_from_program * machine_from_workpiece_;
}

ToolPath::Track ToolPath::track_of(const KinematicsType& type) const {
  Track track;
  if (type.mode == KinematicsMode::kAxes) {
    track.chain = ToolChain(machine_.chain, machine_.joint_letters);
    if (machine_.uvw_by_xyz) std::erase_if(track.chain.steps(), is_uvw);
    glm::dmat3 order(0.0);
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      order[type.source[axis]][i] = type.sign[axis];
    }
    track.slides = order * machine_from_workpiece_.rotation;
    track.shift_mm = order * machine_from_workpiece_.origin_mm;
    track.workpiece_from_chain = link_from_workpiece_.inverse();
    return track;
  }
  // X Y Z are the tip in the workpiece frame, whatever turns; only directions are left of the
  // chain.
  const glm::dmat3 work_from_machine = glm::transpose(machine_from_workpiece_.rotation);
  std::vector<ToolChain::Step> steps;
  using Kind = ToolChain::Kind;
  for (std::uint8_t i = 0; i < 3; ++i) {
    Vec3 along(0.0);
    along[i] = 1.0;
    steps.push_back({Kind::kSlide, i, along});
  }
  track.offset_step = steps.size();
  steps.push_back({Kind::kShift, 0, Vec3(0.0)});
  if (type.mode == KinematicsMode::kArm) {
    for (const char letter : machine_.arm_turns) {
      Vec3 about(0.0);
      about[letter - 'A'] = 1.0;
      steps.push_back(
          {Kind::kTurn, static_cast<std::uint8_t>(3 + letter - 'A'), work_from_machine * about});
    }
  } else {
    const ToolChain whole(machine_.chain, machine_.joint_letters);
    for (const ToolChain::Step& step : whole.steps()) {
      const bool slides = machine_.uvw_by_xyz && is_uvw(step);
      if (step.kind != Kind::kTurn && !slides) continue;
      const Vec3 vector = slides ? in_place_of(step).vector : step.vector;
      steps.push_back({step.kind, step.input, work_from_machine * vector});
    }
  }
  track.chain = ToolChain(std::move(steps));
  track.last_turn = work_from_machine;
  if (link_from_workpiece_.rotation != machine_from_workpiece_.rotation ||
      link_from_workpiece_.origin_mm != machine_from_workpiece_.origin_mm) {
    track.workpiece_from_chain = link_from_workpiece_.inverse() * machine_from_workpiece_;
  }
  return track;
}

/// With the program's A, B, C, U, V, W at 0: is the tip where the program says, and the spindle
/// upright?
bool ToolPath::is_upright_at_zero(const Track& track) const {
  Motion probe;
  probe.from_mm = probe.to_mm = {17.0, -29.0, 41.0};
  probe.tool_offset_mm = {3.0, 5.0, 67.0};
  if (machine_.is_switchable()) {
    probe.torch.analog[machine_.switch_output] = static_cast<float>(&track - tracks_.data());
  }
  const Run run = run_of(probe);
  const Pose pose = run.pose_at(0);
  return glm::length(pose.origin_mm - probe.from_mm) < kStill_mm &&
         glm::length(run.axis_of(pose) - Vec3(0.0, 0.0, 1.0)) < kOrthonormal;
}

const ToolPath::Track& ToolPath::track(const Motion& motion) const {
  return tracks_[static_cast<std::size_t>(machine_.type_of(motion))];
}

ToolPath::Run ToolPath::run_of(const Motion& motion) const {
  Run run;
  run.track = &track(motion);
  run.motion = &motion;
  run.chain = run.track->chain;
  run.shift_mm = run.track->shift_mm;
  const KinematicsType& type = machine_.type(machine_.type_of(motion));
  const Vec3 tool = motion.tool_offset_mm;
  run.axis = machine_.nose_from_tip;
  switch (type.mode) {
    case KinematicsMode::kAxes: {
      // The tool hangs in the last frame; the slides carry its length as an offset.
      Vec3 with_tool(0.0);
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        with_tool[i] = type.sign[axis] * tool[type.source[axis]];
      }
      run.shift_mm += with_tool;
      run.end_mm = -with_tool;
      break;
    }
    case KinematicsMode::kTip: {
      const Vec3 untold = tool - machine_.told_tool(tool.z) * machine_.nose_from_tip;
      const glm::dmat3& back = run.track->last_turn;
      run.chain.steps()[run.track->offset_step].vector = back * untold;
      run.end_mm = -(back * untold);
      break;
    }
    case KinematicsMode::kArm: {
      const glm::dmat3& back = run.track->last_turn;
      run.chain.steps()[run.track->offset_step].vector = back * tool;
      run.end_mm = -(back * Vec3(tool.x, tool.y, tool.z * machine_.nose_from_tip.z));
      break;
    }
  }
  bool slides = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    run.from[kFirstTurn + i] = motion.from_abc_deg[i] + frame_.offset_abc_deg[i];
    run.to[kFirstTurn + i] = motion.to_abc_deg[i] + frame_.offset_abc_deg[i];
    run.from[kFirstSlide + i] = motion.from_uvw_mm[axis] + frame_.offset_uvw_mm[axis];
    run.to[kFirstSlide + i] = motion.to_uvw_mm[axis] + frame_.offset_uvw_mm[axis];
    slides |= run.track->slid_by[i] && motion.from_uvw_mm[axis] != motion.to_uvw_mm[axis];
  }
  AxisValues rate{};
  for (std::size_t i = kFirstTurn; i < kAxisCount; ++i) rate[i] = run.to[i] - run.from[i];
  // Those of an arm in joint mode are turned by X, Y and Z.
  const Vec3 way = run.track->slides * (motion.to_mm - motion.from_mm);
  for (int i = 0; i < 3; ++i) rate[static_cast<std::size_t>(i)] = is_arc(motion) ? 1 : way[i];
  const int turning = run.chain.turning_steps(rate);
  run.bends = turning > 0 || (slides && is_arc(motion));
  run.single_turn = turning == 1;
  if (!run.bends) return run;
  for (std::size_t i = kFirstTurn; i < kAxisCount; ++i) run.bounds.rate[i] = std::abs(rate[i]);
  if (is_arc(motion)) {
    const ArcBounds arc = arc_bounds(motion);
    for (std::size_t i = 0; i < 3; ++i) {
      run.bounds.rate[i] = arc.speed;
      run.bounds.acceleration[i] = arc.acceleration;
      run.bounds.jerk[i] = arc.jerk;
    }
  } else {
    for (int i = 0; i < 3; ++i) run.bounds.rate[static_cast<std::size_t>(i)] = std::abs(way[i]);
  }
  return run;
}

ToolPath::End ToolPath::end_of(const Run& run, double t) {
  const Pose pose = run.pose_at(t);
  return {pose.origin_mm, glm::normalize(run.axis_of(pose))};
}

bool ToolPath::is_upright(const Motion& motion) const {
  const Track& now = track(motion);
  for (int i = 0; i < 3; ++i) {
    if (!now.slid_by[static_cast<std::size_t>(i)]) continue;
    if (motion.to_uvw_mm[i] != 0 || motion.from_uvw_mm[i] != 0) return false;
  }
  return stays_upright(motion);
}

bool ToolPath::stays_upright(const Motion& motion) const {
  const Track& now = track(motion);
  if (!now.upright_at_zero) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!now.turned_by[i]) continue;
    if (motion.to_abc_deg[i] != 0 || motion.from_abc_deg[i] != 0) return false;
  }
  return true;
}

/// Nothing bends the way: the whole motion is one move, somewhere else.
void ToolPath::rigid_move(const Run& run, const Motion& motion, CutMove& move) const {
  const End from = end_of(run, 0);
  const End to = end_of(run, 1);
  move.from_mm = from.tip_mm;
  move.to_mm = to.tip_mm;
  move.axis_from = move.axis_to = from.axis;
  if (!is_arc(motion)) return;
  // As if the program went to the middle of the arc, and along its axis from there.
  Motion spoke = motion;
  spoke.kind = MotionKind::kFeed;
  spoke.from_mm = motion.arc.center_mm;
  spoke.to_mm = motion.arc.center_mm + motion.arc.axis;
  const Run spokes = run_of(spoke);
  const Vec3 center = spokes.pose_at(0).origin_mm;
  const Vec3 axis = glm::normalize(spokes.pose_at(1).origin_mm - center);
  move.arc = CutArc{center, axis, motion.arc.sweep_rad};
}

/// How far the piece [t, t + h] may be from the path, as a multiple of the tolerance.
///
/// With p the path, its chord is off by h^2 / 8 max |p''| at most. With n the spindle and s the
/// even turn between its ends by the angle a, e = n - s vanishes at both ends and e'' = n'' + a^2
/// s, so that |e| <= (max |h^2 n'' + a^2 n| + a^2 max |e|) / 8: nothing where n goes along a great
/// circle itself.
double ToolPath::error_of(const Run& run, double t, double h, const End& from, const End& to,
                          double reach_mm) const {
  const double angle = angle_between(from.axis, to.axis);
  if (angle > kMostTilt_rad) return (angle / kMostTilt_rad) * (angle / kMostTilt_rad) * 4;
  const InputJet inputs = run.jet_at(t + h / 2);
  const PoseJet jet = run.chain.jet(inputs, run.end_mm);
  const PathBounds bounds = run.chain.bounds(inputs.value, run.bounds, h, run.end_mm);
  const double most =
      std::min(glm::length(jet.acceleration_mm) + h / 2 * bounds.jerk_mm, bounds.acceleration_mm);
  const double tip = h * h * most / 8;

  const Vec3 spindle = run.track->last_turn * run.axis;
  const Vec3 n = jet.pose.direction(spindle);
  const double angle2 = angle * angle;
  double bend = 0;
  if (run.single_turn) {
    // A circle about a fixed line: r across it, z along it.
    const double w = glm::length(jet.turning) * h;
    const double z = glm::dot(n, glm::normalize(jet.turning));
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    bend = portable::hypot((angle2 - w * w) * r, angle2 * z);
  } else {
    const double w = bounds.turning_rad * h;
    bend = glm::length(h * h * jet.bend(spindle) + angle2 * n) + (w * w * w + angle2 * w) / 2;
  }
  const double top = tip + reach_mm * bend / (8 - angle2);
  return std::max(tip / tolerance_.tip_mm, top / tolerance_.top_mm);
}

bool ToolPath::moves_of(const Motion& motion, double reach_mm, std::uint64_t id,
                        std::vector<CutMove>& out, std::vector<double>* ends) const {
  const std::size_t before = out.size(), ends_before = ends != nullptr ? ends->size() : 0;
  // False: there are too many.
  const auto add = [&](const CutMove& move, double end) {
    out.push_back(move);
    if (ends != nullptr) ends->push_back(end);
    return out.size() - before <= kMostPieces;
  };
  if (!motion.start_known || !is_move(motion)) return true;
  if (is_upright(motion)) return add(cut_move_from(motion, id), 1);
  const Run run = run_of(motion);
  if (!run.bends) {
    CutMove move;
    move.id = id;
    rigid_move(run, motion, move);
    return add(move, 1);
  }
  const Kept kept = kept_turns(run, reach_mm);
  End from = end_of(run, 0);
  bool all = !kept.parts.empty() || divide(run, 0, 1, reach_mm, id, from, add);
  for (std::size_t n = 0; all && n < kept.parts.size(); ++n) {
    const bool last = n + 1 == kept.parts.size();
    const double begin = kept.parts[n].first / kept.turns;
    if (n > 0) {
      const End to = end_of(run, begin);
      all = add(move_of(from, to, id), begin);
      from = to;
    }
    all = all && divide(run, begin, last ? 1.0 : kept.parts[n].second / kept.turns, reach_mm, id,
                        from, add);
  }
  if (all) return true;
  out.resize(before);
  if (ends != nullptr) ends->resize(ends_before);
  return false;
}

CutMove ToolPath::move_of(const End& from, const End& to, std::uint64_t id) {
  CutMove move;
  move.from_mm = from.tip_mm;
  move.to_mm = to.tip_mm;
  move.axis_from = from.axis;
  move.axis_to = to.axis;
  move.id = id;
  return move;
}

/// From `from`, which is at `begin`, to `end`; `from` is there then. False: add() was, and it is
/// not.
template <class Add>
bool ToolPath::divide(const Run& run, double begin, double end, double reach_mm, std::uint64_t id,
                      End& from, const Add& add) const {
  double t = begin;
  double pieces = 1;  // that the rest is thought to need
  while (t < end) {
    End to;
    double h = 0;
    double error = 0;
    for (;;) {
      h = (end - t) / pieces;
      to = end_of(run, pieces == 1 ? end : t + h);
      error = error_of(run, t, h, from, to, reach_mm);
      if (error <= 1 || h <= kLeastPiece) break;
      pieces = std::ceil(pieces * std::max(1.1, 1.02 * std::sqrt(error)));
    }
    t = pieces == 1 ? end : t + h;
    if (!add(move_of(from, to, id), t)) return false;
    from = to;
    // Longer ones where the path has become straighter.
    const double longer = error > 0 ? std::min(2.0, 0.95 / std::sqrt(error)) : 2.0;
    pieces = std::max(1.0, std::ceil((end - t) / (h * std::max(1.0, longer)) - kStill_mm));
  }
  return true;
}

/// The turns of the axis that turns most: from one to the next only the other axes move the tool.
ToolPath::Kept ToolPath::kept_turns(const Run& run, double reach_mm) const {
  Kept kept;
  if (tolerance_.turn_mm <= 0) return kept;
  InputBounds others = run.bounds;
  std::size_t fastest = kFirstTurn;
  for (std::size_t i = kFirstTurn; i < kFirstSlide; ++i) {
    const bool turns = run.track->turned_by[i - kFirstTurn];
    if (!turns) others.rate[i] = 0;
    if (others.rate[i] > others.rate[fastest]) fastest = i;
  }
  kept.turns = others.rate[fastest] / 360;
  if (kept.turns < kFewTurns) return kept;
  others.rate[fastest] = 0;
  const PathBounds bounds = run.chain.bounds(run.inputs_at(0.5), others, 1, run.end_mm);
  const double pitch = (bounds.speed_mm + bounds.turning_rad * reach_mm) / kept.turns;
  const double whole = std::floor(kept.turns);
  const double stride =
      std::min(std::floor(2 * tolerance_.turn_mm / std::max(pitch, kStill_mm)), whole);
  if (stride < 2) return kept;
  const double count = std::ceil(whole / stride) + 1;
  if (count >= whole) return kept;
  for (double n = 0; n < count; ++n) {
    const double begin = n + std::floor(n * (whole - count) / (count - 1));
    kept.parts.emplace_back(begin, n + 1 == count ? kept.turns : begin + 1);
  }
  return kept;
}

Pose ToolPath::pose_at(const Motion& motion, double fraction) const {
  if (is_upright(motion)) {
    const Vec3 tip = motion.start_known && fraction < 1 ? point_at(motion, std::max(fraction, 0.0))
                                                        : motion.to_mm;
    return shift(tip);
  }
  return run_of(motion).pose_at(motion.start_known ? fraction : 1.0);
}

Vec3 ToolPath::spindle_at(const Motion& motion, double fraction) const {
  return pose_at(motion, fraction).direction(machine_.nose_from_tip);
}

AxisValues ToolPath::axes_at(const Motion& motion, double fraction) const {
  const double t = motion.start_known ? std::clamp(fraction, 0.0, 1.0) : 1.0;
  const Vec3 tip = t >= 1 ? motion.to_mm : point_at(motion, t);
  const Vec3 xyz = machine_from_workpiece_.point(tip) + motion.tool_offset_mm;
  AxisValues axes{xyz.x, xyz.y, xyz.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = motion.from_abc_deg[i];
    const double to = motion.to_abc_deg[i];
    axes[kFirstTurn + i] = (t >= 1 ? to : from + t * (to - from)) + frame_.offset_abc_deg[i];
  }
  const Vec3 uvw =
      t >= 1 ? motion.to_uvw_mm : motion.from_uvw_mm + t * (motion.to_uvw_mm - motion.from_uvw_mm);
  const Vec3 machine_uvw = uvw + frame_.offset_uvw_mm + motion.tool_offset_uvw_mm;
  for (int i = 0; i < 3; ++i) axes[kFirstSlide + static_cast<std::size_t>(i)] = machine_uvw[i];
  return axes;
}

std::optional<MachinePosition> ToolPath::machine_at(const Motion& motion, double fraction) const {
  return machine_.position_of(axes_at(motion, fraction), machine_.type_of(motion),
                              motion.tool_offset_mm.z);
}

void ToolPath::take_up(const Motion& before, Motion& next) const {
  const int type = machine_.type_of(next);
  if (machine_.type_of(before) == type || !next.start_known) return;
  const std::optional<MachinePosition> stands = machine_at(before, 1);
  if (!stands) return;
  const AxisValues axes = machine_.axes_of(stands->joints, type, before.tool_offset_mm.z);
  const Vec3 xyz = Vec3(axes[0], axes[1], axes[2]) - before.tool_offset_mm;
  const Vec3 tip = machine_from_workpiece_.inverse().point(xyz);
  // Where nothing is turned the numbers stay as they are, but for rounding.
  if (glm::length(tip - next.from_mm) > kStill_mm) next.from_mm = tip;
}

}  // namespace kerf
