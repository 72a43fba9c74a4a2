#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kSheetSettings{
    Setting{.key = "beam", .purpose = tr_noop("sheets: the torch, laser or jet that cuts them")},
    Setting{
        .key = "beam.trigger",
        .option = "--beam",
        .commands = kAnyProcess,
        .type = T::kText,
        .purpose = tr_noop("what turns it on, as --beam has it: m3, laser, m62:0, ..; else m3, or "
                           "plasmac for programs of QtPlasmaC"),
        .help = tr_noop("sheets: what turns the torch on: m3 | m62:N | m67:N | m7 | m8 | s | feed "
                        "| z<LEVEL, joined by +, inverted by !; or plasmac | laser (default m3; of "
                        "QtPlasmaC programs plasmac)"),
        .value_name = "TRIGGER",
        .yields_to = "--turret"},
    Setting{.key = "beam.kerf_mm",
            .option = "--kerf",
            .commands = kAnyProcess,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0.01,
            .most = 100,
            .purpose = tr_noop("width of the cuts of tools that `tools` does not describe"),
            .help = tr_noop("sheets: width of the kerf (default: --tool N=kerf:W, the material, "
                            "the tool's diameter)"),
            .value_name = "LENGTH",
            .yields_to = "--turret"},
    Setting{
        .key = "beam.pierce_mm",
        .option = "--pierce",
        .commands = kAnyProcess,
        .type = T::kNumber,
        .unit = "mm",
        .least = 0.01,
        .most = 100,
        .purpose = tr_noop("diameter of the hole where it pierces; else the kerf"),
        .help = tr_noop("sheets: diameter of the hole where the torch pierces (default: the kerf)"),
        .value_name = "LENGTH",
        .yields_to = "--turret"},
    Setting{
        .key = "beam.slats_mm",
        .option = "--slats",
        .commands = kAnyProcess,
        .type = T::kNumber,
        .unit = "mm",
        .least = 1,
        .most = 10000,
        .purpose = tr_noop("from one slat of the table to the next: smaller parts fall through"),
        .help = tr_noop("sheets: distance of the table's slats; parts that are smaller are found"),
        .value_name = "LENGTH",
        .yields_to = "--turret"},
    Setting{.key = "beam.density_kg_per_m3",
            .option = "--density",
            .commands = kAnyProcess,
            .type = T::kNumber,
            .unit = "kg/m3",
            .least = 1,
            .most = 30000,
            .purpose = tr_noop("of the metal, for the weight of parts; else that of steel, 7850"),
            .help = tr_noop("sheets: for the weight of parts (default 7850, steel)"),
            .value_name = "KG/M3"},
    Setting{.key = "beam.qtplasmac",
            .option = "--qtplasmac",
            .commands = kAnyProcess,
            .type = T::kWord,
            .words = "auto|on|off",
            .purpose = tr_noop("whether the program is for QtPlasmaC; auto: by what it reads"),
            .help = tr_noop("whether the program is read as QtPlasmaC does (default auto: if it or "
                            "the INI says so)"),
            .value_name = "auto|on|off",
            .yields_to = "--turret"},
    Setting{
        .key = "beam.materials",
        .option = "--materials",
        .commands = kAnyProcess,
        .type = T::kFile,
        .purpose = tr_noop("material file of QtPlasmaC: kerf widths by number"),
        .help = tr_noop("QtPlasmaC's material file (default: MACHINE_material.cfg beside the INI)"),
        .value_name = "FILE",
        .yields_to = "--turret"},
    Setting{
        .option = "--hal",
        .commands = kAnyProcess,
        .type = T::kText,
        .help = tr_noop("value of a HAL pin that the program reads by #<_hal[PIN]>, repeatable"),
        .value_name = "PIN=VALUE",
        .repeatable = true},
    Setting{.key = "turret",
            .option = "--turret",
            .commands = kAnyProcess,
            .type = T::kFile,
            .purpose = tr_noop("sheets: the punch press instead of a beam, as --turret has it"),
            .help = tr_noop("sheets: the punch press that the program is for: stations, what makes "
                            "it strike, clamps (YAML; configs/punch/turret.yaml explains it)"),
            .value_name = "FILE",
            .yields_to = "--beam|--kerf|--pierce|--slats"},
};

}  // namespace

std::span<const Setting> sheet_settings() { return kSheetSettings; }

}  // namespace kerf
