#include "twin/app/cli_options.h"

namespace kerf {
namespace {

void add_program_argument(CLI::App& command, ProgramArguments& a) {
  command
      .add_option("PROGRAM", a.program,
                  "NC file, saved canonical listing (.canon), or - (either of them on stdin)")
      ->required();
}

void add_program_options(CLI::App& command, ProgramArguments& a) {
  command
      .add_option("--ini", a.ini,
                  "LinuxCNC INI of the machine: limits, speeds, tool table, offsets, startup code")
      ->type_name("FILE");
  command
      .add_option("--work-offset", a.work_offset,
                  "where the work zero (G54 ..) lies in the machine, for G53, G28, G30 and axes "
                  "that turn (default: the INI's parameter file; else it is not known)")
      ->type_name("X,Y,Z");
  command
      .add_option("--units", a.units,
                  "of lengths that options give, and of what is shown (default mm; files that are "
                  "read or written are not touched: JSON is mm)")
      ->type_name("mm|inch");
  command.add_option("--tool-table", a.tool_table, "LinuxCNC tool table (tool.tbl)")
      ->type_name("FILE");
  command
      .add_option("--interp", a.interp,
                  "interpreter: bridge (kerf-interp) | text (LinuxCNC's rs274) (default bridge "
                  "where it is there)")
      ->type_name("NAME");
  command.add_option("--block-delete", a.block_delete, "skip lines that begin with / (default on)")
      ->type_name("on|off");
  command
      .add_option("--max-commands", a.max_commands,
                  "canonical commands after which a program counts as endless (default 50 million, "
                  "or 4 a line if that is more)")
      ->type_name("N");
  command
      .add_option(
          "--max-seconds", a.max_seconds,
          "a program that commands nothing (new) for so long counts as endless (default 20)")
      ->type_name("S");
  command
      .add_option("--max-cpu-seconds", a.max_cpu_seconds,
                  "processor time that the interpreter may use in all (default: any)")
      ->type_name("S");
}

void add_as_mill(CLI::App& command, ProgramArguments& a) {
  command.add_flag("--as-mill", a.as_mill,
                   "mill what is for a lathe (kerf has no model for turning, and refuses it else)");
}

void add_work_options(CLI::App& command, WorkArguments& a) {
  command
      .add_option("--tool", a.tools, "shape of tool N, repeatable; `kerf tools` lists the shapes")
      ->type_name("N=SHAPE")
      ->allow_extra_args(false);
  command
      .add_option("--stock", a.stock,
                  "blank: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d[:axis] | "
                  "tube:x,y,z0:z1:d:inner[:axis] | several of these joined by +; or state:FILE (a "
                  "saved workpiece); or "
                  "sheet:x0,y0:x1,y1:THICKNESS, sheet:FILE.dxf:THICKNESS, sheet:FILE.svg:THICKNESS "
                  "(metal to be cut by a torch, laser or jet, or punched; its top is at Z0)")
      ->type_name("SPEC");
  command
      .add_option("--model", a.model,
                  "workpiece model: zmap | mmap | octree | sheet | auto (default auto: what blank, "
                  "tools and motions need)")
      ->type_name("NAME");
  command.add_flag("--additive", a.additive,
                   "material is added along the path (printing, welding), within the blank's box");
  command
      .add_option("--cell", a.cell,
                  "edge of a cell (default: suits the blank, at most 4 million cells; fine "
                  "engravers: up to 64)")
      ->type_name("MM");
  command
      .add_option("--margin", a.margin, "around a blank that is guessed from the moves (default 5)")
      ->type_name("MM");
  command
      .add_option(
          "--below", a.below,
          "how far below the floor of the blank the tool may go: the spoilboard (default 0)")
      ->type_name("MM");
  command
      .add_option("--path", a.path,
                  "what is cut: programmed | planned, with corners rounded as the machine does "
                  "under G64 (default programmed; beside a machine whose INI is given: planned)")
      ->type_name("NAME");
  command
      .add_option("--threads", a.threads,
                  "cutting threads (default: one less than the cores, at most 8)")
      ->type_name("N");
  command.add_option("--kernel", a.kernel, "cutting kernel: auto | scalar | avx2; same result")
      ->type_name("NAME");
}

void add_no_guess(CLI::App& command, RunArguments& a) {
  command.add_flag(
      "--no-guess", a.no_guess,
      "for scripts: a blank or a tool that nobody has described is an error (exit code "
      "2, with all that is missing)");
}

void add_torch_options(CLI::App& command, TorchArguments& a) {
  command
      .add_option(
          "--beam", a.beam,
          "sheets: what turns the torch on: m3 | m62:N | m67:N | m7 | m8 | s | feed | "
          "z<LEVEL, joined by +, inverted by !; or plasmac | laser (default m3; of QtPlasmaC "
          "programs plasmac)")
      ->type_name("TRIGGER");
  command
      .add_option("--kerf", a.kerf,
                  "sheets: width of the kerf (default: --tool N=kerf:W, the material, the tool's "
                  "diameter)")
      ->type_name("MM");
  command
      .add_option("--pierce", a.pierce,
                  "sheets: diameter of the hole where the torch pierces (default: the kerf)")
      ->type_name("MM");
  command
      .add_option("--slats", a.slats,
                  "sheets: distance of the table's slats; parts that are smaller are found")
      ->type_name("MM");
  command
      .add_option("--density", a.density, "sheets: for the weight of parts (default 7850, steel)")
      ->type_name("KG/M3");
  command
      .add_option("--qtplasmac", a.qtplasmac,
                  "whether the program is read as QtPlasmaC does (default auto: if it or the INI "
                  "says so)")
      ->type_name("auto|on|off");
  command
      .add_option("--materials", a.materials,
                  "QtPlasmaC's material file (default: MACHINE_material.cfg beside the INI)")
      ->type_name("FILE");
  command
      .add_option("--hal", a.hal,
                  "value of a HAL pin that the program reads by #<_hal[PIN]>, "
                  "repeatable")
      ->type_name("PIN=VALUE")
      ->allow_extra_args(false);
}

void add_turret_option(CLI::App& command, TorchArguments& a) {
  command
      .add_option("--turret", a.turret,
                  "sheets: the punch press that the program is for: stations, what makes it "
                  "strike, clamps (YAML; configs/punch/turret.yaml explains it)")
      ->type_name("FILE");
}

void add_outline_options(CLI::App& command, OutputPaths& a) {
  command
      .add_option("--dxf", a.dxf,
                  "what is left of a sheet, for --stock sheet:FILE.dxf:THICKNESS, and each part "
                  "beside it: NAME-part-N.dxf")
      ->type_name("FILE");
  command.add_option("--svg", a.svg, "the same as SVG")->type_name("FILE");
}

void add_output_options(CLI::App& command, OutputPaths& a, std::string& mesh_tolerance) {
  command.add_option("--json", a.json, "report, schema kerf-report/1")->type_name("FILE");
  command.add_option("--png", a.png, "picture of the finished part")->type_name("FILE");
  command.add_option("--stl", a.stl, "finished part as a closed mesh, binary STL")
      ->type_name("FILE");
  command.add_option("--ply", a.ply, "the same as binary PLY")->type_name("FILE");
  command.add_option("--state", a.state, "finished workpiece, for --stock state:FILE")
      ->type_name("FILE");
  command
      .add_option("--mesh-tolerance", mesh_tolerance,
                  "how far meshes may lie from the model (default 0.01; 0 = every cell)")
      ->type_name("MM");
}

void add_replay_options(CLI::App& replay, LiveArguments& a) {
  replay
      .add_option("LOG", a.log,
                  "recording of kerf, CSV with a header, halsampler file, candump -l file, or - "
                  "(standard input)")
      ->required();
  replay.add_option("--speed", a.speed, "program seconds a second, or max (default 1)")
      ->type_name("X|max");
  replay
      .add_option("--pins", a.pins,
                  "halsampler: the pins of its columns, or the .hal file that set it up")
      ->type_name("PIN,PIN..|FILE.hal");
}

void add_shadow_options(CLI::App& shadow, LiveArguments& a) {
  shadow.add_option("--record", a.record, "record what comes, for kerf replay")->type_name("FILE");
  shadow.add_option("--cpu-limit", a.cpu_limit, "share of one CPU that may be used (default all)")
      ->type_name("PERCENT");
  shadow.add_option("--memory-limit", a.memory_limit, "memory that may be used (default all)")
      ->type_name("MB");
}

}  // namespace

void add_run_options(CLI::App& run, RunArguments& a) {
  run.add_option(
         "PROGRAM", a.programs,
         "NC file, saved canonical listing (.canon), or - (either of them on stdin); several "
         "are run one after the other, and the exit code is the worst of them")
      ->required();
  run.add_option("-c,--config", a.config, "configuration: machine, beam, tools, stock")
      ->type_name("FILE");
  run.add_option("--set", a.sets, "any key of the configuration, repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_program_options(run, a.source);
  add_as_mill(run, a.source);
  add_work_options(run, a.work);
  add_no_guess(run, a);
  add_torch_options(run, a.torch);
  add_turret_option(run, a.torch);
  run.add_option("--from-line", a.from_line,
                 "cut what comes before line N without a word, report from there")
      ->type_name("N");
  run.add_option("--until-line", a.until_line, "stop before the first move beyond line N")
      ->type_name("N");
  add_output_options(run, a.outputs, a.mesh_tolerance);
  add_outline_options(run, a.outputs);
  run.add_flag("--view", a.view, "then show it in a window, at its end");
  run.add_option("--draw", a.draw,
                 "the window's workpiece by mesh | raycast | csg (default as it remembers it)")
      ->type_name("NAME");
  run.add_flag("--quiet", a.quiet, "no summary, no progress bar, no warnings");
  run.add_flag("--verbose", a.verbose,
               "a longer summary: moves and distances, the whole time model, what the run took");
}

void add_view_options(CLI::App& view, ViewArguments& a) {
  view.add_option(
      "PROGRAM", a.run.source.program,
      "NC file, saved canonical listing (.canon), a log, or a saved workpiece; without: "
      "an empty window, from which one can be opened");
  view.add_option("-c,--config", a.config, "configuration: machine (its model), tools, stock, view")
      ->type_name("FILE");
  view.add_option("--set", a.sets, "any key of the configuration, repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_program_options(view, a.run.source);
  add_as_mill(view, a.run.source);
  add_work_options(view, a.run.work);
  add_no_guess(view, a.run);
  add_torch_options(view, a.run.torch);
  add_turret_option(view, a.run.torch);
  view.add_option("--until-line", a.run.until_line, "nothing beyond line N")->type_name("N");
  view.add_option("--at-line", a.at_line, "begin at line N")->type_name("N");
  view.add_option("--speed", a.speed, "play at once: program seconds a second, 0.1 to 1000, or max")
      ->type_name("X|max");
  view.add_option("--keyframes", a.keyframes,
                  "memory for jumping to and fro in the program (default 256)")
      ->type_name("MB");
  view.add_option("--compare", a.compare,
                  "part as designed (STL, mm, workpiece frame): colours say what is left over and "
                  "what is gone too far")
      ->type_name("FILE");
  view.add_option("--tolerance", a.tolerance, "deviations up to this are green (default 0.05)")
      ->type_name("MM");
  view.add_flag("--full-redraw", a.no_local,
                "draw the whole picture every time, not only what has changed");
  view.add_option("--png", a.png, "no window: a picture, at the end or at --at-line")
      ->type_name("FILE");
  view.add_option("--frames", a.frames, "no window: the pictures of a film, frame_000000.png ..")
      ->type_name("DIR");
  view.add_option("--fps", a.fps, "frames a second of the film (default 25)")->type_name("N");
  view.add_option("--size", a.size, "of pictures (default 1280x720)")->type_name("WxH");
  view.add_option("--view", a.view,
                  "of pictures: iso | top | bottom | front | back | left | right (default iso)")
      ->type_name("NAME");
  view.add_option("--draw", a.draw,
                  "workpiece by mesh | raycast (pictures without OpenGL) | csg (blank minus "
                  "moves); the last two have no colours and no section (default mesh, or as the "
                  "window has it)")
      ->type_name("NAME");
  view.add_flag("--quiet", a.run.quiet, "no warnings, no progress bar");
}

void add_canon_options(CLI::App& canon, CanonArguments& a) {
  add_program_argument(canon, a.source);
  add_program_options(canon, a.source);
  canon.add_option("--out", a.out, "where to (default -, standard output)")->type_name("FILE");
  canon.add_flag("--quiet", a.quiet, "no progress bar, no warnings");
}

void add_live_options(CLI::App& live, LiveArguments& a, LiveCommand command) {
  if (command == LiveCommand::kReplay) add_replay_options(live, a);
  live.add_option("-c,--config", a.config, "configuration: source, machine, tools, stock")
      ->type_name("FILE");
  live.add_option("--set", a.sets, "any key of the configuration, repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  live.add_option("--program", a.source.program,
                  "the program that the machine runs: its path is cut, what it does beside it is "
                  "found, and what it would hit is told beforehand")
      ->type_name("FILE");
  live.add_option("--next-program", a.next_programs,
                  "another program that the machine may run, repeatable: which one it is, its path "
                  "tells")
      ->type_name("FILE")
      ->allow_extra_args(false);
  live.add_option("--on-program-end", a.on_program_end,
                  "the workpiece when a program has come to its end: keep | new-blank, for the "
                  "next one to begin with (default keep)")
      ->type_name("POLICY");
  add_program_options(live, a.source);
  add_as_mill(live, a.source);
  add_work_options(live, a.work);
  add_torch_options(live, a.torch);
  add_turret_option(live, a.torch);
  if (command == LiveCommand::kShadow) add_shadow_options(live, a);
  live.add_flag("--no-view", a.no_view,
                "no window (there is one where there is a display, but for --speed max)");
  live.add_option("--draw", a.draw,
                  "the window's workpiece by mesh | raycast (default as it remembers it)")
      ->type_name("NAME");
  live.add_option("--for", a.for_s, "end after so long")->type_name("SECONDS");
  live.add_option("--gap", a.gap,
                  "the way between two positions with a gap between them: mark | cut | ignore "
                  "(default mark: a finding, not cut)")
      ->type_name("POLICY");
  live.add_option("--joined-late", a.joined_late,
                  "what a program that runs already cuts before the machine is first seen: cut | "
                  "keep (default cut: it is in the workpiece)")
      ->type_name("POLICY");
  live.add_option("--look-ahead", a.look_ahead,
                  "how far ahead of the machine the program is run (default 10, 0 = not)")
      ->type_name("SECONDS");
  live.add_option("--off-path", a.off_path,
                  "how far from the program's path the tip may be (default 0.5)")
      ->type_name("MM");
  live.add_option("--events", a.events, "states, findings and warnings as JSON lines")
      ->type_name("FILE");
  add_output_options(live, a.outputs, a.mesh_tolerance);
  add_outline_options(live, a.outputs);
  live.add_flag("--quiet", a.quiet, "errors and warnings of collisions only");
}

}  // namespace kerf
