#include "interp_bridge/tool_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "base/small_file.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/tool_lengths.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxRows = 1000;     // CANON_POCKETS_MAX
constexpr std::size_t kMaxRowBytes = 255;  // CANON_TOOL_ENTRY_LEN - 1
constexpr int kLargestToolNumber = 99'999;
constexpr std::size_t kMaxTableBytes = 4 * 1024 * 1024;

/// A program that computes its tool numbers may ask for any; these are given rows.
constexpr int kComputedTools = 99;

/// One row being read.
class RowParser {
 public:
  RowParser(std::string_view line, int number, const std::string& path, Diagnostics& diagnostics)
      : line_(line), number_(number), path_(path), diagnostics_(diagnostics) {}

  /// False: no row, which is an error that was reported, or a comment.
  bool parse(ToolTableRow& row);

 private:
  bool parse_words(std::string_view words, ToolTableRow& row);
  bool parse_word(std::string_view word, std::size_t column, ToolTableRow& row);
  bool store(char letter, double value, std::size_t column, ToolTableRow& row);
  bool report(Severity severity, std::size_t column, std::string message, std::string hint = {});

  std::string_view line_;
  int number_;
  const std::string& path_;
  Diagnostics& diagnostics_;
  std::string seen_;
};

bool RowParser::report(Severity severity, std::size_t column, std::string message,
                       std::string hint) {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = path_;
  diagnostic.line = number_;
  diagnostic.column = static_cast<int>(column) + 1;
  diagnostic.message = std::move(message);
  diagnostic.excerpt = std::string(line_.substr(0, kMaxRowBytes));
  diagnostic.hint = std::move(hint);
  if (column >= kMaxRowBytes) diagnostic.column = 0;
  diagnostics_.push_back(std::move(diagnostic));
  return false;
}

bool RowParser::parse(ToolTableRow& row) {
  const std::size_t semicolon = line_.find(';');
  std::string_view words = line_.substr(0, semicolon);
  if (trim(words, is_line_blank).empty()) return false;
  if (line_.size() > kMaxRowBytes) {
    return report(Severity::kError, kMaxRowBytes,
                  trf("a row of {} bytes; at most {} are allowed", line_.size(), kMaxRowBytes));
  }
  if (!parse_words(words, row)) return false;
  for (const char letter : {'T', 'P'}) {
    if (seen_.find(letter) == seen_.npos) {
      return report(
          Severity::kError, 0, trf("the row has no {} word; it is skipped", letter),
          tr("a row is T<tool> P<pocket> and any of X Y Z A B C U V W D I J Q, then ;remark"));
    }
  }
  if (semicolon != line_.npos) {
    std::string_view remark = line_.substr(semicolon + 1);
    const std::size_t first = remark.find_first_not_of(" \t");
    if (first == remark.npos) return true;
    remark = remark.substr(first, remark.find_last_not_of(" \t\r") - first + 1);
    row.remark = std::string(remark);
  }
  return true;
}

bool RowParser::parse_words(std::string_view words, ToolTableRow& row) {
  if (const std::size_t tab = words.find('\t'); tab != words.npos) {
    report(Severity::kWarning, tab, tr("a tab separates the words; LinuxCNC 2.9 skips such a row"),
           tr("put blanks in place of tabs"));
  }
  if (words.size() >= 2 && words.back() == '\r' && is_blank(words[words.size() - 2])) {
    report(Severity::kWarning, words.size() - 2,
           tr("a blank before the carriage return; LinuxCNC 2.9 skips such a row"),
           tr("store the table with Unix line ends"));
  }
  std::size_t at = 0;
  while (at < words.size()) {
    if (is_line_blank(words[at])) {
      ++at;
      continue;
    }
    const std::size_t end = std::min(words.find_first_of(" \t\r", at), words.size());
    if (!parse_word(words.substr(at, end - at), at, row)) return false;
    at = end;
  }
  return true;
}

bool RowParser::parse_word(std::string_view word, std::size_t column, ToolTableRow& row) {
  const char letter = to_upper(word.front());
  if (std::string_view("TPXYZABCUVWDIJQ").find(letter) == std::string_view::npos) {
    const bool printable = word.front() > ' ' && word.front() < 0x7f;
    return report(
        Severity::kError, column,
        trf("unknown word {}; the row is skipped", printable ? std::string(1, word.front()) : "?"),
        tr("a row is T<tool> P<pocket> and any of X Y Z A B C U V W D I J Q, then ;remark"));
  }
  std::string_view digits = word.substr(1);
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  if (digits.empty()) {
    return report(Severity::kError, column + 1, trf("{} has no value; the row is skipped", letter),
                  tr("no blank may stand between the letter and its number"));
  }
  double value = 0;
  if (!read_number(digits, value) || !std::isfinite(value) || std::abs(value) > 1e9) {
    return report(Severity::kError, column + 1,
                  trf("{}{}: not a number; the row is skipped", letter, digits));
  }
  if (seen_.find(letter) != seen_.npos) {
    return report(Severity::kError, column, trf("{} stands twice; the row is skipped", letter));
  }
  seen_ += letter;
  return store(letter, value, column, row);
}

bool RowParser::store(char letter, double value, std::size_t column, ToolTableRow& row) {
  const bool whole = value == std::floor(value);
  switch (letter) {
    case 'T':
      if (!whole || value < 0 || value > kLargestToolNumber) {
        return report(
            Severity::kError, column + 1,
            trf("tool number {}; must be a whole number from 0 to {}", value, kLargestToolNumber));
      }
      row.tool = static_cast<int>(value);
      return true;
    case 'P':
      if (!whole || value < 0 || value > kLargestToolNumber) {
        return report(Severity::kError, column + 1,
                      trf("pocket number {}; must be a whole number from 0 to {}", value,
                          kLargestToolNumber));
      }
      row.pocket = static_cast<int>(value);
      return true;
    case 'Q':
      if (!whole || value < 0 || value > 9) {
        return report(Severity::kError, column + 1,
                      trf("orientation {}; must be a whole number from 0 to 9", value));
      }
      row.orientation = static_cast<int>(value);
      return true;
    case 'D':
      row.diameter_mm = value;
      row.has_diameter = true;
      return true;
    case 'X':
      row.offset_mm.x = value;
      return true;
    case 'Y':
      row.offset_mm.y = value;
      return true;
    case 'Z':
      row.offset_mm.z = value;
      return true;
    case 'I':
      row.front_angle_deg = value;
      return true;
    case 'J':
      row.back_angle_deg = value;
      return true;
    case 'A':
    case 'B':
    case 'C':
      row.offset_abc_deg[letter - 'A'] = value;
      return true;
    case 'U':
    case 'V':
    case 'W':
      row.offset_uvw_mm[letter - 'U'] = value;
      return true;
    default:
      return true;
  }
}

}  // namespace

std::vector<ToolTableRow> parse_tool_table(std::string_view text, const std::string& path,
                                           Diagnostics& diagnostics) {
  std::vector<ToolTableRow> rows;
  std::set<int> tools;
  int number = 0;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    ToolTableRow row;
    row.line = ++number;
    if (!RowParser(line, number, path, diagnostics).parse(row)) continue;
    Diagnostic fault;
    fault.file = path;
    fault.line = number;
    if (!tools.insert(row.tool).second) {
      fault.severity = Severity::kWarning;
      fault.message = trf("tool {} has a row already; the first one counts", row.tool);
      diagnostics.push_back(std::move(fault));
      continue;
    }
    if (rows.size() == kMaxRows) {
      fault.message = trf("more than {} rows; LinuxCNC holds no more", kMaxRows);
      diagnostics.push_back(std::move(fault));
      break;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Result<std::vector<ToolTableRow>> read_tool_table(const std::string& path, Diagnostics& diagnostics,
                                                  double unit_mm) {
  const Result<std::string> text =
      read_small_file(path, kMaxTableBytes,
                      trf("cannot read {}: larger than {} MB, not a tool table", path,
                          kMaxTableBytes / (1024 * 1024)));
  if (!text) return Error{text.error()};
  std::vector<ToolTableRow> rows = parse_tool_table(*text, path, diagnostics);
  for (ToolTableRow& row : rows) {
    row.diameter_mm *= unit_mm;
    row.offset_mm *= unit_mm;
    row.offset_uvw_mm *= unit_mm;
  }
  return rows;
}

std::vector<ToolTableRow> with_known_diameters(std::vector<ToolTableRow> rows, bool has_table,
                                               const std::map<int, KnownDiameter>& known,
                                               ToolDiameters& told) {
  constexpr double kEqual_mm = 0.01;
  told.all = false;
  std::map<int, KnownDiameter> missing = known;
  int pocket = 0;
  for (ToolTableRow& row : rows) {
    pocket = std::max(pocket, row.pocket);
    if (row.has_diameter) told.known.insert(row.tool);
    const auto shape = missing.find(row.tool);
    if (shape == missing.end()) continue;
    const KnownDiameter diameter = shape->second;
    missing.erase(shape);
    if (!row.has_diameter) {
      row.diameter_mm = diameter.mm;
      if (row.orientation == 0) row.orientation = diameter.orientation;
      told.known.insert(row.tool);
      told.doubts[row.tool] = trf(
          "the tool table has no diameter for tool {}, and the machine would compensate by none; "
          "{:g} mm is taken, as its shape has it",
          row.tool, diameter.mm);
    } else if (diameter.by_argument && row.diameter_mm != 0 &&
               std::abs(std::abs(row.diameter_mm) - diameter.mm) > kEqual_mm) {
      told.doubts[row.tool] =
          trf("cutter radius compensation goes by the tool table: {:g} mm for tool {}; --tool has "
              "{:g} mm",
              row.diameter_mm, row.tool, diameter.mm);
    }
  }
  for (const auto& [tool, diameter] : missing) {
    if (rows.size() >= kMaxRows) break;
    ToolTableRow& row = rows.emplace_back();
    row.tool = tool;
    row.pocket = ++pocket;
    row.diameter_mm = diameter.mm;
    row.orientation = diameter.orientation;
    row.has_diameter = true;
    row.added = true;
    told.known.insert(tool);
    if (!has_table) continue;
    told.doubts[tool] = trf(
        "the tool table does not have tool {}; for compensation {:g} mm is taken, as its shape has "
        "it",
        tool, diameter.mm);
  }
  return rows;
}

InterpreterToolTable interpreter_tool_table(const std::vector<ToolTableRow>& rows,
                                            const NamedTools& named) {
  InterpreterToolTable table;
  table.tool_by_index.push_back(0);
  std::set<int> present;
  int pocket = 0;
  const auto add = [&](const ToolTableRow& row) {
    if (row.tool == 0 || table.tool_by_index.size() >= kMaxRows) return;
    if (!present.insert(row.tool).second) return;
    table.tool_by_index.push_back(row.tool);
    const CodedOffset code = coded_offset(row.tool);
    table.text += fmt::format("T{} P{} U{:.10f} W{:.10f} D{:.10f} I{:.6f} J{:.6f} Q{}\n", row.tool,
                              row.pocket, code.u_mm / kMmPerInch, code.w_mm / kMmPerInch,
                              row.diameter_mm / kMmPerInch, row.front_angle_deg, row.back_angle_deg,
                              row.orientation);
    pocket = std::max(pocket, row.pocket);
  };
  for (const ToolTableRow& row : rows) add(row);
  const auto add_plain = [&](int tool) {
    ToolTableRow row;
    row.tool = tool;
    row.pocket = pocket + 1;
    add(row);
  };
  for (const int tool : named.numbers) add_plain(tool);
  if (named.computed) {
    for (int tool = 1; tool <= kComputedTools; ++tool) add_plain(tool);
  }
  return table;
}

}  // namespace kerf
