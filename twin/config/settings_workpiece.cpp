#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kWorkpieceSettings{
    Setting{.key = "stock", .purpose = tr_noop("the workpiece")},
    Setting{
        .key = "stock.blank",
        .option = "--stock",
        .commands = kCutting,
        .type = T::kText,
        .unit = "mm",
        .purpose = tr_noop("blank, as --stock has it: box:0,0,-20:100,60,0, state:FILE, stl:FILE, "
                           "sheet:0,0:600,400:3, .."),
        .help = tr_noop(
            "blank: box:x0,y0,z0:x1,y1,z1 | cylinder:x,y,z0:z1:d[:axis] | "
            "tube:x,y,z0:z1:d:inner[:axis] | hex:x,y,z0:z1:FLATS | square:x,y,z0:z1:FLATS (bars "
            "for "
            "a lathe, width across flats) | several of these joined by +; or state:FILE (a saved "
            "workpiece); stl:FILE[+ALLOWANCE][:inch], obj:FILE, 3mf:FILE, step:FILE (a casting, an "
            "earlier part), each file with [:flip=x|y][:rotate=A,B,C][:at=x,y,z]; or "
            "profile:FILE.dxf, profile:FILE.svg (what turns about the drawing's x "
            "axis); or "
            "sheet:x0,y0:x1,y1:THICKNESS, sheet:FILE.dxf:THICKNESS, sheet:FILE.svg:THICKNESS "
            "(metal to be cut by a torch, laser or jet, or punched; its top is at Z0)"),
        .value_name = "SPEC"},
    Setting{.key = "stock.model",
            .option = "--model",
            .commands = kCutting,
            .type = T::kWord,
            .words = "auto|zmap|mmap|octree|sheet|turning",
            .fallback = "auto",
            .purpose = tr_noop("how the workpiece is modelled; auto: what tools and motions need"),
            .help = tr_noop(
                "workpiece model: zmap | mmap | octree | sheet | turning | auto (default {}: "
                "what blank, tools and motions need)"),
            .value_name = "NAME",
            .refusal = tr_noop("'{}' is no model; allowed: {}")},
    Setting{.option = "--additive",
            .commands = kAnyProcess,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop(
                "material is added along the path (printing, welding), within the blank's box"),
            .flag = "yes"},
    Setting{.key = "stock.cell_mm",
            .option = "--cell",
            .commands = kCutting,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .least_excluded = true,
            .purpose = tr_noop("grid size; by the size of the blank where it is not given"),
            .hint = tr_noop("0.05 to 0.2 suits most parts"),
            .help = tr_noop("edge of a cell (default: suits the blank, at most 4 million cells; "
                            "fine engravers: up to 64)"),
            .value_name = "LENGTH"},
    Setting{.key = "stock.margin_mm",
            .option = "--margin",
            .commands = kCutting,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 10000,
            .fallback = "5",
            .purpose = tr_noop("around a blank that is guessed from the program"),
            .help = tr_noop("around a blank that is guessed from the moves (default {})"),
            .value_name = "LENGTH"},
    Setting{
        .key = "stock.below_mm",
        .option = "--below",
        .commands = kCutting,
        .type = T::kNumber,
        .unit = "mm",
        .least = 0,
        .most = 1000,
        .fallback = "0",
        .purpose = tr_noop("how far below the floor of the blank the tool may go: the spoilboard"),
        .help = tr_noop(
            "how far below the floor of the blank the tool may go: the spoilboard (default {})"),
        .value_name = "LENGTH"},
    Setting{.key = "tools", .purpose = tr_noop("shapes of tools, by number")},
    Setting{
        .key = "tools.NUMBER",
        .option = "--tool",
        .commands = kCutting,
        .type = T::kText,
        .unit = "mm and degrees",
        .purpose = tr_noop("shape, as --tool has it: flat:6, ball:10:flute=22, profile:FILE, .."),
        .help = tr_noop("shape of tool N, repeatable; `kerf tools` lists the shapes"),
        .value_name = "N=SHAPE",
        .repeatable = true},
    Setting{.key = "fixtures",
            .type = T::kGroups,
            .purpose = tr_noop("what holds the workpiece and stands around it")},
    Setting{.key = "fixtures.name", .type = T::kText, .purpose = tr_noop("for findings")},
    Setting{.key = "fixtures.shape",
            .option = "--fixture",
            .commands = kCutting,
            .key_counts_for = 0,
            .type = T::kText,
            .unit = "mm",
            .purpose = tr_noop("as --fixture has it: vise:125:60:40:at=50,30,-20, stl:clamp.stl"),
            .help = tr_noop(
                "what stands around the workpiece, repeatable: [NAME=]box:x0,y0,z0:x1,y1,z1 | "
                "cylinder:.. | tube:.. | stl:FILE[:inch] | obj:FILE[:inch] | 3mf:FILE | "
                "step:FILE | "
                "vise:JAW_WIDTH:OPENING:HEIGHT | "
                "clamp:LENGTH:WIDTH:HEIGHT | screw:D:LENGTH, with [:at=x,y,z][:turn=DEG]"
                "[:in-blank][:on=LINK]"),
            .value_name = "SPEC",
            .repeatable = true},
    Setting{.key = "fixtures.at",
            .type = T::kText,
            .unit = "mm",
            .fallback = "0,0,0",
            .purpose = tr_noop("x,y,z: where the shape's 0,0,0 lies in the program's coordinates")},
    Setting{.key = "fixtures.turn",
            .type = T::kNumber,
            .unit = "degrees",
            .least = -360,
            .most = 360,
            .fallback = "0",
            .purpose = tr_noop("of the shape about Z")},
    Setting{.key = "fixtures.in_blank",
            .type = T::kYesNo,
            .fallback = "no",
            .purpose = tr_noop("it may stand in the blank: a screw, a mandrel")},
    Setting{
        .key = "fixtures.on",
        .type = T::kText,
        .purpose = tr_noop("link of machine.links that it stands on, and moves with: `at` is in "
                           "the link's frame then")},
    Setting{.key = "fixtures.clearance_mm",
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .purpose = tr_noop("near-miss of this one, instead of clearance_mm")},
    Setting{.key = "clearance_mm",
            .option = "--clearance",
            .commands = kCutting,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .fallback = "0.5",
            .purpose = tr_noop(
                "what comes nearer to a fixture or, above the cutter, to the workpiece without "
                "touching it is told; 0: it is not"),
            .help = tr_noop(
                "near-miss: what comes nearer to a fixture or, above the cutter, to the workpiece "
                "without touching it is told (default {}; 0: it is not)"),
            .value_name = "LENGTH"},
    Setting{.key = "clearances",
            .type = T::kGroups,
            .purpose = tr_noop("near-miss of single pairs, instead of clearance_mm")},
    Setting{.key = "clearances.pair",
            .type = T::kTexts,
            .purpose = tr_noop("two names, as machine.ignore has them: [head, vise]")},
    Setting{.key = "clearances.mm",
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 1000,
            .purpose = tr_noop("what comes nearer is told; 0: it is not")},
    Setting{
        .key = "cut_by_shank",
        .option = "--cut-by-shank",
        .commands = kCutting,
        .type = T::kYesNo,
        .fallback = "no",
        .purpose = tr_noop("what the shank of a tool touches is cut away (--cut-by-shank)"),
        .help = tr_noop("what the shank of a tool touches is cut away; it is told all the same"),
        .flag = "yes"},
    Setting{.key = "tool_libraries",
            .option = "--tools",
            .commands = kCutting,
            .type = T::kTexts,
            .purpose = tr_noop("files of tools, as --tools has them; tools comes before them"),
            .help = tr_noop("tools from a file, repeatable: FreeCAD's .fctl, Fusion's .json or "
                            ".tools, YAML; a .fctb as N=FILE (`kerf tools FILE` lists them)"),
            .value_name = "FILE",
            .repeatable = true},
    Setting{.option = "--threads",
            .commands = kCutting | kJob,
            .type = T::kWhole,
            .unit = "threads",
            .least = 1,
            .most = 256,
            .help = tr_noop("cutting threads (default: one less than the cores, at most 8)"),
            .value_name = "N"},
    Setting{.option = "--kernel",
            .commands = kCutting,
            .type = T::kWord,
            .words = "auto|scalar|sse2|avx2|neon",
            .fallback = "auto",
            .help = tr_noop("cutting kernel: auto | scalar | sse2 | avx2 | neon; same result"),
            .value_name = "NAME",
            .refusal = tr_noop("'{}' is no kernel; allowed: {}")},
    Setting{.option = "--no-guess",
            .commands = kRun | kView | kDiff | kOptimize,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("for scripts: a blank or a tool that nobody has described is an error "
                            "(exit code 2, with all that is missing)"),
            .flag = "yes"},
};

}  // namespace

std::span<const Setting> workpiece_settings() { return kWorkpieceSettings; }

}  // namespace kerf
