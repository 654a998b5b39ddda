// SPDX-License-Identifier: MIT
// Cost of one more term in J^-1 (eq. 37), and of a whole list of inverses. The competitors are the
// same formula in Eigen and the inverse computed anew.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "dense_inverse.h"
#include "fixtures.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/normal_inverse.h"
#include "freqsynth/basis/sample_sequence.h"
#include "rank_one_matrices.h"

namespace freqsynth::bench {
namespace {

// ------------------------------------------------------------------------------------ bordering

struct LibraryBorder : Matrices {
  using Matrices::Matrices;
  double step[max_terms] = {};
  double extend(std::size_t old_terms, const double* b, double d) {
    return border_inverse(inverse, {b, old_terms}, d, {step, old_terms});
  }
};

struct CholeskyBorder : Matrices {
  using Matrices::Matrices;
  double extend(std::size_t old_terms, const double*, double) {
    invert_by_cholesky(normal, old_terms + 1, inverse);
    return inverse(old_terms, old_terms);
  }
};

#ifdef FREQSYNTH_BENCH_LAPACK
struct LapackBorder : LapackMatrices {
  using LapackMatrices::LapackMatrices;
  double extend(std::size_t old_terms, const double*, double) {
    invert_by_lapack(normal, old_terms + 1, inverse);
    return inverse(old_terms, old_terms);
  }
};
#endif

#ifdef FREQSYNTH_BENCH_EIGEN
struct EigenBorder : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  double extend(std::size_t old_terms, const double* values, double d) {
    const auto n = static_cast<Eigen::Index>(old_terms);
    const Eigen::Map<const EigenVector> b(values, n);
    auto old = inverse.topLeftCorner(n, n);
    h.head(n).noalias() = old * b;
    const double delta = d - b.dot(h.head(n));
    w.head(n) = h.head(n) / delta;
    old.noalias() += h.head(n) * w.head(n).transpose();
    inverse.col(n).head(n) = -w.head(n);
    inverse.row(n).head(n) = -w.head(n).transpose();
    inverse(n, n) = 1 / delta;
    return delta;
  }
};
#endif

template <class Method>
void border(benchmark::State& state) {
  const auto old_terms = static_cast<std::size_t>(state.range(0));
  const auto method = std::make_unique<Method>(old_terms + 1);
  TermVector b{};
  for (std::size_t i = 0; i < old_terms; ++i) b[i] = method->normal_at(old_terms, i);
  // So large that the old part of the inverse hardly changes, and can be extended again and again.
  const double d = 1e15;
  for (auto _ : state) {
    benchmark::DoNotOptimize(method->extend(old_terms, b.data(), d));
    benchmark::ClobberMemory();
  }
}

void all_old_sizes(benchmark::internal::Benchmark* b) {
  for (const int terms : {1, 4, 8, 16, 32, 48, 63}) b->Arg(terms);
  b->ArgName("old_terms");
}

BENCHMARK(border<LibraryBorder>)->Name("border/freqsynth")->Apply(all_old_sizes);
#ifdef FREQSYNTH_BENCH_EIGEN
BENCHMARK(border<EigenBorder>)->Name("border/eigen")->Apply(all_old_sizes);
#endif
BENCHMARK(border<CholeskyBorder>)->Name("border/anew_cholesky")->Apply(all_old_sizes);
#ifdef FREQSYNTH_BENCH_LAPACK
BENCHMARK(border<LapackBorder>)->Name("border/anew_lapack")->Apply(all_old_sizes);
#endif

// ------------------------------------------------------------------------------------ whole lists

void list_library(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    const InverseList list;
    list.reserve(count);
    benchmark::DoNotOptimize(list.row(count - 1).change);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// The inverses alone, each computed anew, as many terms as in the library's list.
void list_anew(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const InverseList& model = *prepared_list();
  for (auto _ : state) {
    SampleSequence sequence;
    const auto normal = std::make_unique<TermMatrix>();
    const auto inverse = std::make_unique<TermMatrix>();
    std::vector<std::vector<double>> list(count);
    for (std::size_t n = 0; n < count; ++n) {
      const SequencePosition position = sequence[n];
      TermVector a;
      evaluate_terms(position.s, position.t, a);
      for (std::size_t i = 0; i < max_terms; ++i) {
        for (std::size_t j = 0; j < max_terms; ++j) (*normal)(i, j) += a[i] * a[j];
      }
      const std::size_t terms = model.terms(n);
      invert_by_cholesky(*normal, terms, *inverse);
      for (std::size_t i = 0; i < terms; ++i) {
        list[n].insert(list[n].end(), inverse->row(i), inverse->row(i) + i + 1);
      }
    }
    benchmark::DoNotOptimize(list.back().data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(list_library)
    ->Name("list/freqsynth")
    ->ArgName("entries")
    ->Arg(256)
    ->Arg(1024)
    ->Arg(4096)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(list_anew)
    ->Name("list/anew_cholesky")
    ->ArgName("entries")
    ->Arg(256)
    ->Arg(1024)
    ->Arg(4096)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace freqsynth::bench
