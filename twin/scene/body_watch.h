// twin/scene/body_watch.h - what the tool is near to at a moment, and what it touches.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stock/cutter/cutter.h"
#include "stock/stock_model.h"
#include "twin/collision/tool_bodies.h"
#include "twin/findings/finding.h"
#include "twin/process/check_options.h"
#include "twin/scene/held_bodies.h"
#include "viewer/scene.h"

namespace kerf {

/// A tool as it stands. Which way round it is left open: tools are round.
Pose pose_of(const ToolPose& tool);

/// What may touch, besides the tool and the workpiece.
struct DrawnBodies {
  const std::vector<Fixture>* fixtures = nullptr;     ///< null: there are none
  const std::vector<HoldingBody>* held_by = nullptr;  ///< null: nothing holds a turned workpiece
  const SceneMachine* machine = nullptr;              ///< null: none is drawn
};

/// The collision that a finding tells of, as the viewer marks it: without a place. What holds a
/// turned workpiece counts as fixtures that come after the others. Nothing: it tells of none, or of
/// bodies of which none is drawn.
std::optional<SceneContact> contact_of(const Finding& finding, const DrawnBodies& drawn);

/// For a view of a program or a machine. One thread.
class BodyWatch {
 public:
  /// How far it looks; what is beyond costs little more than nothing.
  static constexpr double kReach_mm = 20;
  /// How long the bodies of a finding stay red, in seconds of who looks on.
  static constexpr double kRed_s = 0.5;

  /// Fixtures, spindle, chuck and tailstock.
  explicit BodyWatch(CollisionWishes wishes);

  /// Null if there are no fixtures.
  const std::vector<Fixture>* fixtures() const { return wishes_.fixtures.get(); }
  std::span<const ToolSection> spindle() const { return wishes_.spindle; }
  /// For SceneUpdate::fixtures; never null, since what was shown before may have had some.
  std::shared_ptr<const SceneMachine> scene() const { return scene_; }
  /// The machine that is drawn, whose links findings may name; null: none.
  /// Fixtures on links that it does not have, and before set_link_poses(), are nowhere.
  void set_machine(std::shared_ptr<const SceneMachine> machine);
  const std::shared_ptr<const SceneMachine>& drawn_machine() const { return machine_; }
  DrawnBodies drawn() const { return {fixtures(), wishes_.held_by.get(), machine_.get()}; }
  const HeldWatch& held() const { return held_; }

  /// In the spindle; null: none that is known. Returns its shape if it is another one than before.
  std::shared_ptr<const ToolShape> mount(const std::shared_ptr<const Cutter>& cutter,
                                         double nose_z_mm);
  /// Of the tool that is mounted; null: it has none such.
  const ToolBody* body_of(ToolPiece piece) const;
  const std::vector<ToolBody>& bodies() const { return bodies_; }
  /// Those that tell of a collision, and when.
  void set_findings(const std::vector<Finding>& findings);
  /// One more, of a machine: it happened at `time_s`. Those whose time is over are forgotten.
  void add_finding(const Finding& finding, double time_s);

  /// Of the machine at this moment, as Moment::link_poses; empty: nobody knows where it stands.
  /// Fixtures on its links go with them.
  void set_link_poses(std::span<const glm::mat4> link_poses);
  /// Of a fixture, to the workpiece frame; none: it is on a link of which that is not known.
  const std::optional<Pose>& place_of(std::size_t fixture) const { return places_[fixture]; }
  /// For Moment::fixture_poses: of fixtures, and of what holds a workpiece that turns.
  const std::vector<glm::mat4>& poses() const { return poses_; }
  /// Clearance and contacts. There is no clearance while a fixture is nowhere, and one that the
  /// tool's own link carries is not looked at. Fixtures are red while the tool is in them, and like
  /// the workpiece from the time of a finding on for kRed_s at `speed` program seconds a second; 0:
  /// it stands still, and the finding is of this very time. `stock`: as it is then; may be null.
  /// About 5 us for a fixture of a few boxes.
  void look(const ToolPose& tool, double time_s, double speed, const StockModel* stock,
            Moment* moment);

 private:
  struct Told {
    double time_s = 0;
    SceneContact contact;
    std::optional<ToolPose> seen_from;  ///< `contact.point_mm` has been looked for there
  };
  void measure(const ToolPose& tool);
  bool measure_fixtures(const Pose& tool, SceneClearance& nearest);
  void measure_held(const Vec3& tip_mm, SceneClearance& nearest);
  std::size_t fixture_count() const { return fixtures() ? fixtures()->size() : 0; }
  bool goes_with_tool(const Fixture& fixture) const;
  void add_told(const ToolPose& tool, double time_s, double speed, const StockModel* stock,
                std::vector<SceneContact>& contacts);

  CollisionWishes wishes_;
  HeldWatch held_;
  std::shared_ptr<const SceneMachine> scene_;
  std::shared_ptr<const SceneMachine> machine_;
  std::vector<std::size_t> link_groups_;     ///< rigid_groups() of the machine that is described
  std::vector<std::optional<Pose>> places_;  ///< of fixtures
  std::vector<glm::mat4> poses_;             ///< the same, and of what stands with the workpiece
  std::shared_ptr<const Cutter> cutter_;
  double nose_z_mm_ = 0;
  bool is_mounted_ = false;
  std::vector<ToolBody> bodies_;
  std::vector<Told> told_;
  std::optional<ToolPose> measured_;  ///< where the two below were found
  std::optional<SceneClearance> clearance_;
  std::vector<SceneContact> touched_;
};

}  // namespace kerf
