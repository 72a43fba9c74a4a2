// twin/process/turning/thread_checks.h - how deep a thread has become: thread-shallow,
// flank-contact of what stands beside the insert's profile.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stock/turning/turning_stock.h"
#include "twin/findings/finding.h"
#include "twin/process/turning/turning_checks.h"

namespace kerf {

/// Passes of one tool with one lead over one stretch are a thread. Its depth is that of the deepest
/// pass below the crest, which is the surface that was there before the first one, both in the
/// middle of what of the pass lies within the workpiece. What pitch and form ask for:
///
///     60 degrees (ISO 68-1)   0.6134 P outside, 0.5413 P in a bore
///     55 degrees (ISO 228)    0.6403 P
///     29, 30 degrees          0.5 P
///
/// Deeper than the insert's profile is high is flank-contact: what of it does not cut runs into the
/// crests.
///
/// The pitch is the lead over the number of starts: of passes as deep as the deepest, how many
/// begin elsewhere along the lead. Beside a machine a pass comes in pieces; each is judged in its
/// own middle. Tools of another angle, taps, and threads of no crest are not judged.
class ThreadChecks {
 public:
  ThreadChecks(const TurningStock& stock, FindingLog& log) : stock_(stock), log_(log) {}

  void mount(const Cutter& cutter);
  /// The tool has the profile of a thread.
  bool is_threading_tool() const { return form_.has_value(); }
  /// A motion with a lead, before it is cut; also one that stays beside the workpiece: where a pass
  /// begins says which start it belongs to.
  void note(const TurnedMove& move);
  /// No more passes come: the tool is changed, the program is over.
  void end();
  void forget() {
    thread_.reset();
    form_.reset();
    pass_.reset();
  }

  /// So much of the depth may be missing: tips are not as the form has them.
  static constexpr double kMissing = 0.05;
  /// The profile may be too low by this, as in TurningChecks::kFlank_mm.
  static constexpr double kBeyond_mm = 0.05;

 private:
  struct Form {
    double angle_deg = 0;
    double outside = 0, inside = 0;  ///< depth over pitch
    bool in_bore = false;
    double profile_mm = 0;  ///< from the tip to where the first of its flanks ends
  };
  struct Thread {
    double lead_mm = 0;
    double low_z_mm = 0, high_z_mm = 0;
    std::vector<Vec2> crests_mm;  ///< (z, r) of pieces of the first pass
    int first_pass = 0, last_pass = 0;
    double depth_mm = 0;         ///< of the deepest pass
    std::vector<double> phases;  ///< of passes as deep, where they begin over the lead
    SourceRef source;            ///< of the deepest pass, and the rest of it
    double time_s = 0;
    Vec3 place_mm{0};
    int tool = 0;
    bool tool_guessed = false;
    bool body_told = false;
  };
  /// The last pass, so far.
  struct Pass {
    int number = 0;
    Vec3 from_mm{0}, to_mm{0};
    SourceRef source;
  };
  std::optional<double> crest_at(double z_mm) const;
  void tell_body(const TurnedMove& move, Thread& thread, double depth_mm);
  void follow_pass(const Motion& motion);
  bool is_apart(double low_z_mm, double high_z_mm) const;

  const TurningStock& stock_;
  FindingLog& log_;
  std::optional<Form> form_;
  std::optional<Thread> thread_;
  std::optional<Pass> pass_;
};

}  // namespace kerf
