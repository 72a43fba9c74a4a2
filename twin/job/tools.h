// twin/job/tools.h - which cutter is in the spindle: shapes gathered from every source, best first.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.h"
#include "interp_bridge/program.h"
#include "stock/cutter/cutter.h"
#include "stock/cutter/shape_spec.h"
#include "stock/cutter/tool_hints.h"
#include "twin/tool_library/tool_library.h"

namespace kerf {

/// A shape that fits what the program does with a tool (twin/guess/): no more than that.
struct ToolGuess {
  int tool = 0;        ///< 0: what is in the spindle before any tool change
  std::string shape;   ///< SHAPE text, parse_shape() accepts it
  std::string reason;  ///< "it only goes up and down"
  /// Its diameter is known, from a comment or the tool table, and nothing but that: this is a
  /// shape of that diameter.
  bool of_known_size = false;
};

/// What is known of tools before the program starts.
struct ToolSources {
  std::vector<ToolShapeArgument> arguments;  ///< --tool N=SHAPE
  std::vector<LibraryTool> library;          ///< of --tools: those with a number, each one once
  std::set<int> named_of_library;            ///< those of them that the program's text names
  std::vector<ToolHint> hints;               ///< comments of the program, in order of lines
  std::vector<ToolHint> turning_hints;       ///< the same for lathes (turning_hints.h)
  std::vector<ToolTableRow> table;           ///< rows of the tool table
  std::vector<ToolGuess> guesses;            ///< taken where nothing else tells
  bool turning = false;  ///< the workpiece turns: rows of the table are lathe tools (turning_row.h)
  std::string turning_sign;  ///< what says so; empty: --model turning

  /// Somebody has described tools by number: one that they do not have is not guessed.
  bool describes() const { return !arguments.empty() || !library.empty() || !table.empty(); }
};

/// The comments that count: of a lathe those for lathes, and others about what these say nothing
/// of.
std::vector<ToolHint> hints_in_force(const ToolSources& sources);

/// The diameters of the tools that arguments and comments describe by number: of the widest place;
/// of turning tools that of the nose, and its orientation.
std::map<int, KnownDiameter> known_diameters(const ToolSources& sources);
/// They, and whether tools stand still.
KnownTools known_tools(const ToolSources& sources);

/// A tool of the program and where its shape comes from.
struct ResolvedTool {
  int number = 0;
  std::optional<Cutter>
      cutter;          ///< absent: nothing is known (`trouble` says what is wrong), it does not cut
  std::string origin;  ///< "--tool", "tool library shop.json: 6 mm", "comment in line 3 (fusion)",
                       ///< "tool table line 4: its remark", ...
  bool guessed = false;     ///< its shape, or whether it is this tool's
  std::string guess;        ///< what is guessed of it, a sentence; empty: all but its diameter
  bool from_moves = false;  ///< of ToolSources::guesses: guessed from what the program does with it
  bool assumed = false;     ///< the spindle was empty, and this is the only tool described
  std::string trouble;

  /// Nothing but its diameter is known, and so a flat cutter was taken.
  bool is_size_alone() const;
};

/// Answers "what is tool N" in the order: --tool; the libraries of --tools; comments of the program
/// that name it or stand in the block of its T word, where they disagree the first, guessed;
/// comments at its tool change, guessed where they are not certainly about it (ToolHint::near) or
/// several stand there; the remark in the tool table; a flat cutter of the tool table's diameter
/// (guessed). Running text that names no tool comes after the tool table; last comes what was
/// guessed from its moves, which also makes a drill of a tool of which nothing but the diameter is
/// known. Never gives one tool for another, with one exception that is marked `assumed`: a program
/// that cuts before any tool change has no tool number, and then the only tool that --tool
/// describes (or, without
/// --tool, the only one that comments describe) is taken.
/// Where the workpiece turns, the tool table comes before comments that give a diameter alone.
/// Cutters are refused where the stock model cannot hold what they leave, and turning tools where
/// the workpiece does not turn.
class ToolResolver {
 public:
  /// Whether a stock model can cut with it, or why not.
  using CutterCheck = Done (*)(const Cutter& cutter);
  /// `can_cut` null: every cutter is welcome.
  ToolResolver(ToolSources sources, CutterCheck can_cut);

  /// The tool now in the spindle, on the first move it makes, at `line` of the program (0: not
  /// known). A comment without a tool number belongs to the first tool that moves at or after its
  /// line. The reference stays valid.
  const ResolvedTool& mount(int tool, std::uint32_t line);

  bool has_arguments() const { return !sources_.arguments.empty(); }

 private:
  ResolvedTool resolve(int tool, std::optional<std::size_t> fresh_hint) const;
  ResolvedTool resolve_empty_spindle(std::optional<std::size_t> fresh_hint) const;
  bool from_argument(ResolvedTool& out) const;
  bool from_library(ResolvedTool& out) const;
  bool from_hint(ResolvedTool& out, const ToolHint& hint) const;
  bool from_comments(ResolvedTool& out) const;
  bool from_comments(ResolvedTool& out, bool guessed) const;
  bool from_place(ResolvedTool& out, std::optional<std::size_t> fresh_hint, bool near) const;
  bool from_only_tool(ResolvedTool& out) const;
  void note_disagreement(ResolvedTool& out, const ToolHint& taken) const;
  bool from_table(ResolvedTool& out) const;
  bool from_turning_row(ResolvedTool& out, const ToolTableRow& row) const;
  bool from_guess(ResolvedTool& out) const;
  void drill_where_it_drills(ResolvedTool& out, int tool) const;
  std::optional<std::size_t> take_nameless_hint(std::uint32_t line);
  void refuse_unfit(ResolvedTool& tool) const;

  ToolSources sources_;
  CutterCheck can_cut_;
  std::size_t next_hint_ = 0;  ///< hints before this one lie before the last tool change
  std::map<int, ResolvedTool> tools_;
};

}  // namespace kerf
