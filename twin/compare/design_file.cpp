#include "twin/compare/design_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/placement.h"
#include "base/translate.h"
#include "base/units.h"
#include "mesh/mesh_reader.h"

namespace kerf {
namespace {

Diagnostic said(Severity severity, const std::string& file, std::string message, std::string hint) {
  Diagnostic d;
  d.severity = severity;
  d.file = file;
  d.message = std::move(message);
  d.hint = std::move(hint);
  return d;
}

std::string range_text(const Box& box) {
  return trf("X{:g}..{:g} Y{:g}..{:g} Z{:g}..{:g} mm", box.min.x, box.max.x, box.min.y, box.max.y,
             box.min.z, box.max.z);
}

/// Rounded up to what is worth writing on a command line.
double rounded(double mm) {
  const double out = std::round(mm * 1e4) / 1e4;
  return out == 0 ? 0 : out;
}

}  // namespace

Vec3 DesignPlacement::placed(const Vec3& p) const {
  return Placement::turned(turn_deg).placed(p) + shift_mm;
}

std::string DesignPlacement::text() const {
  std::string out;
  if (turn_deg != Vec3(0))
    out = trf("turned by {:g}, {:g}, {:g} degrees about X, Y, Z", rounded(turn_deg.x),
              rounded(turn_deg.y), rounded(turn_deg.z));
  if (shift_mm != Vec3(0)) {
    if (!out.empty()) out += ", ";
    out += trf("shifted by X{:g} Y{:g} Z{:g} mm", rounded(shift_mm.x), rounded(shift_mm.y),
               rounded(shift_mm.z));
  }
  return out;
}

DesignPart DesignFile::placed(const DesignPlacement& placement, Diagnostics& diagnostics) const {
  if (placement.is_plain()) return {mesh, path, diagnostics};
  TriangleMesh moved = mesh;
  Placement to = Placement::turned(placement.turn_deg);
  to.at_mm = placement.shift_mm;
  for (glm::vec3& p : moved.positions_mm) p = glm::vec3(to.placed(Vec3(p)));
  return {moved, path, diagnostics};
}

std::shared_ptr<const DesignFile> read_design(const std::string& path, double mm_per_unit,
                                              Diagnostics& diagnostics) {
  const std::optional<MeshFormat> format = mesh_format_of(path);
  if (!format) {
    Diagnostic d;
    d.message =
        trf("--compare: {}: designs are read as STL, OBJ, 3MF or STEP; the name must end so", path);
    d.hint = tr("CAD programs export meshes: choose a deviation well below the tolerance");
    diagnostics.push_back(std::move(d));
    return nullptr;
  }
  Result<MeshFromFile> read = read_mesh(path, *format, mm_per_unit, kMostDesignTriangles);
  if (!read || read->mesh.triangles.empty()) {
    Diagnostic d;
    d.message = "--compare: " + (read ? trf("{}: has no triangles", path) : read.error());
    diagnostics.push_back(std::move(d));
    return nullptr;
  }
  auto file = std::make_shared<DesignFile>();
  file->path = path;
  file->mesh = std::move(read->mesh);
  for (const glm::vec3& p : file->mesh.positions_mm) file->box_mm.extend(Vec3(p));
  return file;
}

void doubt_place(const DesignPart& design, const std::string& path, const Box& blank,
                 double tolerance_mm, Diagnostics& diagnostics) {
  const Box part = design.box_mm();
  bool is_apart = false, is_within = true, has_room = true, is_small = true, is_large = false;
  Vec3 shift(0);
  for (int axis = 0; axis < 3; ++axis) {
    const double size = part.size()[axis], room = blank.size()[axis];
    is_apart |= part.min[axis] > blank.max[axis] || part.max[axis] < blank.min[axis];
    is_within &= part.min[axis] >= blank.min[axis] - tolerance_mm &&
                 part.max[axis] <= blank.max[axis] + tolerance_mm;
    has_room &= size <= room + 2 * tolerance_mm;
    is_small &= size * kMmPerInch <= 1.5 * room;
    is_large |= size >= 0.5 * kMmPerInch * room;
    if (part.min[axis] < blank.min[axis]) {
      shift[axis] = rounded(blank.min[axis] - part.min[axis]);
    } else if (part.max[axis] > blank.max[axis]) {
      shift[axis] = rounded(blank.max[axis] - part.max[axis]);
    }
  }
  const std::string where = trf("{}; the blank is {}", range_text(part), range_text(blank));
  if (is_small) {
    diagnostics.push_back(said(Severity::kWarning, path,
                               trf("is so small that its unit may be the inch: {}", where),
                               tr("--compare-unit inch reads it so")));
    return;
  }
  if (is_large && !has_room) {
    diagnostics.push_back(
        said(Severity::kWarning, path,
             trf("is so large that its numbers may be of another unit: {}", where),
             tr("export it in mm")));
    return;
  }
  if (is_within) return;
  std::string hint = tr("it is taken in the coordinates that the program writes");
  if (has_room) {
    hint = trf("--compare-at {:g},{:g},{:g} puts it inside", shift.x, shift.y, shift.z);
  }
  diagnostics.push_back(said(Severity::kWarning, path,
                             is_apart ? trf("lies beside the blank: {}", where)
                                      : (has_room ? trf("lies partly outside the blank: {}", where)
                                                  : trf("is larger than the blank: {}", where)),
                             std::move(hint)));
}

}  // namespace kerf
