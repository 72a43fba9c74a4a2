// twin/machines/builtin_parts.h - what the built-in machines share. For the sources of
// builtin_machine() only.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/machines/builtin_models.h"
#include "twin/machines/mesh_builder.h"

namespace kerf {

/// A room with nothing left open, in machine coordinates.
struct FittedRoom {
  Box blank_mm;  ///< In the frame of the workpiece link at rest.
  Vec3 nose_min_mm{0.0};
  Vec3 nose_max_mm{0.0};
  double tool_length_mm = 0.0;
  std::optional<ChuckRoom> chuck;  ///< Likewise.

  Vec3 blank_middle() const { return 0.5 * (blank_mm.min + blank_mm.max); }
  Vec3 travel() const { return nose_max_mm - nose_min_mm; }
};

/// Fills in travels, and widens those that do not reach the blank. `nose_from_tip`: of the machine.
FittedRoom fit(const MachineRoom& room, const Vec3& nose_from_tip);

/// 0xAABBGGRR.
namespace paint {
inline constexpr std::uint32_t kCasting = 0xff8f9a86;  // grey-green
inline constexpr std::uint32_t kCastingDark = 0xff6f7a68;
inline constexpr std::uint32_t kIron = 0xffb4b2ae;  // ground surfaces
inline constexpr std::uint32_t kSteel = 0xffc6c4c0;
inline constexpr std::uint32_t kDarkSteel = 0xff78746f;
inline constexpr std::uint32_t kAluminium = 0xffcfcbc6;
inline constexpr std::uint32_t kAccent = 0xff4a86c8;  // orange-brown: what carries the tool
inline constexpr std::uint32_t kBlue = 0xffa07a50;
inline constexpr std::uint32_t kGlass = 0x70a89a8c;  // lets the sheet be seen
}  // namespace paint

/// Collects links with their meshes.
class MachineAssembly {
 public:
  /// Of `mesh`, in the link's frame.
  void add(ChainLink link, TriangleMesh mesh, std::uint32_t color) {
    drawn_.push_back({link.name, std::make_shared<const TriangleMesh>(std::move(mesh)), color});
    links_.push_back(std::move(link));
  }
  void fixed(std::string name, MeshBuilder mesh, std::uint32_t color, std::string parent = {});
  void slide(std::string name, std::string parent, std::size_t axis, const Vec3& direction,
             MeshBuilder mesh, std::uint32_t color);

  MachineModel finish(std::string name, std::string_view workpiece, std::string_view tool,
                      const Pose& machine_from_workpiece, const Vec3& nose_from_tip);

 private:
  std::vector<ChainLink> links_;
  std::vector<LinkShape> drawn_;
};

/// Between a table at its hindmost and the column.
inline constexpr double kGapBehindTable_mm = 25.0;
/// Table of a mill whose table moves, seen from above (z is left open): as large as such machines
/// have it for their travel, at least as given, and around the blank.
Box table_around(const FittedRoom& room, double least_x_mm, double least_y_mm);
/// A table with T-slots along X, its upper face at box.max.z.
void add_slotted_table(MeshBuilder& mesh, const Box& box);
/// Rims, face and taper of a milling spindle: from the nose at `nose` up by `length_mm`.
void add_spindle_nose(MeshBuilder& mesh, const Vec3& nose, double radius_mm, double length_mm);
/// A wheel with a crank, its shaft along `axis` from `base` by length_mm (either sign).
void add_handwheel(MeshBuilder& mesh, const Vec3& base, int axis, double radius_mm,
                   double length_mm);

MachineModel build_knee_mill(const MachineRoom& room);
MachineModel build_gantry(const MachineRoom& room);
MachineModel build_plasma(const MachineRoom& room);
MachineModel build_lathe(const MachineRoom& room);
MachineModel build_trunnion(const MachineRoom& room);
MachineModel build_bridge_mill(const MachineRoom& room);
MachineModel build_swivel_mill(const MachineRoom& room);
MachineModel build_punch(const MachineRoom& room);

}  // namespace kerf
