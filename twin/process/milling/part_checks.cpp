#include "twin/process/milling/part_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/translate.h"
#include "twin/motion/motion_geometry.h"

namespace kerf {
namespace {

/// Where shank and cutter are of one width: the wall that they touch is that of the cut.
constexpr double kSameWidth_mm = 0.02;

std::string text_of(FindingId id, double width_mm, double length_mm) {
  if (id == FindingId::kHolderContact) {
    return trf("holder ({:.4g} mm wide, {:.4g} mm above the tip) touches the workpiece", width_mm,
               length_mm);
  }
  if (id == FindingId::kSpindleContact) {
    return trf("spindle ({:.4g} mm wide, {:.4g} mm above the tip) touches the workpiece", width_mm,
               length_mm);
  }
  if (id == FindingId::kShankContact) {
    return trf("shank ({:.4g} mm wide, {:.4g} mm above the tip) touches the workpiece", width_mm,
               length_mm);
  }
  return trf("material stands higher than the flutes reach ({:.4g} mm): the shank rubs", length_mm);
}

/// Rounded up: what is told does clear.
std::string hint_of(FindingId id, double length_mm, bool above_neck) {
  const double least_mm = std::ceil(length_mm * 100 - 1e-6) / 100;
  if (id == FindingId::kHolderContact)
    return trf("a stick-out of {:.2f} mm would clear it", least_mm);
  if (id == FindingId::kSpindleContact)
    return trf("a tool {:.2f} mm long would clear it", least_mm);
  if (above_neck) return trf("a neck up to {:.2f} mm above the tip would clear it", least_mm);
  return trf("flutes of {:.2f} mm would clear it", least_mm);
}

}  // namespace

void PartChecks::mount(const Cutter& cutter, int tool, std::span<const ToolSection> spindle,
                       double nose_mm) {
  parts_.clear();
  tool_ = tool;
  if (!stock_.checks_parts()) return;
  if (cutter.flute_length_mm() && !cutter.is_flute_length_assumed()) {
    const double flutes_mm = *cutter.flute_length_mm();
    const double cutter_mm = 2 * cutter.radius_mm();
    const auto add = [&](double width_mm, double from_z_mm) {
      const bool same = std::abs(width_mm - cutter_mm) < kSameWidth_mm;
      const FindingId id = same ? FindingId::kFluteTooShort : FindingId::kShankContact;
      parts_.push_back({{width_mm / 2, from_z_mm}, id, width_mm, from_z_mm, 0, {}});
      parts_.back().above_neck = from_z_mm > flutes_mm;
    };
    for (const ToolSection& section : cutter.neck()) add(section.diameter_mm, section.from_z_mm);
    add(cutter.shank_diameter_mm().value_or(cutter_mm),
        cutter.neck().empty() ? flutes_mm : cutter.neck().back().to_z_mm);
  }
  for (const ToolSection& section : cutter.holder()) {
    parts_.push_back({{section.diameter_mm / 2, section.from_z_mm},
                      FindingId::kHolderContact,
                      section.diameter_mm,
                      cutter.holder().front().from_z_mm,
                      0,
                      {}});
  }
  const double top_mm = cutter.holder().empty() ? 0 : cutter.holder().back().to_z_mm;
  const double nose_z_mm = std::max(top_mm, nose_mm);
  for (const ToolSection& section : spindle) {
    if (nose_z_mm <= 0) break;
    parts_.push_back({{section.diameter_mm / 2, nose_z_mm + section.from_z_mm},
                      FindingId::kSpindleContact,
                      section.diameter_mm,
                      nose_z_mm,
                      0,
                      {}});
  }
  for (const Part& part : parts_) row_of(part.id);
}

CollisionPair& PartChecks::row_of(FindingId id) {
  const ToolPart part = id == FindingId::kHolderContact    ? ToolPart::kHolder
                        : id == FindingId::kSpindleContact ? ToolPart::kSpindle
                                                           : ToolPart::kShank;
  for (CollisionPair& row : table_)
    if (row.tool == tool_ && row.part == part) return row;
  CollisionPair row;
  row.tool = tool_;
  row.part = part;
  table_.push_back(std::move(row));
  return table_.back();
}

bool PartChecks::may_touch(const Motion& motion) const {
  if (parts_.empty()) return false;
  const Box way = bounds_of(motion);
  for (const Part& part : parts_) {
    const double low =
        way.min.z + part.body.from_z_mm + kContactTolerance_mm + known_mm(part, motion);
    if (low >= stock_.bounds_mm().max.z) continue;
    const double r = part.body.radius_mm;
    if (low < stock_.highest_mm({way.min.x - r, way.min.y - r}, {way.max.x + r, way.max.y + r}))
      return true;
  }
  return false;
}

double PartChecks::known_mm(const Part& part, const Motion& motion) const {
  if (is_traverse(motion)) return 0;
  for (const Part& other : parts_)
    if (other.id == part.id && other.event) return other.depth_mm;
  return 0;
}

PartChecks::Part* PartChecks::open_event(FindingId id) {
  for (Part& part : parts_)
    if (part.id == id && part.event) return &part;
  return nullptr;
}

void PartChecks::meet(std::size_t index, const CheckedMove& move, const PartContact& contact,
                      double fraction) {
  Part& part = parts_[index];
  Part* open = open_event(part.id);
  if (!open) {
    const Grounds grounds{blank_guessed_, move.tool_guessed};
    Finding finding;
    finding.id = part.id;
    finding.severity = severity_of(part.id, grounds);
    if (part.id == FindingId::kFluteTooShort)
      finding.severity = std::min(finding.severity, Severity::kWarning);
    finding.text =
        text_of(part.id, part.width_mm, part.body.from_z_mm) + doubt_of(part.id, grounds);
    finding.source = move.motion.source;
    finding.time_s = move.step.start_s + fraction * move.step.duration_s;
    finding.position_mm = contact.tip_mm;
    finding.tool = move.tool;
    CollisionPair& row = row_of(part.id);
    finding.bodies = {to_string(row.part), kWorkpieceBody};
    if (row.contacts++ == 0) row.source = finding.source;
    row.least_clearance_mm = 0;
    part.event = log_.add(std::move(finding));
    part.depth_mm = 0;
    open = &part;
  }
  log_.deepen(*open->event, contact.depth_mm);
  open->depth_mm = std::max(open->depth_mm, contact.depth_mm);
  log_.set_hint(*open->event,
                hint_of(open->id, open->length_mm + open->depth_mm, open->above_neck));
}

void PartChecks::check(const CheckedMove& move) {
  const auto count = static_cast<double>(move.moves.size());
  bool touched[4] = {};
  const auto kind_of = [](FindingId id) {
    return id == FindingId::kHolderContact    ? 0
           : id == FindingId::kShankContact   ? 1
           : id == FindingId::kSpindleContact ? 2
                                              : 3;
  };
  struct Met {
    std::size_t part;
    PartContact contact;
    double fraction;
  };
  std::vector<Met> met;
  for (std::size_t i = 0; i < move.moves.size(); ++i) {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      // A traverse that goes through material is told as such: nothing is cut there by flutes.
      if (is_traverse(move.motion) && parts_[k].id == FindingId::kFluteTooShort) continue;
      const double known = known_mm(parts_[k], move.motion);
      CarriedPart body = parts_[k].body;
      body.from_z_mm += known;
      auto contact = stock_.part_contact(move.cutter, body, move.moves[i], kContactTolerance_mm);
      if (!contact) continue;
      contact->depth_mm += known;
      met.push_back({k, *contact, (static_cast<double>(i) + contact->t) / count});
    }
  }
  // What comes first on the move begins the event.
  std::stable_sort(met.begin(), met.end(),
                   [](const Met& a, const Met& b) { return a.fraction < b.fraction; });
  for (const Met& one : met) {
    touched[kind_of(parts_[one.part].id)] = true;
    meet(one.part, move, one.contact, one.fraction);
  }
  if (!is_traverse(move.motion)) return;
  for (Part& part : parts_)
    if (!touched[kind_of(part.id)]) part.event.reset();
}

}  // namespace kerf
