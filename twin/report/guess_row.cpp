#include "twin/report/guess_row.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/blank.h"
#include "stock/cutter/scan.h"
#include "stock/cutter/shape_spec.h"
#include "twin/job/blank_choice.h"
#include "twin/report/shown_lengths.h"

namespace kerf {

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
  std::size_t width = 7;
  for (const GuessRow& row : rows) width = std::max(width, row.what.size());
  for (const GuessRow& row : rows) {
    out += fmt::format("{:<9} {:<{}} {}{}\n", out.empty() ? tr("guessed") : "", row.what, width,
                       row.value, row.reason.empty() ? "" : fmt::format(" ({})", row.reason));
  }
  if (rows.empty() || command.empty()) return out;
  out += tr("          correct what is wrong, and run it again:\n");
  return out + fmt::format("          {}\n", command);
}

}  // namespace kerf
