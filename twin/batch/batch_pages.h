// twin/batch/batch_pages.h - what came of a batch, as a whole: for programs, build servers, people.
#pragma once

#include <span>
#include <string>

#include "twin/batch/batch_run.h"

namespace kerf {

/// summary.json, schema "kerf-batch/1": counts by verdict and of findings, and the results in the
/// order of the programs. Nothing in it depends on how long runs took, in how many goes the batch
/// came to its end, or where its folder lies: equal programs give an equal text.
std::string batch_summary_json(const BatchEnd& end, std::size_t programs,
                               const std::string& version);

/// junit.xml: the lists of the runs, joined; of a run that has left none, a suite with an error.
/// Reads them below `out`.
std::string batch_junit(const BatchEnd& end, const std::string& out, const std::string& version);

/// index.html: a table of the programs with their pictures, and links to the pages of their runs.
/// Needs no network and no script.
std::string batch_index_html(const BatchEnd& end, std::size_t programs, const std::string& version);

/// "115 programs: 90 good, 20 with errors, 5 not finished (2 out of time)": for people.
std::string batch_counts_text(const BatchEnd& end, std::size_t programs);

/// The verdict for people.
std::string shown_verdict(BatchVerdict verdict);

}  // namespace kerf
