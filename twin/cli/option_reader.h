// twin/cli/option_reader.h - values of options, from text to checked values.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/length_unit.h"
#include "twin/config/option_layers.h"

namespace kerf {

/// "--cell: MESSAGE"
void add_fault(std::string_view option, const std::string& message, std::string hint,
               Diagnostics& diagnostics);

/// Understands what choose() hears, by the rows of the setting table, and collects the faults of a
/// command line, all of them: "--cell: '0' is not allowed; must be above 0 and at most 1000 (mm)".
/// What a configuration says has been checked by the same rows.
class OptionReader {
 public:
  /// --units is understood at once. `diagnostics`, and what the layers point to, must outlive this.
  OptionReader(Diagnostics& diagnostics, OptionLayers layers);

  void fault(std::string_view option, const std::string& message, std::string hint = {});

  ChosenValue choose(std::string_view option) const { return kerf::choose(layers_, option); }
  std::string text(std::string_view option) const { return choose(option).text; }
  /// Those of the command line, of a repeatable option.
  const std::vector<std::string>& texts(std::string_view option) const;
  /// Of one that takes no value.
  bool is_yes(std::string_view option) const { return text(option) == "yes"; }

  /// What there is no value for, or a faulty one, is `none`.
  double number(std::string_view option, double none = 0);
  /// A length, given and told in unit(); range, `none` and result are mm.
  double length_mm(std::string_view option, double none_mm = 0);
  double whole_number(std::string_view option, double none = 0);
  /// The place among the words of the row; -1: there is none, or a faulty one.
  int word(std::string_view option);
  /// What the word at that place stands for; `out` stays where there is none.
  template <class Value>
  void word(std::string_view option, std::initializer_list<Value> values, Value& out) {
    if (const int at = word(option); at >= 0) out = values.begin()[at];
  }
  /// Of the words on and off.
  bool on_off(std::string_view option) { return word(option) == 0; }

  /// From now on the INI says this of the option.
  void ini_says(std::string_view option, std::string text);

  Command command() const { return layers_.command; }
  Diagnostics& diagnostics() { return diagnostics_; }
  /// Of lengths on the command line, and of what is shown.
  LengthUnit unit() const { return unit_; }
  /// Of a value that is a text: a configuration's lengths are mm.
  LengthUnit unit_of(const ChosenValue& value) const;

 private:
  double checked(std::string_view option, const ChosenValue& value, LengthUnit unit, double none);

  Diagnostics& diagnostics_;
  OptionLayers layers_;
  LengthUnit unit_ = LengthUnit::kMm;
};

}  // namespace kerf
