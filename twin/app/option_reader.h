// twin/app/option_reader.h - values of options, from text to checked numbers.
#pragma once

#include <string>

#include "base/diagnostic.h"

namespace kerf {

/// Numbers an option may have.
struct OptionRange {
  double least;
  double most;
  bool least_excluded;
  const char* unit;
};

/// Collects the faults of a command line, all of them: "--cell: '0' is not allowed; must be above 0
/// and at most 1000 (mm)".
class OptionReader {
 public:
  explicit OptionReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void fault(const char* option, const std::string& message, std::string hint = {});
  /// `fallback` if the option is not given (empty) or wrong.
  double number(const char* option, const std::string& text, const OptionRange& range,
                double fallback);
  double whole_number(const char* option, const std::string& text, const OptionRange& range,
                      double fallback);
  /// "on" or "off".
  bool on_off(const char* option, const std::string& text, bool fallback);

  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  Diagnostics& diagnostics_;
};

}  // namespace kerf
