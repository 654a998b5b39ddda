#include "freqsynth/basis/normal_inverse.h"

#include <stdexcept>
#include <string>

#include "freqsynth/basis/kernels.h"

namespace freqsynth {

void rank_one_update(TermMatrix& inverse, TermMatrix& normal, std::span<const double> a,
                     std::size_t terms) {
  if (terms == 0 || terms > a.size() || a.size() > max_terms) {
    throw std::invalid_argument("freqsynth: rank_one_update: terms is " + std::to_string(terms) +
                                " with " + std::to_string(a.size()) + " term values");
  }
  detail::rank_one_update(inverse.values.data(), normal.values.data(), a.data(), terms, a.size());
}

double border_inverse(TermMatrix& inverse, std::span<const double> b, double d,
                      std::span<double> step) {
  const std::size_t terms = b.size();
  if (terms == 0 || terms >= max_terms || step.size() != terms) {
    throw std::invalid_argument("freqsynth: border_inverse: " + std::to_string(terms) +
                                " old terms with a step of " + std::to_string(step.size()));
  }
  alignas(32) double rb[max_terms];
  detail::multiply(inverse.values.data(), b.data(), terms, rb);
  for (std::size_t i = terms; i % 4 != 0; ++i) rb[i] = 0;  // whole vectors
  double delta = d;
  for (std::size_t i = 0; i < terms; ++i) delta -= b[i] * rb[i];
  for (std::size_t i = 0; i < terms; ++i) step[i] = -rb[i];
  if (!(delta > 0)) return delta;
  const double scale = 1 / delta;
  detail::add_outer_product(inverse.values.data(), rb, scale, terms);
  for (std::size_t i = 0; i < terms; ++i) inverse(i, terms) = inverse(terms, i) = -rb[i] * scale;
  inverse(terms, terms) = scale;
  return delta;
}

void NormalInverse::add_sample(std::span<const double, max_terms> a) {
  if (terms_ == 0) {
    // The first term is the constant one, which any sample determines.
    for (std::size_t i = 0; i < max_terms; ++i) {
      for (std::size_t j = 0; j < max_terms; ++j) normal_(i, j) = a[i] * a[j];
    }
    inverse_(0, 0) = 1 / normal_(0, 0);
    terms_ = 1;
  } else {
    rank_one_update(inverse_, normal_, a, terms_);
  }
  ++samples_;
}

double NormalInverse::add_term(std::span<double> step, double tolerance) {
  if (terms_ == 0 || terms_ == max_terms) return 0;
  const std::span<const double> b(normal_.row(terms_), terms_);
  const double d = normal_(terms_, terms_);
  // Delta first, so that a term that the samples do not determine leaves the inverse alone.
  alignas(32) double rb[max_terms] = {};
  detail::multiply(inverse_.values.data(), b.data(), terms_, rb);
  double delta = d;
  for (std::size_t i = 0; i < terms_; ++i) delta -= b[i] * rb[i];
  if (!(delta > tolerance * d)) return 0;
  delta = border_inverse(inverse_, b, d, step);
  ++terms_;
  return delta;
}

}  // namespace freqsynth
