#include "twin/guess/guess_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

const ToolGuess* guess_of(const ToolSources& sources, int tool) {
  const auto found = std::find_if(sources.guesses.begin(), sources.guesses.end(),
                                  [tool](const ToolGuess& guess) { return guess.tool == tool; });
  return found == sources.guesses.end() ? nullptr : &*found;
}

GuessRow tool_row(const ToolUse& use, const ToolSources& sources, bool only_tool) {
  const ToolGuess* const guess = guess_of(sources, use.number);
  GuessRow row;
  row.what = use.number == 0 ? tr("tool") : trf("tool {}", use.number);
  row.value = fmt::format("{}={}", std::max(1, use.number), use.shape);
  row.reason = guess ? guess->reason : trf("only in part said: {}", use.origin);
  // Of several --tool none is in the spindle before the first change.
  if (use.number > 0 || only_tool) {
    row.option = "--tool";
  } else {
    row.value = use.shape;
    row.reason += tr("; before the first tool change");
  }
  return row;
}

}  // namespace

std::vector<GuessRow> guess_rows(const SessionOptions& options, const ProgramFront& front,
                                 std::span<const ToolUse> tools) {
  std::vector<GuessRow> rows;
  if (front.blank_guessed && front.blank && !front.guess_reason.empty()) {
    rows.push_back({tr("blank"), "--stock", stock_spec(*front.blank), front.guess_reason});
  }
  if (front.blank_guessed && front.is_sheet() && options.beam.trigger &&
      !options.beam_text.empty()) {
    rows.push_back({tr("beam"), "--beam", options.beam_text, ""});
  }
  for (const ToolUse& use : tools) {
    if (!use.guessed || use.shape.empty()) continue;
    if (front.is_sheet()) {
      const std::string width = use.shape.substr(use.shape.find(':') + 1);
      rows.push_back({tr("kerf"), "--kerf", width, tr("nothing says how wide")});
      break;
    }
    rows.push_back(tool_row(use, front.tools, tools.size() == 1));
  }
  return rows;
}

SessionOptions with_sheet(const SessionOptions& options, const ProgramSurvey::SheetGuess& guess,
                          std::vector<ToolGuess> kerfs) {
  SessionOptions out = options;
  Blank blank;
  blank.sheet = guess.sheet;
  out.blank = std::move(blank);
  out.blank_is_guess = true;
  out.guess_reason = guess.reason;
  out.program.machine.z_matters = false;
  if (!out.beam.trigger && !guess.beam.trigger.empty()) {
    out.beam.trigger = BeamTrigger::parse(guess.beam.trigger).value();
    out.beam_text = guess.beam.trigger;
  }
  out.tool_guesses = std::move(kerfs);
  return out;
}

}  // namespace kerf
