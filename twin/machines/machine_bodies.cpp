#include "twin/machines/machine_bodies.h"

#include <optional>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

void tell(Diagnostics& diagnostics, Severity severity, std::string message) {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.message = std::move(message);
  diagnostics.push_back(std::move(diagnostic));
}

/// False with an error.
bool add_stl(const LinkSpec& link, std::size_t most_triangles, LinkBody& body,
             Diagnostics& diagnostics) {
  const std::optional<TriangleMesh> mesh = stl_of(link, diagnostics);
  if (!mesh) return false;
  if (mesh->triangles.size() > most_triangles) {
    tell(diagnostics, Severity::kNote,
         trf("the link '{}': {} has {} triangles; for collisions {} are the most, and it is left "
             "out there",
             link.chain.name, link.stl_path, mesh->triangles.size(), most_triangles));
    return true;
  }
  body.solids.push_back(Solid::of_mesh(*mesh));
  if (!body.solids.back()->is_closed()) {
    tell(diagnostics, Severity::kNote,
         trf("the link '{}': the surface in {} has holes; collisions are looked for with its "
             "surface, and what is inside of it counts as air",
             link.chain.name, link.stl_path));
  }
  return true;
}

/// Tubes by themselves: of a closed surface it is known what lies in it.
void add_bodies(std::span<const BlankBody> bodies, std::vector<SolidPointer>& out) {
  std::vector<BlankBody> full;
  for (const BlankBody& one : bodies) {
    if (one.kind == BlankBody::Kind::kTube) {
      out.push_back(Solid::of_bodies({&one, 1}));
    } else {
      full.push_back(one);
    }
  }
  if (!full.empty()) out.push_back(Solid::of_bodies(full));
}

}  // namespace

MachineBodiesPointer bodies_of(const LinkedMachine& description, Diagnostics& diagnostics,
                               std::size_t most_triangles) {
  Result<KinematicChain> chain = KinematicChain::create(
      description.links_of_chain(), description.workpiece_on, description.tool_on);
  if (!chain) {
    tell(diagnostics, Severity::kError, trf("the machine's links: {}", chain.error()));
    return nullptr;
  }
  auto machine = std::make_shared<MachineBodies>();
  bool complete = true;
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    const LinkSpec& link = description.links[i];
    LinkBody body{link.chain.name, i, {}};
    add_bodies(link.bodies, body.solids);
    if (!link.stl_path.empty())
      complete = add_stl(link, most_triangles, body, diagnostics) && complete;
    if (!body.solids.empty()) machine->bodies.push_back(std::move(body));
  }
  if (!complete) return nullptr;
  machine->chain = std::move(chain.value());
  return machine;
}

MachineBodiesPointer bodies_of(const MachineModel& model) {
  auto machine = std::make_shared<MachineBodies>();
  machine->chain = model.chain;
  machine->guessed = true;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const LinkShape& link = model.links[i];
    if (link.mesh->triangles.empty()) continue;
    machine->bodies.push_back({link.name, i, {Solid::of_mesh(*link.mesh)}});
  }
  return machine;
}

std::vector<std::size_t> rigid_groups(const KinematicChain& chain) {
  const std::vector<ChainLink>& links = chain.links();
  std::vector<std::size_t> group(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    // Up to what moves it; what hangs on the floor is one with the floor.
    std::size_t at = i;
    while (links[at].joint == JointKind::kFixed && !links[at].parent.empty())
      at = *chain.find(links[at].parent);
    const bool stands = links[at].joint == JointKind::kFixed;
    group[i] = stands ? links.size() : at;
  }
  return group;
}

bool are_neighbours(const KinematicChain& chain, std::size_t a, std::size_t b) {
  const std::vector<ChainLink>& links = chain.links();
  return links[a].parent == links[b].name || links[b].parent == links[a].name;
}

}  // namespace kerf
