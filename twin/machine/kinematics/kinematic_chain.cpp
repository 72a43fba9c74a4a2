#include "twin/machine/kinematics/kinematic_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/translate.h"

namespace kerf {
namespace {

/// Shorter ones say nothing reliable of where they point.
constexpr double kShortestDirection = 1e-6;
/// A machine has some ten.
constexpr std::size_t kMostLinks = 200;

std::optional<std::size_t> place_of(const std::vector<ChainLink>& links, std::string_view name) {
  const auto at =
      std::find_if(links.begin(), links.end(), [&](const ChainLink& l) { return l.name == name; });
  if (at == links.end()) return std::nullopt;
  return static_cast<std::size_t>(at - links.begin());
}

std::string names_of(const std::vector<ChainLink>& links) {
  std::string out;
  for (const ChainLink& link : links) out += (out.empty() ? "" : ", ") + link.name;
  return out;
}

std::string no_link(std::string_view name, const std::vector<ChainLink>& links) {
  return trf("'{}' is no link; there are {}", name, names_of(links));
}

/// Whether the way to the base comes to an end.
bool reaches_base(const std::vector<ChainLink>& links, std::size_t link) {
  for (std::size_t steps = 0; steps <= links.size(); ++steps) {
    if (links[link].parent.empty()) return true;
    const std::optional<std::size_t> parent = place_of(links, links[link].parent);
    if (!parent) return true;  // another fault
    link = *parent;
  }
  return false;
}

}  // namespace

AxisValues joints_of(const AxisValues& axes, std::string_view joint_letters) {
  AxisValues joints{};
  for (std::size_t joint = 0; joint < std::min(joint_letters.size(), kAxisCount); ++joint) {
    const auto at = std::find(kAxisLetters.begin(), kAxisLetters.end(), joint_letters[joint]);
    if (at != kAxisLetters.end()) {
      joints[joint] = axes[static_cast<std::size_t>(at - kAxisLetters.begin())];
    }
  }
  return joints;
}

std::vector<ChainFault> KinematicChain::faults_of(const std::vector<ChainLink>& links,
                                                  std::string_view workpiece,
                                                  std::string_view tool) {
  using Field = ChainFault::Field;
  std::vector<ChainFault> faults;
  if (links.size() > kMostLinks) {
    return {{kMostLinks, Field::kName,
             trf("{} links; {} are the most that a machine has", links.size(), kMostLinks)}};
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    const ChainLink& link = links[i];
    if (link.name.empty()) {
      faults.push_back({i, Field::kName, tr("a link needs a name")});
    } else if (place_of(links, link.name) != i) {
      faults.push_back({i, Field::kName, trf("there are two links '{}'", link.name)});
    }
    if (!link.parent.empty() && !place_of(links, link.parent)) {
      faults.push_back({i, Field::kParent, no_link(link.parent, links)});
    } else if (!reaches_base(links, i)) {
      faults.push_back({i, Field::kParent,
                        trf("'{}' hangs on itself, by way of '{}'; one link of the circle "
                            "must have no parent",
                            link.name, link.parent)});
    }
    // Written so that it also holds for what is no number.
    if (link.joint != JointKind::kFixed && !(glm::length(link.direction) > kShortestDirection)) {
      faults.push_back({i, Field::kDirection, tr("a direction of no length points nowhere")});
    }
  }
  if (!place_of(links, workpiece)) {
    faults.push_back({0, Field::kWorkpiece, no_link(workpiece, links)});
  }
  if (!place_of(links, tool)) faults.push_back({0, Field::kTool, no_link(tool, links)});
  return faults;
}

Result<KinematicChain> KinematicChain::create(std::vector<ChainLink> links,
                                              std::string_view workpiece, std::string_view tool) {
  const std::vector<ChainFault> faults = faults_of(links, workpiece, tool);
  if (!faults.empty()) return Error{faults.front().message};
  KinematicChain chain;
  chain.workpiece_ = *place_of(links, workpiece);
  chain.tool_ = *place_of(links, tool);
  for (ChainLink& link : links) {
    assert(link.input < kAxisCount);
    if (link.joint != JointKind::kFixed) link.direction = glm::normalize(link.direction);
    const std::optional<std::size_t> parent = place_of(links, link.parent);
    chain.parents_.push_back(link.parent.empty() ? -1 : static_cast<std::int32_t>(*parent));
  }
  chain.links_ = std::move(links);
  // A tree: repeated passes take those whose parent has been taken.
  std::vector<bool> taken(chain.links_.size(), false);
  while (chain.order_.size() < chain.links_.size()) {
    for (std::size_t i = 0; i < chain.links_.size(); ++i) {
      const std::int32_t parent = chain.parents_[i];
      if (taken[i] || (parent >= 0 && !taken[static_cast<std::size_t>(parent)])) continue;
      taken[i] = true;
      chain.order_.push_back(i);
    }
  }
  return chain;
}

std::optional<std::size_t> KinematicChain::find(std::string_view name) const {
  return place_of(links_, name);
}

bool KinematicChain::is_driven_by(std::size_t axis) const { return is_driven(false, axis); }

bool KinematicChain::is_driven_by_joint(std::size_t joint) const { return is_driven(true, joint); }

bool KinematicChain::is_driven(bool by_joint, std::size_t input) const {
  for (const std::size_t end : {workpiece_, tool_}) {
    for (auto link = static_cast<std::int32_t>(end); link >= 0;
         link = parents_[static_cast<std::size_t>(link)]) {
      const ChainLink& one = links_[static_cast<std::size_t>(link)];
      if (one.joint != JointKind::kFixed && one.by_joint == by_joint && one.input == input)
        return true;
    }
  }
  return false;
}

Pose KinematicChain::joint_pose(std::size_t link, const MachinePosition& position) const {
  const ChainLink& one = links_[link];
  const double value =
      one.by_joint ? position.joints[one.input] : position.axes[one.input];  // fixed: not used
  switch (one.joint) {
    case JointKind::kFixed:
      break;
    case JointKind::kPrismatic:
      return shift(one.origin_mm + value * one.direction);
    case JointKind::kRotary: {
      Pose pose = turn(one.direction, value);
      pose.origin_mm = one.origin_mm;
      return pose;
    }
  }
  return shift(one.origin_mm);
}

void KinematicChain::forward(const MachinePosition& position,
                             std::span<Pose> base_from_link) const {
  assert(base_from_link.size() == links_.size());
  for (const std::size_t link : order_) {
    const Pose own = joint_pose(link, position);
    const std::int32_t parent = parents_[link];
    base_from_link[link] =
        parent < 0 ? own : base_from_link[static_cast<std::size_t>(parent)] * own;
  }
}

Pose KinematicChain::base_from(std::size_t link, const MachinePosition& position) const {
  Pose pose = joint_pose(link, position);
  for (std::int32_t up = parents_[link]; up >= 0; up = parents_[static_cast<std::size_t>(up)]) {
    pose = joint_pose(static_cast<std::size_t>(up), position) * pose;
  }
  return pose;
}

Pose KinematicChain::workpiece_from_tool(const MachinePosition& position) const {
  return base_from(workpiece_, position).inverse() * base_from(tool_, position);
}

}  // namespace kerf
