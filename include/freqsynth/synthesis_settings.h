// SPDX-License-Identifier: MIT
/// \file
/// What is to be synthesised, and how.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/channel_settings.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/jpeg/quantization_target.h"

namespace freqsynth {

/// What makes an image of the values of samples.
enum class RefinerKind : std::uint8_t {
  least_squares,  ///< the paper's: 64 cosine terms of each block, fit to its samples
  kriging         ///< a tree of nodes and a bank of priors (beyond the paper), see docs/priors.md
};

/// What is to be synthesised, and how.
struct SynthesisSettings {
  std::size_t width = 0;     ///< pixels; 0 gives an image without blocks
  std::size_t height = 0;    ///< pixels
  std::size_t channels = 3;  ///< values per sample, at least 1

  /// What makes values of samples an image. Of RefinerKind::kriging the settings that it has no use
  /// for must be as they are by default: `window`, `quantization`, `max_samples_per_block`,
  /// `least_samples_per_block`, `shared_list`, of `list` all but `seed` and `positions`, and of
  /// `priority` all but `steer` and `exposure`; and no channel has ChannelRole::feature.
  /// Its engine does not survive that memory runs out, see TreeEngine.
  RefinerKind refiner = RefinerKind::least_squares;

  /// Whether the sampler returns Monte Carlo estimates: another value at each call for the same
  /// position. Such noise is smoothed more, and only more samples make it smaller. Without it the
  /// error at edges falls faster. It is noticed: of n samples root n are asked for twice. With
  /// RefinerKind::kriging pictures are then made as with noise, but samples are chosen as before.
  Noise noise = Noise::automatic;

  /// Of Request::seed: pictures with another one, such as frames of an animation, are to have
  /// independent noise. It moves no sample.
  std::uint64_t seed = 0;

  InverseListSettings list = {};   ///< the order of samples and terms
  PrioritySettings priority = {};  ///< which block is next
  /// Blocks sampled between two choices, each of which is asked for one sample or, once it has had
  /// 25, for an eighth as many, up to 8; 0 chooses 1/32 of all blocks. 1 is the paper's strict
  /// order: one sample of one block.
  /// Threads share one wave at a time: for many of them make it larger, see docs/settings.md.
  std::size_t wave = 0;
  /// Requests that are traced together, such as 16 rays, 1 .. 2^20: request() and batch samplers
  /// get multiples of it while so many are left of the wave. Results do not depend on it.
  std::size_t packet = 1;
  /// Most samples of a block, 1 .. SampleSequence::max_size. The default, a complete lattice of 257
  /// x 257, is about 1000 samples per pixel; the shared list takes 60 MB when a block gets there.
  std::size_t max_samples_per_block = std::size_t{257} * 257;
  /// So many samples go to every block before errors decide which is next, at most
  /// max_samples_per_block. In proportion fewer go to blocks that are narrower than 8 x 8 pixels,
  /// or whose importance is below 1. As many as the most: uniform sampling.
  std::size_t least_samples_per_block = 0;
  /// What each channel is for; empty: all steer, with equal weights. Those without
  /// has_coefficients() come after the others, of which there is at least one.
  std::vector<ChannelSettings> channel_settings = {};
  /// Factor on the priority of each block, row by row, 0 or in 1e-6..1e6; empty: 1. 0 leaves a
  /// block at its first sample. See importance_map(), and Synthesizer::set_importance().
  std::vector<float> importance = {};
  /// The part of the width x height pixels that is made, in whole blocks; empty: all of it.
  /// Requests are those of the whole picture. For its borders' sake two blocks more on each side
  /// are sampled, and not shown: where all blocks have their max_samples_per_block, and there is no
  /// noise to smooth, which looks farther, the pixels are those of the whole picture to the bit.
  /// `importance` is that of the whole picture; stop rules and `wave` are of what is sampled.
  PixelWindow window = {};
  /// When set, blocks are chosen by what their errors may change after quantisation, and the
  /// synthesis ends by itself when no block is above the target's tolerance.
  std::optional<QuantizationTarget> quantization = std::nullopt;
  /// A list to share with other images; none: one is built from `list`, which is otherwise not
  /// read.
  SharedInverseList shared_list = {};
};

}  // namespace freqsynth
