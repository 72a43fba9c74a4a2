// twin/process/torch/torch_checks.h - troubles of cutting sheets with a torch: pieces that have
// come free in the way, moves without the beam, a beam that stays on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "interp_bridge/motion.h"
#include "twin/findings/finding.h"
#include "twin/machine/timeline.h"
#include "twin/process/sheet_checks.h"

namespace kerf {

class Sheet;

/// What the checks have to know of the machine.
struct TorchCheckOptions {
  /// After M5 that machine's torch is up, whatever the program says (held off by output 3 it stays
  /// down); it has other tools as well.
  bool is_qtplasmac = false;
  double slats_mm = 0;   ///< from one slat of the table to the next; 0: not known
  bool guessed = false;  ///< BeamSettings::guessed
};

/// Asked before a motion cuts. Paths are looked at in points kStep_mm apart: what is narrower than
/// that, no head can hit. One thread.
class TorchChecks {
 public:
  static constexpr double kStep_mm = 3;
  /// Up to as much above the height of the cuts the head is too low to travel over a piece that has
  /// tipped.
  static constexpr double kLow_mm = 1;
  /// Travels over so many pieces are told one by one, the others with the last of these: the head
  /// of a program that never moves Z travels over every piece.
  static constexpr std::uint64_t kTravelsTold = 10;

  TorchChecks(const Sheet& sheet, FindingLog& log, const TorchCheckOptions& options);

  /// Those of another one that looks at the same sheet are known, and are not told again.
  void go_on_from(const TorchChecks& other);
  /// pierce-in-part.
  void pierces(const Motion& motion, const TimedStep& step);
  /// crosses-part, of a motion with the beam on.
  void burns(const Motion& motion, const TimedStep& step);
  /// crosses-part and beam-off, of one without it.
  void travels(const Motion& motion, const TimedStep& step);
  /// beam-on-traverse, of a motion that has cut: rapids, not those that only go up or down.
  void cuts_on_traverse(const Motion& motion, const TimedStep& step);
  /// torch-left-on.
  void stays_on(SourceRef source, double time_s);
  /// What the motion has cut free.
  void note_freed(const Motion& motion, const TimedStep& step) {
    kerf::note_freed(sheet_, uncut_pieces_, motion, step, freed_);
  }
  /// beam-off and beam-on-traverse are one finding each for the program; small-part.
  void finish();
  /// What went on before is not reported on.
  void forget_events();

  const std::vector<FreedPiece>& freed() const { return freed_; }

 private:
  struct Dark {
    std::uint64_t moves = 0;
    SourceRef source;  ///< the first, and what is told of it
    double time_s = 0;
    Vec3 place_mm{0};
    int tool = 0;
  };

  static void count(Dark& dark, const Motion& motion, const TimedStep& step, const Vec3& place_mm);
  bool is_low(const Vec3& place_mm) const;
  const FreedPiece* freed_at(const Vec3& place_mm) const;
  void check_way(const Motion& motion, const TimedStep& step, bool burning);
  Finding finding(FindingId id, const Motion& motion, const TimedStep& step,
                  const Vec3& place_mm) const;
  void tell_travel(Finding finding);
  void report_dark_moves();
  void report_lit_traverses();
  void report_small_parts();

  const Sheet& sheet_;
  FindingLog& log_;
  TorchCheckOptions options_;
  std::size_t uncut_pieces_;       ///< higher numbers have been cut free
  std::vector<FreedPiece> freed_;  ///< by number
  std::optional<double> cut_z_mm_;
  std::unordered_set<std::uint32_t> crossed_;  ///< told once
  std::uint64_t travels_ = 0;                  ///< over pieces, since reports began
  FindingLog::Handle last_travel_ = 0;         ///< the last that is told, and its text
  std::string last_travel_text_;
  std::size_t report_from_;  ///< index into freed_
  Dark dark_;
  Dark lit_;  ///< traverses that cut
  double lit_mm_ = 0;
};

}  // namespace kerf
