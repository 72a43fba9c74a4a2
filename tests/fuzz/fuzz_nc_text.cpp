// Arbitrary bytes as an NC program whose feeds are to be changed: what is not a feed stays byte for
// byte, and a feed that was written is read again; and what is written out has nothing left to be
// written out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#include "twin/optimize/nc_text.h"
#include "twin/optimize/unroll.h"

namespace {

void check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const bool inch : {false, true}) {
    const kerf::NcText program(text, inch);
    check(program.with({}) == text);
    if (const auto unrolled = kerf::unroll(program, 300)) {
      const kerf::NcText written(unrolled->text, inch);
      check(written.lines().size() == unrolled->line_before.size());
      const auto again = kerf::unroll(written, 1000);
      check(again && again->text == unrolled->text && again->passes == 0 && again->calls == 0);
    }
    std::map<std::uint32_t, kerf::NcEdit> edits;
    std::uint32_t number = 0;
    for (const kerf::NcLine& line : program.lines()) {
      ++number;
      check(line.words_end <= line.text.size());
      if (line.feed != kerf::NcLine::Feed::kNumber) continue;
      check(line.feed_at <= line.feed_end && line.feed_end <= line.text.size());
      edits[number].number = "123.5";
    }
    const kerf::NcText changed(program.with(edits), inch);
    check(changed.lines().size() == program.lines().size());
    for (const auto& [at, edit] : edits) {
      const kerf::NcLine& line = changed.lines()[at - 1];
      check(line.feed == kerf::NcLine::Feed::kNumber && line.feed_number == 123.5);
    }
    check(changed.with(edits) == changed.text());
  }
  return 0;
}
