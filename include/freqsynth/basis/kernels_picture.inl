// SPDX-License-Identifier: MIT
// The kernels that pictures are finished with, written once for all instruction sets like those of
// kernels_body.inl, whose rules hold here.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// How many of 64 numbers there are up to the last ones, in sixteens, that are not all zero.
FREQSYNTH_KERNEL_INLINE std::size_t used_of(const float* values) {
  constexpr std::size_t some = 16;
  std::size_t count = max_terms;
  for (; count > 0; count -= some) {
    unsigned long long words[some / 2], any = 0;
    __builtin_memcpy(words, values + count - some, sizeof words);
    for (const unsigned long long word : words) any |= word;
    if (any != 0) break;
  }
  return count;
}

FREQSYNTH_KERNEL
void residual_means(const float* matrix, const float* amplitudes, const float* sums,
                    const float* shares, float* out) {
  FREQSYNTH_ROUNDING_BEGIN
  using Part = Pack<float, 16>;
  using Four = Pack<float, 4>;
  // A fit of few samples has few terms; adding zeros changes nothing.
  const std::size_t used = used_of(amplitudes);
  for (std::size_t j = 0; j < max_terms; j += 4) {
    const float* row = matrix + j * max_terms;
    Part fits[4] = {};
    for (std::size_t i = 0; i < used; i += 16) {
      const Part amplitude = Part::load(amplitudes + i);
      for (std::size_t k = 0; k < 4; ++k) {
        fits[k] += Part::load(row + k * max_terms + i) * amplitude;
      }
    }
    const Four sum = sums_of(folded(fits[0]), folded(fits[1]), folded(fits[2]), folded(fits[3]));
    ((Four::load_unaligned(sums + j) - sum) * Four::load(shares + j)).store(out + j);
  }
}

FREQSYNTH_KERNEL
void evaluate_separable(const float* amplitudes, const float* wx, std::size_t wx_stride,
                        std::size_t columns, const float* wy, std::size_t rows, float* out,
                        std::size_t out_stride) {
  FREQSYNTH_ROUNDING_BEGIN
  for (std::size_t c = 0; c < columns; c += 8) {
    Float8 partial[block_size];  // sum over u, for each v
    for (std::size_t v = 0; v < block_size; ++v) {
      const float* amplitude = amplitudes + v * block_size;
      Float8 sum = amplitude[0] * Float8::load(wx + c);
      for (std::size_t u = 1; u < block_size; ++u) {
        sum += amplitude[u] * Float8::load(wx + u * wx_stride + c);
      }
      partial[v] = sum;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      const float* weight = wy + r * block_size;
      Float8 sum = weight[0] * partial[0];
      for (std::size_t v = 1; v < block_size; ++v) sum += weight[v] * partial[v];
      sum.store(out + r * out_stride + c);
    }
  }
}

FREQSYNTH_KERNEL
void add_scaled(const double* values, double factor, std::size_t count, double* sums) {
  FREQSYNTH_ROUNDING_BEGIN
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    (Double8::load_unaligned(sums + i) + factor * Double8::load_unaligned(values + i))
        .store_unaligned(sums + i);
  }
  for (; i < count; ++i) sums[i] += factor * values[i];
}

FREQSYNTH_KERNEL
void solve_four(double* matrix, double* right, std::size_t n, std::size_t sides, double* definite) {
  FREQSYNTH_ROUNDING_BEGIN
  constexpr std::size_t lanes = 4;
  const Double4 one = all_lanes<Double4>(1.0);
  Double4 all = one;
  for (std::size_t j = 0; j < n; ++j) {
    double* row = matrix + j * n * lanes;
    Double4 pivot = Double4::load(row + j * lanes);
    for (std::size_t k = 0; k < j; ++k) {
      const Double4 factor = Double4::load(row + k * lanes);
      pivot = pivot - factor * factor;
    }
    all = if_less(Double4{}, pivot, all, Double4{});
    double* diagonal = row + j * lanes;
    if_less(Double4{}, pivot, pivot, one).store(diagonal);
    for (std::size_t i = 0; i < lanes; ++i) diagonal[i] = __builtin_sqrt(diagonal[i]);
    const Double4 root = Double4::load(diagonal);
    for (std::size_t i = j + 1; i < n; ++i) {
      double* lower = matrix + i * n * lanes;
      Double4 value = Double4::load(lower + j * lanes);
      for (std::size_t k = 0; k < j; ++k) {
        value = value - Double4::load(lower + k * lanes) * Double4::load(row + k * lanes);
      }
      quotient(value, root).store(lower + j * lanes);
    }
  }
  for (std::size_t c = 0; c < sides; ++c) {
    double* side = right + c * lanes;
    const std::size_t next = sides * lanes;
    for (std::size_t i = 0; i < n; ++i) {
      const double* row = matrix + i * n * lanes;
      Double4 value = Double4::load(side + i * next);
      for (std::size_t k = 0; k < i; ++k) {
        value = value - Double4::load(row + k * lanes) * Double4::load(side + k * next);
      }
      quotient(value, Double4::load(row + i * lanes)).store(side + i * next);
    }
    for (std::size_t i = n; i-- > 0;) {
      Double4 value = Double4::load(side + i * next);
      for (std::size_t k = i + 1; k < n; ++k) {
        value =
            value - Double4::load(matrix + (k * n + i) * lanes) * Double4::load(side + k * next);
      }
      quotient(value, Double4::load(matrix + (i * n + i) * lanes)).store(side + i * next);
    }
  }
  all.store(definite);
}

FREQSYNTH_KERNEL
void forward_transform(const float* pixels, const double* cosines, const double* scales,
                       float* out) {
  FREQSYNTH_ROUNDING_BEGIN
  alignas(64) double values[max_terms], rows[max_terms];
  for (std::size_t i = 0; i < max_terms; ++i) values[i] = static_cast<double>(pixels[i]);
  for (std::size_t y = 0; y < block_size; ++y) {
    Double8 sum = {};
    for (std::size_t x = 0; x < block_size; ++x) {
      sum += values[y * block_size + x] * Double8::load(cosines + x * block_size);
    }
    sum.store(rows + y * block_size);
  }
  for (std::size_t v = 0; v < block_size; ++v) {
    Double8 sum = {};
    for (std::size_t y = 0; y < block_size; ++y) {
      sum += cosines[y * block_size + v] * Double8::load(rows + y * block_size);
    }
    (Double8::load(scales + v * block_size) * sum).store(values + v * block_size);
  }
  for (std::size_t i = 0; i < max_terms; ++i) out[i] = static_cast<float>(values[i]);
}

FREQSYNTH_KERNEL
void shrink_terms(const float* coefficients, const float* filter, const float* variances,
                  float scale, float* out) {
  FREQSYNTH_ROUNDING_BEGIN
  const Float8 one = all_lanes<Float8>(1.0f);
  for (std::size_t i = 0; i < max_terms; i += 8) {
    const Float8 coefficient = Float8::load_unaligned(coefficients + i);
    const Float8 square = coefficient * coefficient;
    const Float8 error = scale * Float8::load_unaligned(variances + i);
    const Float8 share = if_less(error, square, one - quotient(error, square), Float8{});
    (coefficient * Float8::load_unaligned(filter + i) * share).store_unaligned(out + i);
  }
}

FREQSYNTH_KERNEL
void add_means(const float* means, const float* weights, float doubt, float* pixels) {
  FREQSYNTH_ROUNDING_BEGIN
  const Float8 doubts = all_lanes<Float8>(doubt);
  for (std::size_t i = 0; i < max_terms; i += 8) {
    const Float8 weight = Float8::load(weights + i), pixel = Float8::load(pixels + i);
    const Float8 more = pixel + quotient(Float8::load(means + i) * weight, weight + doubts);
    if_less(Float8{}, weight, more, pixel).store(pixels + i);
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
