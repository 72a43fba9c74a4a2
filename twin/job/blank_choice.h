// twin/job/blank_choice.h - the uncut workpiece when nobody gave one, and the cell size that suits
// it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "interp_bridge/motion.h"
#include "interp_bridge/program.h"
#include "stock/blank.h"
#include "stock/cutter/tool_hints.h"
#include "stock/stock_model.h"
#include "twin/job/feed_links.h"

namespace kerf {

/// The comments of a program with the unit that is in force at each (G20/G21 words of the program's
/// text outside comments, or the unit lines of a saved listing), the T word of its block, and
/// whether it stands at a tool change. Reads the file once more, to a little beyond the last
/// comment.
std::vector<CommentText> comments_with_units(const Program& program, const std::string& path);

/// Gathers where a program works, in one pass over its motions, and makes a box of it.
class BlankGuess {
 public:
  explicit BlankGuess(double margin_mm) : margin_mm_(margin_mm) {}

  /// `tool_radius_mm`: of the tool in the spindle, 0 if not known.
  void add(const Motion& motion, double tool_radius_mm);

  /// The same for a tilted tool: what the motion is cut as.
  void add(const Motion& motion, std::span<const CutMove> moves, double tool_radius_mm);

  /// The tool that made the feed moves within this box is so wide: it was not known before.
  void widen(const Box& feeds_mm, double tool_radius_mm);

  /// A box in whole mm around the feed moves:
  ///   X, Y   the feed moves of the tip, plus the tool's radius and the margin on every side
  ///   top    Z0 if the program works below it (most of its sideways feed length lies there, as CAM
  ///          programs with zero on the top do), else the highest sideways feed move, and the step
  ///          down from there to the next level above it, as far as the lowest rapid allows. Where
  ///          nothing would be cut (pens, engravings at Z0) kSkin_mm above the feeds, or half the
  ///          way to the rapids
  ///          way to the rapids. Ways between a rise and a descent above all else that is fed
  ///          sideways, of a program that hardly has rapids, go through the air and do not count
  ///   floor  the lowest feed move less the margin; Z0 if the program never goes below it (zero on
  ///   the table)
  /// Without feed moves: around the ends of the traverses. Never empty.
  Blank blank() const;
  /// blank() has its top just above the only level that is fed.
  bool is_skin() const;
  /// False: not one move has been seen.
  bool has_moves() const { return !all_mm_.empty(); }

  static constexpr double kSkin_mm = 0.5;
  static constexpr std::size_t kMostLevels = 1000;
  /// Heights at which a program may go from cut to cut at feed.
  static constexpr std::ptrdiff_t kMostLinkLevels = 4;

 private:
  struct Top {
    double z_mm = 0;
    bool skin = false;  ///< just above the only level that is fed
  };
  /// Of the feeds that go sideways.
  struct Sideways {
    double above_zero_mm = 0;  ///< length in X and Y above Z0 ...
    double below_zero_mm = 0;  ///< ... and below or on it
    double highest_mm = 0;
    bool any = false;
    std::map<double, double> levels_mm;  ///< level ones: height, length; at most kMostLevels

    void add(double middle_mm, double high_mm, double length_mm);
    void add_level(double z_mm, double length_mm);
  };
  void take(const FeedLinks::Ended& ended);
  /// Without the ways between cuts; with those that only looked so.
  BlankGuess without_air() const;
  Top top(double lowest) const;
  Blank blank_of_feeds() const;

  double margin_mm_;
  Box feeds_mm_;  ///< grown by the tool's radius in X and Y
  Box all_mm_;    ///< ends of every move
  double lowest_feed_mm_ = 0;
  bool has_feed_ = false;
  Sideways sideways_;
  FeedLinks watch_;
  FeedLinks::Levels links_;  ///< they look so; at most kMostLevels
  std::size_t link_count_ = 0;
  double lowest_rapid_mm_ = 0;  ///< of traverses that go sideways
  std::size_t rapid_count_ = 0;
};

/// Least of 0.01, 0.02, 0.05, 0.1, 0.2, 0.5 mm that gives the blank at most 4 million cells, so
/// that a whole run stays a matter of a second; 0.5 mm for blanks larger than 1 m x 1 m, doubled
/// until there are at most 64 million (above 4 m x 4 m).
double default_cell_mm(const Box& blank_mm);

/// Half the width of what a cutter leaves that goes `depth_mm` deep, mm: cells must be no larger to
/// show it.
double half_width_mm(const Cutter& cutter, double depth_mm);
/// The greatest of the usual cells (see above) that is no larger; the least of them if none is.
double cell_no_larger_mm(double size_mm);
/// The default cell of the blank, or a usual one that is no larger than `finest_mm` (0: any is
/// fine), or as near to it as 64 million cells come.
double suited_cell_mm(const Box& blank_mm, double finest_mm);
/// What the shallowest cuts that are looked for are like: half a width at this depth, mm.
inline constexpr double kShallowCut_mm = 0.2;

/// "box:-5,-5,-10:105,65,0", what --stock takes. Boxes, cylinders along X or Z and rectangular
/// sheets alone; empty for other blanks. Its numbers are in `unit`.
std::string stock_spec(const Blank& blank, LengthUnit unit = LengthUnit::kMm);

}  // namespace kerf
