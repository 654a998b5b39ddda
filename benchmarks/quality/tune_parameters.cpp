// SPDX-License-Identifier: MIT
#include "quality/tune_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/engine/block_grid.h"

namespace tune {
namespace {

/// What Synthesizer does when nothing is told.
Setup default_setup(std::size_t size) {
  Setup setup;
  setup.synthesis.width = setup.synthesis.height = size;
  return setup;
}

/// Values of the number that `field(setup)` refers to; an infinite one switches something off.
template <class Field>
std::vector<Value> numbers(std::initializer_list<double> numbers, Field field) {
  std::vector<Value> values;
  for (const double number : numbers) {
    std::array<char, 32> text{"off"};
    if (std::isfinite(number)) std::snprintf(text.data(), text.size(), "%g", number);
    values.push_back({text.data(), [=](Setup& setup) { field(setup) = number; }});
  }
  return values;
}

/// Waves of a share of all blocks.
Value wave_of(std::string text, std::size_t share) {
  return {std::move(text), [=](Setup& setup) {
            freqsynth::SynthesisSettings& synthesis = setup.synthesis;
            const auto grid = freqsynth::BlockGrid::of(synthesis.width, synthesis.height, 3);
            synthesis.wave = std::max<std::size_t>(1, grid.blocks_x * grid.blocks_y / share);
          }};
}

}  // namespace

Key key_of(const Setup& setup) {
  const freqsynth::SynthesisSettings& synthesis = setup.synthesis;
  const freqsynth::PrioritySettings& priority = synthesis.priority;
  const freqsynth::FinishSettings& finish = setup.finish;
  return {synthesis.list.samples_per_term,
          static_cast<double>(synthesis.list.seed),
          static_cast<double>(synthesis.wave),
          static_cast<double>(priority.measure),
          priority.uncertainty,
          priority.decay,
          priority.weight,
          priority.neighbours,
          priority.image,
          static_cast<double>(finish.butterworth.enabled),
          finish.butterworth.cutoff,
          finish.butterworth.order,
          static_cast<double>(finish.measure_doubt),
          finish.doubt,
          finish.noisy_doubt,
          finish.shrinkage,
          finish.slack,
          finish.ringing,
          static_cast<double>(finish.keep_positive)};
}

std::vector<Parameter> make_parameters() {
  using freqsynth::PriorityMeasure;
  constexpr double off = std::numeric_limits<double>::infinity();
  const auto cutoff = [](Setup& s) -> double& { return s.finish.butterworth.cutoff; };
  const auto doubt = [](Setup& s) -> double& { return s.finish.doubt; };
  const auto noisy_doubt = [](Setup& s) -> double& { return s.finish.noisy_doubt; };
  const auto shrinkage = [](Setup& s) -> double& { return s.finish.shrinkage; };
  const auto slack = [](Setup& s) -> double& { return s.finish.slack; };
  const auto ringing = [](Setup& s) -> double& { return s.finish.ringing; };
  const auto set_measure = [](PriorityMeasure measure) {
    return [=](Setup& s) { s.synthesis.priority.measure = measure; };
  };
  const auto set_measure_doubt = [](bool on) {
    return [=](Setup& s) { s.finish.measure_doubt = on; };
  };
  const auto set_seed = [](std::uint64_t seed) {
    return [=](Setup& s) { s.synthesis.list.seed = seed; };
  };

  std::vector<Parameter> all;
  all.push_back({"samples_per_term", For::all,
                 numbers({1.5, 2, 2.5, 3, 4},
                         [](Setup& s) -> double& { return s.synthesis.list.samples_per_term; })});
  all.push_back({"cutoff", For::all, numbers({0.5, 0.65, 0.8, 1, 1.3}, cutoff)});
  all.back().values.push_back({"off", [](Setup& s) { s.finish.butterworth.enabled = false; }});
  all.push_back({"order", For::all, numbers({1, 2, 4}, [](Setup& s) -> double& {
                   return s.finish.butterworth.order;
                 })});
  all.push_back({"measure",
                 For::all,
                 {{"residual", set_measure(PriorityMeasure::residual)},
                  {"change", set_measure(PriorityMeasure::change)}}});
  all.push_back({"uncertainty", For::all, numbers({0.1, 1, 10}, [](Setup& s) -> double& {
                   return s.synthesis.priority.uncertainty;
                 })});
  all.push_back({"decay", For::all, numbers({0.5, 0.7165, 0.85}, [](Setup& s) -> double& {
                   return s.synthesis.priority.decay;
                 })});
  // It is the change that is averaged over the last samples.
  all.push_back(
      {"weight", For::all,
       numbers({0.1, 0.3, 0.6}, [](Setup& s) -> double& { return s.synthesis.priority.weight; }),
       set_measure(PriorityMeasure::change)});
  all.push_back({"neighbours", For::all, numbers({0, 4, 16, 64}, [](Setup& s) -> double& {
                   return s.synthesis.priority.neighbours;
                 })});
  all.push_back({"image", For::all, numbers({0, 0.25, 1, 4}, [](Setup& s) -> double& {
                   return s.synthesis.priority.image;
                 })});
  // 0 is what the library takes for 1/32 of the blocks.
  all.push_back({"wave",
                 For::all,
                 {{"1 block", [](Setup& s) { s.synthesis.wave = 1; }},
                  wave_of("1/64", 64),
                  {"1/32", [](Setup& s) { s.synthesis.wave = 0; }},
                  wave_of("1/16", 16),
                  wave_of("1/4", 4)}});
  all.push_back({"seed", For::all, {{"0", set_seed(0)}, {"1", set_seed(1)}, {"2", set_seed(2)}}});
  all.push_back({"doubt", For::quiet, numbers({0.25, 0.5, 1, 2}, doubt)});
  all.push_back({"shrinkage", For::quiet, numbers({0, 1, 2, 4}, shrinkage)});
  all.push_back({"slack", For::quiet, numbers({0, 0.2, 0.4, 0.8, off}, slack)});
  all.push_back({"ringing", For::quiet, numbers({0, 0.0125, 0.025, 0.05}, ringing)});
  all.push_back({"noisy_doubt", For::noisy, numbers({0.5, 1, 4, 16}, noisy_doubt)});
  all.push_back({"noisy_measure_doubt",
                 For::noisy,
                 {{"on", set_measure_doubt(true)}, {"off", set_measure_doubt(false)}}});
  all.push_back({"noisy_shrinkage", For::noisy, numbers({1, 2, 4, 8}, shrinkage)});
  all.push_back({"noisy_slack", For::noisy, numbers({0, 0.4, off}, slack)});
  return all;
}

Setup setup_of(const Parameter& parameter, const Value* value, std::size_t size) {
  Setup setup = default_setup(size);
  parameter.base(setup);
  if (value != nullptr) value->apply(setup);
  return setup;
}

bool is_default(const Parameter& parameter, const Value& value, std::size_t size) {
  return key_of(setup_of(parameter, &value, size)) == key_of(setup_of(parameter, nullptr, size));
}

void check_defaults(const std::vector<Parameter>& parameters, std::size_t size) {
  for (const Parameter& parameter : parameters) {
    const auto defaults =
        std::count_if(parameter.values.begin(), parameter.values.end(),
                      [&](const Value& value) { return is_default(parameter, value, size); });
    if (defaults != 1) {
      std::string said = parameter.name;
      throw std::logic_error(said.append(": ").append(std::to_string(defaults)) +
                             " of its values are the default instead of 1");
    }
  }
}

}  // namespace tune
