#include "twin/process/part_checks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/motion_kinds.h"
#include "twin/process/contact_grounds.h"

namespace kerf {
namespace {

/// Where shank and cutter are of one width: the wall that they touch is that of the cut.
constexpr double kSameWidth_mm = 0.02;
/// A shank that is wider than the cutter by less is near its wall by design: that is no clearance
/// which anybody would look at.
constexpr double kWider_mm = 0.2;
/// Clearances are measured up to here, whatever --clearance says.
constexpr double kMeasured_mm = 1;
/// A least clearance that is less by no more is no new one.
constexpr double kGrain_mm = 0.005;
/// So far beyond what matters it is looked, so that moves that follow need no look.
constexpr double kAhead_mm = 4;

double turn_rad_of(const CutMove& move) {
  return std::atan2(glm::length(glm::cross(move.axis_from, move.axis_to)),
                    glm::dot(move.axis_from, move.axis_to));
}

/// No point of `part` that can come nearer to `box` than `near_mm` goes farther on the move.
double travel_mm(const CutMove& move, const CarriedPart& part, const Box& box, double near_mm) {
  double way = glm::length(move.to_mm - move.from_mm);
  if (move.arc) {
    const double arm = std::max(glm::length(move.from_mm - move.arc->center_mm),
                                glm::length(move.to_mm - move.arc->center_mm));
    way += arm * std::abs(move.arc->sweep_rad);
  }
  const double turn = turn_rad_of(move);
  if (turn == 0) return way;
  const double to_box = glm::length(move.from_mm - 0.5 * (box.min + box.max)) + way +
                        0.5 * glm::length(box.size()) + near_mm;
  return way + turn * (std::min(part.to_z_mm, to_box) + part.radius_mm);
}

CutMove begin_of(const CutMove& move) {
  CutMove begin;
  begin.from_mm = begin.to_mm = move.from_mm;
  begin.axis_from = begin.axis_to = move.axis_from;
  return begin;
}

ToolPart part_of(FindingId id) {
  return id == FindingId::kHolderContact    ? ToolPart::kHolder
         : id == FindingId::kSpindleContact ? ToolPart::kSpindle
                                            : ToolPart::kShank;
}

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

void PartChecks::set_clearance(double clearance_mm) { clearance_mm_ = clearance_mm; }

void PartChecks::add(Part part) {
  part.row = row_of(part.id);
  if (part.measured) table_[part.row].clearance_above_mm = most_mm();
  parts_.push_back(std::move(part));
}

void PartChecks::mount(const Cutter& cutter, int tool, std::span<const ToolSection> spindle,
                       double nose_mm) {
  parts_.clear();
  last_.reset();
  tool_ = tool;
  if (!stock_.checks_parts()) return;
  const double no_end = std::numeric_limits<double>::infinity();
  if (cutter.flute_length_mm() && !cutter.is_flute_length_assumed()) {
    const double flutes_mm = *cutter.flute_length_mm();
    const double cutter_mm = 2 * cutter.radius_mm();
    const auto add_shank = [&](double width_mm, double from_z_mm, double to_z_mm) {
      const bool same = std::abs(width_mm - cutter_mm) < kSameWidth_mm;
      const FindingId id = same ? FindingId::kFluteTooShort : FindingId::kShankContact;
      Part part{{width_mm / 2, from_z_mm, to_z_mm}, id, width_mm, from_z_mm, 0};
      part.measured = width_mm > cutter_mm + kWider_mm;
      part.above_neck = from_z_mm > flutes_mm;
      add(std::move(part));
    };
    for (const ToolSection& section : cutter.neck())
      add_shank(section.diameter_mm, section.from_z_mm, section.to_z_mm);
    const double from_mm = cutter.neck().empty() ? flutes_mm : cutter.neck().back().to_z_mm;
    const double to_mm = cutter.holder().empty() ? no_end : cutter.holder().front().from_z_mm;
    if (to_mm > from_mm) add_shank(cutter.shank_diameter_mm().value_or(cutter_mm), from_mm, to_mm);
  }
  for (const ToolSection& section : cutter.holder()) {
    Part part{{section.diameter_mm / 2, section.from_z_mm, section.to_z_mm},
              FindingId::kHolderContact,
              section.diameter_mm,
              cutter.holder().front().from_z_mm,
              0};
    part.measured = true;
    add(std::move(part));
  }
  const double top_mm = cutter.holder().empty() ? 0 : cutter.holder().back().to_z_mm;
  const double nose_z_mm = std::max(top_mm, nose_mm);
  for (const ToolSection& section : spindle) {
    if (nose_z_mm <= 0) break;
    Part part{{section.diameter_mm / 2, nose_z_mm + section.from_z_mm, nose_z_mm + section.to_z_mm},
              FindingId::kSpindleContact,
              section.diameter_mm,
              nose_z_mm,
              0};
    part.measured = true;
    add(std::move(part));
  }
}

double PartChecks::reach_mm() const {
  const double across = glm::length(stock_.bounds_mm().size());
  double reach = 0;
  for (const Part& part : parts_)
    reach = std::max(reach, std::min(part.body.to_z_mm, part.body.from_z_mm + across));
  return reach;
}

void PartChecks::begin_reporting() {
  unmount();
  table_.clear();
  nearest_.clear();
}

std::size_t PartChecks::row_of(FindingId id) {
  const ToolPart part = part_of(id);
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (table_[i].tool == tool_ && table_[i].part == part) return i;
  CollisionPair row;
  row.tool = tool_;
  row.part = part;
  table_.push_back(std::move(row));
  nearest_.emplace_back();
  return table_.size() - 1;
}

/// What is farther away is not measured.
double PartChecks::most_mm() const { return std::max(kMeasured_mm, 2 * clearance_mm_); }

/// What would be a new least clearance; 0: only a contact counts.
double PartChecks::counts_mm(const Part& part) const {
  if (!part.measured) return 0;
  const std::optional<double> least = table_[part.row].least_clearance_mm;
  return least ? std::max(0.0, *least - kGrain_mm) : most_mm();
}

bool PartChecks::comes_near(Part& part, const CutMove& move) const {
  const double counts = counts_mm(part);
  const double most = counts + kAhead_mm;
  const double travel = travel_mm(move, part.body, stock_.bounds_mm(), most);
  // A distance of 0 may be a contact.
  const auto is_far = [&] { return part.spare_mm >= counts && part.spare_mm > 0; };
  part.spare_mm -= travel;
  if (is_far()) return false;
  if (travel < kAhead_mm) {
    const double enough = counts + travel;
    const double here = stock_.part_spare_mm(part.body, begin_of(move), enough, most + travel);
    part.spare_mm = here - travel;
    if (is_far()) return false;
    if (here <= 0) return true;
  }
  part.spare_mm = stock_.part_spare_mm(part.body, move, counts, most);
  return !is_far();
}

bool PartChecks::may_matter(std::span<const CutMove> moves) {
  if (parts_.empty()) return false;
  bool any = false;
  for (Part& part : parts_) part.matters = false;
  for (const CutMove& move : moves) {
    const bool goes_on = last_ && last_->to_mm == move.from_mm && last_->axis_to == move.axis_from;
    for (Part& part : parts_) {
      if (!goes_on) part.spare_mm = -1;
      if (!comes_near(part, move)) continue;
      part.matters = any = true;
      part.spare_mm = -1;
    }
    last_ = move;
  }
  return any;
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
    finding.time_s = move.step.time_at(fraction);
    finding.position_mm = contact.tip_mm;
    finding.tool = move.tool;
    CollisionPair& row = table_[part.row];
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

/// The move does not touch.
void PartChecks::measure(const Part& part, const CheckedMove& move, std::size_t which) {
  const double counts = counts_mm(part);
  if (counts <= 0) return;
  const auto gap = stock_.part_gap(move.cutter, part.body, move.moves[which], counts);
  if (!gap) return;
  CollisionPair& row = table_[part.row];
  row.least_clearance_mm = gap->mm;
  row.source = move.motion.source;
  Finding& near = nearest_[part.row];
  near.source = move.motion.source;
  near.time_s = move.time_s(which, gap->t);
  near.position_mm = gap->tip_mm;
  near.tool = move.tool;
  near.text = doubt_of(FindingId::kHolderContact, {blank_guessed_, move.tool_guessed});
}

void PartChecks::finish() {
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const CollisionPair& row = table_[i];
    if (row.contacts > 0 || !row.least_clearance_mm || *row.least_clearance_mm >= clearance_mm_)
      continue;
    Finding near = nearest_[i];
    near.id = FindingId::kNearMiss;
    near.severity = Severity::kNote;
    near.bodies = {to_string(row.part), kWorkpieceBody};
    near.text = trf("{} comes as near as {:.2f} mm to the workpiece", name_of(row.part),
                    *row.least_clearance_mm) +
                near.text;
    log_.add(std::move(near));
  }
}

void PartChecks::check(const CheckedMove& move) {
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
      if (!parts_[k].matters) continue;
      // A traverse that goes through material is told as such: nothing is cut there by flutes.
      if (is_traverse(move.motion) && parts_[k].id == FindingId::kFluteTooShort) continue;
      const double known = known_mm(parts_[k], move.motion);
      CarriedPart body = parts_[k].body;
      body.from_z_mm += known;
      if (body.from_z_mm >= body.to_z_mm) continue;
      auto contact = stock_.part_contact(move.cutter, body, move.moves[i], kContactTolerance_mm);
      if (!contact) {
        if (known == 0) measure(parts_[k], move, i);
        continue;
      }
      contact->depth_mm += known;
      met.push_back({k, *contact, move.share_of(i, contact->t)});
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
