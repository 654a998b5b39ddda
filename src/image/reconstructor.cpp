#include "freqsynth/image/reconstructor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "freqsynth/basis/kernels.h"

namespace freqsynth {
namespace {

double sinc(double z) {
  const double x = std::numbers::pi * z;
  return x == 0 ? 1 : std::sin(x) / x;
}

/// The pixels of the output that one column (or row) of blocks contributes to.
struct AxisBlock {
  std::size_t first = 0;       // first output pixel
  std::size_t count = 0;       // how many
  bool continues = false;      // the first one began in the previous block
  std::vector<float> weights;  // of cos(pi u s) in each pixel
};

constexpr std::size_t padded(std::size_t count) { return (count + 7) / 8 * 8; }

/// Weight of cos(pi u s) in a pixel that covers [begin, end] of the image, in a block that covers
/// [block, block + 8]. All lengths in units of 1 / `unit` image pixels.
double weight_of(std::uint64_t begin, std::uint64_t end, std::uint64_t block, std::uint64_t unit,
                 std::size_t u, PixelFilter filter) {
  const double length = static_cast<double>(block_size * unit);
  const auto place = [&](double x) { return (x - static_cast<double>(block)) / length; };
  const double omega = std::numbers::pi * static_cast<double>(u);
  if (filter == PixelFilter::none) {
    return std::cos(omega * place(0.5 * static_cast<double>(begin + end)));
  }
  const double s0 = place(static_cast<double>(std::max(begin, block)));
  const double s1 = place(static_cast<double>(std::min(end, block + block_size * unit)));
  const double share = length / static_cast<double>(end - begin);
  // The integral of the cosine, as the product of its value in the middle and a sinc.
  return share * (s1 - s0) * std::cos(omega * 0.5 * (s0 + s1)) *
         sinc(0.5 * static_cast<double>(u) * (s1 - s0));
}

/// One axis of the output: `size` pixels of the image become `out` pixels.
/// \param frequency_major  the layout of the weights: [u][padded(count)], else [count][v]
std::vector<AxisBlock> make_axis(std::size_t size, std::size_t out, PixelFilter filter,
                                 bool frequency_major) {
  std::vector<AxisBlock> blocks((size + block_size - 1) / block_size);
  // Integers: pixel i covers [i * size, (i + 1) * size] in units of 1 / out image pixels.
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    AxisBlock& axis = blocks[b];
    const std::uint64_t begin = block_size * b * out;
    const std::uint64_t end = std::min(begin + block_size * out, std::uint64_t{size} * out);
    std::uint64_t first = begin / size;
    std::uint64_t last = (end + size - 1) / size;
    if (filter == PixelFilter::none) {
      // Pixels whose centre (2 i + 1) size / 2 lies in [begin, end).
      first = (2 * begin + size - 1) / (2 * size);
      last = (2 * end + size - 1) / (2 * size);
    }
    axis.first = first;
    axis.count = last - first;
    axis.continues = filter == PixelFilter::box && first * size < begin;
    const std::size_t stride = padded(axis.count);
    axis.weights.assign(frequency_major ? block_size * stride : axis.count * block_size, 0);
    for (std::size_t i = 0; i < axis.count; ++i) {
      for (std::size_t u = 0; u < block_size; ++u) {
        const double weight =
            weight_of((first + i) * size, (first + i + 1) * size, begin, out, u, filter);
        axis.weights[frequency_major ? u * stride + i : i * block_size + u] =
            static_cast<float>(weight);
      }
    }
  }
  return blocks;
}

/// Row-major factors that turn coefficients F into filtered amplitudes of a point function.
class FactorTable {
 public:
  FactorTable(const ButterworthSettings& settings, CoefficientMeaning meaning)
      : settings_(settings), meaning_(meaning) {}

  const std::array<float, max_terms>& of(std::uint32_t samples) {
    const auto [entry, added] = factors_.try_emplace(samples);
    if (added) {
      entry->second = butterworth_factors(settings_, samples);
      if (meaning_ == CoefficientMeaning::pixel_average) entry->second.fill(1);
      for (std::size_t i = 0; i < max_terms; ++i) {
        double factor = amplitude_of_coefficient(i);
        // Undo the average over a pixel, which the weights of the output apply anew.
        if (meaning_ == CoefficientMeaning::pixel_average) factor /= pixel_mean_of_term(i);
        entry->second[i] *= static_cast<float>(factor);
      }
    }
    return entry->second;
  }

 private:
  ButterworthSettings settings_;
  CoefficientMeaning meaning_;
  std::unordered_map<std::uint32_t, std::array<float, max_terms>> factors_;
};

struct alignas(32) Amplitudes {
  float values[max_terms];
};

void filter_block(std::span<const float, max_terms> coefficients,
                  const std::array<float, max_terms>& factors, Amplitudes& out) {
  for (std::size_t i = 0; i < max_terms; ++i) {
    out.values[detail::zigzag_to_row_major[i]] = coefficients[i] * factors[i];
  }
}

/// Memory for one block of the output, aligned for the kernel.
struct Tile {
  struct alignas(32) Line {
    float values[8];
  };
  std::vector<Line> lines;

  float* reserve(std::size_t floats) {
    if (lines.size() * 8 < floats) lines.resize((floats + 7) / 8);
    return lines.data()->values;
  }
};

}  // namespace

void reconstruct(const FrequencyImage& image, const ReconstructionSettings& settings,
                 const PixelView& out) {
  settings.butterworth.validate();
  if (image.blocks_x() == 0 || out.width == 0 || out.height == 0) return;
  if (out.data == nullptr) {
    throw std::invalid_argument("freqsynth: reconstruct: no memory for " +
                                std::to_string(out.width) + " x " + std::to_string(out.height) +
                                " pixels");
  }
  // The weights of an average are right for coefficients that are averages too, once undone.
  const auto columns = make_axis(image.width(), out.width, settings.pixel_filter, true);
  const auto rows = make_axis(image.height(), out.height, settings.pixel_filter, false);
  FactorTable factors(settings.butterworth, image.meaning());
  Amplitudes amplitudes;
  Tile tile, weights;
  for (std::size_t by = 0; by < rows.size(); ++by) {
    const AxisBlock& row = rows[by];
    for (std::size_t bx = 0; bx < columns.size(); ++bx) {
      const AxisBlock& column = columns[bx];
      const std::size_t stride = padded(column.count);
      const auto& factor = factors.of(image.samples(bx, by));
      float* wx = weights.reserve(block_size * stride);
      std::copy(column.weights.begin(), column.weights.end(), wx);
      float* pixels = tile.reserve(row.count * stride);
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        filter_block(image.coefficients(bx, by, channel), factor, amplitudes);
        detail::evaluate_separable(amplitudes.values, wx, stride, stride, row.weights.data(),
                                   row.count, pixels, stride);
        float* channel_out = out.data + static_cast<std::ptrdiff_t>(channel) * out.channel_stride;
        for (std::size_t r = 0; r < row.count; ++r) {
          float* line = channel_out + static_cast<std::ptrdiff_t>(row.first + r) * out.row_stride +
                        static_cast<std::ptrdiff_t>(column.first) * out.pixel_stride;
          const float* source = pixels + r * stride;
          const bool add_row = r == 0 && row.continues;
          for (std::size_t c = 0; c < column.count; ++c) {
            float& target = line[static_cast<std::ptrdiff_t>(c) * out.pixel_stride];
            // A pixel that an earlier block has begun is a sum over blocks.
            const bool add = add_row || (c == 0 && column.continues);
            target = add ? target + source[c] : source[c];
          }
        }
      }
    }
  }
  if (!settings.clamp_negative) return;
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < out.width; ++x) {
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        float& value = out.data[static_cast<std::ptrdiff_t>(y) * out.row_stride +
                                static_cast<std::ptrdiff_t>(x) * out.pixel_stride +
                                static_cast<std::ptrdiff_t>(channel) * out.channel_stride];
        value = std::max(value, 0.0f);
      }
    }
  }
}

std::size_t scaled_size(std::size_t size, double scale) {
  if (!(scale > 0 && std::isfinite(scale))) {
    throw std::invalid_argument("freqsynth: scale is " + std::to_string(scale) +
                                ", not a finite number > 0");
  }
  const double scaled = std::ceil(static_cast<double>(size) * scale);
  if (scaled > 4294967295.0) {
    throw std::invalid_argument("freqsynth: scale " + std::to_string(scale) + " of " +
                                std::to_string(size) + " pixels is too large");
  }
  return static_cast<std::size_t>(scaled);
}

std::vector<float> reconstruct(const FrequencyImage& image, const ReconstructionSettings& settings,
                               double scale) {
  const std::size_t width = scaled_size(image.width(), scale);
  const std::size_t height = scaled_size(image.height(), scale);
  const std::size_t channels = image.channels();
  std::vector<float> pixels(width * height * channels);
  const auto pixel_stride = static_cast<std::ptrdiff_t>(channels);
  const auto row_stride = static_cast<std::ptrdiff_t>(width * channels);
  reconstruct(image, settings, {pixels.data(), width, height, pixel_stride, row_stride, 1});
  return pixels;
}

void evaluate(const FrequencyImage& image, const ButterworthSettings& butterworth, double x,
              double y, std::span<float> values) {
  butterworth.validate();
  const auto width = static_cast<double>(image.width());
  const auto height = static_cast<double>(image.height());
  if (image.blocks_x() == 0 || !(x >= 0 && x <= width && y >= 0 && y <= height)) {
    throw std::invalid_argument("freqsynth: evaluate: (" + std::to_string(x) + ", " +
                                std::to_string(y) + ") is not in the image");
  }
  if (values.size() != image.channels()) {
    throw std::invalid_argument("freqsynth: evaluate: room for " + std::to_string(values.size()) +
                                " of " + std::to_string(image.channels()) + " channels");
  }
  const auto block_of = [](double at, std::size_t blocks) {
    return std::min(static_cast<std::size_t>(at / block_size), blocks - 1);
  };
  const std::size_t bx = block_of(x, image.blocks_x());
  const std::size_t by = block_of(y, image.blocks_y());
  FactorTable factors(butterworth, image.meaning());
  std::array<double, max_terms> terms;
  evaluate_terms(x / block_size - static_cast<double>(bx), y / block_size - static_cast<double>(by),
                 terms);
  const auto& factor = factors.of(image.samples(bx, by));
  for (std::size_t channel = 0; channel < image.channels(); ++channel) {
    const auto coefficients = image.coefficients(bx, by, channel);
    double sum = 0;
    for (std::size_t i = 0; i < max_terms; ++i) {
      sum += terms[i] * double{coefficients[i] * factor[i]};
    }
    values[channel] = static_cast<float>(sum);
  }
}

}  // namespace freqsynth
