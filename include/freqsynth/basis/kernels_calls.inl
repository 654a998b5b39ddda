// SPDX-License-Identifier: MIT
// The kernels as functions: those of the version that was chosen.
#pragma once

namespace freqsynth::detail {

FREQSYNTH_INLINE void absorb_samples(const SampleRow* rows, std::size_t count, float* states,
                                     float* sums, float* residuals, const float* values,
                                     const float* weights, std::size_t channels, float* changes) {
  kernels().absorb_samples(rows, count, states, sums, residuals, values, weights, channels,
                           changes);
}

FREQSYNTH_INLINE void rank_one_update(double* inverse, double* normal, const double* a,
                                      std::size_t terms, std::size_t normal_terms) {
  kernels().rank_one_update(inverse, normal, a, terms, normal_terms);
}

FREQSYNTH_INLINE void add_outer_product(double* matrix, const double* x, double scale,
                                        std::size_t terms) {
  kernels().add_outer_product(matrix, x, scale, terms);
}

FREQSYNTH_INLINE void multiply(const double* matrix, const double* x, std::size_t terms,
                               double* out) {
  kernels().multiply(matrix, x, terms, out);
}

FREQSYNTH_INLINE void residual_means(const float* matrix, const float* amplitudes,
                                     const float* sums, const float* shares, float* out) {
  kernels().residual_means(matrix, amplitudes, sums, shares, out);
}

FREQSYNTH_INLINE void evaluate_separable(const float* amplitudes, const float* wx,
                                         std::size_t wx_stride, std::size_t columns,
                                         const float* wy, std::size_t rows, float* out,
                                         std::size_t out_stride) {
  kernels().evaluate_separable(amplitudes, wx, wx_stride, columns, wy, rows, out, out_stride);
}

FREQSYNTH_INLINE void add_scaled(const double* values, double factor, std::size_t count,
                                 double* sums) {
  kernels().add_scaled(values, factor, count, sums);
}

FREQSYNTH_INLINE void solve_four(double* matrix, double* right, std::size_t n, std::size_t sides,
                                 double* definite) {
  kernels().solve_four(matrix, right, n, sides, definite);
}

FREQSYNTH_INLINE void forward_transform(const float* pixels, const double* cosines,
                                        const double* scales, float* out) {
  kernels().forward_transform(pixels, cosines, scales, out);
}

FREQSYNTH_INLINE void shrink_terms(const float* coefficients, const float* filter,
                                   const float* variances, float scale, float* out) {
  kernels().shrink_terms(coefficients, filter, variances, scale, out);
}

FREQSYNTH_INLINE void add_means(const float* means, const float* weights, float doubt,
                                float* pixels) {
  kernels().add_means(means, weights, doubt, pixels);
}

FREQSYNTH_INLINE void known_means(const float* sums, const float* shares, PaddedBlock& low,
                                  PaddedBlock& high) {
  kernels().known_means(sums, shares, low, high);
}

FREQSYNTH_INLINE void owned_means(const float* sums, const float* counts, float* out, float* ends) {
  kernels().owned_means(sums, counts, out, ends);
}

FREQSYNTH_INLINE void least_and_most(const PaddedBlock& low, const PaddedBlock& high, float* out) {
  kernels().least_and_most(low, high, out);
}

FREQSYNTH_INLINE float value_of_rank(const PaddedBlock& values, std::size_t rank, float least,
                                     float most) {
  return kernels().value_of_rank(values, rank, least, most);
}

FREQSYNTH_INLINE bool extremes_around(const PaddedBlock& low, const PaddedBlock& high,
                                      const float* pixels, float* least, float* most) {
  return kernels().extremes_around(low, high, pixels, least, most);
}

FREQSYNTH_INLINE void clamp_around(const PaddedBlock& low, const float* least, const float* most,
                                   const float* counts, float slack, const float* whole,
                                   float* pixels) {
  kernels().clamp_around(low, least, most, counts, slack, whole, pixels);
}

FREQSYNTH_INLINE void hold_flat(const float* means, std::size_t stride, float alike, float most_off,
                                float* pixels) {
  kernels().hold_flat(means, stride, alike, most_off, pixels);
}

FREQSYNTH_INLINE void innovate_lanes(const float* factor, std::size_t count, float inverse_pivot,
                                     const float* values, float* innovations) {
  kernels().innovate_lanes(factor, count, inverse_pivot, values, innovations);
}

FREQSYNTH_INLINE void add_lanes(const float* weights, std::size_t count, const float* values,
                                float* sums) {
  kernels().add_lanes(weights, count, values, sums);
}

FREQSYNTH_INLINE void exponentials(const double* x, std::size_t count, double* out) {
  kernels().exponentials(x, count, out);
}

FREQSYNTH_INLINE void cosines(const double* turns, std::size_t count, double* out) {
  kernels().cosines(turns, count, out);
}

FREQSYNTH_INLINE void flux_densities(const double* distances, std::size_t count,
                                     const double* series, bool rough, double* out) {
  kernels().flux_densities(distances, count, series, rough, out);
}

}  // namespace freqsynth::detail
