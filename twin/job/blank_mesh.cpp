#include "twin/job/blank_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/translate.h"
#include "base/units.h"
#include "mesh/mesh_body.h"
#include "mesh/mesh_lines.h"
#include "mesh/mesh_offset.h"
#include "mesh/mesh_reader.h"

namespace kerf {
namespace {

/// What is smaller is seldom milled: it may be in inches.
constexpr double kSmall_mm = 10;
/// No machine that LinuxCNC runs has room for what is larger: it may be of another unit.
constexpr double kLarge_mm = 5000;

void tell_of_mesh(Diagnostics& diagnostics, Severity severity, const std::string& file,
                  std::string message, std::string hint = {}) {
  Diagnostic d;
  d.severity = severity;
  d.file = file;
  d.message = std::move(message);
  d.hint = std::move(hint);
  diagnostics.push_back(std::move(d));
}

bool refuse_mesh(Diagnostics& diagnostics, std::string message, std::string hint = {}) {
  Diagnostic d;
  d.message = "--stock: " + std::move(message);
  d.hint = std::move(hint);
  diagnostics.push_back(std::move(d));
  return false;
}

void doubt_unit(const BlankMesh& blank, MeshFormat format, const Box& box,
                Diagnostics& diagnostics) {
  const Vec3 size = box.size();
  const double largest = std::max({size.x, size.y, size.z});
  if (blank.unit || format == MeshFormat::k3mf || format == MeshFormat::kStep) return;
  const std::string text = fmt::format("{:.4g} x {:.4g} x {:.4g} mm", size.x, size.y, size.z);
  if (largest < kSmall_mm) {
    tell_of_mesh(diagnostics, Severity::kNote, blank.file, trf("is {} large; in inches?", text),
                 tr(":inch behind the file takes its numbers for inches, :mm keeps this quiet"));
  } else if (largest > kLarge_mm) {
    tell_of_mesh(diagnostics, Severity::kNote, blank.file,
                 trf("is {} large; are its numbers of another unit?", text),
                 tr("export it in mm; :mm behind the file keeps this quiet"));
  }
}

}  // namespace

bool read_blank_mesh(Blank& blank, Diagnostics& diagnostics) {
  if (!blank.mesh || blank.mesh->body) return true;
  BlankMesh& said = *blank.mesh;
  const std::optional<MeshFormat> format = mesh_format_of(said.file);
  if (!format)
    return refuse_mesh(diagnostics, trf("{}: is no mesh; allowed: STL, OBJ, 3MF, STEP", said.file));
  const double unit_mm = said.unit == LengthUnit::kInch ? kMmPerInch : 1;
  Result<MeshFromFile> read = read_mesh(said.file, *format, unit_mm, kMostBlankTriangles);
  if (!read) return refuse_mesh(diagnostics, read.error());
  if (read->flat > 0) {
    tell_of_mesh(diagnostics, Severity::kNote, said.file,
                 trf("has triangles without area; they are left out: {}", read->flat));
  }
  Box as_read;
  const Placement place = said.place.placement();
  for (glm::vec3& p : read->mesh.positions_mm) {
    as_read.extend(Vec3(p));
    p = glm::vec3(place.placed(Vec3(p)));
  }
  Result<MeshBody> body = mesh_body(std::move(read->mesh), said.file);
  if (!body) {
    return refuse_mesh(
        diagnostics, body.error(),
        tr("export the part as one solid, or repair the mesh (the CAD program's mesh "
           "repair, a slicer)"));
  }
  if (body->was_turned) {
    tell_of_mesh(diagnostics, Severity::kNote, said.file,
                 tr("is inside out (all normals point inwards); it is turned"));
  }
  doubt_unit(said, *format, as_read, diagnostics);
  if (said.allowance_mm > 0) {
    body = grown(*body, said.allowance_mm, said.file);
    if (!body) return refuse_mesh(diagnostics, body.error());
  }
  said.body = std::make_shared<const MeshBody>(std::move(body.value()));
  return true;
}

std::string need_of_mesh(const Blank& blank) {
  if (!blank.mesh || !blank.mesh->body || blank.mesh->body->is_height_field()) return {};
  return trf("the mesh has undercuts: {:.4g} mm2 of it face down, the most of that from Z{:.4g} up",
             blank.mesh->body->overhang_mm2, blank.mesh->body->overhang_z_mm);
}

SolidPointer solid_of(const Blank& blank) {
  if (blank.mesh && blank.mesh->body) return Solid::of_mesh(blank.mesh->body->mesh);
  return blank.bodies.empty() ? nullptr : Solid::of_bodies(blank.bodies);
}

BlankShadow::BlankShadow(const MeshBody& body, double cell_mm) : bounds_mm_(body.box_mm) {
  const Vec3 size = bounds_mm_.size();
  nx_ = static_cast<int>(std::ceil(size.x / cell_mm));
  ny_ = static_cast<int>(std::ceil(size.y / cell_mm));
  const MeshLines lines(body.mesh, 2, {bounds_mm_, nx_, ny_});
  covered_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
  for (std::size_t cell = 0; cell < covered_.size(); ++cell)
    covered_[cell] = !lines.ends(cell).empty();
}

double BlankShadow::cell_mm() const {
  return std::min(bounds_mm_.size().x / nx_, bounds_mm_.size().y / ny_);
}

bool BlankShadow::covers(double x_mm, double y_mm) const {
  const double i = std::floor((x_mm - bounds_mm_.min.x) / bounds_mm_.size().x * nx_);
  const double j = std::floor((y_mm - bounds_mm_.min.y) / bounds_mm_.size().y * ny_);
  if (!(i >= 0 && i < nx_ && j >= 0 && j < ny_)) return false;
  return covered_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) +
                  static_cast<std::size_t>(i)];
}

}  // namespace kerf
