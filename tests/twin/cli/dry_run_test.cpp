// What a dry run in the background tells of a program.

#include "twin/cli/dry_run.h"

#include <gtest/gtest.h>

#include <string>

namespace kerf {
namespace {

std::string report(const std::string& findings) {
  return R"({"schema": "kerf-report/1", "motion": {"duration_s": 750.4}, "findings": [)" +
         findings + "]}";
}

constexpr const char* kError =
    R"({"id": "rapid-contact", "severity": "error", "file": "part.ngc", "line": 118,
        "time_s": 12.5, "message": "traverse touches the workpiece, 2.31 mm deep"})";
constexpr const char* kWarning =
    R"({"id": "tool-guessed", "severity": "warning", "file": "part.ngc", "line": 3,
        "time_s": null, "message": "tool 1 is guessed"})";
constexpr const char* kNote =
    R"({"id": "no-program-end", "severity": "note", "file": "part.ngc", "line": 9,
        "time_s": null, "message": "no M2"})";

TEST(DryRunResult, CountsErrorsAndWarnings) {
  const std::optional<DryRunResult> result =
      dry_run_result("nc/part.ngc", report(std::string(kError) + "," + kWarning + "," + kNote));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->is_done);
  EXPECT_FALSE(result->is_good());
  EXPECT_EQ(result->errors, 1);
  EXPECT_EQ(result->warnings, 1);
  EXPECT_DOUBLE_EQ(result->duration_s, 750.4);
  ASSERT_EQ(result->findings.size(), 2U);
  EXPECT_EQ(to_string(diagnostic_of(result->findings[0], {})),
            "part.ngc:118: error: rapid-contact: dry run: traverse touches the workpiece, 2.31 mm "
            "deep\n");
  EXPECT_EQ(line_of(*result), "part.ngc: dry run: errors: 1, warnings: 1, 12 min 30 s");
}

TEST(DryRunResult, WithWarningsAloneItIsGood) {
  const std::optional<DryRunResult> result = dry_run_result("part.ngc", report(kWarning));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->is_good());
}

TEST(DryRunResult, WithoutFindingsItSaysSo) {
  const std::optional<DryRunResult> result = dry_run_result("part.ngc", report(""));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->is_good());
  EXPECT_EQ(line_of(*result), "part.ngc: dry run: no findings, 12 min 30 s");
}

/// Cut off anywhere it is no report.
TEST(DryRunResult, HalfAReportIsNone) {
  const std::string whole = report(kError);
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    EXPECT_FALSE(dry_run_result("part.ngc", whole.substr(0, bytes))) << bytes;
  }
  EXPECT_FALSE(dry_run_result("part.ngc", R"({"schema": "kerf-report/1"})"));
  EXPECT_FALSE(dry_run_result("part.ngc", R"({"schema": 7, "motion": 1, "findings": 2})"));
  EXPECT_FALSE(dry_run_result(
      "part.ngc", R"({"schema": "kerf-report/1", "motion": {"duration_s": 1}, "findings": [3]})"));
}

}  // namespace
}  // namespace kerf
