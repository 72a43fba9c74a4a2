// How the interpreter's stream functions are found here before those of the C++ library: an
// executable's symbols come first, as with fopen (private_files.cpp).
#include "interp_bridge/kerf_interp/fast_numbers.h"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <istream>
#include <locale>
#include <streambuf>

#include "interp_bridge/kerf_interp/plain_number.h"

// basic_ios<char>::init, istream::_M_extract<double> and istream::get, by the names that their C++
// ABI gives them. A member function takes its object as a first argument.
extern "C" {
void kerf_ios_init(void* ios, std::streambuf* buffer) __asm__(
    "_ZNSt9basic_iosIcSt11char_traitsIcEE4initEPSt15basic_streambufIcS1_E");
std::istream* kerf_istream_extract(std::istream* in,
                                   double* value) __asm__("_ZNSi10_M_extractIdEERSiRT_");
int kerf_istream_get(std::istream* in) __asm__("_ZNSi3getEv");
}

namespace kerf::interp {
namespace {

using Init = void (*)(void*, std::streambuf*);
using Extract = std::istream* (*)(std::istream*, double*);
using Get = int (*)(std::istream*);
/// Interp::read_real_number; the object comes first.
using ReadRealNumber = int (*)(void*, char*, int*, double*);

/// The C++ library's own. Streams are made before this program's constructors run.
template <typename Function>
Function next(Function& known, const char* name) {
  if (known == nullptr) {
    void* const found = dlsym(RTLD_NEXT, name);
    if (found == nullptr) std::abort();
    std::memcpy(&known, &found, sizeof known);
  }
  return known;
}

Init real_init = nullptr;
Extract real_extract = nullptr;
Get real_get = nullptr;

/// Where read_real_number's instructions are; 0 bytes: it stays slow.
std::uintptr_t reader_begin = 0;
std::uintptr_t reader_bytes = 0;

/// The stream that read_real_number makes: one at a time, and the interpreter has one thread.
struct Stream {
  void* ios = nullptr;  ///< its init() has been put off; null: nothing is
  std::streambuf* buffer = nullptr;
  std::istream* at_end = nullptr;  ///< a plain number has been taken from it, to its last digit
};
Stream stream;

bool is_in_reader(const void* return_address) {
  return reinterpret_cast<std::uintptr_t>(return_address) - reader_begin < reader_bytes;
}

void init(void* ios, std::streambuf* buffer) {
  next(real_init, "_ZNSt9basic_iosIcSt11char_traitsIcEE4initEPSt15basic_streambufIcS1_E")(ios,
                                                                                          buffer);
}

/// What is left to be read of a buffer.
struct Rest : std::streambuf {
  static std::string_view of(const std::streambuf& buffer) {
    char* const begin = (buffer.*&Rest::gptr)();
    char* const end = (buffer.*&Rest::egptr)();
    return {begin, static_cast<std::size_t>(end - begin)};
  }
};

/// read_real_number of librs274, by its name; null: there is none.
ReadRealNumber find_reader() {
  void* const found = dlsym(RTLD_DEFAULT, "_ZN6Interp16read_real_numberEPcPiPd");
  Dl_info info{};
  const ElfW(Sym)* symbol = nullptr;
  if (found == nullptr ||
      dladdr1(found, &info, reinterpret_cast<void**>(const_cast<ElfW(Sym)**>(&symbol)),
              RTLD_DL_SYMENT) == 0 ||
      symbol == nullptr || info.dli_saddr != found) {
    return nullptr;
  }
  reader_begin = reinterpret_cast<std::uintptr_t>(found);
  reader_bytes = symbol->st_size;
  ReadRealNumber reader = nullptr;
  std::memcpy(&reader, &found, sizeof reader);
  return reader;
}

/// That the reader reads plain numbers right by way of what is here.
bool is_proved(ReadRealNumber reader, InterpBase& interpreter) {
  struct Case {
    const char* text;
    int end;
    double value;
  };
  constexpr std::array<Case, 6> kCases = {
      {{"x1.25y2", 5, 1.25},
       {"x-0.1", 5, -0.1},
       {"x+7.", 4, 7},
       {"x.5 ", 3, .5},
       {"x12345.6789z", 11, 12345.6789},
       // Too long to be plain: by the library's own.
       {"x3.14159265358979323846", 23, 3.14159265358979323846}}};
  for (const Case& test : kCases) {
    std::array<char, 32> text{};
    std::strncpy(text.data(), test.text, text.size() - 1);
    int at = 1;
    double value = 0;
    if (reader(&interpreter, text.data(), &at, &value) != 0 || at != test.end ||
        value != test.value) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool use_fast_numbers(InterpBase& interpreter) {
  // Streams take the global locale, whose digits may be grouped.
  if (std::locale() != std::locale::classic()) return false;
  const ReadRealNumber reader = find_reader();
  if (reader != nullptr && is_proved(reader, interpreter)) return true;
  reader_bytes = 0;
  return false;
}

}  // namespace kerf::interp

// The return address says who calls.
[[gnu::noinline]] void kerf_ios_init(void* ios, std::streambuf* buffer) {
  using namespace kerf::interp;
  if (!is_in_reader(__builtin_return_address(0))) return init(ios, buffer);
  stream = {ios, buffer, nullptr};
}

[[gnu::noinline]] std::istream* kerf_istream_extract(std::istream* in, double* value) {
  using namespace kerf::interp;
  if (is_in_reader(__builtin_return_address(0)) && stream.ios == static_cast<std::ios*>(in)) {
    if (stream.buffer != nullptr &&
        kerf::interp::read_plain_number(Rest::of(*stream.buffer), *value)) {
      stream.ios = nullptr;
      stream.at_end = in;
      return in;
    }
    init(stream.ios, stream.buffer);
    stream = {};
  }
  return next(real_extract, "_ZNSi10_M_extractIdEERSiRT_")(in, value);
}

[[gnu::noinline]] int kerf_istream_get(std::istream* in) {
  using namespace kerf::interp;
  if (stream.at_end == in && is_in_reader(__builtin_return_address(0))) {
    stream.at_end = nullptr;
    return std::char_traits<char>::eof();
  }
  return next(real_get, "_ZNSi3getEv")(in);
}
