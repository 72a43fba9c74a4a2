#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kOutputSettings{
    Setting{.option = "--record",
            .commands = kShadow,
            .type = T::kFile,
            .help = tr_noop("record what comes, for kerf replay"),
            .value_name = "FILE"},
    Setting{.option = "--events",
            .commands = kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("states, findings and warnings as JSON lines"),
            .value_name = "FILE"},
    Setting{.option = "--json",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("report, schema kerf-report/1"),
            .value_name = "FILE"},
    Setting{.option = "--png",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("picture of the finished part"),
            .value_name = "FILE"},
    Setting{.option = "--finding-png",
            .commands = kRun | kReplay,
            .type = T::kFolder,
            .help = tr_noop("a picture of each of the first 20 findings that have a place"),
            .value_name = "DIR"},
    Setting{.option = "--stl",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("finished part as a closed mesh, binary STL"),
            .value_name = "FILE"},
    Setting{.option = "--ply",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("the same as binary PLY"),
            .value_name = "FILE"},
    Setting{.option = "--state",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("finished workpiece, for --stock state:FILE"),
            .value_name = "FILE"},
    Setting{.option = "--mesh-tolerance",
            .commands = kRun | kBesideMachine,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .fallback = "0.01",
            .help = tr_noop("how far meshes may lie from the model (default {}; 0 = every cell)"),
            .value_name = "LENGTH"},
    Setting{.option = "--dxf",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("what is left of a sheet, for --stock sheet:FILE.dxf:THICKNESS, and "
                            "each part beside it: NAME-part-N.dxf; of a turned part its contour, "
                            "for --stock profile:FILE.dxf"),
            .value_name = "FILE"},
    Setting{.option = "--svg",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("the same as SVG"),
            .value_name = "FILE"},
    Setting{.option = "--html",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("report to hand on, one HTML file that needs no network: the part in "
                            "3D, findings, tools, set-up sheet"),
            .value_name = "FILE"},
    Setting{.option = "--pdf",
            .commands = kRun | kBesideMachine,
            .type = T::kFile,
            .help = tr_noop("the same on paper, where a browser is installed (chromium)"),
            .value_name = "FILE"},
    Setting{.option = "--out",
            .commands = kCanon,
            .type = T::kFile,
            .fallback = "-",
            .help = tr_noop("where to (default {}, standard output)"),
            .value_name = "FILE"},
};

}  // namespace

std::span<const Setting> output_settings() { return kOutputSettings; }

}  // namespace kerf
