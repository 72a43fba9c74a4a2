// twin/optimize/nc_parameters.h - parameters of NC code, and expressions of them.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// #1 to #30 and #<name> belong to a call of a subroutine, others to the program. What it has not
/// set itself is not known: it is the machine's.
class NcParameters {
 public:
  static constexpr int kLocals = 30;
  /// From here on they are the interpreter's: positions, probing, offsets.
  static constexpr int kFirstOfMachine = 5000;

  NcParameters() { calls_.emplace_back(); }
  void begin_call(const std::vector<double>& arguments);
  void end_call() { calls_.pop_back(); }
  std::size_t depth() const { return calls_.size(); }

  /// Nothing: the program has not set it.
  std::optional<double> get(int number) const;
  std::optional<double> get(const std::string& name) const;
  void set(int number, double value);
  void set(const std::string& name, double value);

 private:
  struct Call {
    std::array<double, kLocals + 1> numbers{};
    std::map<std::string, double> names;
  };
  std::vector<Call> calls_;
  std::map<int, double> numbers_;
  std::map<std::string, double> names_;  ///< those that begin with an underscore
};

/// Reads values of one line as LinuxCNC's interpreter does, without comments; blanks count for
/// nothing, and capitals are as small ones.
class NcExpression {
 public:
  NcExpression(std::string_view text, const NcParameters& parameters)
      : text_(text), parameters_(parameters) {}

  /// The value that stands at `at`, which is moved behind it: a number, #.., [..], a function.
  /// Nothing: fault() says why.
  std::optional<double> value(std::size_t& at);
  /// A parameter (`at` is on its #): its number, or its name.
  struct Place {
    int number = 0;
    std::string name;
  };
  std::optional<Place> place(std::size_t& at);
  /// What cannot be worked out, in words.
  const std::string& fault() const { return fault_; }

 private:
  char peek();
  bool take(char c);
  bool take_word(std::string_view word);
  std::optional<double> fail(std::string why);
  std::optional<double> number();
  std::optional<double> parameter();
  std::optional<double> bracketed();
  std::optional<double> chain(int level);
  std::optional<double> function();
  std::optional<double> single();

  std::string_view text_;
  const NcParameters& parameters_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string fault_;
};

/// Decimals that are read as the same double again, without a power of ten.
std::string exact_text(double value);

}  // namespace kerf
