// viewer/window/scene_renderer.h - draws the scene; redraws no more of it than has changed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/orbit_camera.h"
#include "viewer/picture.h"
#include "viewer/scene.h"
#include "viewer/section.h"
#include "viewer/window/screen_rect.h"
#include "viewer/window/units.h"

namespace kerf {

enum class SceneObject {
  kWorkpiece,
  kCutter,
  kHolder,  ///< and shank, and spindle
  kTraverses,
  kFeeds,
  kPlanned,
  kBlank,
  kFrames,
  kFindings,
  kMachine,
  kFixtures,
};
inline constexpr std::size_t kSceneObjectCount = 11;

struct ObjectLook {
  bool is_visible = true;
  float opacity = 1.0f;  ///< 0.05 .. 1
  bool operator==(const ObjectLook&) const = default;
};

/// What DrawOptions::color_by is about, where it goes by moves.
enum class ColorTarget { kSurface, kBoth, kPath };

struct DrawOptions {
  /// As far as its values have come, else by mesh. Only the mesh has colours, section and
  /// deviations.
  DrawMode draw_mode = DrawMode::kMesh;
  std::array<ObjectLook, kSceneObjectCount> looks{};
  std::optional<SectionPlane> section;
  /// Beside `section`: what is taken away lies beyond both.
  std::optional<SectionPlane> section_beside;
  /// Of the workpiece. Those that go by moves show the CutColors that came last, when their mode is
  /// this one, and patches with MeshPatch::cut_by; kDeviation those with deviation_mm. All else is
  /// drawn plainly: what is left of the blank darker, where patches tell.
  ColorBy color_by = ColorBy::kPlain;
  ColorTarget color_on = ColorTarget::kSurface;
  /// Deviations up to this are green; from twice this on, the colour is full.
  double tolerance_mm = 0.05;
  bool is_dark = false;  ///< The background.
  /// Of the path only so many segments behind the tool are drawn, fading; 0: all, and what comes.
  std::size_t path_tail = 0;
  /// Redraw only what changed while the camera stands still. Off: everything, every time; for
  /// measuring and for doubtful drivers.
  bool is_local = true;
  /// Of patches and path taken to the card per frame; a first patch is taken whatever its size.
  std::size_t upload_bytes_per_frame = 4u << 20;
  bool operator==(const DrawOptions&) const = default;
};

/// What drawing cost so far. Milliseconds are those of the graphics card (or of the software
/// renderer), known some frames later.
struct DrawCounters {
  struct Kind {
    std::uint64_t frames = 0;
    std::uint64_t pixels = 0;     ///< of the kept scene
    std::uint64_t triangles = 0;  ///< of the workpiece
    double ms = 0.0;
  };
  Kind full;                       ///< everything was drawn
  Kind local;                      ///< a rectangle was drawn
  Kind still;                      ///< nothing but the tool, if that
  ScreenRect last_rect;            ///< that was drawn last
  std::uint64_t shown_pixels = 0;  ///< copied, and tool and machine drawn over them
  std::uint64_t uploaded_bytes = 0;
  std::size_t waiting_bytes = 0;
  std::size_t gpu_bytes = 0;  ///< of the scene's meshes, colours and framebuffers, now
};

/// Keeps colour and depth of the scene without tool and machine in a framebuffer of its own:
///
///     kept    workpiece, path, outlines      drawn again where they changed: by the boxes of the
///       |                                    triangles that did, projected, as a scissor rectangle
///     shown   a copy, and the tool and the   copied again where kept changed and where those were
///       |     machine over it                or are
///     window or picture
///
/// A transparent workpiece is kept beside, its nearest surface only, and laid over the shown tool:
/// what is in it or behind it is seen through it, once. Redrawing a rectangle gives the same pixels
/// as redrawing everything. Needs a current OpenGL 3.3 context, from create() to the destructor;
/// leaves blending, depth and scissor test off.
class SceneRenderer {
 public:
  /// `wake`: called from another thread when has_waiting() may have become true.
  static Result<SceneRenderer> create(std::function<void()> wake = {});
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;
  ~SceneRenderer();

  /// Takes over the values; what is for the card waits there for its turn in draw().
  void apply(const SceneUpdate& update);

  /// From now on fewer pixels may be drawn while the eye moves (ScenePace), the full picture when
  /// it stands still: has_waiting() until then. For a window; without, every draw() is in full.
  void keep_pace();

  /// Draws as the scene is now. Error: the size is more than this OpenGL can do, the memory of the
  /// card is full, or the context is lost (the driver was reset); the message says which.
  Done draw(const Projection& projection, const DrawOptions& options);

  /// Patches, path or a picture of the workpiece wait for the next frame: draw again although
  /// nothing new came.
  bool has_waiting() const;
  /// The picture last drawn is that of the eye last asked for, in all of its pixels.
  bool is_full() const;
  /// In which draw mode the workpiece was drawn last, and as seen how: by rays that may be as it
  /// was asked for some frames before.
  DrawMode drawn_mode() const;
  const Projection& projection() const;

  /// What the colours of the workpiece last drawn mean; empty if nothing.
  std::vector<ColorLegendEntry> legend(const Measures& measures = Measures(LengthUnit::kMm)) const;

  /// The pixels that draw() may have changed since the last call.
  ScreenRect take_changed();
  /// Copies a rectangle of the picture last drawn to a framebuffer, in which the lower left corner
  /// of the picture is at the pixel `corner_px` (counted from the lower left). One of fewer pixels
  /// is blown up.
  void show_in(unsigned framebuffer, glm::ivec2 corner_px, const ScreenRect& rect) const;
  /// Waits until the card has drawn everything; for measuring.
  void finish() const;
  /// Version and renderer: "OpenGL 4.5 (Core Profile) Mesa 22.3.6, llvmpipe (...)".
  static std::string gl_name();
  /// Pixels that the smallest detail of the workpiece need have: 1, or 2 where the processor draws,
  /// which has a quarter of the triangles to draw then.
  static double detail_px();
  /// DetailCommand::easy_triangles. Where the processor draws, twice as many, with what lies
  /// about them, take two slow cores longer than a sixtieth of a second.
  static std::size_t easy_triangles();
  /// The picture last drawn, of the pixels that it has.
  Picture read() const;
  /// The point of the scene (not of the tool) at a pixel from the upper left; none on background.
  std::optional<Vec3> pick(glm::ivec2 px) const;

  /// What "fit" shows: the bounds of the setup, else of the workpiece and the path. Maybe empty.
  Box fit_box() const;
  /// For the depth range of the camera; grows in large steps, since each step is a full redraw.
  /// Never empty.
  const Box& depth_box() const;
  const DrawCounters& counters() const;
  void reset_counters();

 private:
  class Impl;
  explicit SceneRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kerf
