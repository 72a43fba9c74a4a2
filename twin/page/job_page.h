// twin/page/job_page.h - a part that is made in several setups as one HTML file: what is to be done
// over all, then each setup with its part, its findings and its set-up sheet.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/length_unit.h"
#include "twin/compare/comparison.h"
#include "twin/report/report.h"

namespace kerf {

/// What a page over all setups tells. Times in s.
struct JobPage {
  struct Setup {
    std::string heading;  ///< "Setup 2 of 3: bottom"
    std::string program;
    std::string lies;  ///< "flipped about X"; empty: as before
    double machining_s = 0, setup_s = 0;
    std::size_t errors = 0, warnings = 0;
    std::string article;  ///< page_article() with anchor(); empty: it came to no report
  };
  struct Tool {
    ToolUse use;                      ///< over all of these setups
    std::vector<std::size_t> setups;  ///< from 1
  };
  std::string path;     ///< of the job file
  std::string command;  ///< that makes all this again
  std::string version;
  LengthUnit units = LengthUnit::kMm;
  std::vector<Setup> setups;
  std::vector<std::string> not_run;
  std::vector<Tool> tools;
  std::optional<Comparison> comparison;

  /// Of the article of a setup (from 0).
  static std::string anchor(std::size_t setup);
};

/// The whole file, UTF-8, in the language of the process.
std::string job_page(const JobPage& job);

}  // namespace kerf
