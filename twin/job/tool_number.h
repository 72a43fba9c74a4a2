// twin/job/tool_number.h - tool numbers that other controls read in another way.
#pragma once

#include <string>

namespace kerf {

/// What T0101 and T1212 mean here and on Fanuc's lathes, which have tool and offset in one number;
/// empty: it is no such number.
std::string hint_of_number(int number);

}  // namespace kerf
