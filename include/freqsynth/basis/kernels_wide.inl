// SPDX-License-Identifier: MIT
// Kernels for many blocks at once, one in each lane, written once like those of kernels_body.inl.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

using Lanes = Pack<float, lane_count>;

FREQSYNTH_KERNEL
void innovate_lanes(const float* factor, std::size_t count, float inverse_pivot,
                    const float* values, float* innovations) {
  FREQSYNTH_ROUNDING_BEGIN
  Lanes sum = {};
  for (std::size_t j = 0; j < count; ++j) {
    sum += factor[j] * Lanes::load(innovations + j * lane_count);
  }
  (inverse_pivot * (Lanes::load(values) - sum)).store(innovations + count * lane_count);
}

FREQSYNTH_KERNEL
void add_lanes(const float* weights, std::size_t count, const float* values, float* sums) {
  FREQSYNTH_ROUNDING_BEGIN
  const Lanes x = Lanes::load(values);
  for (std::size_t p = 0; p < count; ++p) (weights[p] * x).add_to(sums + p * lane_count);
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
