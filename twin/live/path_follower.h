// twin/live/path_follower.h - where on the programmed path a machine is, from where its tip is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "interp_bridge/motion.h"
#include "twin/live/rounded_corner.h"
#include "twin/machine/kinematics/machine_kinematics.h"
#include "twin/machine/timeline.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {

struct FollowOptions {
  /// A tip this near to the path is on it. mm.
  double tolerance_mm = 0.5;
  /// Of several places that the tip may be at, the first is taken that is this much worse than the
  /// best. mm.
  double ambiguity_mm = 0.02;
  /// How much faster than planned the machine may run: feed override, and errors of the model.
  double haste = 2.5;
  /// And how far ahead of the plan it may be besides. s.
  double slack_s = 0.1;
  /// An axis that is off by an angle is off by the way of a point so far from its line. mm.
  double lever_mm = 50;
};

/// A place in the numbers of a program (SamplePose).
struct ProgramPose {
  Vec3 tip_mm{0};
  std::array<double, 3> abc_deg{};
  Vec3 along_tool{0, 0, 1};  ///< the tip of a tool that is 1 mm longer is at tip_mm less this
  Vec3 uvw_mm{0};
};

/// What of the machine is needed to find it on the path.
struct MatchQuery {
  ProgramPose here;
  std::array<bool, 3> abc_known{};  ///< those that are not are not compared
  std::array<bool, 3> uvw_known{};
  /// Of a machine that may switch its kinematics, or of a robot: the same place in the numbers of
  /// each type. Null: `here` is one for all.
  const MachineKinematics* machine = nullptr;
  std::array<ProgramPose, kMostKinematicsTypes> by_type{};
  /// The tip is where a tool of no length would have it: the lengths are those that the program
  /// has in force (Motion::tool_offset_mm, Z).
  bool without_length = false;
  /// The tip is that of the offset which the controller applies: where a program's is not the
  /// tool's length, the tip is as far off as the program's (ToolLengthState::tip_shift_mm).
  bool applied_length = false;
  double elapsed_s = 0;  ///< since the place before
  int line = -1;         ///< program line that the machine says it is on; < 1: it does not say
  int tool = -1;         ///< tool number that it says is in the spindle; -1: it does not say
};

/// The place, if the machine is on this motion. A robot's A B C are the turns that are nearest to
/// those of the motion (nearest_turns()).
ProgramPose place_on(const Motion& motion, const MatchQuery& place);

/// Angles of the same attitude (roll, pitch, yaw) that are nearest to others.
std::array<double, 3> nearest_turns(const std::array<double, 3>& abc_deg,
                                    const std::array<double, 3>& to_deg);

/// Where the tip was found.
struct PathMatch {
  bool on_path = false;
  bool in_reach = false;  ///< as far on as the machine can have come; else by its line alone
  RoundedCorner corner = RoundedCorner::kNone;  ///< of a tip that is not on the path
  double distance_mm = 0;  ///< from the path; of a tip that is not on it: from the nearest point of
                           ///< the part that was searched; infinite: there is no path to search
  ProgramPose place;       ///< on the path
  Vec3 tip_shift_mm{0};    ///< of a wrong tool length there; in `place` already
  ToolLengthState length;  ///< of the program there
  std::optional<double> stated_length_mm;  ///< the program itself says it (kStated), in Z
  int kinematics_type = 0;                 ///< in force there, by the program
  std::array<bool, 3> turned{};            ///< A, B, C: the program has turned it, up to there
  std::array<bool, 3> slid{};              ///< U, V, W: the program has moved it
  double tool_length_mm = 0;               ///< in force there, by the program
  int tool = 0;                            ///< in the spindle there, by the program
  SourceRef source;                        ///< of the motion there
  double program_s = 0;                    ///< program time there, by the plan
  /// Number of the motion there, of all that have been appended; and how far on it: a share of its
  /// way, or of that of the planned piece.
  std::uint64_t motion = 0;
  double share = 0;
};

/// Follows a machine along a program, forward only. In the numbers of the program, X Y Z A B C:
/// what turns counts as FollowOptions::lever_mm says, once the program has turned it (before that
/// a program knows no more of where it stands than that it stands). The path is given piece by
/// piece as the interpreter and the planner yield it; what the machine has passed is forgotten, so
/// memory is that of the look-ahead.
///
/// A tip is looked for from the last point found on, as far as the machine can have come in the
/// time that has passed (FollowOptions::haste). Among equally good places the first is taken: the
/// follower may lag, it never runs ahead of the machine. Where the machine names its line, places
/// on that line go first, and one that was out of sight is looked for on its line as far ahead as
/// the path is known. Motions of another tool are beyond reach until the machine says that it
/// has changed.
///
/// One that was out of sight may have passed the first place that it fits: a drill goes up and down
/// the same hole. When it then leaves the path there, and is exactly on it where it can have come
/// to, it is there.
class PathFollower {
 public:
  explicit PathFollower(const FollowOptions& options) : options_(options) {}

  /// The next step of the program, as Timeline gives it. Steps that do not move, or whose start is
  /// not known, are no path.
  void append(const Motion& motion, const TimedStep& timed, std::span<const PathPiece> path);

  /// Looks for the tip. If it is on the path, the path up to there has been `driven`: each call one
  /// piece of it or part of one, in order, without gaps from where the last one ended; the first
  /// time, from the path's beginning, whether or not the machine has been seen there.
  struct DrivenPart {
    Motion motion;
    double duration_s = 0;       ///< by the plan
    bool of_same_piece = false;  ///< of which the part before was one
  };
  using Drive = std::function<void(const DrivenPart& part)>;
  PathMatch follow(const MatchQuery& place, const Drive& drive);

  /// The machine is at or behind `program_s`: what lies before is passed without being driven.
  void begin_at(double program_s);
  /// The machine has been on the path.
  bool found() const { return found_; }
  /// Program time of the point found last; of the path's beginning before that. s.
  double program_s() const;
  /// Program time of the end of what has been appended.
  double end_s() const { return end_s_; }
  bool passed_all() const;
  /// Within the next seconds of its path it is on this line of the program, or in another file,
  /// whose lines nobody knows.
  bool comes_to(int line) const;
  /// Time in motion from the point found last to the end of what has been appended. s.
  double left_s() const;

 private:
  struct Piece {
    Motion motion;
    double start_s = 0;  ///< program time
    double duration_s = 0;
    double moved_s = 0;            ///< time in motion before it: without dwells and tool changes
    std::uint64_t number = 0;      ///< of its motion
    std::array<bool, 3> turned{};  ///< the program has turned the axis by its end
    std::array<bool, 3> slid{};    ///< or moved U, V, W
    WayInTime way;
    /// Of its time, until so much of its way is done.
    double spent_s(double t) const { return way.time_of(t) * duration_s; }
    double time_at(double t) const { return start_s + spent_s(t); }
    /// Of its way, that can have been gone when the machine has been in motion for so long; 0 to 1.
    /// A machine need not be as slow at the start as the plan, or wait as long.
    double share_at(double time_moved_s) const {
      if (time_moved_s - moved_s >= duration_s) return 1;
      const double time = std::max(0.0, (time_moved_s - moved_s) / duration_s);
      return std::max(time, way.way_of(time));
    }
  };
  struct Candidate {
    std::size_t piece = 0;
    double t = 0;
    double distance_mm = std::numeric_limits<double>::infinity();
  };
  void add(const Motion& motion, const TimedStep& timed);
  /// The part of the path in which a tip is looked for: from where the machine was last.
  struct Reach {
    std::size_t end = 0;  ///< one past the last piece
    /// Time in motion (Piece::moved_s) up to which the machine can have come.
    double latest_s = std::numeric_limits<double>::infinity();
  };
  PointOnWay nearest_of(const Piece& piece, const MatchQuery& place, double from_t,
                        double to_t) const;
  Reach reach(const MatchQuery& place, double hidden_s) const;
  std::optional<Candidate> search_hidden(const MatchQuery& place, int line, const Candidate& at);
  void note_hidden(double latest_s, const Candidate& at);
  int told_line(const MatchQuery& place) const;
  bool has_line(int line) const;
  std::optional<Candidate> search(const MatchQuery& place, const Reach& reach, int line,
                                  int tool) const;
  RoundedCorner corner_at(const Candidate& at, const MatchQuery& place) const;
  void drive_to(const Candidate& to, const Drive& drive);

  FollowOptions options_;
  std::deque<Piece> pieces_;
  double t_ = 0;         ///< on pieces_[0]
  double unseen_s_ = 0;  ///< since the machine was last found on the path
  /// The machine may be so much farther on than it was found, in time of motion, as it had been out
  /// of sight; and how long ago that was. s.
  double hidden_s_ = 0;
  double seen_s_ = 0;
  double end_s_ = 0;
  double moved_s_ = 0;          ///< time in motion of all that was appended
  std::uint64_t appended_ = 0;  ///< motions
  bool found_ = false;
  int approach_line_ = 0;         ///< of the first move, from wherever the machine was
  std::array<bool, 3> turned_{};  ///< by what has been appended
  std::array<bool, 3> slid_{};
};

}  // namespace kerf
