// SPDX-License-Identifier: MIT
// The metrics of blocks and of the borders between them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "metric_helpers.h"
#include "quality/metrics.h"

namespace {

using metric_helpers::counts;
using metric_helpers::noise;
using metric_helpers::Picture;

TEST(Metrics, BlockRmseOfPartialBlocks) {
  // 11 x 9 pixels: blocks of 8 x 8, 3 x 8, 8 x 1 and 3 x 1 pixels.
  Picture picture(11, 9);
  picture.set(7, 7, 0.8f);   // 1 of 64
  picture.set(8, 0, 0.6f);   // 1 of 24
  picture.set(0, 8, 0.4f);   // 1 of 8
  picture.set(10, 8, 0.3f);  // 1 of 3
  const std::vector<double> blocks = quality::block_rmse(picture, Picture(11, 9));
  ASSERT_EQ(blocks.size(), 4u);
  EXPECT_NEAR(blocks[0], 0.8 / 8, 1e-7);
  EXPECT_NEAR(blocks[1], 0.6 / std::sqrt(24.0), 1e-7);
  EXPECT_NEAR(blocks[2], 0.4 / std::sqrt(8.0), 1e-7);
  EXPECT_NEAR(blocks[3], 0.3 / std::sqrt(3.0), 1e-7);
  EXPECT_NEAR(quality::measure(Picture(16, 16, 0.5f), Picture(16, 16), counts(Picture(16, 16), 1))
                  .worst_block_rmse,
              0.5, 1e-7);
}

TEST(Metrics, ABlockIsMissedWhenItsErrorIsGreatAndItsSamplesAreFew) {
  // One of 64 blocks is wrong: its error is 8 times that of the picture.
  const Picture reference(64, 64);
  Picture picture = reference;
  picture.fill(40, 16, 8, 8, 1);
  std::vector<std::uint32_t> samples = counts(picture, 2);
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u) << "it got its share";
  samples[16 * 64 + 40] = 1;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 1u);
  samples[16 * 64 + 41] = 9;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u) << "it got more";
}

TEST(Metrics, ABlockWithAModerateErrorIsNotMissed) {
  // 4 of 64 blocks are wrong: their error is 4 times that of the picture.
  const Picture reference(64, 64);
  Picture picture = reference;
  picture.fill(0, 0, 32, 8, 1);
  std::vector<std::uint32_t> samples = counts(picture, 2);
  samples[0] = 0;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u);
}

TEST(Metrics, PartialBlocksAreMissedByTheirDensity) {
  // The last block has 8 of the usual 64 pixels and 8 samples: the average density.
  const Picture reference(65, 64);
  Picture picture = reference;
  picture.fill(64, 56, 1, 8, 1);
  std::vector<std::uint32_t> samples = counts(picture, 1);
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u);
  samples[64 * 65 - 1] = 0;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 1u);
}

TEST(Metrics, WhiteNoiseHasNoSeam) {
  EXPECT_NEAR(quality::seam_visibility(noise(256, 256, 5), noise(256, 256, 6)), 1, 0.02);
}

/// Noise of 0..1 on squares of 8 x 8 pixels that are alternately 1 brighter and 1 darker, the first
/// of which is cut off by `shift` pixels.
Picture noisy_squares(std::size_t shift, unsigned seed) {
  Picture picture = noise(256, 256, seed);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    const std::size_t x = i / 3 % 256 + shift;
    const std::size_t y = i / 3 / 256 + shift;
    picture.pixels[i] += (x / 8 + y / 8) % 2 == 0 ? 1.0f : -1.0f;
  }
  return picture;
}

TEST(Metrics, SeamOfBlocksWithConstantErrors) {
  // The mean difference of two values of the noise is 1/3, and across a border |2 + d| has mean 2.
  EXPECT_NEAR(quality::seam_visibility(noisy_squares(0, 7), Picture(256, 256)), 6, 0.1);
}

TEST(Metrics, SeamsShiftedByHalfABlockAreNotSeams) {
  // A border's mean difference is 1/3, and one in seven of those within a block is 2.
  EXPECT_NEAR(quality::seam_visibility(noisy_squares(4, 8), Picture(256, 256)), 7.0 / 12, 0.01);
}

TEST(Metrics, SeamOfDegenerateErrors) {
  const Picture reference = noise(32, 32, 9);
  EXPECT_EQ(quality::seam_visibility(reference, reference), 1);
  EXPECT_EQ(quality::seam_visibility(noise(8, 8, 10), Picture(8, 8)), 1) << "one block";
  Picture steps(32, 8);
  for (std::size_t x = 0; x < 32; x += 8) steps.fill(x, 0, 8, 8, static_cast<float>(x / 8));
  EXPECT_EQ(quality::seam_visibility(steps, Picture(32, 8)),
            std::numeric_limits<double>::infinity());
}

}  // namespace
