// twin/app/option_reader.h - values of options, from text to checked numbers.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "base/length_unit.h"

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
  /// `unit`: of the lengths.
  explicit OptionReader(Diagnostics& diagnostics, LengthUnit unit = LengthUnit::kMm)
      : diagnostics_(diagnostics), unit_(unit) {}

  void fault(const char* option, const std::string& message, std::string hint = {});
  /// `fallback` if the option is not given (empty) or wrong.
  double number(const char* option, const std::string& text, const OptionRange& range,
                double fallback);
  /// A length, given and told in unit(); range, fallback and result are mm.
  double length_mm(const char* option, const std::string& text, const OptionRange& range_mm,
                   double fallback_mm);
  double whole_number(const char* option, const std::string& text, const OptionRange& range,
                      double fallback);
  /// "on" or "off".
  bool on_off(const char* option, const std::string& text, bool fallback);

  Diagnostics& diagnostics() { return diagnostics_; }
  LengthUnit unit() const { return unit_; }

 private:
  Diagnostics& diagnostics_;
  LengthUnit unit_;
};

/// --units, else what the configuration has, else mm.
LengthUnit understand_units(const std::string& text, std::optional<LengthUnit> configured,
                            Diagnostics& diagnostics);

}  // namespace kerf
