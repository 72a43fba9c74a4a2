// tests/interp_bridge/program_test_support.h - a folder of test files, and a program run to its
// end.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "interp_bridge/program.h"

namespace kerf {

/// A folder for one test, removed at its end. Programs that it runs put their private folders into
/// `tmp` beneath it, so that what they leave behind can be seen.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-test-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path_ = name;
    std::filesystem::create_directory(path_ / "tmp");
    setenv("TMPDIR", (path_ / "tmp").c_str(), 1);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    unsetenv("TMPDIR");
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  bool nothing_left_behind() const { return std::filesystem::is_empty(path_ / "tmp"); }

 private:
  std::filesystem::path path_;
};

struct ProgramRun {
  bool opened = false;
  std::vector<Motion> motions;
  std::vector<ProgramComment> comments;
  ProgramSummary summary;
  Diagnostics diagnostics;

  std::string messages() const {
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic);
    return text;
  }
};

inline ProgramRun run_program(const ProgramOptions& options) {
  ProgramRun run;
  const std::unique_ptr<Program> program = Program::open(options, run.diagnostics);
  if (program == nullptr) return run;
  run.opened = true;
  run.comments = program->comments();
  run.summary = program->run(
      [&](std::span<const Motion> batch) {
        run.motions.insert(run.motions.end(), batch.begin(), batch.end());
        return true;
      },
      {}, run.diagnostics);
  return run;
}

inline ProgramRun run_program(const std::string& path) {
  ProgramOptions options;
  options.path = path;
  options.interpreter = InterpreterChoice::kText;
  return run_program(options);
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The folder that KERF_SHARED_DATA names, or empty.
inline std::filesystem::path shared_data() {
  const char* const folder = std::getenv("KERF_SHARED_DATA");
  return folder != nullptr ? folder : "";
}

/// A row of the shared data's index, by column.
using Row = std::map<std::string, std::string>;

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == '\t') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

inline std::vector<Row> index_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line);
    Row row;
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace kerf
