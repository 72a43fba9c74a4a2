#include <array>

#include "base/translate.h"
#include "twin/config/setting_table.h"

namespace kerf {
namespace {

using T = KeyType;

constexpr std::array kOptimizeSettings{
    Setting{.option = "PROGRAM",
            .commands = kOptimize,
            .type = T::kFile,
            .help = tr_noop("NC file whose F words are to be others"),
            .required = true},
    Setting{.option = "--out",
            .commands = kOptimize,
            .type = T::kFile,
            .help = tr_noop("where the new program goes"),
            .value_name = "FILE",
            .short_name = "-o"},
    Setting{.option = "--in-place",
            .commands = kOptimize,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("instead of --out: in the place of PROGRAM, of which a copy is kept "
                            "beside it (NAME.bak)"),
            .flag = "yes"},
    Setting{.option = "--chip",
            .commands = kOptimize,
            .type = T::kNumber,
            .unit = "mm",
            .least = 0,
            .most = 5,
            .least_excluded = true,
            .help = tr_noop("thickness of the thickest chip to aim at; tools need their teeth=N"),
            .value_name = "LENGTH"},
    Setting{.option = "--max-rate",
            .commands = kOptimize,
            .type = T::kNumber,
            .unit = "mm3/s",
            .least = 0,
            .most = 1e7,
            .least_excluded = true,
            .help = tr_noop("greatest removal rate"),
            .value_name = "MM3/S"},
    Setting{.option = "--max-feed",
            .commands = kOptimize,
            .type = T::kNumber,
            .unit = "mm/min",
            .least = 0,
            .most = 1e6,
            .least_excluded = true,
            .help = tr_noop("greatest feed of all; slower ones come of what else is limited"),
            .value_name = "MM/MIN"},
    Setting{.option = "--air-feed",
            .commands = kOptimize,
            .type = T::kNumber,
            .unit = "mm/min",
            .least = 0,
            .most = 1e6,
            .least_excluded = true,
            .help = tr_noop("feed of blocks that touch nothing (else they keep theirs)"),
            .value_name = "MM/MIN"},
    Setting{.option = "--split",
            .commands = kOptimize,
            .type = T::kYesNo,
            .fallback = "no",
            .help = tr_noop("divide straight blocks where the tool is engaged in another way"),
            .flag = "yes"},
    Setting{.option = "--json",
            .commands = kOptimize,
            .type = T::kFile,
            .help = tr_noop("what has been changed and what it gains, schema kerf-optimize/1"),
            .value_name = "FILE"},
};

}  // namespace

std::span<const Setting> optimize_settings() { return kOptimizeSettings; }

}  // namespace kerf
