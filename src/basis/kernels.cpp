#include "freqsynth/basis/kernels.h"

#include <algorithm>
#include <cstring>

// One copy of each kernel for plain x86-64 and one for AVX2, chosen by the loader. AVX2 without
// FMA, so that both give the same bits. Address sanitizer cannot run the loader's choice, it starts
// too late.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define FREQSYNTH_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FREQSYNTH_SANITIZED
#endif
#if defined(__x86_64__) && defined(__linux__) && !defined(FREQSYNTH_SANITIZED) && \
    !defined(__AVX2__) && (!defined(__clang__) || __clang_major__ >= 14)
#define FREQSYNTH_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define FREQSYNTH_MULTIVERSION
#endif

namespace freqsynth::detail {
namespace {

// Vectors of the compiler: one AVX register, two SSE or NEON ones, the same arithmetic in all
// cases.
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));

constexpr std::size_t lanes = 8;
constexpr std::size_t double_lanes = 4;

constexpr std::size_t groups_of(std::size_t count, std::size_t width) {
  return (count + width - 1) / width;
}

// Local shorthand. Functions would pass vectors by value, whose ABI depends on the instruction set.
#define FREQSYNTH_FLOAT8(pointer) (*reinterpret_cast<const Float8*>(pointer))
#define FREQSYNTH_FLOAT8_REF(pointer) (*reinterpret_cast<Float8*>(pointer))
#define FREQSYNTH_DOUBLE4(pointer) (*reinterpret_cast<const Double4*>(pointer))
#define FREQSYNTH_DOUBLE4_REF(pointer) (*reinterpret_cast<Double4*>(pointer))
#define FREQSYNTH_SUM8(x) (((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])))
#define FREQSYNTH_SUM4(x) ((x[0] + x[2]) + (x[1] + x[3]))

}  // namespace

FREQSYNTH_MULTIVERSION
float absorb_sample(const SampleRow& row, float* states, float* sums, float* residuals,
                    const float* values, const float* weights, std::size_t channels) {
  const std::size_t fit_groups = groups_of(row.terms, lanes);
  const std::size_t rest_begin = row.terms / lanes;
  const BorderRow* border = row.border;
  float change = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    float* state = states + c * max_terms;
    Float8 even = {}, odd = {};
    std::size_t g = 0;
    for (; g + 2 <= fit_groups; g += 2) {
      even += FREQSYNTH_FLOAT8(row.fit + g * lanes) * FREQSYNTH_FLOAT8(state + g * lanes);
      odd +=
          FREQSYNTH_FLOAT8(row.fit + (g + 1) * lanes) * FREQSYNTH_FLOAT8(state + (g + 1) * lanes);
    }
    if (g < fit_groups) {
      even += FREQSYNTH_FLOAT8(row.fit + g * lanes) * FREQSYNTH_FLOAT8(state + g * lanes);
    }
    even += odd;
    const float prediction = FREQSYNTH_SUM8(even);
    const float absorbed = values != nullptr ? values[c] : prediction;
    const float innovation = absorbed - prediction;
    for (g = 0; g < fit_groups; ++g) {
      FREQSYNTH_FLOAT8_REF(state + g * lanes) +=
          innovation * FREQSYNTH_FLOAT8(row.gain + g * lanes);
    }
    for (g = rest_begin; g < max_terms / lanes; ++g) {
      FREQSYNTH_FLOAT8_REF(state + g * lanes) += absorbed * FREQSYNTH_FLOAT8(row.rest + g * lanes);
    }
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      sums[c * max_terms + row.pixels[p]] += absorbed * row.pixel_weight;
    }
    float squared = row.change * innovation * innovation;
    float residual = residuals[c] + row.residual * innovation * innovation;
    if (border != nullptr) {
      // Eq. 37 applied to Y: the new amplitude, and what it takes from the old ones.
      Float8 sum = {};
      for (g = 0; g < fit_groups; ++g) {
        sum += FREQSYNTH_FLOAT8(border->b + g * lanes) * FREQSYNTH_FLOAT8(state + g * lanes);
      }
      const float added = (state[row.terms] - FREQSYNTH_SUM8(sum)) * border->inverse_delta;
      state[row.terms] = 0;
      for (g = 0; g < groups_of(row.terms + 1, lanes); ++g) {
        FREQSYNTH_FLOAT8_REF(state + g * lanes) +=
            added * FREQSYNTH_FLOAT8(border->step + g * lanes);
      }
      squared += added * (border->change * added + 2 * border->cross * innovation);
      // Rounding may take a little more than there is.
      residual = std::max(residual - border->delta * added * added, 0.0f);
    }
    residuals[c] = residual;
    change += weights[c] * squared;
  }
  return change;
}

FREQSYNTH_MULTIVERSION
void rank_one_update(double* inverse, double* normal, const double* a, std::size_t terms,
                     std::size_t normal_terms) {
  // Padding with zeros to whole vectors leaves every sum as it is. Only as much as is read is set:
  // for few terms setting all would cost more than the update.
  alignas(32) double full[max_terms];
  alignas(32) double fit[max_terms];
  alignas(32) double h[max_terms];      // A^T J^-1
  alignas(32) double gamma[max_terms];  // A (A^T A) + J A = (J + A A^T) A
  const std::size_t width = groups_of(terms, double_lanes) * double_lanes;
  const std::size_t normal_width = groups_of(normal_terms, double_lanes) * double_lanes;
  for (std::size_t j = 0; j < normal_width; j += double_lanes) {
    FREQSYNTH_DOUBLE4_REF(full + j) = Double4{};
  }
  for (std::size_t j = 0; j < width; j += double_lanes) {
    FREQSYNTH_DOUBLE4_REF(fit + j) = FREQSYNTH_DOUBLE4_REF(h + j) = Double4{};
  }
  std::memcpy(full, a, normal_terms * sizeof(double));
  std::memcpy(fit, a, terms * sizeof(double));

  for (std::size_t i = 0; i < terms; i += 4) {
    // Four rows at a time, so that h is loaded and stored once for all of them. Rows beyond `terms`
    // have fit = 0 and rows of the inverse there are zero.
    double* m0 = normal + i * max_terms;
    double* m1 = m0 + max_terms;
    double* m2 = m1 + max_terms;
    double* m3 = m2 + max_terms;
    const double* r0 = inverse + i * max_terms;
    const double* r1 = r0 + max_terms;
    const double* r2 = r1 + max_terms;
    const double* r3 = r2 + max_terms;
    const double a0 = fit[i], a1 = fit[i + 1], a2 = fit[i + 2], a3 = fit[i + 3];
    const double f0 = full[i], f1 = full[i + 1], f2 = full[i + 2], f3 = full[i + 3];
    Double4 s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (std::size_t j = 0; j < width; j += double_lanes) {
      const Double4 x = FREQSYNTH_DOUBLE4(fit + j);
      const Double4 y = FREQSYNTH_DOUBLE4(full + j);
      const Double4 n0 = FREQSYNTH_DOUBLE4(m0 + j) + f0 * y;
      const Double4 n1 = FREQSYNTH_DOUBLE4(m1 + j) + f1 * y;
      const Double4 n2 = FREQSYNTH_DOUBLE4(m2 + j) + f2 * y;
      const Double4 n3 = FREQSYNTH_DOUBLE4(m3 + j) + f3 * y;
      FREQSYNTH_DOUBLE4_REF(m0 + j) = n0;
      FREQSYNTH_DOUBLE4_REF(m1 + j) = n1;
      FREQSYNTH_DOUBLE4_REF(m2 + j) = n2;
      FREQSYNTH_DOUBLE4_REF(m3 + j) = n3;
      s0 += n0 * x;
      s1 += n1 * x;
      s2 += n2 * x;
      s3 += n3 * x;
      FREQSYNTH_DOUBLE4_REF(h + j) +=
          (a0 * FREQSYNTH_DOUBLE4(r0 + j) + a1 * FREQSYNTH_DOUBLE4(r1 + j)) +
          (a2 * FREQSYNTH_DOUBLE4(r2 + j) + a3 * FREQSYNTH_DOUBLE4(r3 + j));
    }
    gamma[i] = FREQSYNTH_SUM4(s0);
    gamma[i + 1] = FREQSYNTH_SUM4(s1);
    gamma[i + 2] = FREQSYNTH_SUM4(s2);
    gamma[i + 3] = FREQSYNTH_SUM4(s3);
  }
  for (std::size_t i = terms; i < width; ++i) gamma[i] = 0;

  double denominator = 0;  // A^T J^-1 gamma
  for (std::size_t i = 0; i < terms; ++i) denominator += h[i] * gamma[i];
  const double scale = 1 / denominator;
  for (std::size_t i = 0; i < terms; ++i) {
    double* row = inverse + i * max_terms;
    Double4 even = {}, odd = {};
    std::size_t j = 0;
    for (; j + 2 * double_lanes <= width; j += 2 * double_lanes) {
      even += FREQSYNTH_DOUBLE4(row + j) * FREQSYNTH_DOUBLE4(gamma + j);
      odd +=
          FREQSYNTH_DOUBLE4(row + j + double_lanes) * FREQSYNTH_DOUBLE4(gamma + j + double_lanes);
    }
    if (j < width) even += FREQSYNTH_DOUBLE4(row + j) * FREQSYNTH_DOUBLE4(gamma + j);
    even += odd;
    const double w = (fit[i] - FREQSYNTH_SUM4(even)) * scale;
    for (j = 0; j < width; j += double_lanes) {
      FREQSYNTH_DOUBLE4_REF(row + j) += w * FREQSYNTH_DOUBLE4(h + j);
    }
  }
  // The columns and rows of J beyond the fit.
  for (std::size_t i = 0; i < normal_terms; ++i) {
    double* row = normal + i * max_terms;
    for (std::size_t j = i < width ? width : 0; j < normal_width; j += double_lanes) {
      FREQSYNTH_DOUBLE4_REF(row + j) += full[i] * FREQSYNTH_DOUBLE4(full + j);
    }
  }
}

FREQSYNTH_MULTIVERSION
void add_outer_product(double* matrix, const double* x, double scale, std::size_t terms) {
  // x is padded with zeros to whole vectors, so that nothing beyond `terms` changes.
  for (std::size_t i = 0; i < terms; ++i) {
    double* row = matrix + i * max_terms;
    const double factor = x[i] * scale;
    for (std::size_t j = 0; j < terms; j += double_lanes) {
      FREQSYNTH_DOUBLE4_REF(row + j) += factor * FREQSYNTH_DOUBLE4(x + j);
    }
  }
}

FREQSYNTH_MULTIVERSION
void multiply(const double* matrix, const double* x, std::size_t terms, double* out) {
  alignas(32) double padded[max_terms];
  for (std::size_t j = 0; j < terms; j += double_lanes) {
    FREQSYNTH_DOUBLE4_REF(padded + j) = Double4{};
  }
  std::memcpy(padded, x, terms * sizeof(double));
  for (std::size_t i = 0; i < terms; ++i) {
    Double4 sum = {};
    for (std::size_t j = 0; j < terms; j += double_lanes) {
      sum += FREQSYNTH_DOUBLE4(matrix + i * max_terms + j) * FREQSYNTH_DOUBLE4(padded + j);
    }
    out[i] = FREQSYNTH_SUM4(sum);
  }
}

FREQSYNTH_MULTIVERSION
void residual_means(const float* matrix, const float* amplitudes, const float* sums,
                    const float* shares, float* out) {
  for (std::size_t j = 0; j < max_terms; ++j) {
    const float* row = matrix + j * max_terms;
    Float8 even = {}, odd = {};
    for (std::size_t i = 0; i < max_terms; i += 2 * lanes) {
      even += FREQSYNTH_FLOAT8(row + i) * FREQSYNTH_FLOAT8(amplitudes + i);
      odd += FREQSYNTH_FLOAT8(row + i + lanes) * FREQSYNTH_FLOAT8(amplitudes + i + lanes);
    }
    even += odd;
    out[j] = (sums[j] - FREQSYNTH_SUM8(even)) * shares[j];
  }
}

FREQSYNTH_MULTIVERSION
void evaluate_separable(const float* amplitudes, const float* wx, std::size_t wx_stride,
                        std::size_t columns, const float* wy, std::size_t rows, float* out,
                        std::size_t out_stride) {
  for (std::size_t c = 0; c < columns; c += lanes) {
    Float8 partial[block_size];  // sum over u, for each v
    for (std::size_t v = 0; v < block_size; ++v) {
      const float* amplitude = amplitudes + v * block_size;
      Float8 sum = amplitude[0] * FREQSYNTH_FLOAT8(wx + c);
      for (std::size_t u = 1; u < block_size; ++u) {
        sum += amplitude[u] * FREQSYNTH_FLOAT8(wx + u * wx_stride + c);
      }
      partial[v] = sum;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      const float* weight = wy + r * block_size;
      Float8 sum = weight[0] * partial[0];
      for (std::size_t v = 1; v < block_size; ++v) sum += weight[v] * partial[v];
      FREQSYNTH_FLOAT8_REF(out + r * out_stride + c) = sum;
    }
  }
}

}  // namespace freqsynth::detail
