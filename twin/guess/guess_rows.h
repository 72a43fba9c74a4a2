// twin/guess/guess_rows.h - what a run has taken for want of better.
#pragma once

#include <span>
#include <vector>

#include "twin/guess/program_survey.h"
#include "twin/job/tool_use.h"
#include "twin/program/program_front.h"
#include "twin/report/guess_row.h"

namespace kerf {

/// Of a run that is over: its blank, its beam, and the tools that it used. Empty: nothing was
/// guessed.
std::vector<GuessRow> guess_rows(const SessionOptions& options, const ProgramFront& front,
                                 std::span<const ToolUse> tools);

/// The same options for a program that is for a beam: over this sheet.
SessionOptions with_sheet(const SessionOptions& options, const ProgramSurvey::SheetGuess& guess,
                          std::vector<ToolGuess> kerfs);

}  // namespace kerf
