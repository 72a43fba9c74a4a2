#include "interp_bridge/kerf_interp/options.h"

#include <fcntl.h>
#include <getopt.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/units.h"

namespace kerf::interp {
namespace {

constexpr const char* kUsage =
    "usage: kerf-interp [OPTION..] PROGRAM\n"
    "Runs LinuxCNC's interpreter and writes records (README.md) to descriptor 3. Started by kerf.\n"
    "  --records FD            another descriptor\n"
    "  --units mm|inch         of the machine: tools, parameters (mm)\n"
    "  --axes MASK             bit 0 is X .. bit 8 is W (511)\n"
    "  --tools FILE            rows of 14 numbers: tool, pocket, offsets X..W, diameter, front "
    "angle,\n"
    "                          back angle\n"
    "                          and orientation; machine units\n"
    "  --parameters FILE       variable file; it is rewritten\n"
    "  --block-delete on|off   lines that begin with / are skipped (on)\n"
    "  --random-toolchanger    M6 swaps tools\n"
    "  --tool-change \"X Y Z [A B C [U V W]]\"\n"
    "                          where the machine goes before M6, mm and degrees (it stays)\n"
    "  --start \"X Y .. W\"      where the machine stands: nine numbers, mm and degrees (all 0)\n"
    "  --startup BLOCK         run first\n"
    "  --first-line N          reads what comes before line N without doing it, as LinuxCNC's\n"
    "                          \"run from here\" does\n"
    "  --there \"X Y .. W\"      where the machine stands then: nine numbers of the workpiece, mm "
    "and\n"
    "                          degrees (where the program would be)\n"
    "  --answers FD            asks where probing moves end, and reads the answers there\n"
    "  --fast on|off|must      plain numbers are read without LinuxCNC's own stream (on);\n"
    "                          must: or nothing is read\n"
    "  --torch FILE            QtPlasmaC's materials and the values of pins (README.md)\n";

/// With the endings that the interpreter puts behind it (".new", ".bak") less than its 256.
constexpr std::size_t kLongestParameterName = 240;

bool fault(const std::string& message) {
  std::fprintf(stderr, "kerf-interp: %s\n", message.c_str());
  return false;
}

bool read_tools(const std::string& path, World& world) {
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream row(line);
    CANON_TOOL_TABLE tool = empty_tool();
    EmcPose& o = tool.offset;
    row >> tool.toolno >> tool.pocketno >> o.tran.x >> o.tran.y >> o.tran.z >> o.a >> o.b >> o.c >>
        o.u >> o.v >> o.w >> tool.diameter >> tool.frontangle >> tool.backangle >> tool.orientation;
    if (!row) return fault(path + ":" + std::to_string(number) + ": not a row of tool data");
    world.add_tool(tool);
  }
  return file.eof() || fault(path + ": " + std::strerror(errno));
}

/// Behind "material": number, then in mm and s what kerf writes for it.
bool read_material(std::istringstream& row, TorchMaterial& material) {
  row >> material.number >> material.pierce_height_mm >> material.pierce_delay_s >>
      material.cut_height_mm >> material.feed_mm_per_min >> material.kerf_width_mm >>
      material.puddle_jump_height_mm >> material.puddle_jump_delay_s >> material.cut_amps >>
      material.cut_volts >> material.pause_at_end_s >> material.gas_pressure >> material.cut_mode;
  return !row.fail();
}

bool read_torch(const std::string& path, World& world) {
  std::ifstream file(path);
  std::string line;
  std::vector<TorchMaterial> materials;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream row(line);
    std::string word;
    std::string name;
    row >> word;
    if (word == "qtplasmac") {
      row >> world.qtplasmac;
    } else if (word == "convert") {
      row >> world.convert_material;
    } else if (word == "hal") {
      row >> name >> world.hal_values[name];
    } else if (word != "material" || !read_material(row, materials.emplace_back())) {
      row.setstate(std::ios::failbit);
    }
    if (!row) return fault(path + ":" + std::to_string(number) + ": not a row of torch data");
  }
  world.materials = MaterialTable(std::move(materials));
  return file.eof() || fault(path + ": " + std::strerror(errno));
}

bool read_pose(const std::string& text, const char* option, Pose& at) {
  std::istringstream numbers(text);
  for (double& number : at) numbers >> number;
  std::string more;
  if (numbers && !(numbers >> more)) return true;
  return fault(std::string(option) + ": '" + text + "' is not nine numbers");
}

bool read_start(const std::string& text, World& world) {
  Pose at{};
  if (!read_pose(text, "--start", at)) return false;
  world.stand_at(at);
  return true;
}

bool read_tool_change(const std::string& text, World& world) {
  std::istringstream numbers(text);
  world.tool_change_axes = 0;
  for (double number = 0; world.tool_change_axes < 9 && numbers >> number;) {
    world.tool_change_place[world.tool_change_axes++] = number;
  }
  if (numbers.eof() && world.tool_change_axes > 0 && world.tool_change_axes % 3 == 0) return true;
  return fault("--tool-change: '" + text + "' is not three, six or nine numbers");
}

bool read_number(const char* text, long least, long most, const char* option, long& value) {
  char* end = nullptr;
  value = std::strtol(text, &end, 10);
  if (*text != 0 && *end == 0 && value >= least && value <= most) return true;
  return fault(std::string(option) + ": '" + text + "' is not a number from " +
               std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

bool read_options(int argc, char** argv, Options& options, World& world) {
  enum {
    kRecords = 1,
    kUnits,
    kAxes,
    kTools,
    kParameters,
    kBlockDelete,
    kRandom,
    kToolChange,
    kStart,
    kStartup,
    kTorch,
    kAnswers,
    kFirstLine,
    kThere,
    kFast
  };
  static const option kOptions[] = {{"records", required_argument, nullptr, kRecords},
                                    {"units", required_argument, nullptr, kUnits},
                                    {"axes", required_argument, nullptr, kAxes},
                                    {"tools", required_argument, nullptr, kTools},
                                    {"parameters", required_argument, nullptr, kParameters},
                                    {"block-delete", required_argument, nullptr, kBlockDelete},
                                    {"random-toolchanger", no_argument, nullptr, kRandom},
                                    {"tool-change", required_argument, nullptr, kToolChange},
                                    {"start", required_argument, nullptr, kStart},
                                    {"startup", required_argument, nullptr, kStartup},
                                    {"torch", required_argument, nullptr, kTorch},
                                    {"answers", required_argument, nullptr, kAnswers},
                                    {"first-line", required_argument, nullptr, kFirstLine},
                                    {"there", required_argument, nullptr, kThere},
                                    {"fast", required_argument, nullptr, kFast},
                                    {nullptr, 0, nullptr, 0}};
  long number = 0;
  for (int code; (code = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    const std::string value = optarg != nullptr ? optarg : "";
    switch (code) {
      case kRecords:
        if (!read_number(optarg, 0, 1023, "--records", number)) return false;
        options.records_fd = static_cast<int>(number);
        break;
      case kUnits:
        if (value != "mm" && value != "inch") return fault("--units: mm or inch");
        world.units_per_mm = value == "mm" ? 1.0 : 1 / kerf::kMmPerInch;
        // As LinuxCNC starts: in the units of the machine.
        world.units = value == "mm" ? CANON_UNITS_MM : CANON_UNITS_INCHES;
        break;
      case kAxes:
        if (!read_number(optarg, 1, 511, "--axes", number)) return false;
        world.axis_mask = static_cast<int>(number);
        break;
      case kTools:
        if (!read_tools(value, world)) return false;
        break;
      case kParameters:
        // The interpreter would cut a longer name off, and then write another file.
        if (value.size() > kLongestParameterName) {
          return fault("--parameters: a name of " + std::to_string(value.size()) +
                       " bytes is not allowed; at most " + std::to_string(kLongestParameterName));
        }
        world.parameter_file = value;
        break;
      case kBlockDelete:
        if (value != "on" && value != "off") return fault("--block-delete: on or off");
        world.block_delete = value == "on";
        break;
      case kRandom:
        world.random_toolchanger = true;
        break;
      case kToolChange:
        if (!read_tool_change(value, world)) return false;
        break;
      case kStart:
        if (!read_start(value, world)) return false;
        break;
      case kStartup:
        options.startup = value;
        break;
      case kAnswers:
        if (!read_number(optarg, 0, 1023, "--answers", number)) return false;
        options.answers_fd = static_cast<int>(number);
        break;
      case kTorch:
        if (!read_torch(value, world)) return false;
        break;
      case kFirstLine:
        if (!read_number(optarg, 1, 2'000'000'000, "--first-line", number)) return false;
        options.first_line = static_cast<int>(number);
        break;
      case kThere:
        if (!read_pose(value, "--there", options.there.emplace())) return false;
        break;
      case kFast:
        if (value != "on" && value != "off" && value != "must") {
          return fault("--fast: on, off or must");
        }
        options.fast = value == "on"    ? Options::Fast::kOn
                       : value == "off" ? Options::Fast::kOff
                                        : Options::Fast::kMust;
        break;
      default:
        std::fputs(kUsage, stderr);
        return false;
    }
  }
  if (optind != argc - 1) {
    std::fputs(kUsage, stderr);
    return false;
  }
  if (world.random_toolchanger) world.mount_pocket_0();
  options.program = argv[optind];
  if (fcntl(options.records_fd, F_GETFD) < 0) {
    return fault("descriptor " + std::to_string(options.records_fd) +
                 " for the records is not open");
  }
  if (options.answers_fd >= 0 && fcntl(options.answers_fd, F_GETFD) < 0) {
    return fault("descriptor " + std::to_string(options.answers_fd) +
                 " for the answers is not open");
  }
  return true;
}

}  // namespace kerf::interp
