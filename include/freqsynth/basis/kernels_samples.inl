// SPDX-License-Identifier: MIT
// How a block takes in samples, written once like the other kernels of kernels_body.inl.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// Adds what a sample brings to the terms in the fit, and to those beyond it.
template <std::size_t channels>
FREQSYNTH_KERNEL_INLINE void add_gains(const SampleRow& row, const float* innovations,
                                       const float* absorbed, float* states) {
  FREQSYNTH_ROUNDING_BEGIN
  std::size_t i = 0;
  for (; i + 16 <= row.terms; i += 16) {
    const Float16 gain = Float16::load(row.gain + i);
    for (std::size_t c = 0; c < channels; ++c) {
      (innovations[c] * gain).add_to(states + c * max_terms + i);
    }
  }
  if (i < row.terms) {
    alignas(64) static constexpr float numbers[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                      8, 9, 10, 11, 12, 13, 14, 15};
    const Float16 gain = Float16::load(row.gain + i);
    const Float16 lanes = Float16::load(numbers);
    const Float16 end = all_lanes<Float16>(static_cast<float>(row.terms - i));
    for (std::size_t c = 0; c < channels; ++c) {
      const Float16 factors =
          if_less(lanes, end, all_lanes<Float16>(innovations[c]), all_lanes<Float16>(absorbed[c]));
      (factors * gain).add_to(states + c * max_terms + i);
    }
    i += 16;
  }
  for (; i < max_terms; i += 16) {
    const Float16 gain = Float16::load(row.gain + i);
    for (std::size_t c = 0; c < channels; ++c) {
      (absorbed[c] * gain).add_to(states + c * max_terms + i);
    }
  }
}

/// Eq. 37 applied to Y: writes the new amplitudes, and takes what they take from the old ones.
template <std::size_t channels>
FREQSYNTH_KERNEL_INLINE void add_term(const BorderRow& border, std::size_t term, float* states,
                                      float* added) {
  FREQSYNTH_ROUNDING_BEGIN
  Float8 products[channels] = {};
  for (std::size_t i = 0; i < term; i += 8) {
    const Float8 b = Float8::load(border.b + i);
    for (std::size_t c = 0; c < channels; ++c) {
      products[c] += b * Float8::load(states + c * max_terms + i);
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    added[c] = (states[c * max_terms + term] - sum_of(products[c])) * border.inverse_delta;
  }
  const std::size_t last = term / 8 * 8;
  for (std::size_t i = 0; i < last; i += 8) {
    const Float8 step = Float8::load(border.step + i);
    for (std::size_t c = 0; c < channels; ++c) {
      (added[c] * step).add_to(states + c * max_terms + i);
    }
  }
  // Y of the new term becomes 0 in a register: a number that was stored alone cannot be loaded with
  // its neighbours before it is in the cache.
  alignas(32) static constexpr float numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const Float8 lanes = Float8::load(numbers);
  const Float8 own = all_lanes<Float8>(static_cast<float>(term - last));
  const Float8 step = Float8::load(border.step + last);
  for (std::size_t c = 0; c < channels; ++c) {
    float* at = states + c * max_terms + last;
    const Float8 before = Float8::load(at);
    const Float8 others = if_less(lanes, own, before, if_less(own, lanes, before, Float8{}));
    (others + added[c] * step).store(at);
  }
}

/// absorb_samples() of one sample and 1 to 4 channels, side by side: each waits for its sums, but
/// not for those of the others.
/// \return `change`, to which theirs are added
template <std::size_t channels>
FREQSYNTH_KERNEL_INLINE float absorb_sample(const SampleRow& row, float* states, float* sums,
                                            float* residuals, const float* values,
                                            const float* weights, float change) {
  FREQSYNTH_ROUNDING_BEGIN
  Float16 products[channels] = {};
  for (std::size_t i = 0; i < row.terms; i += 16) {
    const Float16 fit = Float16::load(row.fit + i);
    for (std::size_t c = 0; c < channels; ++c) {
      products[c] += fit * Float16::load(states + c * max_terms + i);
    }
  }
  float absorbed[channels], innovations[channels], added[channels] = {};
  for (std::size_t c = 0; c < channels; ++c) {
    const float prediction = sum_of(folded(products[c]));
    absorbed[c] = values != nullptr ? values[c] : prediction;
    innovations[c] = absorbed[c] - prediction;
  }
  add_gains<channels>(row, innovations, absorbed, states);
  const BorderRow* const border = row.border;
  if (border != nullptr) add_term<channels>(*border, row.terms, states, added);

  // All four pixels, as those without a share have a weight of 0: how many there are is a branch
  // that no processor foresees. The same for the first sample in a pixel.
  for (std::size_t p = 0; p < 4; ++p) {
    float* const shares = sums + row.pixels[p];
    const float weight = row.pixel_weights[p];
    for (std::size_t c = 0; c < channels; ++c) shares[2 * c * max_terms] += absorbed[c] * weight;
  }
  if (row.own_pixel != SampleRow::no_pixel) {
    float* const owns = sums + max_terms + row.own_pixel;
    const float share = row.own_share;
    const float known = share > 0 ? 1 : 0;
    for (std::size_t c = 0; c < channels; ++c) {
      float& own = owns[2 * c * max_terms];
      const float off = absorbed[c] - own * share;
      const float distance = known * (off < 0 ? -off : off);
      const float spread = residuals[2 * c + 1];
      residuals[2 * c + 1] = distance > spread ? distance : spread;
      own += absorbed[c];
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    const float innovation = innovations[c];
    float squared = row.change * innovation * innovation;
    float residual = residuals[2 * c] + row.residual * innovation * innovation;
    if (border != nullptr) {
      squared += added[c] * (border->change * added[c] + 2 * border->cross * innovation);
      // Rounding may take a little more than there is.
      residual -= border->delta * added[c] * added[c];
      residual = residual < 0 ? 0 : residual;
    }
    residuals[2 * c] = residual;
    change += weights[c] * squared;
  }
  return change;
}

/// absorb_samples() of 1 to 4 of the channels, with `stride` values a sample.
/// \param changes  what those of the channels before them add up to
template <std::size_t channels>
FREQSYNTH_KERNEL_INLINE void absorb_run(const SampleRow* rows, std::size_t count, float* states,
                                        float* sums, float* residuals, const float* values,
                                        std::size_t stride, const float* weights, float* changes) {
  for (std::size_t s = 0; s < count; ++s) {
    changes[s] =
        absorb_sample<channels>(rows[s], states, sums, residuals, values, weights, changes[s]);
    if (values != nullptr) values += stride;
  }
}

FREQSYNTH_KERNEL
void absorb_samples(const SampleRow* rows, std::size_t count, float* states, float* sums,
                    float* residuals, const float* values, const float* weights,
                    std::size_t channels, float* changes) {
  FREQSYNTH_ROUNDING_BEGIN
  for (std::size_t s = 0; s < count; ++s) changes[s] = 0;
  for (std::size_t c = 0; c < channels; c += 4) {
    float* state = states + c * max_terms;
    float* pixels = sums + 2 * c * max_terms;
    float* squares = residuals + 2 * c;
    const float* known = values != nullptr ? values + c : nullptr;
    const float* shares = weights + c;
    switch (channels - c) {
      case 1:
        absorb_run<1>(rows, count, state, pixels, squares, known, channels, shares, changes);
        break;
      case 2:
        absorb_run<2>(rows, count, state, pixels, squares, known, channels, shares, changes);
        break;
      case 3:
        absorb_run<3>(rows, count, state, pixels, squares, known, channels, shares, changes);
        break;
      default:
        absorb_run<4>(rows, count, state, pixels, squares, known, channels, shares, changes);
    }
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
