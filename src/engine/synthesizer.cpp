#include "freqsynth/synthesizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/block_neighbours.h"

namespace freqsynth {
namespace {

constexpr std::size_t most_bad_reported = 1000;

SynthesisSettings validated(SynthesisSettings settings) {
  const BlockGrid grid = BlockGrid::of(settings.width, settings.height, settings.channels);
  settings.priority.validate();
  if (settings.max_samples_per_block == 0 ||
      settings.max_samples_per_block > SampleSequence::max_size) {
    throw std::invalid_argument("freqsynth: max_samples_per_block is " +
                                std::to_string(settings.max_samples_per_block) + ", not in 1.." +
                                std::to_string(SampleSequence::max_size));
  }
  const std::size_t blocks = grid.blocks_x * grid.blocks_y;
  if (!settings.importance.empty() && settings.importance.size() != blocks) {
    throw std::invalid_argument("freqsynth: importance has " +
                                std::to_string(settings.importance.size()) + " entries for " +
                                std::to_string(blocks) + " blocks");
  }
  for (const float importance : settings.importance) {
    if (!(importance >= 0 && std::isfinite(importance))) {
      throw std::invalid_argument("freqsynth: importance holds " + std::to_string(importance));
    }
  }
  if (settings.quantization) settings.quantization->validate(settings.channels);
  if (!settings.shared_list) {
    settings.shared_list = std::make_shared<const InverseList>(settings.list);
  }
  return settings;
}

/// Asks for a line of memory that will be written soon.
void prefetch(const float* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address, 1);
#else
  static_cast<void>(address);
#endif
}

/// Reflects a coordinate that may lie beyond `size` back into [0, size].
double reflect(double x, double size) {
  if (x <= size) return x;
  x = std::fmod(x, 2 * size);
  return x > size ? 2 * size - x : x;
}

/// Share of the pixels of block `block` along one axis that the image shows.
double visible_share(std::size_t block, std::size_t size) {
  const std::size_t first = block * block_size;
  return static_cast<double>(std::min(size - first, block_size)) / block_size;
}

}  // namespace

Synthesizer::Synthesizer(SynthesisSettings settings)
    : settings_(validated(std::move(settings))),
      grid_(BlockGrid::of(settings_.width, settings_.height, settings_.channels)),
      refiner_(settings_.shared_list, settings_.channels, settings_.channel_weights),
      metric_(settings_.priority, settings_.max_samples_per_block),
      cache_(grid_, settings_.channels),
      queue_(grid_.blocks_x * grid_.blocks_y),
      state_stride_(refiner_.state_size()) {
  const std::size_t blocks = queue_.size();
  wave_size_ = settings_.wave != 0 ? settings_.wave : std::max<std::size_t>(1, blocks / 32);
  states_.resize(blocks * state_stride_ * sizeof(float) / sizeof(StateLine));
  counts_.resize(blocks);
  variations_.resize(blocks);
  residuals_.resize(blocks);
  told_.resize(blocks);
  in_wave_.resize(blocks);
  factors_.resize(blocks, 1);
  sums_.resize(settings_.channels);
  squares_.resize(settings_.channels);
  channel_variances_.resize(settings_.channels);
  untouched_blocks_ = blocks;
  stats_.blocks = blocks;
  for (std::size_t b = 0; b < blocks; ++b) {
    refiner_.reset(state_of(b));
    const double visible = visible_share(b % grid_.blocks_x, settings_.width) *
                           visible_share(b / grid_.blocks_x, settings_.height);
    factors_[b] = static_cast<float>(visible);
    if (!settings_.importance.empty()) factors_[b] *= settings_.importance[b];
    queue_.update(b, priority_of(static_cast<std::uint32_t>(b)));
  }
}

void Synthesizer::set_stop(const StopRule& stop) {
  if (!(stop.samples_per_pixel >= 0)) {
    throw std::invalid_argument("freqsynth: samples_per_pixel is " +
                                std::to_string(stop.samples_per_pixel) + ", not >= 0");
  }
  if (!(stop.aliasing_threshold >= 0)) {
    throw std::invalid_argument("freqsynth: aliasing_threshold is " +
                                std::to_string(stop.aliasing_threshold) + ", not >= 0");
  }
  const std::lock_guard lock(mutex_);
  sample_limit_ = stop.samples;
  const double samples = std::round(stop.samples_per_pixel * static_cast<double>(settings_.width) *
                                    static_cast<double>(settings_.height));
  if (samples < static_cast<double>(sample_limit_)) {
    sample_limit_ = static_cast<std::uint64_t>(samples);
  }
  // Not infinite, so that blocks without a sample, whose priority is, still get theirs.
  threshold_ = static_cast<float>(std::min(stop.aliasing_threshold * stop.aliasing_threshold,
                                           double{std::numeric_limits<float>::max()}));
}

std::size_t Synthesizer::request(std::span<Request> out) {
  const std::lock_guard lock(mutex_);
  if (slots_.empty() && prepare_wave()) return 0;
  std::size_t count = 0;
  const auto hand_out = [&](std::uint32_t slot) {
    slots_[slot].state = SlotState::owed;
    out[count++] = make_request(slot);
  };
  while (count < out.size() && !returned_.empty()) {
    hand_out(returned_.back());
    returned_.pop_back();
  }
  while (count < out.size() && next_slot_ < slots_.size()) {
    hand_out(static_cast<std::uint32_t>(next_slot_++));
  }
  return count;
}

std::optional<StopReason> Synthesizer::stopped() {
  const std::lock_guard lock(mutex_);
  if (slots_.empty()) return prepare_wave();
  const bool more = next_slot_ < slots_.size() || !returned_.empty();
  return more ? std::nullopt : std::optional(StopReason::waiting);
}

std::optional<StopReason> Synthesizer::prepare_wave() {
  if (stats_.samples >= sample_limit_) return StopReason::samples;
  const std::uint64_t remaining = sample_limit_ - stats_.samples;
  const std::size_t most = std::min<std::uint64_t>(wave_size_, remaining);
  while (slots_.size() < most && queue_.top_priority() > threshold_) {
    const auto block = static_cast<std::uint32_t>(queue_.top());
    queue_.update(block, BlockQueue::absent);
    touched_.push_back(block);
    if (!asked_by_neighbour(block, counts_[block])) {
      slots_.push_back({block, counts_[block], SlotState::waiting});
    }
    in_wave_[block] = 1;
  }
  if (slots_.empty()) {
    return queue_.top_priority() >= 0 ? StopReason::threshold : StopReason::exhausted;
  }
  slot_values_.resize(slots_.size() * settings_.channels);
  return std::nullopt;
}

BlockNeighbours Synthesizer::neighbours() const {
  return {static_cast<std::uint32_t>(grid_.blocks_x), static_cast<std::uint32_t>(queue_.size())};
}

bool Synthesizer::asked_by_neighbour(std::uint32_t block, std::uint32_t index) const {
  bool asked = false;
  neighbours().visit_sharing(
      block, refiner_.list().position(index), [&](std::uint32_t other, std::uint32_t other_index) {
        asked = asked || (in_wave_[other] != 0 && counts_[other] == other_index);
      });
  return asked;
}

Request Synthesizer::make_request(std::uint32_t slot) const {
  const Slot& asked = slots_[slot];
  const SequencePosition& position = refiner_.list().position(asked.index);
  const std::size_t block_x = asked.block % grid_.blocks_x;
  const std::size_t block_y = asked.block / grid_.blocks_x;
  Request request;
  request.x = reflect((static_cast<double>(block_x) + position.s) * block_size,
                      static_cast<double>(settings_.width));
  request.y = reflect((static_cast<double>(block_y) + position.t) * block_size,
                      static_cast<double>(settings_.height));
  request.spacing = position.spacing * block_size;
  request.slot = slot;
  // The point's name is its lowest block and its index there, whichever block asks.
  static_assert(SampleSequence::max_size < (std::size_t{1} << 21));
  Place name{asked.block, asked.index};
  neighbours().visit_sharing(asked.block, position,
                             [&](std::uint32_t other, std::uint32_t other_index) {
                               if (other < name.block) name = {other, other_index};
                             });
  request.id = (std::uint64_t{name.block} << 21) | name.index;
  return request;
}

void Synthesizer::settle(std::span<const Request> requests, SlotState state) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Request& request = requests[i];
    const bool owed = request.slot < slots_.size() &&
                      slots_[request.slot].state == SlotState::owed &&
                      make_request(request.slot).id == request.id;
    if (owed) {
      slots_[request.slot].state = state;
      continue;
    }
    for (const Request& before : requests.first(i)) slots_[before.slot].state = SlotState::owed;
    throw std::invalid_argument("freqsynth: request " + std::to_string(request.id) +
                                " is not owed");
  }
}

void Synthesizer::deliver(std::span<const Request> requests, std::span<const float> values) {
  const std::size_t channels = settings_.channels;
  if (values.size() != requests.size() * channels) {
    throw std::invalid_argument("freqsynth: " + std::to_string(values.size()) + " values for " +
                                std::to_string(requests.size()) + " requests of " +
                                std::to_string(channels) + " channels");
  }
  const std::lock_guard lock(mutex_);
  settle(requests, SlotState::delivered);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    std::copy_n(values.data() + i * channels, channels,
                slot_values_.data() + requests[i].slot * channels);
  }
  delivered_slots_ += requests.size();
  if (!slots_.empty() && delivered_slots_ == slots_.size()) finish_wave();
}

void Synthesizer::give_back(std::span<const Request> requests) {
  const std::lock_guard lock(mutex_);
  settle(requests, SlotState::waiting);
  for (const Request& request : requests) returned_.push_back(request.slot);
}

void Synthesizer::finish_wave() {
  const std::size_t channels = settings_.channels;
  // The states of blocks lie all over the memory: fetch those that come soon.
  constexpr std::size_t ahead = 6;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (i + ahead < slots_.size()) {
      const Slot& next = slots_[i + ahead];
      const float* state = state_of(next.block);
      const std::size_t pixel = refiner_.list().row(next.index).pixels[0];
      for (std::size_t at = 0; at < channels * max_terms; at += 16) prefetch(state + at);
      for (std::size_t c = 0; c < channels; ++c) {
        prefetch(state + (channels + c) * max_terms + pixel);
      }
      prefetch(state + 2 * channels * max_terms);
    }
    route(slots_[i], slot_values_.data() + i * channels);
  }
  stats_.samples += slots_.size();
  ++stats_.waves;
  slots_.clear();
  next_slot_ = delivered_slots_ = 0;
  if (untouched_blocks_ == 0 && variance_ == 0) {
    rescale();
  } else {
    for (const std::uint32_t block : touched_) queue_.update(block, priority_of(block));
    revise_neighbours();
  }
  for (const std::uint32_t block : touched_) in_wave_[block] = 0;
  touched_.clear();
}

void Synthesizer::route(const Slot& slot, const float* values) {
  const std::size_t channels = settings_.channels;
  const InverseList& list = refiner_.list();
  const SequencePosition& position = list.position(slot.index);
  const bool usable = std::all_of(values, values + channels, is_usable_sample);
  if (!usable) {
    ++stats_.bad_samples;
    if (bad_.size() < most_bad_reported) {
      const Request request = make_request(static_cast<std::uint32_t>(&slot - slots_.data()));
      bad_.push_back({request.x, request.y, request.id});
    }
  } else if (position.side == BlockSide::corner) {
    for (std::size_t c = 0; c < channels; ++c) {
      sums_[c] += double{values[c]};
      squares_[c] += double{values[c]} * double{values[c]};
    }
    ++corners_;
  }

  std::array<std::uint32_t, 4> blocks{slot.block};
  std::size_t block_count = 1;
  absorb(slot.block, values);
  neighbours().visit_sharing(slot.block, position,
                             [&](std::uint32_t other, std::uint32_t other_index) {
                               if (counts_[other] == other_index) {
                                 absorb(other, values);
                                 blocks[block_count++] = other;
                               } else if (other_index < settings_.max_samples_per_block) {
                                 cache_.put(other % grid_.blocks_x, other / grid_.blocks_x,
                                            list.position(other_index), {values, channels});
                               }
                             });
  for (std::size_t i = 0; i < block_count; ++i) advance(blocks[i]);
}

void Synthesizer::absorb(std::uint32_t block, const float* values) {
  std::uint32_t& count = counts_[block];
  if (count == 0) --untouched_blocks_;
  const float change = refiner_.absorb(state_of(block), count, values);
  variations_[block] = metric_.variation(variations_[block], change);
  ++count;
  ++stats_.absorbed;
  note_residual(block);
  if (in_wave_[block] == 0) {
    in_wave_[block] = 1;
    touched_.push_back(block);
  }
}

void Synthesizer::advance(std::uint32_t block) {
  const InverseList& list = refiner_.list();
  while (counts_[block] < settings_.max_samples_per_block) {
    const float* values =
        cache_.take(block % grid_.blocks_x, block / grid_.blocks_x, list.position(counts_[block]));
    if (values == nullptr) return;
    absorb(block, values);
  }
}

FrequencyImage Synthesizer::image() const {
  const std::lock_guard lock(mutex_);
  FrequencyImage image(settings_.width, settings_.height, settings_.channels);
  for (std::size_t b = 0; b < queue_.size(); ++b) {
    const std::size_t x = b % grid_.blocks_x;
    const std::size_t y = b / grid_.blocks_x;
    image.samples(x, y) = counts_[b];
    for (std::size_t c = 0; c < settings_.channels; ++c) {
      refiner_.coefficients(state_of(b), counts_[b], c, image.coefficients(x, y, c));
    }
  }
  return image;
}

FrequencyImage Synthesizer::finished_image() const {
  return finished_image(settings_.noisy ? FinishSettings::noisy() : FinishSettings{});
}

FrequencyImage Synthesizer::finished_image(const FinishSettings& settings) const {
  const std::lock_guard lock(mutex_);
  FrequencyImage image(settings_.width, settings_.height, settings_.channels,
                       CoefficientMeaning::pixel_average);
  PixelFinisher finisher(settings_.shared_list, settings);
  std::vector<std::uint32_t> order(queue_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return counts_[a] < counts_[b]; });
  std::array<float, max_terms> coefficients;
  for (const std::uint32_t block : order) {
    const std::size_t x = block % grid_.blocks_x;
    const std::size_t y = block / grid_.blocks_x;
    const std::uint32_t count = counts_[block];
    image.samples(x, y) = count;
    finisher.advance(count);
    for (std::size_t c = 0; c < settings_.channels; ++c) {
      refiner_.coefficients(state_of(block), count, c, coefficients);
      finisher.finish(coefficients, refiner_.pixel_sums(state_of(block), c),
                      residual_variance(block, c), image.coefficients(x, y, c));
    }
  }
  return image;
}

SynthesisStats Synthesizer::stats() const {
  const std::lock_guard lock(mutex_);
  SynthesisStats stats = stats_;
  stats.samples += delivered_slots_;
  return stats;
}

std::vector<BadSample> Synthesizer::bad_samples() const {
  const std::lock_guard lock(mutex_);
  return bad_;
}

void detail::check_run(std::size_t sampler_channels, std::size_t channels, std::size_t batch) {
  if (sampler_channels != channels) {
    throw std::invalid_argument("freqsynth: the sampler returns " +
                                std::to_string(sampler_channels) + " values for " +
                                std::to_string(channels) + " channels");
  }
  if (batch == 0) throw std::invalid_argument("freqsynth: batch is 0");
}

}  // namespace freqsynth
