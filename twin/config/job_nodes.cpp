#include "twin/config/job_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/suggest.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr double kMostTurn_deg = 360;

void read_zero(ConfigNode& node, JobTurn& turn, ConfigFaults& faults) {
  const std::string word = to_lower(trim(node.scalar));
  if (node.kind == NodeKind::kScalar && word.find(',') == word.npos) {
    if (word == "top") turn.zero = JobTurn::Zero::kTop;
    if (word == "corner") turn.zero = JobTurn::Zero::kCorner;
    if (word == "middle") turn.zero = JobTurn::Zero::kMiddle;
    if (turn.zero == JobTurn::Zero::kStays) {
      faults.at_value(node, trf("'{}' is not allowed; must be top, corner, middle or [x, y, z]",
                                shown(node.scalar)));
    }
    return;
  }
  const std::optional<Vec3> point = job_three(node, kMostJobCoordinate_mm, "mm", faults);
  if (!point) return;
  turn.zero = JobTurn::Zero::kPoint;
  turn.point_mm = *point;
}

void read_points(ConfigNode& setup, ConfigNode& node, JobTurn& turn, ConfigFaults& faults) {
  constexpr const char* kForm = "points: [{was: [0, 0, 0], is: [0.2, -0.1, 0]}, .., ..]";
  if (node.faulty) return;
  for (const char* const other : {"flip", "rotate", "zero"}) {
    if (ConfigNode* const beside = setup.child(other)) {
      faults.at_key(*beside, tr("three touched points say how the workpiece lies; leave it out"));
      return;
    }
  }
  if (node.kind != NodeKind::kList || node.children.size() != 3) {
    faults.at_value(node, tr("must be a list of three points, each with was and is"), kForm);
    return;
  }
  JobTurn::Touched touched;
  for (std::size_t n = 0; n < 3; ++n) {
    ConfigNode& point = *node.children[n];
    check_job_names(point, {"was", "is"}, {}, faults);
    ConfigNode* const was = point.child("was");
    ConfigNode* const is = point.child("is");
    if (was == nullptr || is == nullptr) {
      faults.at_value(point, tr("must have was and is, [x, y, z] each"), kForm);
      return;
    }
    const auto before = job_three(*was, kMostJobCoordinate_mm, "mm", faults);
    const auto now = job_three(*is, kMostJobCoordinate_mm, "mm", faults);
    if (!before || !now) return;
    touched.was_mm[n] = *before;
    touched.is_mm[n] = *now;
  }
  if (!Placement::by_points(touched.was_mm, touched.is_mm)) {
    faults.at_value(node, tr("the three points lie on one line; they do not say how it is turned"));
    return;
  }
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t m = (n + 1) % 3;
    const double was_mm = glm::distance(touched.was_mm[n], touched.was_mm[m]);
    const double is_mm = glm::distance(touched.is_mm[n], touched.is_mm[m]);
    if (std::abs(was_mm - is_mm) <= kTouchSlack_mm) continue;
    faults.at_value(node,
                    trf("points {} and {} were {:.3f} mm apart and are {:.3f} mm; at most "
                        "{:g} mm of difference are allowed",
                        n + 1, m + 1, was_mm, is_mm, kTouchSlack_mm),
                    tr("a rigid part keeps its distances: one of them was touched or written "
                       "wrong"));
    return;
  }
  turn.touched = touched;
}

}  // namespace

void check_job_names(ConfigNode& node, const std::vector<std::string>& known,
                     const std::string& others, ConfigFaults& faults) {
  for (const auto& child : node.children) {
    if (std::find(known.begin(), known.end(), child->key) != known.end()) continue;
    const std::string near = nearest_word(child->key, known);
    std::string hint;
    if (!near.empty()) {
      hint = trf("did you mean {}?", near);
    } else if (others.empty()) {
      hint = trf("here may be: {}", fmt::join(known, ", "));
    } else {
      hint = others;
    }
    faults.at_key(*child, tr("unknown key"), std::move(hint));
  }
}

ConfigNode* job_value(ConfigNode& node, std::string_view name, ConfigFaults& faults) {
  ConfigNode* const child = node.child(name);
  if (child == nullptr || child->faulty) return nullptr;
  if (child->kind == NodeKind::kScalar && !trim(child->scalar).empty()) return child;
  faults.at_value(*child, trf("{} is not allowed; must be a value", to_string(child->kind)));
  return nullptr;
}

std::optional<Vec3> job_three(ConfigNode& node, double most, const char* unit,
                              ConfigFaults& faults) {
  if (node.faulty) return std::nullopt;
  std::vector<std::string> texts;
  if (node.kind == NodeKind::kScalar) {
    for (const std::string_view part : split(node.scalar, ',')) texts.emplace_back(trim(part));
  } else {
    for (const auto& child : node.children) texts.push_back(child->scalar);
  }
  Vec3 out(0);
  bool good = texts.size() == 3 && node.kind != NodeKind::kMap;
  for (std::size_t n = 0; good && n < 3; ++n) {
    const std::optional<double> number = parse_decimal(trim(texts[n]));
    good = number && std::abs(*number) <= most;
    if (good) out[static_cast<int>(n)] = *number;
  }
  if (good) return out;
  faults.at_value(node, trf("'{}' is not allowed; must be three numbers from {:g} to {:g} ({}), "
                            "[x, y, z]",
                            shown(fmt::format("{}", fmt::join(texts, ", "))), -most, most, unit));
  return std::nullopt;
}

void read_job_turn(ConfigNode& setup, JobTurn& turn, ConfigFaults& faults) {
  if (ConfigNode* const flip = job_value(setup, "flip", faults)) {
    const std::string word = to_lower(trim(flip->scalar));
    if (word == "x" || word == "y") {
      turn.flip = word[0];
    } else {
      faults.at_value(*flip, trf("'{}' is not allowed; must be x or y", shown(flip->scalar)),
                      tr("half a turn about that axis; rotate: [0, 0, A] turns about Z"));
    }
  }
  if (ConfigNode* const rotate = setup.child("rotate")) {
    if (const auto degrees = job_three(*rotate, kMostTurn_deg, "degrees", faults))
      turn.rotate_deg = *degrees;
  }
  if (ConfigNode* const zero = setup.child("zero")) read_zero(*zero, turn, faults);
  if (ConfigNode* const points = setup.child("points")) read_points(setup, *points, turn, faults);
}

}  // namespace kerf
