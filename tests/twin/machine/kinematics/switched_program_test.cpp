// M428 and M429 as LinuxCNC's sample configurations have them: remapped to subroutines that set an
// analog output, and stop the program where the kinematics do not follow.
#include <gtest/gtest.h>

#include "tests/interp_bridge/program_test_support.h"
#include "twin/machine/kinematics/tool_path.h"

namespace kerf {
namespace {

std::string remap(int code, int type) {
  const std::string name = std::to_string(code) + "remap";
  const std::string number = std::to_string(type);
  return "o<" + name + "> sub\no1 if [exists [#<_hal[motion.switchkins-type]>]]\no1 else\n  M2\n" +
         "o1 endif\n  M68 E3 Q" + number + "\n  M66 E0 L0\n" +
         "o2 if [#<_hal[motion.switchkins-type]> NE " + number + "]\n  M2\no2 endif\no<" + name +
         "> endsub\nM2\n";
}

TEST(SwitchedProgram, EveryMotionKnowsItsKinematics) {
  const TestFolder folder;
  folder.write("subs/428remap.ngc", remap(428, 1));
  folder.write("subs/429remap.ngc", remap(429, 0));
  ProgramOptions options;
  options.interpreter = InterpreterChoice::kBridge;
  options.kerf_interp_path = KERF_INTERP_EXECUTABLE;
  options.machine.ini_path =
      folder.write("trt.ini",
                   "[RS274NGC]\nSUBROUTINE_PATH = ./subs\nHAL_PIN_VARS = 1\n"
                   "REMAP = M428 modalgroup=10 ngc=428remap\n"
                   "REMAP = M429 modalgroup=10 ngc=429remap\n[TRAJ]\nCOORDINATES = XYZAC\n"
                   "LINEAR_UNITS = mm\n");
  options.machine.working_folder = folder.path("");
  options.path = folder.write("part.ngc",
                              "G21 G90\nG0 X10 Y0 Z0\nG1 F100 C90\nG1 C0\nM428\nG1 C90\nG1 C0\n"
                              "M429\nG1 X0\nM2\n");
  const ProgramRun run = run_program(options);
  ASSERT_TRUE(run.opened) << run.messages();
  const auto machine = known_machine("xyzac-trt-kins sparm=identityfirst", "", {}, {});
  ASSERT_TRUE(machine);
  const auto path = ToolPath::create(*machine, {}, {});
  ASSERT_TRUE(path);
  std::string types;
  for (const Motion& m : run.motions) {
    if (m.kind != MotionKind::kFeed) continue;
    types += static_cast<char>('0' + machine->type_of(m));
    // A quarter turn of the table carries the tip round; followed, it stays.
    if (m.to_abc_deg[2] != 90) continue;
    const Vec3 tip = path->pose_at(m, 1).origin_mm;
    const Vec3 expected = machine->type_of(m) == 0 ? Vec3(0, -10, 0) : Vec3(10, 0, 0);
    EXPECT_LT(std::abs(tip.x - expected.x) + std::abs(tip.y - expected.y), 1e-9);
  }
  EXPECT_EQ(types, "00110") << run.messages();
}

}  // namespace
}  // namespace kerf
