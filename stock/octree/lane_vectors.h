// stock/octree/lane_vectors.h - eight numbers as vectors of whatever size the instructions have.
//
// Compilers' own vector types, halves of halves of eight lanes: `+`, `<` and choose() make the same
// bits in each lane whatever their size. In an unnamed namespace, as this is compiled once for each
// instruction set, and calls nothing that a linker could take from another variant.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace kerf::octree {
namespace {

#define KERF_LANES [[gnu::always_inline]] inline

#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr int kVectorBytes = 64;
#elif defined(__AVX2__)
constexpr int kVectorBytes = 32;
#else
constexpr int kVectorBytes = 16;
#endif
constexpr int kFloatBytes = kVectorBytes < 32 ? kVectorBytes : 32;

typedef double DoublePart __attribute__((vector_size(kVectorBytes)));
using MaskPart = decltype(DoublePart{} < DoublePart{});
typedef float FloatPart __attribute__((vector_size(kFloatBytes)));
using IntPart = decltype(FloatPart{} < FloatPart{});
typedef std::uint16_t WordPart __attribute__((vector_size(kFloatBytes / 2)));

template <class V>
struct Pair {
  V low, high;
};

template <class V, int kTimes>
struct Halves {
  using Type = Pair<typename Halves<V, kTimes / 2>::Type>;
};
template <class V>
struct Halves<V, 1> {
  using Type = V;
};

/// Eight lanes each. A mask's lanes are all ones or 0.
using Doubles = Halves<DoublePart, 64 / kVectorBytes>::Type;
using Masks = Halves<MaskPart, 64 / kVectorBytes>::Type;
using Floats = Halves<FloatPart, 32 / kFloatBytes>::Type;
using Ints = Halves<IntPart, 32 / kFloatBytes>::Type;
/// Small enough to be one vector everywhere.
typedef std::uint16_t Words __attribute__((vector_size(16)));
typedef std::uint8_t Bytes __attribute__((vector_size(8)));

template <class V>
KERF_LANES Pair<V> operator+(const Pair<V>& a, const Pair<V>& b) {
  return {a.low + b.low, a.high + b.high};
}
template <class V>
KERF_LANES Pair<V> operator-(const Pair<V>& a, const Pair<V>& b) {
  return {a.low - b.low, a.high - b.high};
}
template <class V>
KERF_LANES Pair<V> operator*(const Pair<V>& a, const Pair<V>& b) {
  return {a.low * b.low, a.high * b.high};
}
template <class V>
KERF_LANES Pair<V> operator/(const Pair<V>& a, const Pair<V>& b) {
  return {a.low / b.low, a.high / b.high};
}
template <class V>
KERF_LANES Pair<V> operator&(const Pair<V>& a, const Pair<V>& b) {
  return {a.low & b.low, a.high & b.high};
}
template <class V>
KERF_LANES Pair<V> operator|(const Pair<V>& a, const Pair<V>& b) {
  return {a.low | b.low, a.high | b.high};
}
template <class V>
KERF_LANES Pair<V> operator^(const Pair<V>& a, const Pair<V>& b) {
  return {a.low ^ b.low, a.high ^ b.high};
}
template <class V>
KERF_LANES Pair<V> operator~(const Pair<V>& a) {
  return {~a.low, ~a.high};
}
template <class V>
KERF_LANES auto operator<(const Pair<V>& a, const Pair<V>& b) {
  return Pair<decltype(a.low < b.low)>{a.low < b.low, a.high < b.high};
}
template <class V>
KERF_LANES auto operator<=(const Pair<V>& a, const Pair<V>& b) {
  return Pair<decltype(a.low <= b.low)>{a.low <= b.low, a.high <= b.high};
}

template <class V>
KERF_LANES auto operator==(const Pair<V>& a, const Pair<V>& b) {
  return Pair<decltype(a.low == b.low)>{a.low == b.low, a.high == b.high};
}
template <class V>
KERF_LANES Pair<V> operator>>(const Pair<V>& a, int bits) {
  return {a.low >> bits, a.high >> bits};
}

// Each for one part, and for pairs.
KERF_LANES DoublePart choose(const MaskPart& yes, const DoublePart& a, const DoublePart& b) {
  return yes ? a : b;
}
KERF_LANES FloatPart choose(const IntPart& yes, const FloatPart& a, const FloatPart& b) {
  return yes ? a : b;
}
KERF_LANES IntPart choose(const IntPart& yes, const IntPart& a, const IntPart& b) {
  return yes ? a : b;
}
template <class M, class V>
KERF_LANES Pair<V> choose(const Pair<M>& yes, const Pair<V>& a, const Pair<V>& b) {
  return {choose(yes.low, a.low, b.low), choose(yes.high, a.high, b.high)};
}

KERF_LANES bool any(const MaskPart& mask) {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#else
  return (mask[0] | mask[1]) != 0;
#endif
}
template <class M>
KERF_LANES bool any(const Pair<M>& mask) {
  return any(mask.low | mask.high);
}

/// Has any lane a bit?
KERF_LANES bool any_bits(const IntPart& v) {
#if defined(__AVX2__)
  const __m256i bits = reinterpret_cast<__m256i>(v);
  return _mm256_testz_si256(bits, bits) == 0;
#elif defined(__x86_64__)
  const __m128i none = _mm_cmpeq_epi8(reinterpret_cast<__m128i>(v), _mm_setzero_si128());
  return _mm_movemask_epi8(none) != 0xffff;
#else
  return (v[0] | v[1] | v[2] | v[3]) != 0;
#endif
}
template <class V>
KERF_LANES bool any_bits(const Pair<V>& v) {
  return any_bits(v.low | v.high);
}

KERF_LANES DoublePart root(const DoublePart& a) {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xff, a);
#elif defined(__AVX2__)
  return _mm256_sqrt_pd(a);
#elif defined(__x86_64__)
  return _mm_sqrt_pd(a);
#else
  return DoublePart{__builtin_sqrt(a[0]), __builtin_sqrt(a[1])};
#endif
}
KERF_LANES FloatPart root(const FloatPart& a) {
#if defined(__AVX2__)
  return _mm256_sqrt_ps(a);
#elif defined(__x86_64__)
  return _mm_sqrt_ps(a);
#else
  return FloatPart{__builtin_sqrtf(a[0]), __builtin_sqrtf(a[1]), __builtin_sqrtf(a[2]),
                   __builtin_sqrtf(a[3])};
#endif
}
template <class V>
KERF_LANES Pair<V> root(const Pair<V>& a) {
  return {root(a.low), root(a.high)};
}

template <class V, class T>
KERF_LANES void fill(V& out, T value) {
  out = value - V{};  // as no lane of V{} is negative, a value of -0 stays one
}
template <class V, class T>
KERF_LANES void fill(Pair<V>& out, T value) {
  fill(out.low, value);
  fill(out.high, value);
}
template <class V, class T>
KERF_LANES V all(T value) {
  V out;
  fill(out, value);
  return out;
}
KERF_LANES Doubles all(double value) { return all<Doubles, double>(value); }

template <class V, class T>
KERF_LANES V load_lanes(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V, class T>
KERF_LANES void store_lanes(const V& v, T* to) {
  std::memcpy(to, &v, sizeof v);
}

KERF_LANES Doubles lesser(const Doubles& a, const Doubles& b) { return choose(a < b, a, b); }
KERF_LANES Doubles greater(const Doubles& a, const Doubles& b) { return choose(b < a, a, b); }

/// Between types of as many lanes, part by part.
template <class To, class From>
KERF_LANES void convert(const From& from, To& to) {
  to = __builtin_convertvector(from, To);
}
template <class To, class From>
KERF_LANES void convert(const Pair<From>& from, Pair<To>& to) {
  convert(from.low, to.low);
  convert(from.high, to.high);
}

/// Eight numbers of 16 bits.
KERF_LANES void widen(const std::uint16_t* from, IntPart& to) {
  to = __builtin_convertvector(load_lanes<WordPart>(from), IntPart);
}
template <class V>
KERF_LANES void widen(const std::uint16_t* from, Pair<V>& to) {
  widen(from, to.low);
  widen(from + sizeof(V) / sizeof(std::int32_t), to.high);
}

/// The first four lanes are `left`, the others `right`.
template <class V, class T>
KERF_LANES V four_each(T left, T right) {
  if constexpr (sizeof(T) == sizeof(std::int32_t)) {
    constexpr std::int32_t kLeft[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
    return choose(load_lanes<Ints>(kLeft), all<V>(left), all<V>(right));
  } else {
    const T lanes[8] = {left, left, left, left, right, right, right, right};
    return load_lanes<V>(lanes);
  }
}

/// Eight doubles cut down to whole numbers.
KERF_LANES void whole_of(const Doubles& from, Ints& to) {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
  to = reinterpret_cast<IntPart>(_mm512_maskz_cvttpd_epi32(0xff, from));
#elif defined(__AVX2__)
  to = reinterpret_cast<IntPart>(
      _mm256_set_m128i(_mm256_cvttpd_epi32(from.high), _mm256_cvttpd_epi32(from.low)));
#else
  alignas(64) double wide[8];
  alignas(64) std::int32_t slim[8];
  store_lanes(from, wide);
  for (int l = 0; l < 8; ++l) slim[l] = static_cast<std::int32_t>(wide[l]);
  to = load_lanes<Ints>(slim);
#endif
}

/// Eight whole numbers as doubles.
KERF_LANES void widen_to(const Ints& from, Doubles& to) {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
  to = _mm512_maskz_cvtepi32_pd(0xff, reinterpret_cast<__m256i>(from));
#elif defined(__AVX2__)
  const __m256i whole = reinterpret_cast<__m256i>(from);
  to.low = _mm256_cvtepi32_pd(_mm256_castsi256_si128(whole));
  to.high = _mm256_cvtepi32_pd(_mm256_extracti128_si256(whole, 1));
#else
  std::int32_t slim[8];
  alignas(64) double wide[8];
  store_lanes(from, slim);
  for (int l = 0; l < 8; ++l) wide[l] = slim[l];
  to = load_lanes<Doubles>(wide);
#endif
}

KERF_LANES double last(const DoublePart& v) { return v[kVectorBytes / 8 - 1]; }
template <class V>
KERF_LANES double last(const Pair<V>& v) {
  return last(v.high);
}

/// Eight doubles as floats.
KERF_LANES void narrow_to(const Doubles& from, Floats& to) {
#if defined(__AVX512DQ__) && defined(__AVX512F__)
  to = _mm512_maskz_cvtpd_ps(0xff, from);
#elif defined(__AVX2__)
  to = _mm256_set_m128(_mm256_cvtpd_ps(from.high), _mm256_cvtpd_ps(from.low));
#else
  alignas(64) double wide[8];
  alignas(64) float slim[8];
  store_lanes(from, wide);
  for (int l = 0; l < 8; ++l) slim[l] = static_cast<float>(wide[l]);
  to = load_lanes<Floats>(slim);
#endif
}

}  // namespace
}  // namespace kerf::octree
