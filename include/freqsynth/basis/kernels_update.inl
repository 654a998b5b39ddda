// SPDX-License-Identifier: MIT
// The rank-one update, written once like the other kernels of kernels_body.inl, and worth wider
// registers than those.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// rank_one_update() of at most 4 terms: all sums stay in registers.
FREQSYNTH_KERNEL_INLINE void update_few_terms(double* inverse, double* normal, const double* a,
                                              std::size_t terms) {
  FREQSYNTH_ROUNDING_BEGIN
  if (terms == 1) {
    const double sum = normal[0] + a[0] * a[0];
    const double gamma = sum * a[0];
    const double h = inverse[0] * a[0];
    normal[0] = sum;
    inverse[0] += (a[0] - inverse[0] * gamma) * (1 / (h * gamma)) * h;
    return;
  }
  const Double4 x = first_of_4(a, terms);
  Double4 gamma = {}, h = {};
  for (std::size_t i = 0; i < terms; ++i) {
    const Double4 row = Double4::load(normal + i * max_terms) + a[i] * x;
    row.store(normal + i * max_terms);
    gamma += a[i] * row;
    h += a[i] * Double4::load(inverse + i * max_terms);
  }
  const double scale = 1 / sum_of(h * gamma);
  for (std::size_t i = 0; i < terms; ++i) {
    double* row = inverse + i * max_terms;
    const double w = (a[i] - sum_of(Double4::load(row) * gamma)) * scale;
    (w * h).add_to(row);
  }
}

FREQSYNTH_KERNEL
void rank_one_update(double* inverse, double* normal, const double* a, std::size_t terms,
                     std::size_t normal_terms) {
  FREQSYNTH_ROUNDING_BEGIN
  if (terms <= 4 && terms == normal_terms) return update_few_terms(inverse, normal, a, terms);
  // Padding with zeros to whole vectors leaves every sum as it is. J is read and written once, J^-1
  // read once before its update.
  alignas(64) double full[max_terms];
  alignas(64) double fit[max_terms];
  alignas(64) double h[max_terms];      // A^T J^-1
  alignas(64) double w[max_terms];      // (A - J^-1 gamma) / (A^T J^-1 gamma)
  alignas(64) double gamma[max_terms];  // A (A^T A) + J A = (J + A A^T) A
  const std::size_t width = round_up(terms, 8);
  const std::size_t normal_width = round_up(normal_terms, 8);
  copy_padded(a, normal_terms, full);
  copy_padded(a, terms, fit);
  for (std::size_t j = 0; j < width; j += 8) {
    Double8{}.store(h + j);
    Double8{}.store(gamma + j);
  }

  // Four rows at a time, so that a sum of rows is loaded and stored once for all of them. Those
  // beyond `terms` have fit = 0, which leaves them as they are.
  for (std::size_t i = 0; i < terms; i += 4) {
    double* m = normal + i * max_terms;
    for (std::size_t j = 0; j < width; j += 8) {
      const Double8 x = Double8::load(full + j);
      const Double8 n0 = Double8::load(m + j) + fit[i] * x;
      const Double8 n1 = Double8::load(m + max_terms + j) + fit[i + 1] * x;
      const Double8 n2 = Double8::load(m + 2 * max_terms + j) + fit[i + 2] * x;
      const Double8 n3 = Double8::load(m + 3 * max_terms + j) + fit[i + 3] * x;
      n0.store(m + j);
      n1.store(m + max_terms + j);
      n2.store(m + 2 * max_terms + j);
      n3.store(m + 3 * max_terms + j);
      ((fit[i] * n0 + fit[i + 1] * n1) + (fit[i + 2] * n2 + fit[i + 3] * n3)).add_to(gamma + j);
    }
  }
  if (terms < normal_terms) {
    for (std::size_t j = terms; j < width; ++j) gamma[j] = 0;
  }

  // Upwards, and then downwards again: the rows that were last read are those that a cache which
  // does not hold both matrices still has.
  for (std::size_t i = round_up(terms, 4); i > 0;) {
    i -= 4;
    const double* r = inverse + i * max_terms;
    Double8 s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (std::size_t j = 0; j < width; j += 8) {
      const Double8 x = Double8::load(gamma + j);
      const Double8 r0 = Double8::load(r + j);
      const Double8 r1 = Double8::load(r + max_terms + j);
      const Double8 r2 = Double8::load(r + 2 * max_terms + j);
      const Double8 r3 = Double8::load(r + 3 * max_terms + j);
      s0 += r0 * x;
      s1 += r1 * x;
      s2 += r2 * x;
      s3 += r3 * x;
      ((fit[i] * r0 + fit[i + 1] * r1) + (fit[i + 2] * r2 + fit[i + 3] * r3)).add_to(h + j);
    }
    (Double4::load(fit + i) - sums_of(s0, s1, s2, s3)).store(w + i);
  }
  Double8 product = {};
  for (std::size_t j = 0; j < width; j += 8) {
    product += Double8::load(h + j) * Double8::load(gamma + j);
  }
  const double scale = 1 / sum_of(product);  // 1 / (A^T J^-1 gamma)
  for (std::size_t i = 0; i < terms; i += 4) (scale * Double4::load(w + i)).store(w + i);
  for (std::size_t i = 0; i < terms; i += 4) {
    double* r = inverse + i * max_terms;
    for (std::size_t j = 0; j < width; j += 8) {
      const Double8 x = Double8::load(h + j);
      (w[i] * x).add_to(r + j);
      (w[i + 1] * x).add_to(r + max_terms + j);
      (w[i + 2] * x).add_to(r + 2 * max_terms + j);
      (w[i + 3] * x).add_to(r + 3 * max_terms + j);
    }
  }
  // The columns and rows of J beyond the fit.
  for (std::size_t i = 0; i < normal_terms; ++i) {
    double* row = normal + i * max_terms;
    for (std::size_t j = i < terms ? width : 0; j < normal_width; j += 8) {
      (full[i] * Double8::load(full + j)).add_to(row + j);
    }
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
