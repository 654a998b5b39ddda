// SPDX-License-Identifier: MIT
/// \file
/// A picture by the tree and a bank of priors.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/tree_pictures.h"

namespace quality {

/// What the tree makes of samples.
struct TreePicture {
  std::vector<float> pixels;  ///< channels interleaved, row by row
  double predicted = 0;       ///< root mean square of the error that is expected
};

/// That of so many samples of a sampler (freqsynth/sampler.h).
template <class F>
TreePicture tree_picture(const freqsynth::TreeSettings& settings, std::uint64_t samples,
                         F&& sampler) {
  freqsynth::DirectionRule rule;
  freqsynth::TreeSampler tree(settings, &rule);
  tree.run(std::forward<F>(sampler), samples);
  freqsynth::TreePictures pictures(tree.tree().positions(), settings.noisy
                                                                ? freqsynth::PriorBank::noisy()
                                                                : freqsynth::PriorBank::exact());
  TreePicture picture{pictures.pixels(tree.tree())};
  const std::vector<float> errors = pictures.errors(tree.tree());
  for (const float error : errors) picture.predicted += double{error};
  picture.predicted = std::sqrt(picture.predicted / static_cast<double>(errors.size()));
  return picture;
}

}  // namespace quality
