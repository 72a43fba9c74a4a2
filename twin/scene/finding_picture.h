// twin/scene/finding_picture.h - pictures of findings: part, tool, fixtures, and where they touch.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "stock/cutter/cutter.h"
#include "stock/stock_model.h"
#include "twin/findings/finding.h"
#include "twin/machines/machine_model.h"
#include "twin/process/check_options.h"
#include "viewer/picture.h"
#include "viewer/scene.h"

namespace kerf {

/// A finding that has a place, and what was there at that time.
struct FindingShot {
  Finding finding;
  std::string place;    ///< for the caption: "part.ngc:12"; may be empty
  std::string message;  ///< message_of() and what to do, in the units of who reads it
  std::shared_ptr<const StockModel> stock;
  std::shared_ptr<const Cutter> cutter;  ///< null: none that is known
  double nose_z_mm = 0;                  ///< of the spindle above the tip; 0: not known
  ToolPose tool;
  /// Of the links of the machine that is drawn, as Moment::link_poses; empty: not known.
  std::vector<glm::mat4> link_poses;
};

/// "01-fixture-contact-line-12.png"; of the finding in that place of the list, from 1 on.
std::string finding_picture_name(std::size_t number, const Finding& finding);

/// Draws them by the window's renderer, without a display. One thread, which must not have another
/// OpenGL context.
class FindingPictures {
 public:
  /// `wishes`: the fixtures and the spindle that the checks had. `machine`: null: none is drawn,
  /// nor fixtures that stand on its links. Error: no OpenGL, and why. `size_px`: each at least 64.
  static Result<FindingPictures> create(CollisionWishes wishes,
                                        std::shared_ptr<const MachineModel> machine = nullptr,
                                        glm::ivec2 size_px = glm::ivec2(1280, 960));
  FindingPictures(FindingPictures&&) noexcept;
  FindingPictures& operator=(FindingPictures&&) noexcept;
  ~FindingPictures();

  /// The tool with its holder, and what of fixtures and workpiece is about it; where links of the
  /// machine touch something, these too, and the rest of it as glass. Both bodies are red
  /// (amber if they only come near), a ring marks where they touch, once more and larger in a
  /// corner, a caption says what, the file and the line. Seen from the side on which the workpiece
  /// does not hide the place; where it does on all sides, it is seen through. On a lathe straight
  /// from the front, Z to the right and X up, and cut open where they touch within the workpiece.
  /// About a second on a core without a graphics card; less for workpieces that share tiles with
  /// the one before. Error: OpenGL failed.
  Result<Picture> draw(const FindingShot& shot);

 private:
  class Impl;
  explicit FindingPictures(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
