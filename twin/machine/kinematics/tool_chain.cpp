#include "twin/machine/kinematics/tool_chain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/units.h"

namespace kerf {
namespace {

std::uint8_t input_of(const ChainLink& link, std::string_view joint_letters) {
  if (!link.by_joint || link.input >= joint_letters.size()) return link.input;
  const auto at = std::find(kAxisLetters.begin(), kAxisLetters.end(), joint_letters[link.input]);
  return at != kAxisLetters.end() ? static_cast<std::uint8_t>(at - kAxisLetters.begin())
                                  : link.input;
}

/// Links from the base down to `link`.
std::vector<std::size_t> branch(const KinematicChain& chain, std::size_t link) {
  std::vector<std::size_t> out{link};
  while (!chain.links()[out.back()].parent.empty()) {
    out.push_back(*chain.find(chain.links()[out.back()].parent));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

Vec3 PoseJet::bend(const Vec3& direction) const {
  const Vec3 n = pose.direction(direction);
  return glm::cross(turning_rate, n) + glm::cross(turning, glm::cross(turning, n));
}

ToolChain::ToolChain(const KinematicChain& chain, std::string_view joint_letters)
    : ToolChain(chain, joint_letters, chain.workpiece_link(), chain.tool_link()) {}

ToolChain::ToolChain(const KinematicChain& chain, std::string_view joint_letters,
                     std::size_t from_link, std::size_t to_link) {
  const std::vector<std::size_t> up = branch(chain, from_link);
  const std::vector<std::size_t> down = branch(chain, to_link);
  // What both hang on does not matter.
  std::size_t common = 0;
  while (common < up.size() && common < down.size() && up[common] == down[common]) ++common;
  const auto add = [&](Kind kind, std::uint8_t input, const Vec3& vector) {
    if (kind == Kind::kShift && vector == Vec3(0.0)) return;
    steps_.push_back({kind, input, vector});
  };
  for (std::size_t i = up.size(); i-- > common;) {
    const ChainLink& link = chain.links()[up[i]];
    const std::uint8_t input = input_of(link, joint_letters);
    if (link.joint == JointKind::kRotary) add(Kind::kTurn, input, -link.direction);
    if (link.joint == JointKind::kPrismatic) add(Kind::kSlide, input, -link.direction);
    add(Kind::kShift, 0, -link.origin_mm);
  }
  for (std::size_t i = common; i < down.size(); ++i) {
    const ChainLink& link = chain.links()[down[i]];
    const std::uint8_t input = input_of(link, joint_letters);
    add(Kind::kShift, 0, link.origin_mm);
    if (link.joint == JointKind::kRotary) add(Kind::kTurn, input, link.direction);
    if (link.joint == JointKind::kPrismatic) add(Kind::kSlide, input, link.direction);
  }
}

int ToolChain::turning_steps(const AxisValues& rate) const {
  return static_cast<int>(std::count_if(steps_.begin(), steps_.end(), [&](const Step& step) {
    return step.kind == Kind::kTurn && rate[step.input] != 0;
  }));
}

Pose ToolChain::pose(const AxisValues& inputs) const {
  Pose at;
  for (const Step& step : steps_) {
    switch (step.kind) {
      case Kind::kShift:
        at.origin_mm += at.direction(step.vector);
        break;
      case Kind::kSlide:
        at.origin_mm += at.direction(step.vector) * inputs[step.input];
        break;
      case Kind::kTurn:
        at.rotation = at.rotation * turn(step.vector, inputs[step.input]).rotation;
        break;
    }
  }
  return at;
}

PoseJet ToolChain::jet(const InputJet& inputs, const Vec3& end_mm) const {
  PoseJet at;
  // The origin moves on by r, which changes in the turning frame by r1, r2 per t and t^2.
  const auto move = [&](const Vec3& r, const Vec3& r1, const Vec3& r2) {
    at.pose.origin_mm += r;
    at.velocity_mm += glm::cross(at.turning, r) + r1;
    at.acceleration_mm += glm::cross(at.turning_rate, r) +
                          glm::cross(at.turning, glm::cross(at.turning, r)) +
                          2.0 * glm::cross(at.turning, r1) + r2;
  };
  for (const Step& step : steps_) {
    const Vec3 along = at.pose.direction(step.vector);
    const double value = inputs.value[step.input];
    const double rate = inputs.rate[step.input];
    const double acceleration = inputs.acceleration[step.input];
    switch (step.kind) {
      case Kind::kShift:
        move(along, Vec3(0.0), Vec3(0.0));
        break;
      case Kind::kSlide:
        move(along * value, along * rate, along * acceleration);
        break;
      case Kind::kTurn: {
        const Vec3 turned = along * (rate * kRadPerDeg);
        at.turning_rate += glm::cross(at.turning, turned) + along * (acceleration * kRadPerDeg);
        at.turning += turned;
        at.pose.rotation = at.pose.rotation * turn(step.vector, value).rotation;
        break;
      }
    }
  }
  move(at.pose.direction(end_mm), Vec3(0.0), Vec3(0.0));
  return at;
}

PathBounds ToolChain::bounds(const AxisValues& middle, const InputBounds& inputs, double h,
                             const Vec3& end_mm, double around_mm) const {
  PathBounds out;
  // Of the point as seen from the frame reached so far, going from the tool to the workpiece.
  double b0 = around_mm, b1 = 0, b2 = 0, b3 = 0;
  Vec3 level = end_mm;  // sum of what lies between two turns, at the middle
  const auto close_level = [&] {
    b0 += glm::length(level);
    level = Vec3(0.0);
  };
  for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
    const double rate = inputs.rate[step->input];
    switch (step->kind) {
      case Kind::kShift:
        level += step->vector;
        break;
      case Kind::kSlide:
        level += step->vector * middle[step->input];
        b0 += rate * h / 2;
        b1 += rate;
        b2 += inputs.acceleration[step->input];
        b3 += inputs.jerk[step->input];
        break;
      case Kind::kTurn: {
        close_level();
        const double w = rate * kRadPerDeg;
        out.turning_rad += w;
        b3 += 3 * w * b2 + 3 * w * w * b1 + w * w * w * b0;
        b2 += 2 * w * b1 + w * w * b0;
        b1 += w * b0;
        break;
      }
    }
  }
  close_level();
  out.speed_mm = b1;
  out.acceleration_mm = b2;
  out.jerk_mm = b3;
  return out;
}

}  // namespace kerf
