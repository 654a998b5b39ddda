// SPDX-License-Identifier: MIT
// Construction of the list that all images share, from nothing, one thread. The competitors find
// J^-1 anew for every entry, by Cholesky's factors: as in a textbook, in Eigen, and in LAPACK. They
// are given the positions and the numbers of terms, and find no more than the gains k = J^-1 A.
// `per_entry` is the time divided by the number of entries; `off` is how far the last gains are
// from the list's.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dense_inverse.h"
#include "fixtures.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/kernels.h"
#include "rank_one_matrices.h"

namespace freqsynth::bench {
namespace {

void report_per_entry(benchmark::State& state, std::size_t entries) {
  state.counters["per_entry"] = benchmark::Counter(
      static_cast<double>(entries),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void build(benchmark::State& state) {
  const auto entries = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    const InverseList list;
    list.reserve(entries);
    benchmark::DoNotOptimize(list.row(entries - 1).gain[0]);
  }
  report_per_entry(state, entries);
}

struct Cholesky {
  static void invert(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
    invert_by_cholesky(normal, terms, inverse);
  }
};

#ifdef FREQSYNTH_BENCH_LAPACK
struct Lapack {
  Lapack() {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  }
  static void invert(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
    invert_by_lapack(normal, terms, inverse);
  }
};
#endif

#ifdef FREQSYNTH_BENCH_EIGEN
struct EigenCholesky {
  Eigen::LLT<EigenMatrix> factors;

  void invert(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
    const auto n = static_cast<Eigen::Index>(terms);
    using Rows = Eigen::OuterStride<>;
    const Eigen::Map<const EigenMatrix, 0, Rows> from(normal.row(0), n, n, Rows(capacity));
    Eigen::Map<EigenMatrix, 0, Rows> to(inverse.row(0), n, n, Rows(capacity));
    factors.compute(from);
    to.setIdentity();
    factors.solveInPlace(to);
  }
};
#endif

template <class Method>
void anew(benchmark::State& state) {
  const auto entries = static_cast<std::size_t>(state.range(0));
  const SharedInverseList known = prepared_list();
  const auto normal = std::make_unique<TermMatrix>(), inverse = std::make_unique<TermMatrix>();
  alignas(64) std::array<double, max_terms> a, gain;
  std::size_t terms = 0;
  for (auto _ : state) {
    *normal = TermMatrix();
    *inverse = TermMatrix();
    Method method;
    for (std::size_t n = 0; n < entries; ++n) {
      const SequencePosition& position = known->position(n);
      terms = known->row(n).terms;
      evaluate_terms(position.s, position.t, a);
      detail::add_outer_product(normal->row(0), a.data(), 1, max_terms);
      method.invert(*normal, terms, *inverse);
      detail::multiply(inverse->row(0), a.data(), terms, gain.data());
      benchmark::DoNotOptimize(gain.data());
      benchmark::ClobberMemory();
    }
  }
  report_per_entry(state, entries);
  const std::span<const double> expected = known->gain(entries - 1);
  double off = 0;
  for (std::size_t i = 0; i < terms; ++i) off = std::max(off, std::abs(gain[i] - expected[i]));
  state.counters["off"] = off;
  if (expected.size() != terms || !(off < 1e-8)) state.SkipWithError("the gains are others");
}

void all_sizes(benchmark::internal::Benchmark* b) {
  for (const int entries : {64, 160, 1024, 4096}) b->Arg(entries);
  b->ArgName("entries")->Unit(benchmark::kMillisecond);
}

BENCHMARK(build)->Name("inverse_list/build")->Apply(all_sizes);
BENCHMARK(anew<Cholesky>)->Name("inverse_list/anew_cholesky")->Apply(all_sizes);
#ifdef FREQSYNTH_BENCH_EIGEN
BENCHMARK(anew<EigenCholesky>)->Name("inverse_list/anew_eigen")->Apply(all_sizes);
#endif
#ifdef FREQSYNTH_BENCH_LAPACK
BENCHMARK(anew<Lapack>)->Name("inverse_list/anew_lapack")->Apply(all_sizes);
#endif

}  // namespace
}  // namespace freqsynth::bench
