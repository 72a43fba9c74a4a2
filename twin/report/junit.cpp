#include <fmt/format.h>

#include <string_view>

#include "base/text_scan.h"
#include "base/translate.h"
#include "twin/report/finding_lists.h"

namespace kerf {
namespace {

constexpr std::string_view kNoCharacter = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the character of UTF-8 that begins here; 0: none does, or XML has no such character.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r';
  const std::size_t count = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < count) return 0;
  std::uint32_t code = first & (0xFFU >> (count + 1));
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool allowed =
      code >= kLeast[count] && code <= 0x10FFFF && code != 0xFFFE && code != 0xFFFF;
  return allowed && !surrogate ? count : 0;
}

/// One check of a program.
struct Check {
  std::string failure;   ///< what its errors say; empty: it has none
  std::string headline;  ///< the first of them
  std::string type;      ///< its id
  std::string output;    ///< what is milder
  std::size_t errors = 0;
};

/// `program`: of which the lines are; of another file it is named.
void add(Check& check, const Finding& finding, const Diagnostic& said, const std::string& program) {
  std::string& text = finding.severity == Severity::kError ? check.failure : check.output;
  text += to_string(said);
  if (finding.severity != Severity::kError) return;
  if (check.errors++ > 0) return;
  if (said.line <= 0)
    check.headline = said.message;
  else if (said.file.empty() || said.file == program)
    check.headline = trf("line {}: {}", said.line, said.message);
  else
    check.headline = fmt::format("{}:{}: {}", said.file, said.line, said.message);
  check.type = to_string(finding.id);
}

std::string finished_case(const ListedProgram& program, bool& finished) {
  std::string said;
  for (const Diagnostic& fault : program.faults) {
    if (fault.severity == Severity::kError) said += to_string(fault);
  }
  if (!program.partial_reason.empty()) {
    said += trf("not run to its end: {}", program.partial_reason) + "\n";
  }
  finished = said.empty();
  const std::string path = xml_text(program.path);
  std::string out =
      fmt::format("    <testcase classname=\"{}\" name=\"finished\" file=\"{}\" time=\"{:.3f}\"",
                  path, path, program.total_s);
  if (finished) return out + "/>\n";
  const std::string first = said.substr(0, said.find('\n'));
  return out + fmt::format(
                   ">\n      <error type=\"unfinished\" message=\"{}\">{}</error>\n"
                   "    </testcase>\n",
                   xml_text(first), xml_text(said));
}

std::string topic_case(const ListedProgram& program, const FindingTopicRow& topic,
                       const Check& check) {
  const std::string path = xml_text(program.path);
  std::string out = fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" time=\"0\"",
                                path, topic.name, path);
  if (check.failure.empty() && check.output.empty()) return out + "/>\n";
  out += ">\n";
  if (check.errors > 0) {
    const std::string more =
        check.errors > 1 ? trf(" (and {} more)", check.errors - 1) : std::string();
    out += fmt::format("      <failure type=\"{}\" message=\"{}\">{}</failure>\n", check.type,
                       xml_text(check.headline + more), xml_text(check.failure));
  }
  if (!check.output.empty()) {
    out += fmt::format("      <system-out>{}</system-out>\n", xml_text(check.output));
  }
  return out + "    </testcase>\n";
}

/// Of one suite, or of all.
struct Sums {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  double time_s = 0;

  std::string text() const {
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", tests,
                       failures, errors, time_s);
  }
};

std::string suite_of(const ListedProgram& program, Sums& all) {
  std::array<Check, kFindingTopics> checks;
  for (const Finding& finding : program.findings.kept()) {
    add(checks[static_cast<std::size_t>(row_of(finding.id).topic)], finding,
        diagnostic_of(finding, program.files), program.path);
  }
  Sums sums;
  sums.time_s = program.total_s;
  bool finished = true;
  std::string cases = finished_case(program, finished);
  sums.tests = 1;
  sums.errors = finished ? 0 : 1;
  for (const FindingTopicRow& topic : finding_topics()) {
    const auto at = static_cast<std::size_t>(topic.topic);
    if (!program.looked_at[at]) continue;
    ++sums.tests;
    sums.failures += checks[at].errors > 0 ? 1 : 0;
    cases += topic_case(program, topic, checks[at]);
  }
  std::string left_out;
  const std::uint64_t total = program.findings.total();
  if (const std::size_t kept = program.findings.kept().size(); total > kept) {
    left_out = fmt::format(
        "    <system-out>{}</system-out>\n",
        xml_text(trf("{} findings in all; {} are left out of this list", total, total - kept)));
  }
  all.tests += sums.tests;
  all.failures += sums.failures;
  all.errors += sums.errors;
  all.time_s += sums.time_s;
  return fmt::format("  <testsuite name=\"{}\" {} skipped=\"0\">\n{}{}  </testsuite>\n",
                     xml_text(program.path), sums.text(), cases, left_out);
}

constexpr std::string_view kSuitesEnd = "</testsuites>\n";

std::string suites_text(const std::string& version, const Sums& all, const std::string& suites) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"kerf {}\" {}>\n{}{}",
      xml_text(version), all.text(), suites, kSuitesEnd);
}

/// Of an element as Sums::text() writes it: name="VALUE".
template <class Number>
bool add_value(std::string_view element, std::string_view name, Number& sum) {
  const std::size_t at = element.find(fmt::format(" {}=\"", name));
  if (at == element.npos) return false;
  std::string_view value = element.substr(at + name.size() + 3);
  value = value.substr(0, value.find('"'));
  Number number = 0;
  if (!read_number(value, number)) return false;
  sum += number;
  return true;
}

}  // namespace

std::optional<std::string> join_junit(std::span<const std::string> texts,
                                      const std::string& version) {
  Sums all;
  std::string suites;
  for (const std::string& text : texts) {
    const std::size_t start = text.find("<testsuites ");
    const std::size_t body = start == text.npos ? text.npos : text.find(">\n", start);
    if (body == text.npos || !text.ends_with(kSuitesEnd)) return std::nullopt;
    const std::string_view element = std::string_view(text).substr(start, body - start);
    if (!add_value(element, "tests", all.tests) || !add_value(element, "failures", all.failures) ||
        !add_value(element, "errors", all.errors) || !add_value(element, "time", all.time_s)) {
      return std::nullopt;
    }
    suites += text.substr(body + 2, text.size() - kSuitesEnd.size() - body - 2);
  }
  return suites_text(version, all, suites);
}

std::string xml_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    if (bytes == 0) {
      out += kNoCharacter;
    } else if (character == "&") {
      out += "&amp;";
    } else if (character == "<") {
      out += "&lt;";
    } else if (character == ">") {
      out += "&gt;";
    } else if (character == "\"") {
      out += "&quot;";
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

std::string junit_text(std::span<const ListedProgram> programs, const std::string& version) {
  Sums all;
  std::string suites;
  for (const ListedProgram& program : programs) suites += suite_of(program, all);
  return suites_text(version, all, suites);
}

}  // namespace kerf
