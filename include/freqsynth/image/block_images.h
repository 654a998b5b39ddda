// SPDX-License-Identifier: MIT
/// \file
/// Images of a snapshot of blocks: what the refiner says of each, as it is and finished.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/block_picture.h"
#include "freqsynth/image/block_sinks.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_view.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/image/smoothing_features.h"
#include "freqsynth/image/tile_finisher.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// The fit itself (CoefficientMeaning::point_function). \throws what the executor throws, too.
template <Refiner R>
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                                       const detail::ExecutorRef& executor = {}) {
  FrequencyImage image(grid.width, grid.height, blocks.channels());
  const detail::ImageSink sink(grid, blocks, image);
  detail::share_work(executor, grid.blocks_y, [&](detail::WorkPieces& rows) {
    std::vector<Gap> gaps;
    detail::AlignedVector<float> state(blocks.state_size());
    for (std::size_t y; rows.take(y);) {
      for (std::size_t block = y * grid.blocks_x; block < (y + 1) * grid.blocks_x; ++block) {
        blocks.read(block, state.data());
        for (std::size_t c = 0; c < blocks.channels(); ++c) {
          sink.put(block, c, blocks.fit_without_gaps(block, state.data(), c, gaps).coefficients);
        }
      }
    }
  });
  return image;
}

/// The same of blocks that nobody changes meanwhile.
template <Refiner R>
[[nodiscard]] FrequencyImage fit_image(const BlockGrid& grid, const BlockStore<R>& blocks) {
  return fit_image(grid, BlockSnapshot<R>(blocks));
}

namespace detail {

/// Finishes all blocks of a picture with noise, which is smoothed, and puts them into sinks, one
/// for each thread.
template <Refiner R, class MakeSink>
void finish_smoothly(const FinishJob<R>& job, const SmoothingFeatures& features,
                     const ExecutorRef& executor, const MakeSink& make_sink) {
  const TileGrid tiles(job.grid);
  BlockPicture picture(job.grid, job.blocks.refiner().weights(), features);
  share_work(executor, tiles.size(), [&](WorkPieces& pieces) {
    TileFinisher<R> finisher(job);
    auto sink = make_sink();
    AlignedBlock own;
    for (std::size_t piece; pieces.take(piece);) {
      finisher.finish(tiles.tile(piece),
                      [&](const PixelFinisher& pixels, const BlockFit& fit, std::size_t block,
                          std::size_t c, const AlignedBlock& rows) {
                        if (picture.has(c)) {
                          picture.add(pixels, fit, block, c, rows);
                        } else {
                          BlockPicture::pass(rows, sink.positive(c), own);
                          sink.put_rows(block, c, own);
                        }
                      });
    }
  });
  if (features.means) picture.add_means(*features.means, job.settings.doubt, executor);
  picture.smooth(executor);
  share_work(executor, tiles.size(), [&](WorkPieces& pieces) {
    auto sink = make_sink();
    AlignedBlock rows;
    for (std::size_t piece; pieces.take(piece);) {
      const BlockRange tile = tiles.tile(piece);
      for (std::size_t place = 0; place < tile.size(); ++place) {
        const std::size_t block =
            (tile.top + place / tile.width()) * tiles.blocks_x + tile.left + place % tile.width();
        for (std::size_t c = 0; c < job.blocks.channels(); ++c) {
          if (!picture.has(c)) continue;
          picture.take(block, c, sink.positive(c), rows);
          sink.put_rows(block, c, rows);
        }
      }
    }
  });
}

/// Finishes all blocks and puts them into sinks, one for each thread.
template <Refiner R, class MakeSink>
void finish_blocks(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                   const SharedInverseList& list, const FinishSettings& settings,
                   const SmoothingFeatures& features, const ExecutorRef& executor,
                   const MakeSink& make_sink) {
  settings.validate();
  if (grid.size() == 0) return;
  const ButterworthFilters filters(settings.butterworth, blocks.counts(), executor);
  const FinishJob<R> job{grid, blocks, list, settings, filters};
  if (settings.residuals && settings.smooth_noise && settings.noise == Noise::present) {
    finish_smoothly(job, features, executor, make_sink);
    return;
  }
  const TileGrid tiles(grid);
  share_work(executor, tiles.size(), [&](WorkPieces& pieces) {
    TileFinisher<R> finisher(job);
    auto sink = make_sink();
    for (std::size_t piece; pieces.take(piece);) {
      finisher.finish(tiles.tile(piece),
                      [&](const PixelFinisher&, const BlockFit&, std::size_t block, std::size_t c,
                          const AlignedBlock& rows) { sink.put_rows(block, c, rows); });
    }
  });
}

/// Whether no pixel of a finished channel is to be below zero.
template <Refiner R>
bool is_positive(const BlockSnapshot<R>& blocks, const FinishSettings& settings, std::size_t c) {
  return settings.residuals && settings.keep_positive && !blocks.any_negative(c);
}

}  // namespace detail

/// Finished pixels (CoefficientMeaning::pixel_average).
/// \param list      the one that the blocks were refined with
/// \param features  what guides the smoothing of noise
/// \throws std::invalid_argument when a setting is out of range; what the executor throws.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings,
                                            const SmoothingFeatures& features = {},
                                            const detail::ExecutorRef& executor = {}) {
  FrequencyImage image(grid.width, grid.height, blocks.channels(),
                       CoefficientMeaning::pixel_average);
  for (std::size_t c = 0; c < blocks.channels(); ++c) {
    image.set_non_negative(c, detail::is_positive(blocks, settings, c));
  }
  detail::finish_blocks(grid, blocks, list, settings, features, executor,
                        [&] { return detail::ImageSink(grid, blocks, image); });
  return image;
}

/// The same of blocks that nobody changes meanwhile.
template <Refiner R>
[[nodiscard]] FrequencyImage finished_image(const BlockGrid& grid, const BlockStore<R>& blocks,
                                            const SharedInverseList& list,
                                            const FinishSettings& settings,
                                            const SmoothingFeatures& features = {}) {
  return finished_image(grid, BlockSnapshot<R>(blocks), list, settings, features);
}

/// Finished pixels in the caller's memory: those that reconstruct() makes of finished_image(). No
/// frequency image is made where no pixel of the output lies in two blocks.
/// \param shown  the part of the grid's pixels that is written: whole blocks
/// \throws like finished_image() and reconstruct().
template <Refiner R>
void finish(const BlockGrid& grid, const BlockSnapshot<R>& blocks, const SharedInverseList& list,
            const FinishSettings& settings, const SmoothingFeatures& features,
            const PixelWindow& shown, const PixelView& out,
            const detail::ExecutorRef& executor = {}) {
  settings.validate();
  if (grid.size() == 0 || out.width == 0 || out.height == 0) return;
  const detail::OutputAxes axes(shown.width, shown.height, PixelFilter::box, {},
                                out.resolved(blocks.channels()));
  if (!axes.separate()) {
    FrequencyImage image = finished_image(grid, blocks, list, settings, features, executor);
    if (shown.width != grid.width || shown.height != grid.height) image = image.part(shown);
    reconstruct(image, {}, out, executor);
    return;
  }
  std::vector<bool> positive;
  for (std::size_t c = 0; c < blocks.channels(); ++c) {
    positive.push_back(detail::is_positive(blocks, settings, c));
  }
  detail::finish_blocks(grid, blocks, list, settings, features, executor,
                        [&] { return detail::PixelSink(grid, blocks, shown, axes, positive); });
}

}  // namespace freqsynth
