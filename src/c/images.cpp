// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "c/bridge.h"
#include "freqsynth/image/frequency_image_file.h"

namespace freqsynth::detail {
namespace {

PixelView view_of(const freqsynth_pixels* pixels) {
  const freqsynth_pixels& c = object(pixels, "pixels");
  return {c.data,         c.width,      c.height,
          c.pixel_stride, c.row_stride, c.channel_stride == 0 ? 1 : c.channel_stride};
}

/// Memory for exactly the pixels that an engine shows.
PixelView whole_view(const Synthesizer& engine, const freqsynth_pixels* pixels,
                     std::size_t channels) {
  const PixelView view = view_of(pixels).resolved(channels);
  const PixelWindow window = engine.window();
  if (view.width != window.width || view.height != window.height) {
    refuse("pixels has " + std::to_string(view.width) + " x " + std::to_string(view.height) +
           " pixels, not " + std::to_string(window.width) + " x " + std::to_string(window.height));
  }
  return view;
}

/// Row by row, the channels of a pixel side by side.
void copy_pixels(const std::vector<float>& values, const PixelView& view, std::size_t channels) {
  const float* from = values.data();
  for (std::size_t y = 0; y < view.height; ++y) {
    float* to = view.data + static_cast<std::ptrdiff_t>(y) * view.row_stride;
    for (std::size_t x = 0; x < view.width; ++x, to += view.pixel_stride) {
      for (std::size_t c = 0; c < channels; ++c) {
        to[static_cast<std::ptrdiff_t>(c) * view.channel_stride] = *from++;
      }
    }
  }
}

/// Channels of a picture: those with coefficients.
std::size_t image_channels(const SynthesisSettings& settings) {
  const auto& all = settings.channel_settings;
  const auto apart = std::count_if(all.begin(), all.end(), [](const ChannelSettings& channel) {
    return !has_coefficients(channel.role);
  });
  return settings.channels - static_cast<std::size_t>(apart);
}

}  // namespace
}  // namespace freqsynth::detail

using namespace freqsynth::detail;

freqsynth_status freqsynth_finish(const freqsynth_synthesizer* synthesizer,
                                  const freqsynth_finish_settings* finish,
                                  const freqsynth_reconstruction_settings* reconstruction,
                                  const freqsynth_pixels* pixels) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    const freqsynth::PixelView view = view_of(pixels);
    if (reconstruction == nullptr) return engine.finish(view, finish_settings_of(finish));
    const auto settings = reconstruction_settings_of(reconstruction);
    freqsynth::reconstruct(engine.finished_image(finish_settings_of(finish)), settings, view);
  });
}

freqsynth_status freqsynth_error_image(const freqsynth_synthesizer* synthesizer,
                                       const freqsynth_finish_settings* finish,
                                       const freqsynth_pixels* pixels) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    const std::size_t channels = image_channels(engine.settings());
    const freqsynth::PixelView view = whole_view(engine, pixels, channels);
    copy_pixels(engine.error_image(finish_settings_of(finish)), view, channels);
  });
}

freqsynth_status freqsynth_predicted_rmse(const freqsynth_synthesizer* synthesizer,
                                          const freqsynth_finish_settings* finish, double* rmse) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    double& out = object(rmse, "rmse");
    out = engine.predicted_rmse(finish_settings_of(finish));
  });
}

freqsynth_status freqsynth_channel_pixels(const freqsynth_synthesizer* synthesizer, size_t channel,
                                          const freqsynth_pixels* pixels) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    const freqsynth::PixelView view = whole_view(engine, pixels, 1);
    copy_pixels(engine.channel_pixels(channel), view, 1);
  });
}

freqsynth_status freqsynth_fitted_image(const freqsynth_synthesizer* synthesizer,
                                        freqsynth_image** image) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    freqsynth_image*& out = object(image, "image");
    out = new freqsynth_image{engine.image()};
  });
}

freqsynth_status freqsynth_finished_image(const freqsynth_synthesizer* synthesizer,
                                          const freqsynth_finish_settings* settings,
                                          freqsynth_image** image) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    freqsynth_image*& out = object(image, "image");
    out = new freqsynth_image{engine.finished_image(finish_settings_of(settings))};
  });
}

void freqsynth_image_destroy(freqsynth_image* image) { delete image; }

freqsynth_status freqsynth_image_get_info(const freqsynth_image* image,
                                          freqsynth_image_info* info) {
  return guarded([&] {
    const freqsynth::FrequencyImage& from = object(image, "image").image;
    freqsynth_image_info out = {};
    out.width = from.width();
    out.height = from.height();
    out.channels = from.channels();
    out.blocks_x = from.blocks_x();
    out.blocks_y = from.blocks_y();
    out.finished = from.meaning() == freqsynth::CoefficientMeaning::pixel_average;
    write_result(out, info, "info");
  });
}

freqsynth_status freqsynth_image_get_block(const freqsynth_image* image, size_t block_x,
                                           size_t block_y, size_t channel, float* coefficients,
                                           uint32_t* samples) {
  return guarded([&] {
    const freqsynth::FrequencyImage& from = object(image, "image").image;
    if (block_x >= from.blocks_x() || block_y >= from.blocks_y() || channel >= from.channels()) {
      refuse("there is no channel " + std::to_string(channel) + " of a block (" +
             std::to_string(block_x) + ", " + std::to_string(block_y) + ")");
    }
    const auto values = from.coefficients(block_x, block_y, channel);
    if (coefficients != nullptr) std::copy(values.begin(), values.end(), coefficients);
    if (samples != nullptr) *samples = from.samples(block_x, block_y);
  });
}

freqsynth_status freqsynth_reconstruct(const freqsynth_image* image,
                                       const freqsynth_reconstruction_settings* settings,
                                       const freqsynth_pixels* pixels) {
  return guarded([&] {
    freqsynth::reconstruct(object(image, "image").image, reconstruction_settings_of(settings),
                           view_of(pixels));
  });
}

freqsynth_status freqsynth_evaluate(const freqsynth_image* image,
                                    const freqsynth_reconstruction_settings* settings, double x,
                                    double y, float* values, size_t count) {
  return guarded([&] {
    freqsynth::evaluate(object(image, "image").image,
                        reconstruction_settings_of(settings).butterworth, x, y,
                        array(values, count, "values"));
  });
}

freqsynth_status freqsynth_image_save(const freqsynth_image* image, const char* file) {
  return guarded([&] { freqsynth::save_file(file_name(file), object(image, "image").image); });
}

freqsynth_status freqsynth_image_load(const char* file, freqsynth_image** image) {
  return guarded([&] {
    freqsynth_image*& out = object(image, "image");
    out = new freqsynth_image{freqsynth::load_frequency_image(file_name(file))};
  });
}
