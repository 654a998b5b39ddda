// SPDX-License-Identifier: MIT
// The kernels, written once. kernels.inl includes this file for each instruction set, with
//   FREQSYNTH_KERNEL_SET    the namespace
//   FREQSYNTH_KERNEL        the attributes of its functions
//   FREQSYNTH_KERNEL_BYTES  the size of a vector register
// Nothing here calls a function that is not forced inline: it would be compiled for another
// instruction set. All versions add in the same order, whatever the size of their registers.

#include "freqsynth/basis/kernels_pack.inl"
#include "freqsynth/basis/kernels_picture.inl"
#include "freqsynth/basis/kernels_ranges.inl"
#include "freqsynth/basis/kernels_update.inl"

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

FREQSYNTH_KERNEL
float absorb_sample(const SampleRow& row, float* states, float* sums, float* residuals,
                    const float* values, const float* weights, std::size_t channels) {
  FREQSYNTH_KERNEL_BEGIN
  const std::size_t fit_end = round_up(row.terms, 8);
  const std::size_t rest_begin = row.terms / 8 * 8;
  const BorderRow* border = row.border;
  float change = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    float* state = states + c * max_terms;
    Float8 even = {}, odd = {};
    std::size_t i = 0;
    for (; i + 16 <= fit_end; i += 16) {
      even += Float8::load(row.fit + i) * Float8::load(state + i);
      odd += Float8::load(row.fit + i + 8) * Float8::load(state + i + 8);
    }
    if (i < fit_end) even += Float8::load(row.fit + i) * Float8::load(state + i);
    const float prediction = sum_of(even + odd);
    const float absorbed = values != nullptr ? values[c] : prediction;
    const float innovation = absorbed - prediction;
    for (i = 0; i < fit_end; i += 8) {
      (innovation * Float8::load(row.gain + i)).add_to(state + i);
    }
    for (i = rest_begin; i < max_terms; i += 8) {
      (absorbed * Float8::load(row.rest + i)).add_to(state + i);
    }
    float* shares = sums + 2 * c * max_terms;
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      shares[row.pixels[p]] += absorbed * row.pixel_weights[p];
    }
    if (row.own_pixel != SampleRow::no_pixel) {
      float& own = shares[max_terms + row.own_pixel];
      if (row.own_share > 0) {
        const float off = absorbed - own * row.own_share;
        const float distance = off < 0 ? -off : off;
        if (distance > residuals[2 * c + 1]) residuals[2 * c + 1] = distance;
      }
      own += absorbed;
    }
    float squared = row.change * innovation * innovation;
    float residual = residuals[2 * c] + row.residual * innovation * innovation;
    if (border != nullptr) {
      // Eq. 37 applied to Y: the new amplitude, and what it takes from the old ones.
      Float8 sum = {};
      for (i = 0; i < fit_end; i += 8) {
        sum += Float8::load(border->b + i) * Float8::load(state + i);
      }
      const float added = (state[row.terms] - sum_of(sum)) * border->inverse_delta;
      state[row.terms] = 0;
      for (i = 0; i <= row.terms; i += 8) {
        (added * Float8::load(border->step + i)).add_to(state + i);
      }
      squared += added * (border->change * added + 2 * border->cross * innovation);
      // Rounding may take a little more than there is.
      residual -= border->delta * added * added;
      if (residual < 0) residual = 0;
    }
    residuals[2 * c] = residual;
    change += weights[c] * squared;
  }
  return change;
}

FREQSYNTH_KERNEL
void add_outer_product(double* matrix, const double* x, double scale, std::size_t terms) {
  FREQSYNTH_KERNEL_BEGIN
  // x is padded with zeros to whole vectors, so that nothing beyond `terms` changes.
  for (std::size_t i = 0; i < terms; i += 4) {
    double* r = matrix + i * max_terms;
    const Double4 factors = scale * Double4::load(x + i);
    alignas(32) double factor[4];
    factors.store(factor);
    for (std::size_t j = 0; j < terms; j += 4) {
      const Double4 row = Double4::load(x + j);
      (factor[0] * row).add_to(r + j);
      (factor[1] * row).add_to(r + max_terms + j);
      (factor[2] * row).add_to(r + 2 * max_terms + j);
      (factor[3] * row).add_to(r + 3 * max_terms + j);
    }
  }
}

FREQSYNTH_KERNEL
void multiply(const double* matrix, const double* x, std::size_t terms, double* out) {
  FREQSYNTH_KERNEL_BEGIN
  alignas(64) double padded[max_terms];
  copy_padded(x, terms, padded);
  for (std::size_t i = 0; i < terms; i += 4) {
    const double* r = matrix + i * max_terms;
    Double4 s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (std::size_t j = 0; j < terms; j += 4) {
      const Double4 factor = Double4::load(padded + j);
      s0 += Double4::load(r + j) * factor;
      s1 += Double4::load(r + max_terms + j) * factor;
      s2 += Double4::load(r + 2 * max_terms + j) * factor;
      s3 += Double4::load(r + 3 * max_terms + j) * factor;
    }
    const Double4 products = sums_of(s0, s1, s2, s3);
    if (i + 4 <= terms) {
      products.store_unaligned(out + i);
    } else {
      alignas(32) double last[4];
      products.store(last);
      for (std::size_t k = 0; i + k < terms; ++k) out[i + k] = last[k];
    }
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
