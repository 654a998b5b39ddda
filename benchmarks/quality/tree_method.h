// SPDX-License-Identifier: MIT
/// \file
/// A picture by the tree and a bank of priors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/tree_pictures.h"

namespace quality {

/// What the tree makes of so many samples of a sampler (freqsynth/sampler.h): pixels, channels
/// interleaved, row by row.
template <class F>
std::vector<float> tree_pixels(const freqsynth::TreeSettings& settings, std::uint64_t samples,
                               F&& sampler) {
  freqsynth::DirectionRule rule;
  freqsynth::TreeSampler tree(settings, &rule);
  tree.run(std::forward<F>(sampler), samples);
  freqsynth::TreePictures pictures(tree.tree().positions(), settings.noisy
                                                                ? freqsynth::PriorBank::noisy()
                                                                : freqsynth::PriorBank::exact());
  return pictures.pixels(tree.tree());
}

}  // namespace quality
