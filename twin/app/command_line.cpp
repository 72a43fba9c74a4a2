#include "twin/app/command_line.h"

#include "base/shell_word.h"

namespace kerf {
namespace {

class Line {
 public:
  explicit Line(std::string begin) : text_(std::move(begin)) {}
  void word(const std::string& text) { text_ += ' ' + shell_word(text); }
  void option(const char* name, const std::string& value) {
    if (value.empty()) return;
    word(name);
    word(value);
  }
  void options(const char* name, const std::vector<std::string>& values) {
    for (const std::string& value : values) option(name, value);
  }
  void flag(const char* name, bool is_set) {
    if (is_set) word(name);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A name that begins like an option is none; "-" is standard input.
void add_program_name(const std::string& program, Line& line) {
  if (program.empty()) return;
  line.word(program.front() == '-' && program != "-" ? "./" + program : program);
}

void add_program(const ProgramArguments& a, Line& line) {
  line.option("--units", a.units);
  line.option("--ini", a.ini);
  line.option("--work-offset", a.work_offset);
  line.option("--tool-table", a.tool_table);
  line.option("--interp", a.interp);
  line.option("--block-delete", a.block_delete);
  line.option("--max-commands", a.max_commands);
  line.option("--max-seconds", a.max_seconds);
  line.option("--max-cpu-seconds", a.max_cpu_seconds);
  line.flag("--as-mill", a.as_mill);
}

void add_work(const WorkArguments& a, Line& line) {
  line.option("--stock", a.stock);
  line.options("--tool", a.tools);
  line.option("--cell", a.cell);
  line.option("--model", a.model);
  line.flag("--additive", a.additive);
  line.option("--margin", a.margin);
  line.option("--below", a.below);
  line.option("--path", a.path);
  line.option("--threads", a.threads);
  line.option("--kernel", a.kernel);
}

void add_torch(const TorchArguments& a, Line& line) {
  line.option("--beam", a.beam);
  line.option("--kerf", a.kerf);
  line.option("--pierce", a.pierce);
  line.option("--slats", a.slats);
  line.option("--density", a.density);
  line.option("--qtplasmac", a.qtplasmac);
  line.option("--materials", a.materials);
  line.options("--hal", a.hal);
  line.option("--turret", a.turret);
}

}  // namespace

std::string command_line(const RunArguments& a) {
  Line line(shell_word(a.kerf) + " run");
  add_program_name(a.source.program, line);
  line.option("--config", a.config);
  line.options("--set", a.sets);
  add_program(a.source, line);
  add_work(a.work, line);
  add_torch(a.torch, line);
  line.option("--from-line", a.from_line);
  line.option("--until-line", a.until_line);
  line.option("--mesh-tolerance", a.mesh_tolerance);
  for (const auto& [option, path] : a.outputs.named()) line.option(option, *path);
  line.flag("--view", a.view);
  line.option("--draw", a.draw);
  line.flag("--no-guess", a.no_guess);
  line.flag("--quiet", a.quiet);
  line.flag("--verbose", a.verbose);
  return line.text();
}

std::string command_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::string command_line(const ViewArguments& a) {
  Line line(shell_word(a.run.kerf) + " view");
  add_program_name(a.run.source.program, line);
  line.option("--config", a.config);
  line.options("--set", a.sets);
  add_program(a.run.source, line);
  add_work(a.run.work, line);
  add_torch(a.run.torch, line);
  line.option("--until-line", a.run.until_line);
  line.option("--at-line", a.at_line);
  line.option("--speed", a.speed);
  line.option("--keyframes", a.keyframes);
  line.option("--compare", a.compare);
  line.option("--tolerance", a.tolerance);
  line.option("--png", a.png);
  line.option("--frames", a.frames);
  line.option("--fps", a.fps);
  line.option("--size", a.size);
  line.option("--view", a.view);
  line.option("--draw", a.draw);
  line.flag("--full-redraw", a.no_local);
  line.flag("--no-guess", a.run.no_guess);
  line.flag("--quiet", a.run.quiet);
  return line.text();
}

RunArguments with_guesses(RunArguments a, std::span<const GuessRow> rows) {
  for (const GuessRow& row : rows) {
    if (row.option == "--stock") a.work.stock = row.value;
    if (row.option == "--tool") a.work.tools.push_back(row.value);
    if (row.option == "--beam") a.torch.beam = row.value;
    if (row.option == "--kerf") a.torch.kerf = row.value;
  }
  return a;
}

}  // namespace kerf
