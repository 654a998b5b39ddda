// SPDX-License-Identifier: MIT
// Cost of one more sample in J^-1 (eq. 33). The competitors are the formula of Sherman and Morrison
// in Eigen, in the three ways to write it that are the fastest at some number of terms; the formula
// of the paper in Eigen, word for word; and the inverse computed anew.
//
// Sherman and Morrison's formula does less: it needs no J, and does not update it. All others do,
// and say how far J J^-1 is from the identity in the end. Eigen has the instruction set that the
// compiler was told; configure with -DFREQSYNTH_NATIVE=ON to give it that of the machine.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "dense_inverse.h"
#include "fixtures.h"
#include "freqsynth/basis/normal_inverse.h"
#include "rank_one_matrices.h"

namespace freqsynth::bench {
namespace {

struct Library : Matrices {
  using Matrices::Matrices;
  void add(const double* a, std::size_t terms) {
    rank_one_update(inverse, normal, {a, terms}, terms);
  }
};

/// As in an inverse list, where J always has all 64 terms.
struct LibraryWithWholeNormal : Matrices {
  explicit LibraryWithWholeNormal(std::size_t terms) : Matrices(terms) {
    normal = *normal_matrix(max_terms);
  }
  void add(const double* a, std::size_t terms) {
    rank_one_update(inverse, normal, {a, max_terms}, terms);
  }
};

struct Cholesky : Matrices {
  using Matrices::Matrices;
  void add(const double* a, std::size_t terms) {
    add_to_normal(a, terms);
    invert_by_cholesky(normal, terms, inverse);
  }
};

#ifdef FREQSYNTH_BENCH_LAPACK
struct Lapack : LapackMatrices {
  using LapackMatrices::LapackMatrices;
  void add(const double* a, std::size_t terms) {
    add_to_normal(a, terms);
    invert_by_lapack(normal, terms, inverse);
  }
};
#endif

#ifdef FREQSYNTH_BENCH_EIGEN
struct EigenPowell : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  void add(const double* values, std::size_t terms) {
    const Eigen::Map<const EigenVector> a(values, static_cast<Eigen::Index>(terms));
    gamma.noalias() = normal * a;
    gamma += a.squaredNorm() * a;
    h.noalias() = inverse.transpose() * a;
    w = a;
    w.noalias() -= inverse * gamma;
    w /= h.dot(gamma);
    inverse.noalias() += w * h.transpose();
    normal.noalias() += a * a.transpose();
  }
};

/// The fastest for few terms: nothing is handed to Eigen's kernels for large matrices.
struct EigenShermanMorrisonLazy : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  void add(const double* values, std::size_t terms) {
    const Eigen::Map<const EigenVector> a(values, static_cast<Eigen::Index>(terms));
    h.noalias() = inverse.lazyProduct(a);
    w = (-1 / (1 + a.dot(h))) * h;
    inverse += h.lazyProduct(w.transpose());
  }
};

struct EigenShermanMorrison : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  void add(const double* values, std::size_t terms) {
    const Eigen::Map<const EigenVector> a(values, static_cast<Eigen::Index>(terms));
    h.noalias() = inverse * a;
    w = h / (1 + a.dot(h));
    inverse.noalias() -= h * w.transpose();
  }
};

/// The fastest for many terms without AVX: half of the inverse does for all of it.
struct EigenShermanMorrisonTriangle : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  void add(const double* values, std::size_t terms) {
    const Eigen::Map<const EigenVector> a(values, static_cast<Eigen::Index>(terms));
    h.noalias() = inverse.selfadjointView<Eigen::Lower>() * a;
    inverse.selfadjointView<Eigen::Lower>().rankUpdate(h, -1 / (1 + a.dot(h)));
  }
};
#endif

template <class Method, bool maintains_normal = true>
void rank_one(benchmark::State& state) {
  const auto terms = static_cast<std::size_t>(state.range(0));
  const std::vector<TermVector>& vectors = term_vectors();
  const auto start = std::make_unique<Method>(terms);
  const auto method = std::make_unique<Method>(terms);
  // J grows with every sample. Starting anew so rarely costs nothing.
  constexpr std::size_t period = 65536;
  std::size_t n = 0;
  for (auto _ : state) {
    if (++n % period == 0) *method = *start;
    method->add(vectors[n % vectors.size()].data(), terms);
    benchmark::DoNotOptimize(method->inverse);
    benchmark::ClobberMemory();
  }
  if (!maintains_normal) return;
  const double error = residual(*method, terms);
  state.counters["residual"] = error;
  if (!(error < 1e-6)) state.SkipWithError("J J^-1 is not the identity");
}

void all_sizes(benchmark::internal::Benchmark* b) {
  for (const int terms : {1, 2, 4, 8, 16, 32, 48, 64}) b->Arg(terms);
  b->ArgName("terms");
}

BENCHMARK(rank_one<Library>)->Name("rank_one/freqsynth")->Apply(all_sizes);
BENCHMARK(rank_one<LibraryWithWholeNormal>)
    ->Name("rank_one/freqsynth_whole_normal")
    ->Apply(all_sizes);
#ifdef FREQSYNTH_BENCH_EIGEN
BENCHMARK(rank_one<EigenShermanMorrisonLazy, false>)
    ->Name("rank_one/eigen_sherman_morrison_without_normal/lazy")
    ->Apply(all_sizes);
BENCHMARK(rank_one<EigenShermanMorrison, false>)
    ->Name("rank_one/eigen_sherman_morrison_without_normal/whole")
    ->Apply(all_sizes);
BENCHMARK(rank_one<EigenShermanMorrisonTriangle, false>)
    ->Name("rank_one/eigen_sherman_morrison_without_normal/triangle")
    ->Apply(all_sizes);
BENCHMARK(rank_one<EigenPowell>)->Name("rank_one/eigen_powell")->Apply(all_sizes);
#endif
BENCHMARK(rank_one<Cholesky>)->Name("rank_one/anew_cholesky")->Apply(all_sizes);
#ifdef FREQSYNTH_BENCH_LAPACK
BENCHMARK(rank_one<Lapack>)->Name("rank_one/anew_lapack")->Apply(all_sizes);
#endif

}  // namespace
}  // namespace freqsynth::bench
