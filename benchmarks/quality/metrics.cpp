// SPDX-License-Identifier: MIT
#include "metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace quality {
namespace {

std::string size_of(const PictureView& picture) {
  return std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels with " +
         std::to_string(picture.pixels.size()) + " values";
}

void check(const PictureView& picture, const PictureView& reference) {
  const bool same = picture.width == reference.width && picture.height == reference.height;
  const std::size_t values = 3 * picture.width * picture.height;
  if (!same || values == 0 || picture.pixels.size() != values ||
      reference.pixels.size() != values) {
    throw std::invalid_argument("picture of " + size_of(picture) +
                                " cannot be compared with a reference of " + size_of(reference));
  }
}

/// 0..255.
double display_encoded(float linear) {
  const double x = std::clamp(double{linear}, 0.0, 1.0);
  return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

/// Mean of term(picture's value, reference's value).
template <class Term>
double mean_of(const PictureView& picture, const PictureView& reference, const Term& term) {
  check(picture, reference);
  double sum = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    sum += term(picture.pixels[i], reference.pixels[i]);
  }
  return sum / static_cast<double>(picture.pixels.size());
}

std::vector<double> luma(const PictureView& picture) {
  std::vector<double> result;
  result.reserve(picture.width * picture.height);
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    result.push_back(0.299 * display_encoded(picture.pixels[i]) +
                     0.587 * display_encoded(picture.pixels[i + 1]) +
                     0.114 * display_encoded(picture.pixels[i + 2]));
  }
  return result;
}

std::array<double, ssim_window> gaussian() {
  std::array<double, ssim_window> weights{};
  double sum = 0;
  for (std::size_t i = 0; i < ssim_window; ++i) {
    const double distance = static_cast<double>(i) - static_cast<double>(ssim_window / 2);
    sum += weights[i] = std::exp(-distance * distance / (2 * 1.5 * 1.5));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// The weighted mean of value(pixel) over each window inside, row by row.
template <class Value>
std::vector<double> window_means(std::size_t width, std::size_t height, const Value& value) {
  static const std::array<double, ssim_window> weights = gaussian();
  const std::size_t across = width - ssim_window + 1;
  const std::size_t down = height - ssim_window + 1;
  std::vector<double> rows(across * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < across; ++x) {
      double sum = 0;
      for (std::size_t i = 0; i < ssim_window; ++i) sum += weights[i] * value(y * width + x + i);
      rows[y * across + x] = sum;
    }
  }
  std::vector<double> means(across * down);
  for (std::size_t y = 0; y < down; ++y) {
    for (std::size_t x = 0; x < across; ++x) {
      double sum = 0;
      for (std::size_t i = 0; i < ssim_window; ++i) sum += weights[i] * rows[(y + i) * across + x];
      means[y * across + x] = sum;
    }
  }
  return means;
}

/// Calls visit(block, pixel) for all pixels, row by row.
template <class Visitor>
void visit_blocks(const PictureView& picture, const Visitor& visit) {
  const std::size_t blocks_x = (picture.width + block_size - 1) / block_size;
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      visit(y / block_size * blocks_x + x / block_size, y * picture.width + x);
    }
  }
}

std::size_t block_count(const PictureView& picture) {
  return ((picture.width + block_size - 1) / block_size) *
         ((picture.height + block_size - 1) / block_size);
}

/// The mean of |value(i) - value(j)| over neighbouring values i and j on both sides of a border
/// between two blocks, divided by the mean over neighbours within a block.
template <class Value>
double border_ratio(const PictureView& picture, const Value& value) {
  struct Mean {
    double sum = 0, count = 0;
    double value() const { return count == 0 ? 0 : sum / count; }
  };
  Mean across, within;
  const auto add = [&](std::size_t pixel, std::size_t earlier, bool border) {
    Mean& mean = border ? across : within;
    for (std::size_t c = 0; c < 3; ++c) {
      mean.sum += std::abs(value(3 * pixel + c) - value(3 * earlier + c));
      mean.count += 1;
    }
  };
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::size_t pixel = y * picture.width + x;
      if (x != 0) add(pixel, pixel - 1, x % block_size == 0);
      if (y != 0) add(pixel, pixel - picture.width, y % block_size == 0);
    }
  }
  if (across.count == 0 || (across.value() == 0 && within.value() == 0)) return 1;
  return across.value() / within.value();
}

}  // namespace

double rmse(const PictureView& picture, const PictureView& reference) {
  return std::sqrt(mean_of(picture, reference, [](float value, float wanted) {
    const double error = double{value} - double{wanted};
    return error * error;
  }));
}

double psnr(const PictureView& picture, const PictureView& reference) {
  const double mse = mean_of(picture, reference, [](float value, float wanted) {
    const double error = display_encoded(value) - display_encoded(wanted);
    return error * error;
  });
  return mse == 0 ? std::numeric_limits<double>::infinity() : 10 * std::log10(255.0 * 255.0 / mse);
}

double relative_mse(const PictureView& picture, const PictureView& reference) {
  return mean_of(picture, reference, [](float value, float wanted) {
    const double error = (double{value} - double{wanted}) / (double{wanted} + 0.01);
    return error * error;
  });
}

double ssim(const PictureView& picture, const PictureView& reference) {
  check(picture, reference);
  const std::size_t width = picture.width;
  const std::size_t height = picture.height;
  if (width < ssim_window || height < ssim_window) {
    throw std::invalid_argument("picture of " + size_of(picture) + " has no window of 11 x 11");
  }
  const std::vector<double> a = luma(picture);
  const std::vector<double> b = luma(reference);
  const auto means = [&](const auto& value) { return window_means(width, height, value); };
  const auto mean_a = means([&](std::size_t i) { return a[i]; });
  const auto mean_b = means([&](std::size_t i) { return b[i]; });
  const auto mean_aa = means([&](std::size_t i) { return a[i] * a[i]; });
  const auto mean_bb = means([&](std::size_t i) { return b[i] * b[i]; });
  const auto mean_ab = means([&](std::size_t i) { return a[i] * b[i]; });
  constexpr double c1 = (0.01 * 255) * (0.01 * 255);
  constexpr double c2 = (0.03 * 255) * (0.03 * 255);
  double sum = 0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double square_a = mean_a[i] * mean_a[i];
    const double square_b = mean_b[i] * mean_b[i];
    const double product = mean_a[i] * mean_b[i];
    sum += (2 * product + c1) * (2 * (mean_ab[i] - product) + c2) /
           ((square_a + square_b + c1) * (mean_aa[i] - square_a + mean_bb[i] - square_b + c2));
  }
  return sum / static_cast<double>(mean_a.size());
}

std::vector<double> block_rmse(const PictureView& picture, const PictureView& reference) {
  check(picture, reference);
  std::vector<double> sums(block_count(picture));
  std::vector<double> pixels(sums.size());
  visit_blocks(picture, [&](std::size_t block, std::size_t pixel) {
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const double error = double{picture.pixels[i]} - double{reference.pixels[i]};
      sums[block] += error * error;
    }
    pixels[block] += 1;
  });
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = std::sqrt(sums[i] / (3 * pixels[i]));
  return sums;
}

std::size_t missed_blocks(const PictureView& picture, const PictureView& reference,
                          std::span<const std::uint32_t> samples) {
  const std::vector<double> errors = block_rmse(picture, reference);
  if (samples.size() != picture.width * picture.height) {
    throw std::invalid_argument("picture of " + size_of(picture) + " cannot have " +
                                std::to_string(samples.size()) + " counts of samples");
  }
  std::vector<double> taken(errors.size());
  std::vector<double> pixels(errors.size());
  double all = 0;
  visit_blocks(picture, [&](std::size_t block, std::size_t pixel) {
    taken[block] += samples[pixel];
    pixels[block] += 1;
    all += samples[pixel];
  });
  const double average = all / static_cast<double>(samples.size());
  const double limit = 5 * rmse(picture, reference);
  std::size_t missed = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    missed += errors[i] > limit && taken[i] < average * pixels[i];
  }
  return missed;
}

double seam_visibility(const PictureView& picture, const PictureView& reference) {
  check(picture, reference);
  return border_ratio(picture, [&](std::size_t i) {
    return double{picture.pixels[i]} - double{reference.pixels[i]};
  });
}

double relmse(const PictureView& picture, const PictureView& reference) {
  return mean_of(picture, reference, [](float value, float wanted) {
    const double error = double{value} - double{wanted};
    return error * error / (double{wanted} * double{wanted} + 0.01);
  });
}

double mean_ratio(const PictureView& picture, const PictureView& reference) {
  const double is = mean_of(picture, reference, [](float value, float) { return double{value}; });
  const double wanted = mean_of(picture, reference, [](float, float r) { return double{r}; });
  return is == wanted ? 1 : is / wanted;
}

double border_step(const PictureView& picture) {
  check(picture, picture);
  std::vector<double> encoded(picture.pixels.size());
  std::transform(picture.pixels.begin(), picture.pixels.end(), encoded.begin(), display_encoded);
  return border_ratio(picture, [&](std::size_t i) { return encoded[i]; });
}

double negative_share(const PictureView& picture) {
  return mean_of(picture, picture, [](float value, float) { return value < 0 ? 1.0 : 0.0; });
}

Metrics measure(const PictureView& picture, const PictureView& reference,
                std::span<const std::uint32_t> samples) {
  check(picture, reference);
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(reference.pixels.begin(), reference.pixels.end(), finite)) {
    throw std::invalid_argument("reference has a value that is not finite");
  }
  Metrics result;
  std::vector<float> pixels(picture.pixels.begin(), picture.pixels.end());
  for (float& value : pixels) {
    if (finite(value)) continue;
    value = 0;
    result.bad_values += 1;
  }
  const PictureView usable{picture.width, picture.height, pixels};
  result.rmse = rmse(usable, reference);
  result.psnr = psnr(usable, reference);
  result.relative_mse = relative_mse(usable, reference);
  result.ssim = ssim(usable, reference);
  const std::vector<double> blocks = block_rmse(usable, reference);
  result.worst_block_rmse = *std::max_element(blocks.begin(), blocks.end());
  result.missed_blocks = static_cast<double>(missed_blocks(usable, reference, samples));
  result.seam = seam_visibility(usable, reference);
  result.relmse = relmse(usable, reference);
  result.mean_ratio = mean_ratio(usable, reference);
  result.border_step = border_step(usable);
  result.negative_share = negative_share(usable);
  return result;
}

}  // namespace quality
