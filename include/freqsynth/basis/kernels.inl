// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <span>

#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/rounding.h"

// Windows aligns the stack to 16 bytes, to which gcc's code for AVX does not adapt.
#if defined(__x86_64__) && !defined(_WIN32)
#define FREQSYNTH_KERNELS_AVX2
#if !(defined(__clang__) && defined(__FAST_MATH__))
#define FREQSYNTH_KERNELS_AVX512
#endif
#endif

#define FREQSYNTH_KERNEL inline FREQSYNTH_KERNEL_TARGET FREQSYNTH_ROUNDING
#define FREQSYNTH_KERNEL_INLINE FREQSYNTH_KERNEL __attribute__((always_inline))

#define FREQSYNTH_KERNEL_SET plain
#define FREQSYNTH_KERNEL_BYTES 16
#if defined(__x86_64__)
#define FREQSYNTH_KERNEL_TARGET __attribute__((target("no-fma,no-fma4,no-avx512f")))
#else
#define FREQSYNTH_KERNEL_TARGET
#endif
#include "freqsynth/basis/kernels_body.inl"
#undef FREQSYNTH_KERNEL_SET
#undef FREQSYNTH_KERNEL_BYTES
#undef FREQSYNTH_KERNEL_TARGET

#if defined(FREQSYNTH_KERNELS_AVX2)
#define FREQSYNTH_KERNEL_SET avx2
#define FREQSYNTH_KERNEL_BYTES 32
#define FREQSYNTH_KERNEL_TARGET __attribute__((target("avx2,no-fma,no-fma4,no-avx512f")))
#include "freqsynth/basis/kernels_body.inl"
#undef FREQSYNTH_KERNEL_SET
#undef FREQSYNTH_KERNEL_BYTES
#undef FREQSYNTH_KERNEL_TARGET
#endif

#if defined(FREQSYNTH_KERNELS_AVX512)
#define FREQSYNTH_KERNEL_SET avx512
#define FREQSYNTH_KERNEL_BYTES 64
#define FREQSYNTH_KERNEL_TARGET __attribute__((target("avx512f,avx512dq,avx512vl")))
#include "freqsynth/basis/kernels_functions.inl"
#include "freqsynth/basis/kernels_pack.inl"
#include "freqsynth/basis/kernels_picture.inl"
#include "freqsynth/basis/kernels_ranges.inl"
#include "freqsynth/basis/kernels_update.inl"
#include "freqsynth/basis/kernels_wide.inl"
#undef FREQSYNTH_KERNEL_SET
#undef FREQSYNTH_KERNEL_BYTES
#undef FREQSYNTH_KERNEL_TARGET
#endif

#undef FREQSYNTH_KERNEL
#undef FREQSYNTH_KERNEL_INLINE

namespace freqsynth::detail {

inline constexpr Kernels plain_kernels = {
    "plain",
    &plain::absorb_samples,
    &plain::rank_one_update,
    &plain::add_outer_product,
    &plain::multiply,
    &plain::residual_means,
    &plain::evaluate_separable,
    &plain::add_scaled,
    &plain::solve_four,
    &plain::forward_transform,
    &plain::shrink_terms,
    &plain::add_means,
    &plain::known_means,
    &plain::owned_means,
    &plain::least_and_most,
    &plain::value_of_rank,
    &plain::extremes_around,
    &plain::clamp_around,
    &plain::hold_flat,
    &plain::innovate_lanes,
    &plain::add_lanes,
    &plain::exponentials,
    &plain::cosines,
    &plain::flux_densities,
};
#if defined(FREQSYNTH_KERNELS_AVX2)
inline constexpr Kernels avx2_kernels = {
    "avx2",
    &avx2::absorb_samples,
    &avx2::rank_one_update,
    &avx2::add_outer_product,
    &avx2::multiply,
    &avx2::residual_means,
    &avx2::evaluate_separable,
    &avx2::add_scaled,
    &avx2::solve_four,
    &avx2::forward_transform,
    &avx2::shrink_terms,
    &avx2::add_means,
    &avx2::known_means,
    &avx2::owned_means,
    &avx2::least_and_most,
    &avx2::value_of_rank,
    &avx2::extremes_around,
    &avx2::clamp_around,
    &avx2::hold_flat,
    &avx2::innovate_lanes,
    &avx2::add_lanes,
    &avx2::exponentials,
    &avx2::cosines,
    &avx2::flux_densities,
};
#endif
#if defined(FREQSYNTH_KERNELS_AVX512)
// The others are no faster: they wait for sums, or have too few terms.
inline constexpr Kernels avx512_kernels = [] {
  Kernels kernels = avx2_kernels;
  kernels.name = "avx512";
  kernels.rank_one_update = &avx512::rank_one_update;
  kernels.residual_means = &avx512::residual_means;
  kernels.evaluate_separable = &avx512::evaluate_separable;
  kernels.add_scaled = &avx512::add_scaled;
  kernels.solve_four = &avx512::solve_four;
  kernels.forward_transform = &avx512::forward_transform;
  kernels.shrink_terms = &avx512::shrink_terms;
  kernels.add_means = &avx512::add_means;
  kernels.known_means = &avx512::known_means;
  kernels.owned_means = &avx512::owned_means;
  kernels.least_and_most = &avx512::least_and_most;
  kernels.value_of_rank = &avx512::value_of_rank;
  kernels.extremes_around = &avx512::extremes_around;
  kernels.clamp_around = &avx512::clamp_around;
  kernels.hold_flat = &avx512::hold_flat;
  kernels.innovate_lanes = &avx512::innovate_lanes;
  kernels.add_lanes = &avx512::add_lanes;
  kernels.exponentials = &avx512::exponentials;
  kernels.cosines = &avx512::cosines;
  kernels.flux_densities = &avx512::flux_densities;
  return kernels;
}();
#endif

inline constexpr const Kernels* all_kernels[] = {
    &plain_kernels,
#if defined(FREQSYNTH_KERNELS_AVX2)
    &avx2_kernels,
#endif
#if defined(FREQSYNTH_KERNELS_AVX512)
    &avx512_kernels,
#endif
};

FREQSYNTH_INLINE std::span<const Kernels* const> runnable_kernels() {
  std::size_t count = 1;
#if defined(FREQSYNTH_KERNELS_AVX2)
  __builtin_cpu_init();  // constructors may come here before its own
  if (__builtin_cpu_supports("avx2")) ++count;
#endif
#if defined(FREQSYNTH_KERNELS_AVX512)
  if (count == 2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    ++count;
  }
#endif
  return std::span(all_kernels).first(count);
}

/// Makes the choice when it is first called, and calls.
template <auto kernel>
struct Undecided;
template <class Result, class... Arguments, Result (*Kernels::*kernel)(Arguments...)>
struct Undecided<kernel> {
  static Result call(Arguments... arguments) { return (chosen_kernels().*kernel)(arguments...); }
};

/// Stands for the choice until the first call of a kernel makes it: a constant, so that no order of
/// initialisation can be wrong. Threads that choose at the same time choose the same.
inline constexpr Kernels undecided_kernels = {
    "undecided",
    &Undecided<&Kernels::absorb_samples>::call,
    &Undecided<&Kernels::rank_one_update>::call,
    &Undecided<&Kernels::add_outer_product>::call,
    &Undecided<&Kernels::multiply>::call,
    &Undecided<&Kernels::residual_means>::call,
    &Undecided<&Kernels::evaluate_separable>::call,
    &Undecided<&Kernels::add_scaled>::call,
    &Undecided<&Kernels::solve_four>::call,
    &Undecided<&Kernels::forward_transform>::call,
    &Undecided<&Kernels::shrink_terms>::call,
    &Undecided<&Kernels::add_means>::call,
    &Undecided<&Kernels::known_means>::call,
    &Undecided<&Kernels::owned_means>::call,
    &Undecided<&Kernels::least_and_most>::call,
    &Undecided<&Kernels::value_of_rank>::call,
    &Undecided<&Kernels::extremes_around>::call,
    &Undecided<&Kernels::clamp_around>::call,
    &Undecided<&Kernels::hold_flat>::call,
    &Undecided<&Kernels::innovate_lanes>::call,
    &Undecided<&Kernels::add_lanes>::call,
    &Undecided<&Kernels::exponentials>::call,
    &Undecided<&Kernels::cosines>::call,
    &Undecided<&Kernels::flux_densities>::call,
};

inline constinit std::atomic<const Kernels*> chosen{&undecided_kernels};

FREQSYNTH_INLINE const Kernels& chosen_kernels() {
  const Kernels* kernels = chosen.load(std::memory_order_relaxed);
  if (kernels == &undecided_kernels) [[unlikely]] {
    kernels = runnable_kernels().back();
    chosen.store(kernels, std::memory_order_relaxed);
  }
  return *kernels;
}

/// The chosen ones, or those that choose them.
inline const Kernels& kernels() { return *chosen.load(std::memory_order_relaxed); }

}  // namespace freqsynth::detail

#include "freqsynth/basis/kernels_calls.inl"
