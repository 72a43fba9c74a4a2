// twin/machines/linked_machine.h - a machine as its user describes it, link by link.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "stock/blank.h"
#include "twin/machines/builtin_models.h"
#include "twin/machines/machine_model.h"

namespace kerf {

/// One link: how it moves and what it looks like. Shapes are those of `--stock`, in the link's
/// frame.
struct LinkSpec {
  ChainLink chain;
  std::vector<BlankBody> bodies;
  std::string bodies_spec;   ///< The text that `bodies` was read from; may be empty: no bodies.
  std::string stl_path;      ///< Empty: no STL.
  double mm_per_unit = 1.0;  ///< Of the STL.
  Vec3 mesh_offset_mm{0.0};  ///< Added to all of its corners, after the scale.
  std::uint32_t color = 0xffa0a0a0;  ///< 0xAABBGGRR
};

struct LinkedMachine {
  std::vector<LinkSpec> links;
  std::string workpiece_on;  ///< Name of the link that carries the workpiece.
  std::string tool_on;       ///< Of the one whose origin holds the tool.

  std::vector<ChainLink> links_of_chain() const;
};

/// What is in the link's STL file, where it lies in the link's frame. Nothing, with an error that
/// names link, file and reason, if it cannot be read.
std::optional<TriangleMesh> stl_of(const LinkSpec& link, Diagnostics& diagnostics);

/// Box, cylinder or tube as a closed mesh.
TriangleMesh mesh_of(const BlankBody& body);

/// Reads the STL files and forgets them again: each that is missing or broken is an error that
/// names link, file and reason. For a command that shows a machine, before it begins.
void check_shapes(const LinkedMachine& description, Diagnostics& diagnostics);

/// Reads the STL files. Nothing if one is missing or broken (each is an error that names file and
/// reason), or if the chain is none (KinematicChain::faults_of; whoever read the description has
/// told where). A link without shape is not drawn but moves what hangs on it.
std::optional<MachineModel> linked_machine(const LinkedMachine& description,
                                           const Pose& machine_from_workpiece,
                                           Diagnostics& diagnostics);

}  // namespace kerf
