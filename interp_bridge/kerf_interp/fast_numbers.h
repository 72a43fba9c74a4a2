// interp_bridge/kerf_interp/fast_numbers.h - the numbers of a program read without a stream.
#pragma once

#include <interp_base.hh>

namespace kerf::interp {

/// LinuxCNC's Interp::read_real_number makes a std::stringstream for each number, which takes half
/// of the time of a plain program: each looks up six facets of a locale, three times over. Here the
/// three functions of the stream that cost are answered at once when that function calls them for a
/// number of plain digits, with the same bits; anything else goes to the C++ library's own, as all
/// calls from elsewhere do.
///
/// Nothing of the interpreter's memory is looked at. It is on only if read_real_number is found
/// and, tried with `interpreter`, reads what it should; another build of LinuxCNC than those known
/// is read as slowly as ever. Before InterpBase::init(). False: it stays off.
bool use_fast_numbers(InterpBase& interpreter);

}  // namespace kerf::interp
