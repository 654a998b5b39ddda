// SPDX-License-Identifier: MIT
// Cost of one RGB sample in a block of 64 terms: through the shared gains, and through X = J^-1 Y
// (eq. 25). Indices 200 .. 499 of the sequence, where the fit is complete. `blocks:1` keeps one
// state in the nearest cache; with many blocks the next one is anywhere, as in the engine.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#ifdef FREQSYNTH_BENCH_EIGEN
#include <Eigen/Dense>
#endif

#include "fixtures.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/refine/literal_refiner.h"

namespace freqsynth::bench {
namespace {

constexpr std::size_t first_index = 200;
constexpr std::size_t last_index = 499;
constexpr std::size_t channels = 3;

using Value = std::array<float, channels>;

/// Values of samples, a new one for each call.
class Values {
 public:
  Values() : values_(1024) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    for (Value& value : values_) {
      for (float& v : value) v = uniform(random);
    }
  }
  const Value& next() { return values_[n_++ % values_.size()]; }

 private:
  std::vector<Value> values_;
  std::size_t n_ = 0;
};

/// Blocks in a random order, each of which takes one sample per round, at an index of its own.
struct Blocks {
  std::vector<std::uint32_t> order, indices;
  std::size_t n = 0;

  explicit Blocks(std::size_t count) : order(count), indices(count) {
    std::mt19937 random(2);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    for (std::uint32_t& index : indices) {
      index = static_cast<std::uint32_t>(first_index + random() % (last_index - first_index + 1));
    }
  }
  /// The next block; its index is indices[block], to be stepped by step().
  std::uint32_t next() {
    if (n == order.size()) n = 0;
    return order[n++];
  }
  void step(std::uint32_t block) {
    indices[block] = indices[block] == last_index ? first_index : indices[block] + 1;
  }
};

struct alignas(64) Line {
  float values[16];
};

void gain_path(benchmark::State& state) {
  const LeastSquaresRefiner refiner(prepared_list(), channels);
  Blocks blocks(static_cast<std::size_t>(state.range(0)));
  Values values;
  const std::size_t lines = refiner.state_size() / std::size(Line{}.values);
  std::vector<Line> states(blocks.order.size() * lines);
  const auto state_of = [&](std::size_t block) { return states[block * lines].values; };
  for (std::size_t block = 0; block < blocks.order.size(); ++block) {
    refiner.reset(state_of(block));
    for (std::size_t n = 0; n < first_index; ++n) {
      refiner.absorb(state_of(block), n, values.next().data());
    }
  }
  for (auto _ : state) {
    const std::uint32_t block = blocks.next();
    benchmark::DoNotOptimize(
        refiner.absorb(state_of(block), blocks.indices[block], values.next().data()));
    blocks.step(block);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(gain_path)->Name("rgb_sample/gains")->ArgName("blocks")->Arg(1)->Arg(4096)->Arg(32400);

/// One block, from index 200 to 499 and again.
void literal_refiner(benchmark::State& state) {
  Values values;
  std::array<LiteralRefiner, channels> start{LiteralRefiner(prepared_list()),
                                             LiteralRefiner(prepared_list()),
                                             LiteralRefiner(prepared_list())};
  for (std::size_t n = 0; n < first_index; ++n) {
    const Value& value = values.next();
    for (std::size_t c = 0; c < channels; ++c) start[c].absorb(double{value[c]});
  }
  auto refiners = start;
  std::size_t n = first_index;
  for (auto _ : state) {
    if (n > last_index) {
      refiners = start;
      n = first_index;
    }
    const Value& value = values.next();
    for (std::size_t c = 0; c < channels; ++c) {
      refiners[c].absorb(double{value[c]});
      benchmark::DoNotOptimize(refiners[c].amplitudes()[0]);
    }
    ++n;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(literal_refiner)->Name("rgb_sample/literal_refiner");

/// What the literal path needs at each index: J^-1 as a packed lower triangle, and the term values.
template <class T>
struct Solver {
  std::vector<T> triangles;  // all in one piece
  std::vector<std::array<T, max_terms>> terms;
  static constexpr std::size_t triangle_size = max_terms * (max_terms + 1) / 2;

  Solver() {
    for (std::size_t n = first_index; n <= last_index; ++n) {
      for (const double x : prepared_list()->inverse(n)) triangles.push_back(static_cast<T>(x));
      auto& row = terms.emplace_back();
      for (std::size_t i = 0; i < max_terms; ++i) row[i] = static_cast<T>(term_vectors()[n][i]);
    }
  }
  const T* triangle(std::size_t index) const {
    return triangles.data() + (index - first_index) * triangle_size;
  }
};

/// Plain loops over the triangle, all channels at once, so that J^-1 is read once.
template <class T>
void packed_triangle(benchmark::State& state) {
  const auto solver = std::make_unique<Solver<T>>();
  Values values;
  Blocks blocks(1);
  T x[channels][max_terms] = {};
  T y[channels][max_terms] = {};
  for (auto _ : state) {
    const std::uint32_t block = blocks.next();
    const std::size_t index = blocks.indices[block];
    const Value& value = values.next();
    const auto& a = solver->terms[index - first_index];
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t i = 0; i < max_terms; ++i) y[c][i] += static_cast<T>(value[c]) * a[i];
    }
    const T* row = solver->triangle(index);
    for (std::size_t i = 0; i < max_terms; ++i) {
      T sum[channels] = {};
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t c = 0; c < channels; ++c) {
          sum[c] += row[j] * y[c][j];
          x[c][j] += row[j] * y[c][i];
        }
      }
      for (std::size_t c = 0; c < channels; ++c) x[c][i] = sum[c] + row[i] * y[c][i];
      row += i + 1;
    }
    benchmark::DoNotOptimize(x);
    benchmark::ClobberMemory();
    blocks.step(block);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(packed_triangle<float>)->Name("rgb_sample/triangle_float");
BENCHMARK(packed_triangle<double>)->Name("rgb_sample/triangle_double");

#ifdef FREQSYNTH_BENCH_EIGEN
/// Whole matrices of known size, all channels in one product: the best case of the literal path.
template <class T>
void eigen_product(benchmark::State& state) {
  using Matrix = Eigen::Matrix<T, static_cast<int>(max_terms), static_cast<int>(max_terms)>;
  using Block = Eigen::Matrix<T, static_cast<int>(max_terms), static_cast<int>(channels)>;
  using Vector = Eigen::Matrix<T, static_cast<int>(max_terms), 1>;
  using Sample = Eigen::Matrix<T, 1, static_cast<int>(channels)>;
  const auto solver = std::make_unique<Solver<T>>();
  std::vector<Matrix> inverses;
  for (std::size_t n = first_index; n <= last_index; ++n) {
    const T* packed = solver->triangle(n);
    Matrix& inverse = inverses.emplace_back();
    for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) inverse(i, j) = inverse(j, i) = *packed++;
    }
  }
  Values values;
  Blocks blocks(1);
  Block x = Block::Zero();
  Block y = Block::Zero();
  for (auto _ : state) {
    const std::uint32_t block = blocks.next();
    const std::size_t place = blocks.indices[block] - first_index;
    const Value& value = values.next();
    const Sample sample = Eigen::Map<const Eigen::RowVector3f>(value.data()).template cast<T>();
    y.noalias() += Eigen::Map<const Vector>(solver->terms[place].data()) * sample;
    x.noalias() = inverses[place] * y;
    benchmark::DoNotOptimize(x);
    benchmark::ClobberMemory();
    blocks.step(block);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(eigen_product<float>)->Name("rgb_sample/eigen_float");
BENCHMARK(eigen_product<double>)->Name("rgb_sample/eigen_double");
#endif

}  // namespace
}  // namespace freqsynth::bench
