// twin/process/milling/engagement_meter.h - how a tool is engaged along its feed moves: where to
// look, and what of the way each look stands for.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/engagement_log.h"
#include "twin/process/milling/engagement_scan.h"
#include "twin/process/milling/solid_front.h"
#include "twin/process/milling/upright_arc.h"

namespace kerf {

/// Looks ahead of the tool (EngagementScan::look_ahead) before each move is cut, at most half a
/// diameter of its way (and eight cells) apart, and closer to an eighth (two cells) where two
/// looks differ by more than kSameAngle_rad, or a twentieth of the depth or the diameter. Moves
/// that are shorter are taken together: each look counts until the way from it on is that long, or
/// turns by 30 degrees; where looks one after the other are alike, for up to two diameters. Where
/// moves are cut so quickly that looks would take more than a quarter of that time, for up to four.
/// Needs heights as they are (PresentHeights) and upright tools, or a model that can be asked about
/// points (SolidPoints); tools without an undercut, moves that are straight, arcs about Z of up to
/// one turn, or arcs of upright tools in a plane that stands upright. Of these last each look is at
/// the line that touches the arc there, no farther apart than kUprightTurn_rad, and parts that are
/// told turn by kUprightPart_rad at most. Others are told as unmeasured. One thread.
class EngagementMeter {
 public:
  /// `hand_over`: gives all moves before to the model. Both outlive this. Where somebody hears the
  /// log, who goes by each of its parts, it looks at short moves as often as they want it, whatever
  /// that costs.
  EngagementMeter(const StockModel& stock, EngagementLog& log, std::function<void()> hand_over);

  /// Each part of a feed move that is told to the log is told to this one, too.
  using Hearer = std::function<void(const EngagementLog::Part&)>;
  void hear_by(Hearer hearer) { hearer_ = std::move(hearer); }

  void mount(int tool, const Cutter& cutter);
  /// The tool has gone through the air, to where nobody looks.
  void lift();

  /// A feed move that is going to be cut, as one piece.
  struct Feed {
    const Cutter& cutter;
    const CutMove& move;
    bool near = true;            ///< it may touch material
    bool anticlockwise = false;  ///< the spindle, seen from above (M4)
    SourceRef source;
    double start_s = 0, duration_s = 0;
  };
  /// What came of it: the pass that it belongs to last, and how it was engaged; without what it
  /// removes. Good until the next call.
  struct Taken {
    std::uint32_t pass = EngagementLog::kNoPass;
    bool measured = false;
    EngagementSums sums;
    double most_mm3 = 0;  ///< what stands before the tool on all of it
  };
  const Taken& take(const Feed& feed);
  /// One that is cut as several, or turns.
  void take_unmeasured(double length_mm) { log_.add_unmeasured(length_mm); }
  /// The move before, if it was straight.
  void note(const CutMove& move);
  /// A move that is cut, under its number, whatever it is.
  void note_cut(const CutMove& move) { ways_.add(move); }

  /// All is cut: what crests are left (ScallopScan), where there are heights and it is known who
  /// cut them.
  void finish();

  static constexpr double kSameAngle_rad = 8 * kPi / 180;
  static constexpr double kUprightTurn_rad = 10 * kPi / 180, kUprightPart_rad = 2 * kPi / 180;

 private:
  struct Node {
    double at = 0;
    EngagementLook look;
  };
  /// Of looks, times the parts of the way for which they stand.
  struct Sum {
    double angle = 0, wide = 0, gaps = 0, deep = 0, entry = 0, exit = 0, climb = 0;
    double effective = 0, contact = 0;
    void add(const EngagementLook& look, double share);
    EngagementLook mean(const EngagementLook& like, double shares) const;
  };
  bool is_same(const EngagementLook& a, const EngagementLook& b) const;
  void add(double from, double to, const EngagementLook& look);
  void refine(const Node& from, const Node& to, int halvings);
  void take_along(double from, double to, int places);
  void take_upright(double farthest_mm);
  void tell(const EngagementLook& mean, double from, double to);
  void tell_all(const EngagementLook& look);
  double most_mm2(const EngagementLook& look, double down_rad) const;
  double front_of(const CutMove& move) const;
  double farthest_mm() const;
  double closest_mm() const;
  void flush();
  EngagementLook look(double at);
  bool find_material(std::optional<HeightGrid>& heights);
  bool counts_still(const CutMove& move);
  bool meets_material(const CutMove& move) const;

  const StockModel& stock_;
  EngagementLog& log_;
  std::function<void()> hand_over_;
  Hearer hearer_;
  EngagementScan scan_;
  SolidFront front_;
  PastWays ways_;
  const PresentHeights* owners_ = nullptr;
  double diameter_mm_ = 0;
  bool is_ball_ = false, is_flat_ = false;
  bool has_held_ = false;
  CutMove held_;
  EngagementLook last_;
  double since_mm_ = 0;    ///< way since last_ was looked at; negative: it counts for nothing
  bool is_brief_ = false;  ///< the look that comes
  bool is_short_ = false;  ///< the present move
  double saved_cells_ = 0, look_cells_ = 0;
  double brief_ = 1;  ///< of a look's cost, one in brief
  int free_looks_ = 0;
  bool is_thrifty_ = true;  ///< looks at short moves may not cost much
  double spacing_mm_ = 0;   ///< as far as it counts
  Vec3 last_ahead_{0};      ///< the way of the move that it was looked at on
  // The present move.
  const Cutter* cutter_ = nullptr;
  const CutMove* move_ = nullptr;
  const HeightGrid* heights_ = nullptr;
  const SolidPoints* points_ = nullptr;  ///< where there are no heights
  double front_mm_ = 0;                  ///< as wide as it may be in material
  double length_mm_ = 0, start_s_ = 0, duration_s_ = 0, down_rad_ = 0;
  std::optional<UprightArc> upright_;  ///< if it is one
  std::vector<double> turnings_;       ///< of that
  CutMove line_;                       ///< where it is looked at
  double until_ = 1;                   ///< part of its way, where it turns back
  bool anticlockwise_ = false;
  SourceRef source_;
  Taken taken_;
  /// The part that is being put together, of parts that are alike.
  double from_ = 0, to_ = 0;
  Sum sum_;
  EngagementLook first_;
};

}  // namespace kerf
