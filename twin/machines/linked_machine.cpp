#include "twin/machines/linked_machine.h"

#include <fmt/format.h>

#include <cmath>

#include "base/translate.h"
#include "mesh/stl_mesh.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {
namespace {

void report(Diagnostics& diagnostics, std::string message) {
  Diagnostic diagnostic;
  diagnostic.message = std::move(message);
  diagnostics.push_back(std::move(diagnostic));
}

std::optional<TriangleMesh> shape_of(const LinkSpec& link, Diagnostics& diagnostics) {
  MeshBuilder shape;
  for (const BlankBody& body : link.bodies) shape.add(mesh_of(body), Pose{});
  if (!link.stl_path.empty()) {
    const std::optional<TriangleMesh> stl = stl_of(link, diagnostics);
    if (!stl) return std::nullopt;
    shape.add(*stl, Pose{});
  }
  return shape.take();
}

}  // namespace

std::optional<TriangleMesh> stl_of(const LinkSpec& link, Diagnostics& diagnostics) {
  Result<TriangleMesh> stl = read_stl(link.stl_path, link.mm_per_unit);
  if (!stl) {
    report(diagnostics,
           trf("the link '{}' of the machine cannot be read: {}", link.chain.name, stl.error()));
    return std::nullopt;
  }
  for (glm::vec3& corner : stl->positions_mm) corner += glm::vec3(link.mesh_offset_mm);
  return std::move(stl.value());
}

TriangleMesh mesh_of(const BlankBody& body) {
  MeshBuilder mesh;
  const Box& bounds = body.bounds_mm;
  if (body.kind == BlankBody::Kind::kBox) {
    mesh.box(bounds.min, bounds.max);
    return mesh.take();
  }
  const int axis = body.axis - 'x';
  const double inner = body.kind == BlankBody::Kind::kTube ? body.inner_diameter_mm / 2 : 0.0;
  const double outer = body.diameter_mm / 2;
  const double length = bounds.size()[axis];
  Vec3 base = body.center_mm;
  base[axis] = bounds.min[axis];
  const std::array<Vec2, 4> outline{Vec2(inner, 0), Vec2(outer, 0), Vec2(outer, length),
                                    Vec2(inner, length)};
  mesh.turned(base, axis, outline);
  return mesh.take();
}

std::vector<ChainLink> LinkedMachine::links_of_chain() const {
  std::vector<ChainLink> chain;
  for (const LinkSpec& link : links) chain.push_back(link.chain);
  return chain;
}

void check_shapes(const LinkedMachine& description, Diagnostics& diagnostics) {
  for (const LinkSpec& link : description.links) shape_of(link, diagnostics);
}

std::optional<MachineModel> linked_machine(const LinkedMachine& description,
                                           const Pose& machine_from_workpiece,
                                           Diagnostics& diagnostics) {
  std::vector<LinkShape> drawn;
  bool complete = true;
  for (const LinkSpec& link : description.links) {
    std::optional<TriangleMesh> shape = shape_of(link, diagnostics);
    complete = complete && shape.has_value();
    if (!complete) continue;
    drawn.push_back(
        {link.chain.name, std::make_shared<const TriangleMesh>(std::move(*shape)), link.color});
  }
  if (!complete) return std::nullopt;
  Result<KinematicChain> chain = KinematicChain::create(
      description.links_of_chain(), description.workpiece_on, description.tool_on);
  if (!chain) {
    report(diagnostics, trf("the machine's links: {}", chain.error()));
    return std::nullopt;
  }
  const Pose link_from_workpiece = link_from_workpiece_of(*chain, machine_from_workpiece);
  return MachineModel{"machine", std::move(chain.value()), std::move(drawn), link_from_workpiece,
                      Vec3(0, 0, 1)};
}

}  // namespace kerf
