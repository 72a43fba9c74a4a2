// Arbitrary bytes as an NC program, in two pieces: numbered, and surveyed for comments.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "interp_bridge/probe_branches.h"
#include "interp_bridge/program_prepare.h"
#include "interp_bridge/source_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t half =
      text.rfind('\n', size / 2) == text.npos ? 0 : text.rfind('\n', size / 2) + 1;
  kerf::LineNumberer whole(0);
  kerf::LineNumberer pieces(0);
  std::string at_once;
  std::string in_two;
  whole.append(text, at_once);
  pieces.append(text.substr(0, half), in_two);
  pieces.append(text.substr(half), in_two);
  // A line more or less would shift every line number behind it.
  const auto newlines = [](std::string_view in) {
    std::size_t count = 0;
    for (const char c : in) count += c == '\n' ? 1 : 0;
    return count;
  };
  if (at_once != in_two || newlines(at_once) != newlines(text) + whole.added()) std::abort();

  // Numbering what is numbered changes nothing.
  kerf::LineNumberer again(0);
  std::string twice;
  again.append(at_once, twice);
  const bool may_differ = !whole.unnumbered().empty() || whole.added() > 0;
  if (!may_differ && text.find('\r') == text.npos && twice != at_once) std::abort();

  // What is added takes no branch away.
  const bool branches = kerf::branches_on_probe(std::string(text));
  if (branches && !kerf::branches_on_probe(std::string(text) + "\n#1=#2\n")) std::abort();

  kerf::TextSurveyor surveyor;
  surveyor.add(text.substr(0, half));
  surveyor.add(text.substr(half));
  if (surveyor.survey().lines != whole.lines()) std::abort();
  return 0;
}
