// Cost of keeping J^-1 up to date: one more sample (eq. 33), one more term (eq. 37), a whole list.
// The competitors are the inverse computed anew and the same formulas in Eigen. Each case maintains
// J as well, and says how far J J^-1 is from the identity in the end, except for Sherman and
// Morrison's, which does without J.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#ifdef FREQSYNTH_BENCH_EIGEN
#include <Eigen/Dense>
#endif

#include "dense_inverse.h"
#include "fixtures.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/normal_inverse.h"
#include "freqsynth/basis/sample_sequence.h"

#ifdef FREQSYNTH_BENCH_LAPACK
extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dpotri_(const char* uplo, const int* n, double* a, const int* lda, int* info);
// Of OpenBLAS only. Its threads make matrices of this size slower.
void openblas_set_num_threads(int threads) __attribute__((weak));
}
#endif

namespace freqsynth::bench {
namespace {

/// J and J^-1 as the library stores them.
struct Matrices {
  TermMatrix normal, inverse;

  explicit Matrices(std::size_t terms) : normal(*normal_matrix(terms)) {
    invert_by_cholesky(normal, terms, inverse);
  }
  [[nodiscard]] double normal_at(std::size_t i, std::size_t j) const { return normal(i, j); }
  [[nodiscard]] double inverse_at(std::size_t i, std::size_t j) const { return inverse(i, j); }
  void add_to_normal(const double* a, std::size_t terms) {
    for (std::size_t i = 0; i < terms; ++i) {
      double* row = normal.row(i);
      for (std::size_t j = 0; j < terms; ++j) row[j] += a[i] * a[j];
    }
  }
};

/// Largest entry of J J^-1 - 1.
template <class M>
double residual(const M& m, std::size_t terms) {
  double worst = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < terms; ++j) {
      double sum = i == j ? -1 : 0;
      for (std::size_t k = 0; k < terms; ++k) sum += m.normal_at(i, k) * m.inverse_at(k, j);
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

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
void invert_by_lapack(const TermMatrix& normal, std::size_t terms, TermMatrix& inverse) {
  constexpr int stride = max_terms;
  const int n = static_cast<int>(terms);
  int info = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    std::copy_n(normal.row(i), terms, inverse.row(i));
  }
  // Column-major "L" is the upper triangle of these rows.
  dpotrf_("L", &n, inverse.row(0), &stride, &info);
  dpotri_("L", &n, inverse.row(0), &stride, &info);
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < i; ++j) inverse(i, j) = inverse(j, i);
  }
}

struct Lapack : Matrices {
  explicit Lapack(std::size_t terms) : Matrices(terms) {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  }
  void add(const double* a, std::size_t terms) {
    add_to_normal(a, terms);
    invert_by_lapack(normal, terms, inverse);
  }
};
#endif

#ifdef FREQSYNTH_BENCH_EIGEN
constexpr int capacity = max_terms;
using EigenMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, capacity, capacity>;
using EigenVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, capacity, 1>;

EigenMatrix to_eigen(const TermMatrix& matrix, std::size_t terms) {
  const auto n = static_cast<Eigen::Index>(terms);
  return Eigen::Map<const EigenMatrix, 0, Eigen::OuterStride<>>(matrix.row(0), n, n,
                                                                Eigen::OuterStride<>(capacity));
}

struct EigenMatrices {
  EigenMatrix normal, inverse;
  EigenVector gamma, h, w;

  explicit EigenMatrices(std::size_t terms) {
    const auto start = std::make_unique<Matrices>(terms);
    normal = to_eigen(start->normal, terms);
    inverse = to_eigen(start->inverse, terms);
    gamma = h = w = EigenVector::Zero(normal.rows());
  }
  [[nodiscard]] double normal_at(std::size_t i, std::size_t j) const {
    return normal(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  [[nodiscard]] double inverse_at(std::size_t i, std::size_t j) const {
    return inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
};

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

struct EigenShermanMorrison : EigenMatrices {
  using EigenMatrices::EigenMatrices;
  void add(const double* values, std::size_t terms) {
    const Eigen::Map<const EigenVector> a(values, static_cast<Eigen::Index>(terms));
    h.noalias() = inverse * a;
    w = h / (1 + a.dot(h));
    inverse.noalias() -= h * w.transpose();
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
  for (const int terms : {1, 4, 8, 16, 32, 48, 64}) b->Arg(terms);
  b->ArgName("terms");
}

BENCHMARK(rank_one<Library>)->Name("rank_one/freqsynth")->Apply(all_sizes);
BENCHMARK(rank_one<LibraryWithWholeNormal>)
    ->Name("rank_one/freqsynth_whole_normal")
    ->Apply(all_sizes);
#ifdef FREQSYNTH_BENCH_EIGEN
BENCHMARK(rank_one<EigenPowell>)->Name("rank_one/eigen_powell")->Apply(all_sizes);
BENCHMARK(rank_one<EigenShermanMorrison, false>)
    ->Name("rank_one/eigen_sherman_morrison")
    ->Apply(all_sizes);
#endif
BENCHMARK(rank_one<Cholesky>)->Name("rank_one/anew_cholesky")->Apply(all_sizes);
#ifdef FREQSYNTH_BENCH_LAPACK
BENCHMARK(rank_one<Lapack>)->Name("rank_one/anew_lapack")->Apply(all_sizes);
#endif

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
struct LapackBorder : Matrices {
  explicit LapackBorder(std::size_t terms) : Matrices(terms) {
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  }
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
