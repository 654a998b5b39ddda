// SPDX-License-Identifier: MIT
// What is demanded of a Refiner and of a BlockMeasure: each member by its own absence.
#include <cstddef>
#include <cstdint>
#include <span>

#include "freqsynth/engine/block_measure.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/refine/refiner.h"
#include "support/other_parts.h"

namespace freqsynth {
namespace {

using helpers::FewestSamples;
using helpers::MeanRefiner;

static_assert(Refiner<LeastSquaresRefiner>);
static_assert(Refiner<MeanRefiner>);

// A deleted member hides that of the base: all that is missing is this one.
struct WithoutList : MeanRefiner {
  const InverseList& list() const = delete;
};
struct WithoutChannels : MeanRefiner {
  std::size_t channels() const = delete;
};
struct WithoutWeights : MeanRefiner {
  std::span<const float> weights() const = delete;
};
struct WithoutStateSize : MeanRefiner {
  std::size_t state_size() const = delete;
};
struct WithoutWeigh : MeanRefiner {
  void weigh(std::span<const float>) = delete;
};
struct WithoutRescale : MeanRefiner {
  void rescale(float*, std::size_t, int) const = delete;
};
struct WithoutReset : MeanRefiner {
  void reset(float*) const = delete;
};
struct WithoutAbsorb : MeanRefiner {
  float absorb(float*, std::size_t, const float*) const = delete;
};
struct WithoutPrefetch : MeanRefiner {
  void prefetch(const float*, std::size_t) const = delete;
};
struct WithoutFreedom : MeanRefiner {
  float freedom(std::size_t) const = delete;
};
struct WithoutResidual : MeanRefiner {
  using MeanRefiner::residual;
  float residual(const float*, std::size_t) const = delete;
};
struct WithoutResidualOfAChannel : MeanRefiner {
  using MeanRefiner::residual;
  float residual(const float*, std::size_t, std::size_t) const = delete;
};
struct WithoutTerms : MeanRefiner {
  std::size_t terms(std::size_t) const = delete;
};
struct WithoutVariances : MeanRefiner {
  std::span<const float, max_terms> variances(std::size_t) const = delete;
};
struct WithoutCoefficients : MeanRefiner {
  void coefficients(const float*, std::size_t, std::size_t,
                    std::span<float, max_terms>) const = delete;
};
struct WithoutFit : MeanRefiner {
  BlockFit fit(const float*, std::size_t, std::size_t) const = delete;
};
// What is there must be of the right type, too, and work on a state that may not be written to.
struct InDouble : MeanRefiner {
  double freedom(std::size_t n) const { return MeanRefiner::freedom(n); }
};
struct WritesWhileReading : MeanRefiner {
  BlockFit fit(float* state, std::size_t n, std::size_t channel) const {
    return MeanRefiner::fit(state, n, channel);
  }
};
struct OnlyAddsSomething : MeanRefiner {};

static_assert(!Refiner<WithoutList>);
static_assert(!Refiner<WithoutChannels>);
static_assert(!Refiner<WithoutWeights>);
static_assert(!Refiner<WithoutStateSize>);
static_assert(!Refiner<WithoutWeigh>);
static_assert(!Refiner<WithoutRescale>);
static_assert(!Refiner<WithoutReset>);
static_assert(!Refiner<WithoutAbsorb>);
static_assert(!Refiner<WithoutPrefetch>);
static_assert(!Refiner<WithoutFreedom>);
static_assert(!Refiner<WithoutResidual>);
static_assert(!Refiner<WithoutResidualOfAChannel>);
static_assert(!Refiner<WithoutTerms>);
static_assert(!Refiner<WithoutVariances>);
static_assert(!Refiner<WithoutCoefficients>);
static_assert(!Refiner<WithoutFit>);
static_assert(!Refiner<InDouble>);
static_assert(!Refiner<WritesWhileReading>);
static_assert(Refiner<OnlyAddsSomething>);
static_assert(!Refiner<int>);

struct WithoutPriority : FewestSamples {
  template <Refiner R>
  float priority(const BlockView<R>&, std::uint32_t, float) const = delete;
};
struct WithoutUnits : FewestSamples {
  template <Refiner R>
  void use_units(const BlockView<R>&, float) = delete;
};
struct WithoutNews : FewestSamples {
  bool has_news(std::uint32_t) = delete;
};

struct WithoutNoise : FewestSamples {
  template <Refiner R>
  bool notice_noise(const BlockView<R>&) = delete;
};

static_assert(BlockMeasure<FewestSamples, MeanRefiner>);
static_assert(BlockMeasure<ChangeMeasure, MeanRefiner>);
static_assert(BlockMeasure<ResidualMeasure, MeanRefiner>);
static_assert(!BlockMeasure<WithoutPriority, MeanRefiner>);
static_assert(!BlockMeasure<WithoutNoise, MeanRefiner>);
static_assert(!BlockMeasure<WithoutUnits, MeanRefiner>);
static_assert(!BlockMeasure<WithoutNews, MeanRefiner>);
static_assert(!BlockMeasure<MeanRefiner, MeanRefiner>);

}  // namespace
}  // namespace freqsynth
