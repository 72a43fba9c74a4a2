#include "twin/cli/command_examples.h"

#include "base/translate.h"

namespace kerf {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  kerf run part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --png part.png\n"
    "  kerf shadow -c mill.yaml --program part.ngc\n"
    "  kerf replay run.csv --speed max --stock box:0,0,-20:100,60,0\n"
    "  kerf view part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  kerf diff old.ngc new.ngc\n"
    "  kerf optimize part.ngc -o fast.ngc --max-rate 300\n"
    "  kerf batch parts --out results\n"
    "  kerf canon part.ngc\n"
    "  kerf models\n"
    "  kerf tools\n";

constexpr const char* kRunExample =
    "Examples:\n"
    "  kerf run part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --json - --stl part.stl\n"
    "  kerf run plate.ngc --stock sheet:0,0:600,400:3 --kerf 1.2 --pierce 3 --dxf rest.dxf\n";

constexpr const char* kViewExample =
    "Examples:\n"
    "  kerf view part.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  kerf view part.ngc --frames film --fps 25 --speed 10\n";

constexpr const char* kDiffExample = tr_noop(
    "Exit code 0: the same; 1: different.\n\n"
    "Examples:\n"
    "  kerf diff old.ngc new.ngc --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  kerf diff part.ngc part.state --json -\n");

constexpr const char* kOptimizeExample = tr_noop(
    "Only F words are changed. The new program is read and cut again: it appears if its motions\n"
    "are the same, bit for bit, so is the workpiece, and no limit is exceeded.\n\n"
    "Examples:\n"
    "  kerf optimize part.ngc -o fast.ngc --chip 0.05 --tool 1=flat:10:teeth=3 --ini mill.ini\n"
    "  kerf optimize part.ngc --in-place --max-rate 300 --max-feed 2500 --air-feed 4000\n");

constexpr const char* kJobExample =
    "Example:\n"
    "  kerf job examples/job/housing.yaml --png pictures --json job.json\n";

constexpr const char* kBatchExample =
    "Examples:\n"
    "  kerf batch parts --out results --stock box:0,0,-20:100,60,0 --tool 1=flat:6\n"
    "  git ls-files '*.ngc' | kerf batch - --out results --jobs 4 --options options.txt\n";

constexpr const char* kCanonExample = tr_noop(
    "Each line is an object: line, file, kind, from, to, feed, tool, t, duration, and what else\n"
    "applies; mm, mm/min, s, degrees.\n\n"
    "Example:\n"
    "  kerf canon part.ngc | jq -c 'select(.kind == \"traverse\") | .to'\n");

constexpr const char* kShadowExample =
    "Examples:\n"
    "  kerf shadow --set source.type=hal --ini mill.ini --program part.ngc --stock "
    "box:0,0,-20:100,60,0\n"
    "  kerf shadow -c mill.yaml --record run.csv\n";

constexpr const char* kReplayExample =
    "Example:\n"
    "  kerf replay run.csv --stock box:0,0,-20:100,60,0 --tool 1=flat:6 --speed max --png "
    "part.png\n";

constexpr const char* kConfigExample =
    "Examples:\n"
    "  kerf config check mill.yaml\n"
    "  kerf config print mill.yaml\n"
    "  kerf config schema\n"
    "  kerf config completion bash\n"
    "  kerf config man kerf-run\n";

constexpr const char* kMachineExample =
    "Example:\n"
    "  kerf machine part.ngc --modbus-tcp 127.0.0.1:1502 --frame workpiece\n";

constexpr const char* kSetupExample =
    "Examples:\n"
    "  kerf setup mill.ini\n"
    "  kerf setup mill.ini --write\n"
    "  kerf setup mill.ini --undo --write\n";

constexpr const char* kToolsExample =
    "Examples:\n"
    "  kerf tools\n"
    "  kerf tools --holders\n"
    "  kerf tools --inserts\n"
    "  kerf tools shop.json\n";

constexpr const char* kMcpExample = tr_noop(
    "A client starts it, and speaks with it on standard input and output.\n\n"
    "Example:\n"
    "  kerf mcp --folder ~/linuxcnc/nc_files\n");

}  // namespace

const char* examples_of_kerf() { return kExamples; }

const char* examples_of(Command command) {
  switch (command) {
    case kRun:
      return kRunExample;
    case kView:
      return kViewExample;
    case kShadow:
      return kShadowExample;
    case kReplay:
      return kReplayExample;
    case kDiff:
      return kDiffExample;
    case kOptimize:
      return kOptimizeExample;
    case kBatch:
      return kBatchExample;
    case kJob:
      return kJobExample;
    case kCanon:
      return kCanonExample;
    case kConfig:
      return kConfigExample;
    case kMachine:
      return kMachineExample;
    case kSetup:
      return kSetupExample;
    case kModels:
      return "Example:\n  kerf models\n";
    case kSources:
      return "Example:\n  kerf sources\n";
    case kTools:
      return kToolsExample;
    case kMcp:
      return kMcpExample;
    default:
      return "";
  }
}

}  // namespace kerf
