// twin/machines/machine_bodies.h - the links of a machine as rigid bodies: what collisions are
// looked for between.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "twin/collision/solid.h"
#include "twin/machine/kinematics/kinematic_chain.h"
#include "twin/machines/linked_machine.h"
#include "twin/machines/machine_model.h"

namespace kerf {

/// A link that has a shape, in the link's frame.
struct LinkBody {
  std::string name;
  std::size_t link = 0;  ///< of the chain
  std::vector<SolidPointer> solids;
};

/// Immutable; any number of threads.
struct MachineBodies {
  KinematicChain chain;
  std::vector<LinkBody> bodies;
  bool guessed = false;  ///< nobody has measured these shapes: a machine that kerf has built in
};
using MachineBodiesPointer = std::shared_ptr<const MachineBodies>;

/// Reads the STL files. Boxes and cylinders are taken exactly, meshes by their triangles. Null with
/// an error as linked_machine() has them. Notes: meshes with holes, of which the surface counts;
/// meshes of more than `most_triangles`, which are left out.
inline constexpr std::size_t kMostLinkTriangles = 2'000'000;
MachineBodiesPointer bodies_of(const LinkedMachine& description, Diagnostics& diagnostics,
                               std::size_t most_triangles = kMostLinkTriangles);

/// Of a machine that is built in: guessed.
MachineBodiesPointer bodies_of(const MachineModel& model);

/// Which links move as one: a number each, equal for those that are joined by nothing that moves.
std::vector<std::size_t> rigid_groups(const KinematicChain& chain);

/// One hangs on the other by a joint, as `saddle` does on `frame`.
bool are_neighbours(const KinematicChain& chain, std::size_t a, std::size_t b);

}  // namespace kerf
