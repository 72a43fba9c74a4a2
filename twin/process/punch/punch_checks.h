// twin/process/punch/punch_checks.h - troubles of punching sheets: clamps in the way, strokes that
// hit nothing, webs between strokes, pieces that have come free.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "stock/sheet/blank_area.h"
#include "twin/findings/finding.h"
#include "twin/machine/punch_moves.h"
#include "twin/machine/timeline.h"
#include "twin/machine/turret.h"
#include "twin/process/sheet_checks.h"

namespace kerf {

class Sheet;

/// Follows the clamps, and is asked before and after strokes are cut. Of each kind of
/// trouble the first kTold are told one by one, the others with the last of these. One thread.
class PunchChecks {
 public:
  static constexpr std::uint64_t kTold = 10;

  PunchChecks(const Sheet& sheet, FindingLog& log, TurretPointer turret);

  /// Every motion, before its strokes: re-gripping. grip-lost, punch-down.
  void follow(const Motion& motion, const TimedStep& step, bool drags);
  /// position-unknown: a stroke where nobody knows. Once.
  void strikes_unseen(const Motion& motion, const TimedStep& step);
  /// no-punch, station-empty.
  void no_station(const Motion& motion, const TimedStep& step, const Vec3& place_mm);
  /// Strokes of one motion that are about to be cut: hit-on-clamp, hit-off-sheet, hit-over-edge,
  /// hit-on-part.
  void strikes(const Motion& motion, const TimedStep& step, const Cutter& punch,
               std::span<const CutMove> strokes);
  /// They have been cut: pieces that are free now.
  void note_freed(const Motion& motion, const TimedStep& step) {
    kerf::note_freed(sheet_, uncut_pieces_, motion, step, freed_);
  }
  /// Once a motion, `strokes` are all of them: hit-in-air, web-left (`nibbled`).
  void struck(const Motion& motion, const TimedStep& step, const Cutter& punch,
              std::span<const CutMove> strokes, double removed_mm3, bool nibbled);
  /// Those of another one that looks at the same sheet are known.
  void go_on_from(const PunchChecks& other);
  /// The program is over.
  void never_struck();
  /// What went on before is not reported on.
  void forget_events() { told_.clear(); }

  const std::vector<FreedPiece>& freed() const { return freed_; }
  std::uint64_t regrips() const { return regrips_; }

 private:
  struct Told {
    std::uint64_t count = 0;
    FindingLog::Handle last = 0;
    std::string text;  ///< of the last
  };

  void tell(FindingId id, Severity severity, const Motion& motion, const TimedStep& step,
            const Vec3& place_mm, std::string text);
  void check_grip(const Motion& motion, const TimedStep& step);
  void check_clamps(const Motion& motion, const TimedStep& step, const CutMove& stroke,
                    const PlaneOutline& shape);
  void check_edge(const Motion& motion, const TimedStep& step, const CutMove& stroke,
                  const PlaneOutline& shape);
  void check_webs(const Motion& motion, const TimedStep& step, const Cutter& punch,
                  std::span<const CutMove> strokes);
  bool web_between(const Cutter& punch, const CutMove& a, const CutMove& b) const;

  const Sheet& sheet_;
  FindingLog& log_;
  TurretPointer turret_;
  BlankArea blank_;
  ClampPlace place_;
  std::uint64_t regrips_ = 0;
  bool grip_checked_ = false;
  bool unseen_told_ = false;
  bool off_sheet_ = false;  ///< a stroke of the present motion
  std::size_t uncut_pieces_;
  std::vector<FreedPiece> freed_;
  std::map<FindingId, Told> told_;
};

}  // namespace kerf
