#include "twin/guess/guess_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "stock/cutter/scan.h"
#include "twin/shown_lengths.h"

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
  row.what = use.number == 0 ? "tool" : fmt::format("tool {}", use.number);
  row.value = fmt::format("{}={}", std::max(1, use.number), use.shape);
  row.reason = guess ? guess->reason : fmt::format("only in part said: {}", use.origin);
  // Of several --tool none is in the spindle before the first change.
  if (use.number > 0 || only_tool) {
    row.option = "--tool";
  } else {
    row.value = use.shape;
    row.reason += "; before the first tool change";
  }
  return row;
}

}  // namespace

std::vector<GuessRow> guess_rows(const SessionOptions& options, const ProgramFront& front,
                                 std::span<const ToolUse> tools) {
  std::vector<GuessRow> rows;
  if (front.blank_guessed && front.blank) {
    rows.push_back({"blank", "--stock", stock_spec(*front.blank), front.guess_reason});
  }
  if (front.blank_guessed && front.is_sheet() && options.beam.trigger &&
      !options.beam_text.empty()) {
    rows.push_back({"beam", "--beam", options.beam_text, ""});
  }
  for (const ToolUse& use : tools) {
    if (!use.guessed || use.shape.empty()) continue;
    if (front.is_sheet()) {
      const std::string width = use.shape.substr(use.shape.find(':') + 1);
      rows.push_back({"kerf", "--kerf", width, "nothing says how wide"});
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

std::vector<GuessRow> rows_in(std::span<const GuessRow> rows, LengthUnit unit) {
  std::vector<GuessRow> out(rows.begin(), rows.end());
  for (GuessRow& row : out) {
    row.reason = in_unit(row.reason, unit);
    if (row.option == "--stock") {
      if (const Result<Blank> blank = parse_blank(row.value)) row.value = stock_spec(*blank, unit);
    } else if (row.option == "--kerf") {
      if (const auto mm = parse_decimal(row.value)) row.value = length_number(*mm, unit);
    } else if (row.option != "--beam") {
      // "1=flat:6"; what no option can say is a shape alone.
      const std::size_t shape = row.option.empty() ? 0 : row.value.find('=') + 1;
      row.value = row.value.substr(0, shape) + shape_in(row.value.substr(shape), unit);
    }
  }
  return out;
}

std::string guess_text(std::span<const GuessRow> rows, const std::string& command) {
  std::string out;
  for (const GuessRow& row : rows) {
    out += fmt::format("{:<9} {:<8}{}{}\n", out.empty() ? "guessed" : "", row.what, row.value,
                       row.reason.empty() ? "" : fmt::format(" ({})", row.reason));
  }
  if (rows.empty() || command.empty()) return out;
  out += "          correct what is wrong, and run it again:\n";
  return out + fmt::format("          {}\n", command);
}

}  // namespace kerf
