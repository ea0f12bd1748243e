#pragma once
/// The bilinear kernel of sync/warp, N channels at once. Two forms with the same arithmetic: plain C++, and SSE2 (part of every x86-64).
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif
namespace venato::sync::detail {

inline constexpr int kWeightBits = 14;  ///< of a pixel: 1/16384 px, at most 0.02 levels of position error
inline constexpr int kWeightOne = 1 << kWeightBits;
inline constexpr int kBlendShift = 7;  ///< horizontal blend kept as level * 128: 255 * 128 still fits 16 signed bits
inline constexpr int kFinalShift = 2 * kWeightBits - kBlendShift;

/// Four neighbours and weights of one output pixel.
struct Tap {
  const std::uint8_t* upper;   ///< left pixel of the upper row
  std::ptrdiff_t right, down;  ///< byte steps to the right pixel and to the lower row (0 when the source is one pixel wide or high)
  int wx, wy;                  ///< 0..16384: weight of the right pixel, of the lower row
};

template <int N>
inline void blend_scalar(const Tap& tap, std::uint8_t* out) {
  constexpr int half_blend = 1 << (kWeightBits - kBlendShift - 1), half_final = 1 << (kFinalShift - 1);
  for (int c = 0; c < N; ++c) {
    const std::uint8_t* u = tap.upper + c;
    const std::uint8_t* l = u + tap.down;
    const int h0 = (u[0] * (kWeightOne - tap.wx) + u[tap.right] * tap.wx + half_blend) >> (kWeightBits - kBlendShift);
    const int h1 = (l[0] * (kWeightOne - tap.wx) + l[tap.right] * tap.wx + half_blend) >> (kWeightBits - kBlendShift);
    out[c] = static_cast<std::uint8_t>((h0 * (kWeightOne - tap.wy) + h1 * tap.wy + half_final) >> kFinalShift);
  }
}

#if defined(__SSE2__)
inline __m128i weight_pair(int weight) { return _mm_set1_epi32((weight << 16) | (kWeightOne - weight)); }

/// 8 channels (level * 128, signed 16 bit) of one row.
inline __m128i blend_row(const std::uint8_t* left, std::ptrdiff_t right, __m128i weights) {
  const __m128i half = _mm_set1_epi32(1 << (kWeightBits - kBlendShift - 1));
  const __m128i a = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(left));
  const __m128i b = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(left + right));
  const __m128i ab = _mm_unpacklo_epi8(a, b);
  const __m128i lo = _mm_madd_epi16(_mm_unpacklo_epi8(ab, _mm_setzero_si128()), weights);
  const __m128i hi = _mm_madd_epi16(_mm_unpackhi_epi8(ab, _mm_setzero_si128()), weights);
  return _mm_packs_epi32(_mm_srai_epi32(_mm_add_epi32(lo, half), kWeightBits - kBlendShift),
                         _mm_srai_epi32(_mm_add_epi32(hi, half), kWeightBits - kBlendShift));
}

/// Reads 8 bytes at each of the four neighbours and writes 8 bytes: the caller makes sure that they exist and that what lies behind the
/// N written bytes is written later.
inline void blend_sse2(const Tap& tap, std::uint8_t* out) {
  const __m128i half = _mm_set1_epi32(1 << (kFinalShift - 1));
  const __m128i wx = weight_pair(tap.wx), wy = weight_pair(tap.wy);
  const __m128i h0 = blend_row(tap.upper, tap.right, wx), h1 = blend_row(tap.upper + tap.down, tap.right, wx);
  const __m128i lo = _mm_madd_epi16(_mm_unpacklo_epi16(h0, h1), wy), hi = _mm_madd_epi16(_mm_unpackhi_epi16(h0, h1), wy);
  const __m128i v = _mm_packs_epi32(_mm_srai_epi32(_mm_add_epi32(lo, half), kFinalShift), _mm_srai_epi32(_mm_add_epi32(hi, half), kFinalShift));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_packus_epi16(v, v));
}
inline constexpr std::ptrdiff_t kVectorBytes = 8;
#endif
}  // namespace venato::sync::detail
