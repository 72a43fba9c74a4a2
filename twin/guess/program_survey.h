// twin/guess/program_survey.h - what nobody has said of a program's blank and tools, and what fits
// the program.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/torch_materials.h"
#include "stock/blank.h"
#include "twin/findings/finding.h"
#include "twin/guess/beam_guess.h"
#include "twin/guess/tool_guess.h"
#include "twin/guess/turned_tool_guess.h"
#include "twin/job/tools.h"
#include "twin/machine/motion_moves.h"
#include "twin/program/program_front.h"

namespace kerf {

/// What is to be guessed, where nothing else says it.
struct SurveyWishes {
  double margin_mm = 5;
  bool blank = false;  ///< nothing says what it is
  bool sheet = true;   ///< it may be one
  bool tools = true;   ///< those of which nothing is known; what is in the spindle before any tool
                       ///< change is guessed in any case

  /// As the user has it: who describes tools (--tool, a tool table) wants to know which is missing.
  static SurveyWishes of(const SessionOptions& options, const ProgramFront& front);
};

/// Finds the tools of which nothing is known, as CutStage mounts them.
class OpenTools {
 public:
  explicit OpenTools(const ToolSources& sources) : resolver_(sources, nullptr) {}
  /// The tool of a feed move that goes somewhere; null: it is none.
  const ResolvedTool* feeding(const Motion& motion);

 private:
  ToolResolver resolver_;
  int tool_ = 0;
  const ResolvedTool* mounted_ = nullptr;
};

/// Takes a program in its order, whole, and says what fits it. Its own tools are those of a
/// ToolResolver over `sources`. One thread; costs little beside reading the program.
class ProgramSurvey {
 public:
  ProgramSurvey(const SurveyWishes& wishes, const ToolSources& sources);

  /// `moves`: how the machine moves.
  void add(std::span<const Motion> motions, const MotionMoves& moves);

  /// The program is for a torch, laser or jet. `materials`: of Program, the first one counts.
  struct SheetGuess {
    BlankSheet sheet;
    BeamGuess beam;
    std::string reason;  ///< of its thickness
  };
  /// Nothing, if it is not, or no sheet may be guessed.
  std::optional<SheetGuess> sheet(bool is_qtplasmac,
                                  std::span<const TorchMaterial> materials) const;
  /// The blank that fits, wide enough for the tools of tools().
  Blank blank() const;
  bool has_moves() const { return turning_ || blank_.is_round() || blank_.guess().has_moves(); }
  /// What blank() goes by, as stock-guessed says it.
  std::string blank_reason() const;
  /// blank() is a skin over what a pen draws or a knife cuts (CheckOptions::is_drawn).
  bool is_drawn() const { return !spindle_started_ && blank_.guess().is_skin(); }
  /// One shape for each tool of which nothing is known: of a box at `top_mm`. And a drill for each
  /// of which the diameter alone is, if it only goes up and down in it.
  std::vector<ToolGuess> tools(double top_mm) const;
  /// A kerf for each tool that feeds.
  std::vector<ToolGuess> kerfs(const BeamGuess& beam) const;
  /// What is missing, as errors that say which option gives it: for those who want no guesses.
  Diagnostics missing() const;
  /// guess_warning(). Nothing where nothing moves.
  std::optional<Finding> warning(const Blank& blank, const std::string& reason) const;

 private:
  /// What is known of a tool is its size.
  struct SizedTool {
    ToolTrace trace;
    double diameter_mm = 0;
  };

  bool may_guess(int tool) const { return wishes_.tools || tool == 0; }
  void add_turned(const Motion& motion);
  void add_drills(double top_mm, std::vector<ToolGuess>& guesses) const;

  SurveyWishes wishes_;
  OpenTools tools_;
  BlankSurvey blank_;
  BeamWatch beam_;
  bool turning_;
  std::map<int, ToolTrace> open_tools_;
  std::map<int, TurnedTrace> turned_tools_;
  std::map<int, SizedTool> sized_tools_;
  std::map<int, std::string> half_known_;  ///< guessed of what is known: why, a sentence
  std::set<int> fed_tools_;
  bool spindle_started_ = false;
};

/// stock-guessed. `reason`: what it was made of.
Finding guess_warning(const Blank& blank, const std::string& reason);

}  // namespace kerf
