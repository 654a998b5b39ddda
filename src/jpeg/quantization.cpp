#include "freqsynth/jpeg/quantization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "freqsynth/basis/dct.h"
#include "jpeg/block_scaling.h"

namespace freqsynth {
namespace {

using Block = std::array<float, max_terms>;

/// Y of JPEG is shifted by -128, which is -8 * 128 in the constant coefficient (eq. 1).
constexpr float level_shift = 1024;

constexpr QuantizationTable to_zigzag(const std::array<std::uint16_t, max_terms>& rows) {
  QuantizationTable table{};
  for (std::size_t i = 0; i < max_terms; ++i) table[i] = rows[detail::zigzag_to_row_major[i]];
  return table;
}

// clang-format off
constexpr QuantizationTable figure_5 = to_zigzag({
    16, 11, 10, 16,  24,  40,  51,  61,
    12, 12, 14, 19,  26,  58,  60,  55,
    14, 13, 16, 24,  40,  57,  69,  56,
    14, 17, 22, 29,  51,  87,  80,  62,
    18, 22, 37, 56,  68, 109, 103,  77,
    24, 35, 55, 64,  81, 104, 113,  92,
    49, 64, 78, 87, 103, 121, 120, 101,
    72, 92, 95, 98, 112, 100, 103,  99});

constexpr QuantizationTable table_k2 = to_zigzag({
    17, 18, 24, 47, 99, 99, 99, 99,
    18, 21, 26, 66, 99, 99, 99, 99,
    24, 26, 56, 99, 99, 99, 99, 99,
    47, 66, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99});
// clang-format on

void check_table(const QuantizationTable& table, const char* name) {
  if (std::find(table.begin(), table.end(), 0) != table.end()) {
    throw std::invalid_argument("freqsynth: the " + std::string(name) +
                                " quantization table holds a 0");
  }
}

void check_channels(std::size_t channels) {
  if (channels != 1 && channels != 3) {
    throw std::invalid_argument("freqsynth: quantization of " + std::to_string(channels) +
                                " channels, not 1 or 3");
  }
}

/// The filtered coefficients of the pixels' means.
class PixelBlocks {
 public:
  PixelBlocks(const FrequencyImage& image, const ButterworthSettings& butterworth)
      : image_(image), butterworth_(butterworth) {
    for (std::size_t i = 0; i < max_terms; ++i) {
      box_[i] = static_cast<float>(pixel_mean_of_term(i));
    }
  }

  /// Block (x, y); beyond the grid the image is continued as in a mirror.
  void read(std::size_t x, std::size_t y, std::size_t channel, Block& block) {
    const bool mirror_x = x >= image_.blocks_x();
    const bool mirror_y = y >= image_.blocks_y();
    const std::size_t bx = mirror_x ? image_.blocks_x() - 1 : x;
    const std::size_t by = mirror_y ? image_.blocks_y() - 1 : y;
    const auto coefficients = image_.coefficients(bx, by, channel);
    if (image_.meaning() == CoefficientMeaning::point_function) {
      const Block& factors = factors_of(image_.samples(bx, by));
      for (std::size_t i = 0; i < max_terms; ++i) block[i] = coefficients[i] * factors[i];
    } else {
      std::copy(coefficients.begin(), coefficients.end(), block.begin());
    }
    if (!mirror_x && !mirror_y) return;
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      if ((mirror_x && f.u % 2 == 1) != (mirror_y && f.v % 2 == 1)) block[i] = -block[i];
    }
  }

  /// The means of 2 x 2 pixels of the four blocks from (2 x, 2 y) on.
  void read_halved(std::size_t x, std::size_t y, std::size_t channel, Block& block) {
    for (std::size_t i = 0; i < 4; ++i) read(2 * x + i % 2, 2 * y + i / 2, channel, four_[i]);
    block = halve_blocks(four_);
  }

 private:
  const Block& factors_of(std::uint32_t samples) {
    if (last_ != nullptr && samples == last_samples_) return *last_;
    const auto [entry, added] = factors_.try_emplace(samples);
    if (added) {
      entry->second = butterworth_factors(butterworth_, samples);
      for (std::size_t i = 0; i < max_terms; ++i) entry->second[i] *= box_[i];
    }
    last_samples_ = samples;
    last_ = &entry->second;
    return *last_;
  }

  const FrequencyImage& image_;
  ButterworthSettings butterworth_;
  Block box_;
  std::unordered_map<std::uint32_t, Block> factors_;
  const Block* last_ = nullptr;  // a map's entries stay where they are
  std::uint32_t last_samples_ = 0;
  std::array<Block, 4> four_;
};

/// The quantised value of a term that may be out of range or not a number.
std::int16_t clamp_value(float value, std::size_t term, std::uint64_t& clamped) {
  const float least = term == 0 ? -1024 : -1023;
  // A value half a step beyond the range is rounding, not an overshoot.
  if (!(value > least - 1 && value < 1024)) ++clamped;
  if (std::isnan(value)) return 0;
  return static_cast<std::int16_t>(std::clamp(std::round(value), least, 1023.0f));
}

/// Eq. 3 for one block, halves away from zero.
void quantize_block(const Block& block, const Block& steps, std::int16_t* out,
                    std::uint64_t& clamped) {
  Block values;
  int outside = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    values[i] = block[i] / steps[i];
    outside |= static_cast<int>(!(std::abs(values[i]) <= 1023.0f));
  }
  if (outside != 0) {
    for (std::size_t i = 0; i < max_terms; ++i) out[i] = clamp_value(values[i], i, clamped);
    return;
  }
  // std::round() without a call: the float below 1/2 takes a half to the next integer, for the sum
  // is rounded to even, and nothing that is less.
  constexpr float below_half = 0x1.fffffep-2f;
  for (std::size_t i = 0; i < max_terms; ++i) {
    out[i] = static_cast<std::int16_t>(
        static_cast<int>(values[i] + std::copysign(below_half, values[i])));
  }
}

}  // namespace

const QuantizationTable& luminance_table() { return figure_5; }
const QuantizationTable& chrominance_table() { return table_k2; }

QuantizationTable scale_table(const QuantizationTable& table, int quality) {
  if (quality < 1 || quality > 100) {
    throw std::invalid_argument("freqsynth: quality is " + std::to_string(quality) +
                                ", not in 1..100");
  }
  check_table(table, "given");
  const int scale = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  QuantizationTable scaled{};
  for (std::size_t i = 0; i < max_terms; ++i) {
    scaled[i] = static_cast<std::uint16_t>(std::clamp((table[i] * scale + 50) / 100, 1, 255));
  }
  return scaled;
}

std::array<float, max_terms> halve_blocks(const std::array<Block, 4>& blocks) {
  using detail::AxisMap;
  static const std::array<AxisMap, 2> shrink{AxisMap::shrink(0, 2), AxisMap::shrink(1, 2)};
  detail::RowBlock sum{};
  detail::RowBlock rows;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < max_terms; ++k) {
      rows.values[detail::zigzag_to_row_major[k]] = blocks[i][k];
    }
    const detail::RowBlock part = AxisMap::apply(shrink[i % 2], shrink[i / 2], rows);
    for (std::size_t k = 0; k < max_terms; ++k) sum.values[k] += part.values[k];
  }
  Block out;
  for (std::size_t k = 0; k < max_terms; ++k) out[k] = sum.values[detail::zigzag_to_row_major[k]];
  return out;
}

QuantizedImage quantize(const FrequencyImage& image, const QuantizationSettings& settings) {
  if (image.blocks_x() == 0) {
    throw std::invalid_argument("freqsynth: quantize: the image has no pixels");
  }
  check_channels(image.channels());
  check_table(settings.luminance, "luminance");
  check_table(settings.chrominance, "chrominance");
  settings.butterworth.validate();

  const bool color = image.channels() == 3;
  const bool halve = color && settings.subsampling == Subsampling::both;
  const std::size_t group = halve ? 2 : 1;  // blocks of Y along a block of Cb
  const std::size_t groups_x = (image.blocks_x() + group - 1) / group;
  const std::size_t groups_y = (image.blocks_y() + group - 1) / group;
  QuantizedImage result;
  result.width = image.width();
  result.height = image.height();
  result.tables.push_back(settings.luminance);
  if (color) result.tables.push_back(settings.chrominance);
  std::array<Block, 2> steps;
  for (std::size_t t = 0; t < result.tables.size(); ++t) {
    std::copy(result.tables[t].begin(), result.tables[t].end(), steps[t].begin());
  }
  result.components.resize(image.channels());
  for (std::size_t channel = 0; channel < image.channels(); ++channel) {
    QuantizedComponent& component = result.components[channel];
    component.blocks_x = channel == 0 ? image.blocks_x() : groups_x;
    component.blocks_y = channel == 0 ? image.blocks_y() : groups_y;
    component.horizontal = component.vertical = channel == 0 ? static_cast<int>(group) : 1;
    component.table = channel == 0 ? 0 : 1;
    component.values.resize(component.blocks_x * component.blocks_y * max_terms);
  }

  PixelBlocks blocks(image, settings.butterworth);
  Block block;
  const auto write = [&](std::size_t x, std::size_t y, std::size_t channel) {
    QuantizedComponent& component = result.components[channel];
    if (channel == 0) block[0] -= level_shift;
    quantize_block(block, steps[component.table],
                   component.values.data() + (y * component.blocks_x + x) * max_terms,
                   result.clamped);
  };
  // All channels of a block in one go, for they lie together in memory.
  for (std::size_t y = 0; y < groups_y; ++y) {
    for (std::size_t x = 0; x < groups_x; ++x) {
      for (std::size_t i = 0; i < group * group; ++i) {
        const std::size_t luma_x = group * x + i % group;
        const std::size_t luma_y = group * y + i / group;
        if (luma_x >= image.blocks_x() || luma_y >= image.blocks_y()) continue;
        blocks.read(luma_x, luma_y, 0, block);
        write(luma_x, luma_y, 0);
      }
      for (std::size_t channel = 1; channel < image.channels(); ++channel) {
        if (halve) {
          blocks.read_halved(x, y, channel, block);
        } else {
          blocks.read(x, y, channel, block);
        }
        write(x, y, channel);
      }
    }
  }
  return result;
}

QuantizationTarget quantization_target(const QuantizationSettings& settings, std::size_t channels,
                                       double tolerance) {
  QuantizationTarget target;
  target.tolerance = tolerance;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const QuantizationTable& table = channel == 0 ? settings.luminance : settings.chrominance;
    const bool half = channel > 0 && settings.subsampling == Subsampling::both;
    auto& steps = target.steps.emplace_back();
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      if (!half) {
        steps[i] = table[i];
      } else if (f.u < block_size / 2 && f.v < block_size / 2) {
        // The four blocks' terms (u, v) make (2u, 2v) and those beside it, with a quarter of the
        // variance.
        steps[i] = 2.0f * static_cast<float>(table[term_of_frequency(2 * f.u, 2 * f.v)]);
      } else {
        steps[i] = std::numeric_limits<float>::infinity();
      }
    }
  }
  target.validate(channels);
  return target;
}

}  // namespace freqsynth
