// SPDX-License-Identifier: MIT
#include <array>
#include <cstring>

#include "c/bridge.h"

namespace freqsynth::detail {
namespace {

static_assert(FREQSYNTH_NOISE_AUTOMATIC == static_cast<int>(Noise::automatic));
static_assert(FREQSYNTH_NOISE_NONE == static_cast<int>(Noise::none));
static_assert(FREQSYNTH_NOISE_PRESENT == static_cast<int>(Noise::present));
static_assert(FREQSYNTH_ROLE_STEER == static_cast<int>(ChannelRole::steer));
static_assert(FREQSYNTH_ROLE_PASSIVE == static_cast<int>(ChannelRole::passive));
static_assert(FREQSYNTH_ROLE_FEATURE == static_cast<int>(ChannelRole::feature));
static_assert(FREQSYNTH_ROLE_NEAREST == static_cast<int>(ChannelRole::nearest));
static_assert(FREQSYNTH_ROLE_MEAN == static_cast<int>(ChannelRole::mean));
static_assert(FREQSYNTH_ROLE_MEAN_FEATURE == static_cast<int>(ChannelRole::mean_feature));
static_assert(FREQSYNTH_MEASURE_RESIDUAL == static_cast<int>(PriorityMeasure::residual));
static_assert(FREQSYNTH_MEASURE_CHANGE == static_cast<int>(PriorityMeasure::change));
static_assert(FREQSYNTH_STEER_LINEAR == static_cast<int>(Steer::linear));
static_assert(FREQSYNTH_STEER_RELATIVE == static_cast<int>(Steer::relative));
static_assert(FREQSYNTH_STEER_DISPLAY == static_cast<int>(Steer::display));
static_assert(FREQSYNTH_POSITIONS_BENT == static_cast<int>(SamplePositions::bent));
static_assert(FREQSYNTH_POSITIONS_LATTICE == static_cast<int>(SamplePositions::lattice));
static_assert(FREQSYNTH_REFINER_LEAST_SQUARES == static_cast<int>(RefinerKind::least_squares));
static_assert(FREQSYNTH_REFINER_KRIGING == static_cast<int>(RefinerKind::kriging));
static_assert(FREQSYNTH_FILTER_NONE == static_cast<int>(PixelFilter::none));
static_assert(FREQSYNTH_FILTER_BOX == static_cast<int>(PixelFilter::box));
static_assert(FREQSYNTH_FILTER_TENT == static_cast<int>(PixelFilter::tent));
static_assert(FREQSYNTH_FILTER_GAUSSIAN == static_cast<int>(PixelFilter::gaussian));
static_assert(FREQSYNTH_FILTER_BLACKMAN_HARRIS == static_cast<int>(PixelFilter::blackman_harris));
static_assert(FREQSYNTH_FILTER_MITCHELL == static_cast<int>(PixelFilter::mitchell));

/// The steps of all channels that have coefficients.
QuantizationTarget quantization_of(const freqsynth_settings& c, std::size_t channels) {
  QuantizationTarget target;
  target.tolerance = c.quantization_tolerance;
  target.most_samples = c.quantization_most_samples;
  target.steps.resize(channels);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    std::memcpy(target.steps[channel].data(), c.quantization_steps + channel * max_terms,
                sizeof target.steps[channel]);
  }
  return target;
}

}  // namespace

SynthesisSettings settings_of(const freqsynth_settings* from) {
  const freqsynth_settings c = read_settings(from, freqsynth_settings_init, "settings");
  SynthesisSettings settings;
  settings.width = c.width;
  settings.height = c.height;
  settings.channels = c.channels;
  settings.noise = enumerator(c.noise, Noise::present, "noise");
  settings.seed = c.seed;
  settings.list = {c.list_samples_per_term, c.list_max_terms, c.list_seed,
                   enumerator(c.list_positions, SamplePositions::lattice, "list_positions")};
  PrioritySettings& priority = settings.priority;
  priority.measure = enumerator(c.priority_measure, PriorityMeasure::change, "priority_measure");
  priority.steer = enumerator(c.priority_steer, Steer::display, "priority_steer");
  priority.weight = c.priority_weight;
  priority.uncertainty = c.priority_uncertainty;
  priority.decay = c.priority_decay;
  priority.neighbours = c.priority_neighbours;
  priority.image = c.priority_image;
  priority.exploration = c.priority_exploration;
  priority.exposure = c.priority_exposure;
  settings.wave = c.wave;
  settings.max_samples_per_block = c.max_samples_per_block;
  settings.least_samples_per_block = c.least_samples_per_block;
  settings.window = {c.window_x, c.window_y, c.window_width, c.window_height};
  std::size_t apart = 0;
  if (c.channel_settings != nullptr) {
    for (std::size_t i = 0; i < c.channels; ++i) {
      const freqsynth_channel& channel = c.channel_settings[i];
      const auto role = enumerator(channel.role, ChannelRole::mean_feature, "role");
      settings.channel_settings.push_back({role, channel.weight});
      apart += has_coefficients(role) ? 0 : 1;
    }
  }
  const auto importance = array(c.importance, c.importance_count, "importance");
  settings.importance.assign(importance.begin(), importance.end());
  if (c.quantization_steps != nullptr) {
    settings.quantization = quantization_of(c, c.channels - apart);
  }
  if (c.shared_list != nullptr) settings.shared_list = c.shared_list->list;
  settings.refiner = enumerator(c.refiner, RefinerKind::kriging, "refiner");
  settings.packet = c.packet;
  return settings;
}

StopRule stop_rule_of(const freqsynth_stop_rule* from) {
  const freqsynth_stop_rule c = read_settings(from, freqsynth_stop_rule_init, "rule");
  StopRule rule;
  rule.samples_per_pixel = c.samples_per_pixel;
  rule.samples = c.samples;
  rule.seconds = c.seconds;
  rule.aliasing_threshold = c.aliasing_threshold;
  rule.least_samples = c.least_samples;
  rule.target_rmse = c.target_rmse;
  return rule;
}

FinishSettings finish_settings_of(const freqsynth_finish_settings* from) {
  const freqsynth_finish_settings c =
      read_settings(from, freqsynth_finish_settings_init, "finish settings");
  FinishSettings settings;
  settings.butterworth = {c.butterworth != 0, c.butterworth_cutoff, c.butterworth_order};
  settings.residuals = c.residuals != 0;
  settings.noise = enumerator(c.noise, Noise::present, "noise");
  settings.measure_doubt = c.measure_doubt != 0;
  settings.doubt = c.doubt;
  settings.noisy_doubt = c.noisy_doubt;
  settings.shrinkage = c.shrinkage;
  settings.slack = c.slack;
  settings.ringing = c.ringing;
  settings.smooth_noise = c.smooth_noise != 0;
  settings.keep_positive = c.keep_positive != 0;
  return settings;
}

ReconstructionSettings reconstruction_settings_of(const freqsynth_reconstruction_settings* from) {
  const freqsynth_reconstruction_settings c =
      read_settings(from, freqsynth_reconstruction_settings_init, "reconstruction settings");
  ReconstructionSettings settings;
  settings.butterworth = {c.butterworth != 0, c.butterworth_cutoff, c.butterworth_order};
  settings.pixel_filter = enumerator(c.pixel_filter, PixelFilter::mitchell, "pixel_filter");
  settings.filter_shape = {c.filter_radius, c.filter_sigma, c.filter_b, c.filter_c};
  settings.clamp_negative = c.clamp_negative != 0;
  return settings;
}

}  // namespace freqsynth::detail

void freqsynth_settings_init(freqsynth_settings* settings, size_t size) {
  const freqsynth::SynthesisSettings usual;
  const freqsynth::QuantizationTarget target;
  freqsynth_settings c = {};
  c.channels = usual.channels;
  c.noise = static_cast<int32_t>(usual.noise);
  c.list_positions = static_cast<int32_t>(usual.list.positions);
  c.list_seed = usual.list.seed;
  c.list_samples_per_term = usual.list.samples_per_term;
  c.list_max_terms = usual.list.max_terms;
  c.priority_measure = static_cast<int32_t>(usual.priority.measure);
  c.priority_steer = static_cast<int32_t>(usual.priority.steer);
  c.priority_weight = usual.priority.weight;
  c.priority_uncertainty = usual.priority.uncertainty;
  c.priority_decay = usual.priority.decay;
  c.priority_neighbours = usual.priority.neighbours;
  c.priority_image = usual.priority.image;
  c.priority_exploration = usual.priority.exploration;
  c.priority_exposure = usual.priority.exposure;
  c.wave = usual.wave;
  c.max_samples_per_block = usual.max_samples_per_block;
  c.quantization_tolerance = target.tolerance;
  c.quantization_most_samples = target.most_samples;
  c.refiner = static_cast<int32_t>(usual.refiner);
  c.packet = static_cast<uint32_t>(usual.packet);
  freqsynth::detail::write_defaults(c, settings, size);
}

void freqsynth_stop_rule_init(freqsynth_stop_rule* rule, size_t size) {
  const freqsynth::StopRule usual;
  freqsynth_stop_rule c = {};
  c.samples_per_pixel = usual.samples_per_pixel;
  c.samples = usual.samples;
  c.seconds = usual.seconds;
  c.aliasing_threshold = usual.aliasing_threshold;
  c.least_samples = usual.least_samples;
  c.target_rmse = usual.target_rmse;
  freqsynth::detail::write_defaults(c, rule, size);
}

void freqsynth_finish_settings_init(freqsynth_finish_settings* settings, size_t size) {
  const freqsynth::FinishSettings usual;
  freqsynth_finish_settings c = {};
  c.butterworth = usual.butterworth.enabled;
  c.butterworth_cutoff = usual.butterworth.cutoff;
  c.butterworth_order = usual.butterworth.order;
  c.residuals = usual.residuals;
  c.noise = static_cast<int32_t>(usual.noise);
  c.measure_doubt = usual.measure_doubt;
  c.doubt = usual.doubt;
  c.noisy_doubt = usual.noisy_doubt;
  c.shrinkage = usual.shrinkage;
  c.slack = usual.slack;
  c.ringing = usual.ringing;
  c.smooth_noise = usual.smooth_noise;
  c.keep_positive = usual.keep_positive;
  freqsynth::detail::write_defaults(c, settings, size);
}

void freqsynth_reconstruction_settings_init(freqsynth_reconstruction_settings* settings,
                                            size_t size) {
  const freqsynth::ReconstructionSettings usual;
  freqsynth_reconstruction_settings c = {};
  c.butterworth = usual.butterworth.enabled;
  c.butterworth_cutoff = usual.butterworth.cutoff;
  c.butterworth_order = usual.butterworth.order;
  c.pixel_filter = static_cast<int32_t>(usual.pixel_filter);
  c.filter_radius = usual.filter_shape.radius;
  c.filter_sigma = usual.filter_shape.sigma;
  c.filter_b = usual.filter_shape.b;
  c.filter_c = usual.filter_shape.c;
  c.clamp_negative = usual.clamp_negative;
  freqsynth::detail::write_defaults(c, settings, size);
}
