// stock/zmap/lanes_avx2.h - eight numbers at a time by AVX2: see lanes.h.
#pragma once

#ifndef KERF_LANES_NAMESPACE
#error "define KERF_LANES_NAMESPACE before including lanes_avx2.h"
#endif

#include <immintrin.h>

#include <cstdint>

namespace kerf::KERF_LANES_NAMESPACE {

/// Four numbers; only what a list of blocks needs.
struct F4 {
  __m128 v;
  static F4 of(float a, float b, float c, float d) { return {_mm_set_ps(d, c, b, a)}; }
  static F4 load(const float* p) { return {_mm_load_ps(p)}; }
};
inline F4 operator+(F4 a, F4 b) { return {_mm_add_ps(a.v, b.v)}; }
inline void store(float* p, F4 a) { _mm_store_ps(p, a.v); }

struct MaskF {
  __m256 v;
};
struct F8 {
  using Scalar = float;
  using Mask = MaskF;
  __m256 v;
  static F8 all(float x) { return {_mm256_set1_ps(x)}; }
  static F8 load(const float* p) { return {_mm256_load_ps(p)}; }
};
inline void store(float* p, F8 a) { _mm256_store_ps(p, a.v); }
inline F8 operator+(F8 a, F8 b) { return {_mm256_add_ps(a.v, b.v)}; }
inline F8 operator-(F8 a, F8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline F8 operator*(F8 a, F8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline F8 operator/(F8 a, F8 b) { return {_mm256_div_ps(a.v, b.v)}; }
inline F8 sqrt(F8 a) { return {_mm256_sqrt_ps(a.v)}; }
inline F8 min(F8 a, F8 b) { return {_mm256_min_ps(a.v, b.v)}; }
inline F8 max(F8 a, F8 b) { return {_mm256_max_ps(a.v, b.v)}; }
inline F8 abs(F8 a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
inline MaskF operator>=(F8 a, F8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
inline MaskF operator<=(F8 a, F8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)}; }
inline MaskF operator>(F8 a, F8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
inline MaskF operator<(F8 a, F8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)}; }
inline MaskF operator&(MaskF a, MaskF b) { return {_mm256_and_ps(a.v, b.v)}; }
inline MaskF operator|(MaskF a, MaskF b) { return {_mm256_or_ps(a.v, b.v)}; }
inline MaskF and_not(MaskF a, MaskF b) { return {_mm256_andnot_ps(b.v, a.v)}; }
inline bool any(MaskF a) { return _mm256_movemask_ps(a.v) != 0; }
inline F8 select(MaskF m, F8 a, F8 b) { return {_mm256_blendv_ps(b.v, a.v, m.v)}; }

/// Writes eight rows of (a, b, c, 0).
inline void store_rows(float* out, F8 a, F8 b, F8 c) {
  const __m256 zero = _mm256_setzero_ps();
  const __m256 ab_low = _mm256_unpacklo_ps(a.v, b.v), ab_high = _mm256_unpackhi_ps(a.v, b.v);
  const __m256 c_low = _mm256_unpacklo_ps(c.v, zero), c_high = _mm256_unpackhi_ps(c.v, zero);
  const __m256 rows[4] = {_mm256_shuffle_ps(ab_low, c_low, _MM_SHUFFLE(1, 0, 1, 0)),
                          _mm256_shuffle_ps(ab_low, c_low, _MM_SHUFFLE(3, 2, 3, 2)),
                          _mm256_shuffle_ps(ab_high, c_high, _MM_SHUFFLE(1, 0, 1, 0)),
                          _mm256_shuffle_ps(ab_high, c_high, _MM_SHUFFLE(3, 2, 3, 2))};
  for (int i = 0; i < 4; ++i) {  // row i and row i + 4
    _mm_store_ps(out + 4 * i, _mm256_castps256_ps128(rows[i]));
    _mm_store_ps(out + 16 + 4 * i, _mm256_extractf128_ps(rows[i], 1));
  }
}
/// One bit a lane.
inline unsigned bits(MaskF a) { return static_cast<unsigned>(_mm256_movemask_ps(a.v)); }

/// Eight 32-bit sums.
struct I8 {
  __m256i v;
  static I8 zero() { return {_mm256_setzero_si256()}; }
};
inline I8 operator+(I8 a, I8 b) { return {_mm256_add_epi32(a.v, b.v)}; }
inline I8 round_to_int(F8 a) { return {_mm256_cvtps_epi32(a.v)}; }
inline void store(std::int32_t* p, I8 a) { _mm256_store_si256(reinterpret_cast<__m256i*>(p), a.v); }
/// Writes `value` to the lanes of `m`. (A blend: masked stores are slow on some machines.)
inline void store_where(MaskF m, std::uint32_t value, std::uint32_t* p) {
  __m256i* const to = reinterpret_cast<__m256i*>(p);
  const __m256i all = _mm256_set1_epi32(static_cast<int>(value));
  _mm256_store_si256(to, _mm256_blendv_epi8(_mm256_load_si256(to), all, _mm256_castps_si256(m.v)));
}

struct MaskD {
  __m256d lo, hi;
};
struct D8 {
  using Scalar = double;
  using Mask = MaskD;
  __m256d lo, hi;
  static D8 all(double x) { return {_mm256_set1_pd(x), _mm256_set1_pd(x)}; }
  static D8 load(const double* p) { return {_mm256_load_pd(p), _mm256_load_pd(p + 4)}; }
};
inline D8 operator+(D8 a, D8 b) { return {_mm256_add_pd(a.lo, b.lo), _mm256_add_pd(a.hi, b.hi)}; }
inline D8 operator-(D8 a, D8 b) { return {_mm256_sub_pd(a.lo, b.lo), _mm256_sub_pd(a.hi, b.hi)}; }
inline D8 operator*(D8 a, D8 b) { return {_mm256_mul_pd(a.lo, b.lo), _mm256_mul_pd(a.hi, b.hi)}; }
inline D8 operator/(D8 a, D8 b) { return {_mm256_div_pd(a.lo, b.lo), _mm256_div_pd(a.hi, b.hi)}; }
inline D8 sqrt(D8 a) { return {_mm256_sqrt_pd(a.lo), _mm256_sqrt_pd(a.hi)}; }
inline D8 min(D8 a, D8 b) { return {_mm256_min_pd(a.lo, b.lo), _mm256_min_pd(a.hi, b.hi)}; }
inline D8 max(D8 a, D8 b) { return {_mm256_max_pd(a.lo, b.lo), _mm256_max_pd(a.hi, b.hi)}; }
inline D8 abs(D8 a) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return {_mm256_andnot_pd(sign, a.lo), _mm256_andnot_pd(sign, a.hi)};
}
inline MaskD operator>=(D8 a, D8 b) {
  return {_mm256_cmp_pd(a.lo, b.lo, _CMP_GE_OQ), _mm256_cmp_pd(a.hi, b.hi, _CMP_GE_OQ)};
}
inline MaskD operator<=(D8 a, D8 b) {
  return {_mm256_cmp_pd(a.lo, b.lo, _CMP_LE_OQ), _mm256_cmp_pd(a.hi, b.hi, _CMP_LE_OQ)};
}
inline MaskD operator>(D8 a, D8 b) {
  return {_mm256_cmp_pd(a.lo, b.lo, _CMP_GT_OQ), _mm256_cmp_pd(a.hi, b.hi, _CMP_GT_OQ)};
}
inline MaskD operator<(D8 a, D8 b) {
  return {_mm256_cmp_pd(a.lo, b.lo, _CMP_LT_OQ), _mm256_cmp_pd(a.hi, b.hi, _CMP_LT_OQ)};
}
inline MaskD operator&(MaskD a, MaskD b) {
  return {_mm256_and_pd(a.lo, b.lo), _mm256_and_pd(a.hi, b.hi)};
}
inline MaskD operator|(MaskD a, MaskD b) {
  return {_mm256_or_pd(a.lo, b.lo), _mm256_or_pd(a.hi, b.hi)};
}
inline MaskD and_not(MaskD a, MaskD b) {
  return {_mm256_andnot_pd(b.lo, a.lo), _mm256_andnot_pd(b.hi, a.hi)};
}
inline bool any(MaskD a) { return (_mm256_movemask_pd(a.lo) | _mm256_movemask_pd(a.hi)) != 0; }
inline D8 select(MaskD m, D8 a, D8 b) {
  return {_mm256_blendv_pd(b.lo, a.lo, m.lo), _mm256_blendv_pd(b.hi, a.hi, m.hi)};
}
inline F8 to_float(D8 a) { return {_mm256_set_m128(_mm256_cvtpd_ps(a.hi), _mm256_cvtpd_ps(a.lo))}; }

}  // namespace kerf::KERF_LANES_NAMESPACE
