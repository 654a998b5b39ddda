// SPDX-License-Identifier: MIT
// The kernels, written once. kernels.inl includes this file for each instruction set, with
//   FREQSYNTH_KERNEL_SET    the namespace
//   FREQSYNTH_KERNEL        the attributes of its functions
//   FREQSYNTH_KERNEL_BYTES  the size of a vector register
// Nothing here calls a function that is not forced inline: it would be compiled for another
// instruction set. All versions add in the same order, whatever the size of their registers.

#include "freqsynth/basis/kernels_functions.inl"
#include "freqsynth/basis/kernels_pack.inl"
#include "freqsynth/basis/kernels_picture.inl"
#include "freqsynth/basis/kernels_ranges.inl"
#include "freqsynth/basis/kernels_samples.inl"
#include "freqsynth/basis/kernels_update.inl"
#include "freqsynth/basis/kernels_wide.inl"

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

FREQSYNTH_KERNEL
void add_outer_product(double* matrix, const double* x, double scale, std::size_t terms) {
  FREQSYNTH_ROUNDING_BEGIN
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
  FREQSYNTH_ROUNDING_BEGIN
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
