#include "interp_bridge/program.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/translate.h"
#include "base/units.h"
#include "interp_bridge/interpreter_process.h"
#include "interp_bridge/program_kinds.h"
#include "interp_bridge/tool_table.h"

namespace kerf {
namespace {

void report(Diagnostics& diagnostics, const std::string& file, std::string message,
            std::string hint = {}, std::size_t line = 0) {
  Diagnostic diagnostic;
  diagnostic.file = file;
  diagnostic.line = static_cast<int>(line);
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostics.push_back(std::move(diagnostic));
}

bool is_regular_file(const std::string& path, Diagnostics& diagnostics) {
  struct stat status {};
  if (path.empty()) {
    report(diagnostics, {}, tr("no program is named"));
    return false;
  }
  if (stat(path.c_str(), &status) != 0) {
    report(diagnostics, path, trf("cannot be read: {}", std::strerror(errno)));
    return false;
  }
  if (S_ISDIR(status.st_mode)) {
    report(diagnostics, path, tr("is a folder; a program is an NC file or a canonical listing"));
    return false;
  }
  if (!S_ISREG(status.st_mode)) {
    report(diagnostics, path, tr("is not a regular file"),
           tr("canonical text from a pipe is read from stdin: -"));
    return false;
  }
  return true;
}

/// Reads the whole text once. False: it is not a program, which has been reported.
bool survey_file(const std::string& path, TextSurvey& survey, Diagnostics& diagnostics) {
  TextPieces pieces(path);
  TextSurveyor surveyor(path.ends_with(".canon"));
  std::string_view piece;
  while (pieces.next(piece)) {
    if (surveyor.survey().bytes == 0 && piece.substr(0, 2) == "\x1f\x8b") {
      report(diagnostics, path, tr("is compressed (gzip); a program is plain text"),
             tr("gunzip it first, or pipe a listing: zcat part.canon.gz | kerf run -"));
      return false;
    }
    surveyor.add(piece);
    if (surveyor.survey().nul_line != 0) break;
  }
  survey = surveyor.take();
  if (!pieces.error().empty()) {
    report(diagnostics, path, trf("cannot be read: {}", std::strerror(errno)));
  } else if (survey.nul_line != 0) {
    report(diagnostics, path, tr("is not text: it holds a NUL byte"), tr("a program is plain text"),
           survey.nul_line);
  } else if (survey.bytes == 0) {
    report(diagnostics, path, tr("is empty"));
  } else if (survey.blank) {
    report(diagnostics, path, tr("is empty: it holds only white space"));
  } else {
    return true;
  }
  return false;
}

/// Faults of single rows are for whoever reads the table for its shapes (read_tool_table); they are
/// not said twice.
bool read_tools(const ProgramOptions& options, std::vector<ToolTableRow>& rows,
                Diagnostics& diagnostics) {
  if (options.tool_table_path.empty()) return true;
  Diagnostics row_faults;
  auto read = read_tool_table(options.tool_table_path, row_faults,
                              mm_of_unit(options.machine.inch_machine));
  if (read) {
    rows = std::move(*read);
    return true;
  }
  report(diagnostics, {}, read.error());
  return false;
}

/// As ProgramOptions::kerf_interp_path says.
std::string find_kerf_interp(const std::string& given) {
  if (!given.empty()) return find_executable(given);
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    for (const char* place : {"kerf-interp", "../lib/kerf/kerf-interp"}) {
      std::string found = find_executable((self.parent_path() / place).string());
      if (!found.empty()) return found;
    }
  }
  return find_executable("kerf-interp");
}

/// False: a file that is named cannot be read, which has been reported.
bool read_torch(const ProgramOptions& options, TorchRun& torch, Diagnostics& diagnostics) {
  TorchSources sources;
  sources.materials_path = options.torch.materials_path;
  sources.ini_path = options.machine.ini_path;
  sources.hal_values = options.torch.hal_values;
  sources.inch_machine = options.machine.inch_machine;
  torch.qtplasmac = torch.text.is_qtplasmac || options.torch.qtplasmac == QtPlasmacChoice::kOn;
  if (options.torch.qtplasmac == QtPlasmacChoice::kOff) {
    torch.qtplasmac = false;
    torch.materials.assign(1, TorchMaterial{});
    torch.hal_values = std::move(sources.hal_values);
    return true;
  }
  return read_torch_sources(sources, torch, diagnostics);
}

std::unique_ptr<Program> open_kind(const ProgramOptions& options, bool from_stdin,
                                   std::vector<ToolTableRow> tools, TextSurvey survey,
                                   TorchRun torch, Diagnostics& diagnostics) {
  if (from_stdin || survey.listing) {
    std::vector<int> tool_by_index;
    if (!tools.empty()) tool_by_index.push_back(0);
    for (const ToolTableRow& row : tools) tool_by_index.push_back(row.tool);
    return make_listing_program(options, std::move(tool_by_index), std::move(survey),
                                std::move(torch));
  }
  if (options.interpreter != InterpreterChoice::kText) {
    std::string kerf_interp = find_kerf_interp(options.kerf_interp_path);
    if (!kerf_interp.empty()) {
      return make_bridge_program(options, std::move(kerf_interp), std::move(tools),
                                 std::move(survey), std::move(torch));
    }
    if (options.interpreter == InterpreterChoice::kBridge) {
      report(
          diagnostics, {},
          tr("kerf-interp was not found: neither beside kerf, nor in ../lib/kerf, nor in PATH"),
          tr("it is built where linuxcnc-uspace-dev and libboost-dev are installed; --interp text "
             "does without"));
      return nullptr;
    }
  }
  std::string rs274 = find_executable(options.rs274_path);
  if (rs274.empty()) {
    report(diagnostics, {},
           trf("LinuxCNC's interpreter was not found: no executable {}{}", options.rs274_path,
               options.rs274_path.find('/') == std::string::npos ? tr(" in PATH") : ""),
           tr("sudo apt install --no-remove linuxcnc-uspace"));
    return nullptr;
  }
  return make_nc_program(options, std::move(rs274), std::move(tools), std::move(survey),
                         std::move(torch));
}

}  // namespace

std::uint64_t command_limit(const ProgramOptions& options, std::size_t lines) {
  constexpr std::uint64_t kLeast = 50'000'000;
  constexpr std::uint64_t kOfALine = 4;
  return options.max_commands.value_or(std::max(kLeast, kOfALine * lines));
}

std::unique_ptr<Program> Program::open(const ProgramOptions& options, Diagnostics& diagnostics) {
  std::vector<ToolTableRow> tools;
  TextSurvey survey;
  if (!read_tools(options, tools, diagnostics)) return nullptr;
  const bool from_stdin = options.path == "-";
  if (!from_stdin && (!is_regular_file(options.path, diagnostics) ||
                      !survey_file(options.path, survey, diagnostics))) {
    return nullptr;
  }
  TorchRun torch;
  torch.text = std::move(survey.torch);
  if (!read_torch(options, torch, diagnostics)) return nullptr;
  const bool is_qtplasmac = torch.qtplasmac;
  TurningWords turning = survey.turning;
  const std::vector<TorchMaterial> materials = torch.materials;
  auto program = open_kind(options, from_stdin, std::move(tools), std::move(survey),
                           std::move(torch), diagnostics);
  if (program == nullptr) return nullptr;
  program->is_qtplasmac_ = is_qtplasmac;
  program->materials_ = materials;
  program->turning_ = std::move(turning);
  return program;
}

std::string repeat_message(const RepeatWatch& repeats) {
  const double days = repeats.machine_s() / 86'400;
  return trf(
      "the last {} commands are all repetitions, and {}; the program counts as endless",
      repeats.commands(),
      days < 1 ? std::string(tr("move nothing")) : trf("would take the machine {:.3g} days", days));
}

std::string cpu_message(const ProgramOptions& options) {
  return trf("the interpreter has used {:g} s of processor time (--max-cpu-seconds)",
             options.max_cpu_s);
}

}  // namespace kerf
