// SPDX-License-Identifier: MIT
// Each kernel, in its plain version, against the same formula in long double.

#include "freqsynth/basis/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "support/kernel_cases.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using namespace kernel_cases;
using oracle::Real;

// --------------------------------------------------------------------------- slow computations

/// A number in long double, and the most by which one that was rounded to T after each operation
/// may differ from it.
template <class T>
struct Bounded {
  static constexpr Real unit = std::numeric_limits<T>::epsilon() / Real{2};

  Real value = 0;
  Real error = 0;

  Bounded() = default;
  Bounded(T exact) : value(exact) {}  // NOLINT: numbers stand for themselves
  Bounded(Real v, Real e) : value(v), error(e + unit * (std::abs(v) + e)) {}

  friend Bounded operator+(Bounded a, Bounded b) { return {a.value + b.value, a.error + b.error}; }
  friend Bounded operator-(Bounded a, Bounded b) { return {a.value - b.value, a.error + b.error}; }
  friend Bounded operator*(Bounded a, Bounded b) {
    return {a.value * b.value,
            std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error};
  }
  friend Bounded operator/(Bounded a, Bounded b) {
    const Real quotient = a.value / b.value;
    return {quotient, (a.error + std::abs(quotient) * b.error) / (std::abs(b.value) - b.error)};
  }
  /// A sum in any order.
  static Bounded sum(const std::vector<Bounded>& terms) {
    Real value = 0, magnitude = 0, error = 0;
    for (const Bounded& term : terms) {
      value += term.value;
      magnitude += std::abs(term.value) + term.error;
      error += term.error;
    }
    const Real share = static_cast<Real>(terms.size()) * unit;
    return {value, error + share / (1 - share) * magnitude};
  }
};

template <class T>
void expect_within(T actual, const Bounded<T>& expected, const std::string& what) {
  EXPECT_LE(std::abs(static_cast<Real>(actual) - expected.value), expected.error) << what;
}

// ------------------------------------------------------------------------------ absorb_samples

TEST(Kernels, AbsorbSamplesIsItsFormula) {
  using Number = Bounded<float>;
  for_all_absorptions([](auto make) {
    const auto before = make();
    const auto after = make();
    after->run(plain());
    const SampleRow& row = before->row;
    const BorderRow& border = before->border;
    std::vector<Number> changes;
    for (std::size_t c = 0; c < before->channels; ++c) {
      std::vector<Number> state(
          before->states.begin() + static_cast<std::ptrdiff_t>(c * max_terms),
          before->states.begin() + static_cast<std::ptrdiff_t>((c + 1) * max_terms));
      std::vector<Number> products;
      for (std::size_t i = 0; i < row.terms; ++i) products.push_back(row.fit[i] * state[i]);
      const Number prediction = Number::sum(products);
      const Number absorbed = before->known ? Number(before->values[c]) : prediction;
      const Number innovation = absorbed - prediction;
      for (std::size_t i = 0; i < max_terms; ++i) {
        state[i] = state[i] + (i < row.terms ? innovation * row.gain[i] : absorbed * row.gain[i]);
      }
      for (std::size_t p = 0; p < row.pixel_count; ++p) {
        const std::size_t place = 2 * c * max_terms + row.pixels[p];
        expect_within(after->sums[place], before->sums[place] + absorbed * row.pixel_weights[p],
                      "sum");
      }
      Number spread = before->residuals[2 * c + 1];
      for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
        const std::size_t place = (2 * c + 1) * max_terms + pixel;
        if (pixel != row.own_pixel) {
          EXPECT_EQ(after->sums[place], before->sums[place]);
          continue;
        }
        expect_within(after->sums[place], before->sums[place] + absorbed, "own sum");
        Number off = absorbed - before->sums[place] * Number(row.own_share);
        off.value = std::abs(off.value);
        if (row.own_share > 0 && off.value > spread.value) spread = off;
      }
      expect_within(after->residuals[2 * c + 1], spread, "spread");
      Number squared = row.change * innovation * innovation;
      Number residual = before->residuals[2 * c] + row.residual * innovation * innovation;
      if (row.border != nullptr) {
        products.clear();
        for (std::size_t i = 0; i < row.terms; ++i) products.push_back(border.b[i] * state[i]);
        const Number added = (state[row.terms] - Number::sum(products)) * border.inverse_delta;
        state[row.terms] = Number(0.0f);
        for (std::size_t i = 0; i <= row.terms; ++i) state[i] = state[i] + added * border.step[i];
        squared = squared + added * (border.change * added + 2.0f * border.cross * innovation);
        residual = residual - border.delta * added * added;
        if (residual.value < 0) residual.value = 0;
      }
      for (std::size_t i = 0; i < max_terms; ++i) {
        expect_within(after->states[c * max_terms + i], state[i], "state");
      }
      expect_within(after->residuals[2 * c], residual, "residual");
      changes.push_back(before->weights[c] * squared);
    }
    expect_within(after->change, Number::sum(changes), "change");
    // Nothing else moves.
    for (std::size_t i = 0; i < max_terms; ++i) {
      const std::size_t place = before->channels * max_terms + i;
      EXPECT_EQ(after->states[place], before->states[place]);
      EXPECT_EQ(after->sums[2 * before->channels * max_terms + i],
                before->sums[2 * before->channels * max_terms + i]);
      EXPECT_EQ(after->sums[(2 * before->channels + 1) * max_terms + i],
                before->sums[(2 * before->channels + 1) * max_terms + i]);
    }
    EXPECT_EQ(after->residuals[2 * before->channels], before->residuals[2 * before->channels]);
    EXPECT_EQ(after->residuals.back(), before->residuals.back());
  });
}

// ----------------------------------------------------------------------------- rank_one_update

TEST(Kernels, RankOneUpdateIsPowellsFormula) {
  using Number = Bounded<double>;
  for_all_updates([](auto make) {
    const Update before = make();
    Update after = make();
    after.run(plain());
    const std::size_t terms = before.terms;
    const AlignedVector<double>& a = before.a;
    const auto at = [](const AlignedVector<double>& m, std::size_t i, std::size_t j) {
      return Number(m[i * max_terms + j]);
    };
    std::vector<Number> gamma(terms), h(terms), products(terms);
    for (std::size_t j = 0; j < terms; ++j) {
      for (std::size_t i = 0; i < terms; ++i) {
        products[i] = a[i] * (at(before.normal, i, j) + Number(a[i]) * a[j]);
      }
      gamma[j] = Number::sum(products);
      for (std::size_t i = 0; i < terms; ++i) products[i] = a[i] * at(before.inverse, i, j);
      h[j] = Number::sum(products);
    }
    for (std::size_t i = 0; i < terms; ++i) products[i] = h[i] * gamma[i];
    const Number scale = Number(1.0) / Number::sum(products);
    for (std::size_t i = 0; i < max_terms; ++i) {
      Number w = 0.0;
      if (i < terms) {
        for (std::size_t j = 0; j < terms; ++j) products[j] = at(before.inverse, i, j) * gamma[j];
        w = (a[i] - Number::sum(products)) * scale;
      }
      for (std::size_t j = 0; j < max_terms; ++j) {
        const std::size_t place = i * max_terms + j;
        if (i < terms && j < terms) {
          expect_within(after.inverse[place], at(before.inverse, i, j) + w * h[j], "inverse");
        } else {
          EXPECT_EQ(after.inverse[place], 0);
        }
        if (i < before.normal_terms && j < before.normal_terms) {
          const Number sum = at(before.normal, i, j) + Number(a[i]) * a[j];
          expect_within(after.normal[place], sum, "normal");
        } else {
          EXPECT_EQ(after.normal[place], before.normal[place]);
        }
      }
    }
  });
}

// --------------------------------------------------------------------------- the small kernels

TEST(Kernels, AddOuterProductIsItsFormula) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    const AlignedVector<double> after = outer_product(plain(), terms);
    oracle::Random random(static_cast<unsigned>(terms));
    const AlignedVector<double> before = random_numbers<double>(max_terms * max_terms, random);
    const AlignedVector<double> x = padded_numbers(terms, random);
    const Bounded<double> scale = random.uniform(-1, 1);
    for (std::size_t i = 0; i < max_terms; ++i) {
      for (std::size_t j = 0; j < max_terms; ++j) {
        const std::size_t place = i * max_terms + j;
        if (i < terms && j < terms) {
          expect_within(after[place], before[place] + x[i] * scale * x[j], "entry");
        } else {
          EXPECT_EQ(after[place], before[place]);
        }
      }
    }
  }
}

TEST(Kernels, MultiplyIsItsFormula) {
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    const Product product(plain(), terms);
    for (std::size_t i = 0; i < terms; ++i) {
      std::vector<Bounded<double>> products;
      for (std::size_t j = 0; j < terms; ++j) {
        products.push_back(Bounded<double>(product.matrix[i * max_terms + j]) * product.x[j + 1]);
      }
      expect_within(product.out[i], Bounded<double>::sum(products), "entry");
    }
    EXPECT_EQ(product.out[terms], -7) << "written beyond the end";
  }
}

TEST(Kernels, ResidualMeansAreTheirFormula) {
  using Number = Bounded<float>;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Residuals r(seed);
    r.run(plain());
    for (std::size_t j = 0; j < max_terms; ++j) {
      std::vector<Number> products;
      for (std::size_t i = 0; i < max_terms; ++i) {
        products.push_back(Number(r.matrix[j * max_terms + i]) * r.amplitudes[i]);
      }
      expect_within(r.out[j], (r.sums[j] - Number::sum(products)) * r.shares[j], "pixel");
    }
  }
}

TEST(Kernels, EvaluateSeparableIsItsFormula) {
  using Number = Bounded<float>;
  for_all_sizes([](std::size_t columns, std::size_t rows) {
    Separable s(columns, rows);
    s.run(plain());
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < s.stride; ++c) {
        if (c >= columns) {
          EXPECT_EQ(s.out[r * s.stride + c], -7) << "written beyond the row";
          continue;
        }
        std::vector<Number> outer(block_size), inner(block_size);
        for (std::size_t v = 0; v < block_size; ++v) {
          for (std::size_t u = 0; u < block_size; ++u) {
            inner[u] = Number(s.amplitudes[v * block_size + u]) * s.wx[u * s.stride + c];
          }
          outer[v] = s.wy[r * block_size + v] * Number::sum(inner);
        }
        expect_within(s.out[r * s.stride + c], Number::sum(outer), "pixel");
      }
    }
  });
}

}  // namespace
}  // namespace freqsynth
