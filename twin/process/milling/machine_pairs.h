// twin/process/milling/machine_pairs.h - the bodies of a machine at work, and which of them are
// held against each other.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stock/cutter/cutter.h"
#include "twin/collision/tool_bodies.h"
#include "twin/findings/finding.h"
#include "twin/machines/machine_bodies.h"
#include "twin/machines/machine_run.h"
#include "twin/process/check_options.h"
#include "twin/process/collision_table.h"

namespace kerf {

/// A link, a fixture, the workpiece, a part of the tool: rigid, on a link of the machine.
struct WorkingBody {
  enum class Kind : std::uint8_t { kLink, kFixture, kWorkpiece, kToolPart };
  Kind kind = Kind::kLink;
  std::string name;  ///< as rules and reports have it
  ToolPart part = ToolPart::kCutter;
  std::size_t link = 0;
  /// Of fixtures and the workpiece that are given in the program's coordinates: in that frame, on
  /// the workpiece's link.
  bool by_program = false;
  Pose frame_from_body;  ///< in its link's frame, or the program's
  Pose link_from_body;
  std::vector<SolidPointer> solids;
  std::optional<double> clearance_mm;  ///< of a fixture
  double reach_mm = 0;                 ///< from its origin
  bool has_triangles = false;
  bool has_depth = false;   ///< some of it is no mesh: it can be measured how deep it goes
  bool has_closed = false;  ///< some of it is a closed surface
  std::size_t pieces = 0;

  /// For sentences.
  std::string shown() const;
};

/// Two bodies, and what is known of how near they came.
struct WorkingPair {
  std::uint32_t moving = 0, still = 0;  ///< bodies; the workpiece is always the still one
  ToolChain chain;                      ///< from the link of the still one to that of the other
  CollisionPair row;
  std::string sentence_a, sentence_b;  ///< the bodies
  FindingId id = FindingId::kMachineCollision;
  double near_mm = 0;  ///< what counts as near
  bool of_links = false;
  bool with_workpiece = false;
  bool guessed_tool = false;

  double least_mm = std::numeric_limits<double>::infinity();
  /// No nearer than this while the axes stand at `seen_at`; below 0: nobody knows.
  double spare_mm = -1;
  AxisValues seen_at{};
  bool stood = false;     ///< it has been looked at where the machine first stood
  bool overlaps = false;  ///< since then: nothing is told until they are apart
  bool dead = false;      ///< two links that overlap from the start: nothing is told
  std::optional<FindingLog::Handle> event;
  double depth_mm = 0;           ///< of the event
  std::uint64_t touched_in = 0;  ///< the last motion on which they touched
  Finding nearest;               ///< place of the least clearance
};

/// All that there is, and the pairs that are worth a look. The tool's parts come and go.
class MachinePairs {
 public:
  /// The workpiece's box, in the program's coordinates.
  void set(const CollisionWishes& wishes, const Box& workpiece_mm);
  /// The program's coordinates on the workpiece's link; memory of distances is gone.
  void place(const Pose& link_from_program, std::string_view joint_letters);
  /// Empties and fills the spindle.
  void mount(const Cutter& cutter, int tool, bool guessed, double nose_mm);
  void unmount();
  /// Where the tip is on the tool's link. True: it was elsewhere, and what was known of the tool's
  /// distances is gone.
  bool hang_tool(const Vec3& tip_from_nose);

  const std::vector<WorkingBody>& bodies() const { return bodies_; }
  /// Of a body on a link that the workpiece's link carries without a joint between: where it stands
  /// in the program's coordinates. None: it moves against the workpiece.
  std::optional<Pose> beside_workpiece(const WorkingBody& body,
                                       const Pose& program_from_link) const;
  /// Those with what is in the spindle now.
  std::vector<WorkingPair*>& active() { return active_; }
  std::vector<std::unique_ptr<WorkingPair>>& all() { return pairs_; }
  const std::vector<std::unique_ptr<WorkingPair>>& all() const { return pairs_; }
  /// How deep they go into each other is measured: one of them has boxes or bodies of revolution,
  /// or both closed surfaces.
  bool knows_depth(const WorkingPair& pair) const;
  /// From the tip to the top of what is known of the tool; 0: nothing says where it ends.
  double tool_mm() const { return tool_mm_; }
  bool has_tool() const { return bodies_.size() > lasting_; }
  const KinematicChain& chain() const { return wishes_.machine->chain; }

 private:
  void add(WorkingBody body);
  void pair_up(std::uint32_t a, std::uint32_t b, int tool, bool guessed);
  bool may_meet(const WorkingBody& a, const WorkingBody& b) const;
  void describe(WorkingPair& pair, const WorkingBody& a, const WorkingBody& b) const;
  WorkingPair* known(int tool, const WorkingBody& a, const WorkingBody& b) const;
  void make_chain(WorkingPair& pair) const;

  CollisionWishes wishes_;
  std::vector<std::size_t> groups_;
  std::vector<WorkingBody> bodies_;
  std::size_t lasting_ = 0;  ///< of them, those that are no tool's
  std::vector<std::unique_ptr<WorkingPair>> pairs_;
  std::vector<WorkingPair*> active_;
  std::string joint_letters_;
  Vec3 tip_from_nose_{std::numeric_limits<double>::quiet_NaN()};
  double tool_mm_ = 0;
};

}  // namespace kerf
