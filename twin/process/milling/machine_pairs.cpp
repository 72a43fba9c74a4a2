#include "twin/process/milling/machine_pairs.h"

#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "twin/collision/solid_sweep.h"

namespace kerf {
namespace {

using Kind = WorkingBody::Kind;

void measure(WorkingBody& body) {
  for (const SolidPointer& solid : body.solids) {
    body.has_triangles = body.has_triangles || has_triangles(*solid);
    body.has_closed = body.has_closed || solid->is_closed();
    body.pieces += solid->pieces().size();
    for (const Convex& piece : solid->pieces()) {
      body.reach_mm = std::max(body.reach_mm, reach_of(piece));
      body.has_depth = body.has_depth || piece.kind != Convex::Kind::kHull;
    }
  }
}

/// Which of the two is moved against the other, which is the same: the one of which depths can be
/// measured, and of two such that of fewer pieces.
bool is_better_mover(const WorkingBody& a, const WorkingBody& b) {
  if (a.kind == Kind::kWorkpiece || b.kind == Kind::kWorkpiece) return b.kind == Kind::kWorkpiece;
  if (a.has_triangles != b.has_triangles) return b.has_triangles;
  return a.pieces <= b.pieces;
}

}  // namespace

std::string WorkingBody::shown() const {
  switch (kind) {
    case Kind::kLink:
      return trf("link '{}'", name);
    case Kind::kFixture:
      return trf("fixture '{}'", name);
    case Kind::kToolPart:
      return name_of(part);
    case Kind::kWorkpiece:
      break;
  }
  return tr("the workpiece");
}

void MachinePairs::set(const CollisionWishes& wishes, const Box& workpiece_mm) {
  wishes_ = wishes;
  const KinematicChain& machine = chain();
  groups_ = rigid_groups(machine);
  for (const LinkBody& link : wishes_.machine->bodies) {
    WorkingBody body;
    body.name = link.name;
    body.link = link.link;
    body.solids = link.solids;
    add(std::move(body));
  }
  if (wishes_.fixtures) {
    for (const Fixture& fixture : *wishes_.fixtures) {
      WorkingBody body;
      body.kind = Kind::kFixture;
      body.name = fixture.name;
      body.by_program = fixture.on.empty();
      body.link = body.by_program ? machine.workpiece_link() : *machine.find(fixture.on);
      body.frame_from_body = fixture.workpiece_from_fixture;
      body.link_from_body = body.frame_from_body;
      body.clearance_mm = fixture.clearance_mm;
      body.solids = {fixture.solid};
      add(std::move(body));
    }
  }
  if (!workpiece_mm.empty()) {
    WorkingBody body;
    body.kind = Kind::kWorkpiece;
    body.name = "workpiece";
    body.by_program = true;
    body.link = machine.workpiece_link();
    BlankBody box;
    box.bounds_mm = workpiece_mm;
    body.solids = {Solid::of_bodies({&box, 1})};
    add(std::move(body));
  }
  lasting_ = bodies_.size();
  for (std::uint32_t a = 0; a < lasting_; ++a)
    for (std::uint32_t b = a + 1; b < lasting_; ++b) pair_up(a, b, 0, false);
}

void MachinePairs::add(WorkingBody body) {
  measure(body);
  bodies_.push_back(std::move(body));
}

bool MachinePairs::may_meet(const WorkingBody& a, const WorkingBody& b) const {
  if (groups_[a.link] == groups_[b.link]) return false;
  const bool links = a.kind == Kind::kLink && b.kind == Kind::kLink;
  if (links && are_neighbours(chain(), a.link, b.link)) return false;
  // The program's coordinates are where the tool works: its checks look at these.
  const auto is_of_program = [](const WorkingBody& one) { return one.by_program; };
  const bool tool = a.kind == Kind::kToolPart || b.kind == Kind::kToolPart;
  if (tool && (is_of_program(a) || is_of_program(b))) return false;
  return !wishes_.rules.ignores(a.name, b.name);
}

void MachinePairs::describe(WorkingPair& pair, const WorkingBody& a, const WorkingBody& b) const {
  // Of what is a machine's the tool comes first, then what a user has put on it.
  const bool swapped = a.kind < b.kind;
  const WorkingBody& first = swapped ? b : a;
  const WorkingBody& second = swapped ? a : b;
  pair.sentence_a = first.shown();
  pair.sentence_b = second.shown();
  pair.row.part = first.part;
  if (first.kind != Kind::kToolPart) pair.row.first = first.name;
  pair.row.other = second.name;
  pair.with_workpiece = a.kind == Kind::kWorkpiece || b.kind == Kind::kWorkpiece;
  pair.of_links = a.kind == Kind::kLink && b.kind == Kind::kLink;
  const bool link = a.kind == Kind::kLink || b.kind == Kind::kLink;
  pair.id = link ? FindingId::kMachineCollision : FindingId::kFixtureContact;
  const std::optional<double> own = first.clearance_mm ? first.clearance_mm : second.clearance_mm;
  pair.near_mm =
      wishes_.rules.clearance_mm(a.name, b.name).value_or(own.value_or(wishes_.clearance_mm));
}

bool MachinePairs::knows_depth(const WorkingPair& pair) const {
  const WorkingBody &moving = bodies_[pair.moving], &still = bodies_[pair.still];
  return moving.has_depth || (!pair.with_workpiece && moving.has_closed && still.has_closed);
}

WorkingPair* MachinePairs::known(int tool, const WorkingBody& a, const WorkingBody& b) const {
  const WorkingBody& part = a.kind == Kind::kToolPart ? a : b;
  const WorkingBody& other = a.kind == Kind::kToolPart ? b : a;
  if (part.kind != Kind::kToolPart) return nullptr;
  for (const auto& pair : pairs_) {
    const CollisionPair& row = pair->row;
    if (row.first.empty() && row.tool == tool && row.part == part.part && row.other == other.name)
      return pair.get();
  }
  return nullptr;
}

void MachinePairs::pair_up(std::uint32_t a, std::uint32_t b, int tool, bool guessed) {
  if (!may_meet(bodies_[a], bodies_[b])) return;
  WorkingPair* pair = known(tool, bodies_[a], bodies_[b]);
  if (pair == nullptr) {
    pairs_.push_back(std::make_unique<WorkingPair>());
    pair = pairs_.back().get();
    describe(*pair, bodies_[a], bodies_[b]);
    pair->row.tool = tool;
  }
  const bool first_moves = is_better_mover(bodies_[a], bodies_[b]);
  pair->moving = first_moves ? a : b;
  pair->still = first_moves ? b : a;
  pair->guessed_tool = guessed;
  pair->spare_mm = -1;
  pair->stood = pair->overlaps = false;
  pair->event.reset();
  make_chain(*pair);
  active_.push_back(pair);
}

void MachinePairs::make_chain(WorkingPair& pair) const {
  pair.chain =
      ToolChain(chain(), joint_letters_, bodies_[pair.still].link, bodies_[pair.moving].link);
}

void MachinePairs::place(const Pose& link_from_program, std::string_view joint_letters) {
  joint_letters_ = joint_letters;
  for (WorkingBody& body : bodies_)
    if (body.by_program) body.link_from_body = link_from_program * body.frame_from_body;
  for (const auto& pair : pairs_) {
    make_chain(*pair);
    pair->spare_mm = -1;
  }
}

std::optional<Pose> MachinePairs::beside_workpiece(const WorkingBody& body,
                                                   const Pose& program_from_link) const {
  const std::size_t workpiece = chain().workpiece_link();
  if (groups_[body.link] != groups_[workpiece]) return std::nullopt;
  const ToolChain way(chain(), joint_letters_, workpiece, body.link);
  return program_from_link * way.pose({}) * body.link_from_body;
}

void MachinePairs::mount(const Cutter& cutter, int tool, bool guessed, double nose_mm) {
  unmount();
  tool_mm_ = 0;
  const std::vector<ToolBody> parts = tool_bodies(cutter, wishes_.spindle, nose_mm);
  for (const ToolBody& part : parts) {
    WorkingBody body;
    body.kind = Kind::kToolPart;
    body.part = part.part;
    body.name = to_string(part.part);
    body.link = chain().tool_link();
    body.solids = {part.solid};
    if (part.part == ToolPart::kHolder) tool_mm_ = std::max(tool_mm_, part.solid->box_mm().max.z);
    add(std::move(body));
  }
  for (auto a = static_cast<std::uint32_t>(lasting_); a < bodies_.size(); ++a)
    for (std::uint32_t b = 0; b < lasting_; ++b) pair_up(a, b, tool, guessed);
  tip_from_nose_ = Vec3(std::numeric_limits<double>::quiet_NaN());
}

void MachinePairs::unmount() {
  bodies_.resize(lasting_);
  std::erase_if(active_, [](const WorkingPair* pair) { return pair->row.first.empty(); });
  tool_mm_ = 0;
}

bool MachinePairs::hang_tool(const Vec3& tip_from_nose) {
  if (tip_from_nose == tip_from_nose_ || !has_tool()) return false;
  tip_from_nose_ = tip_from_nose;
  for (std::size_t i = lasting_; i < bodies_.size(); ++i)
    bodies_[i].link_from_body = shift(tip_from_nose);
  for (WorkingPair* pair : active_)
    if (pair->row.first.empty()) pair->spare_mm = -1;
  return true;
}

}  // namespace kerf
