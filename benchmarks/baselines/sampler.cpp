// SPDX-License-Identifier: MIT
#include "sampler.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace baselines {
namespace {

std::size_t column_of(double position, std::size_t size) {
  return std::min(static_cast<std::size_t>(std::max(position, 0.0)), size - 1);
}

}  // namespace

std::uint64_t scatter(std::uint64_t seed) {
  seed += 0x9e3779b97f4a7c15U;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9U;
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebU;
  return seed ^ (seed >> 31);
}

Rectangle image_plane(const Job& job) {
  return {0, 0, static_cast<double>(job.width), static_cast<double>(job.height)};
}

double rate(const Job& job) {
  return static_cast<double>(job.samples) / static_cast<double>(job.width * job.height);
}

std::size_t pixel_at(double x, double y, std::size_t width, std::size_t height) {
  return column_of(y, height) * width + column_of(x, width);
}

Sampler::Sampler(const Radiance& radiance, const Job& job)
    : radiance_(radiance),
      job_(job),
      first_pixel_(scatter(job.seed)),
      counts_(job.width * job.height, 0) {
  if (!radiance) throw std::invalid_argument("the radiance function must not be empty");
  if (counts_.empty()) throw std::invalid_argument("the image must have at least one pixel");
  if (job.samples == 0) throw std::invalid_argument("at least one sample must be allowed");
}

std::uint64_t Sampler::count(double& x, double& y) {
  if (left() == 0) throw std::logic_error("all samples of the job are taken");
  x = std::clamp(x, 0.0, static_cast<double>(job_.width));
  y = std::clamp(y, 0.0, static_cast<double>(job_.height));
  const std::size_t pixel = pixel_at(x, y, job_.width, job_.height);
  ++taken_;
  return ((first_pixel_ + pixel) << 24) + counts_[pixel]++;
}

Sample Sampler::take(double x, double y) {
  Sample sample{x, y, {}};
  const std::uint64_t id = count(sample.x, sample.y);
  radiance_(sample.x, sample.y, id, sample.rgb);
  return sample;
}

void Sampler::take_with_features(double x, double y, std::span<float> values) {
  const std::uint64_t id = count(x, y);
  if (job_.features == 0) {
    radiance_(x, y, id, values.first<3>());
  } else {
    job_.radiance_and_features(x, y, id, values);
  }
}

Sample Sampler::take_in(const Rectangle& area, Random& random) {
  // In this order: that of a call's arguments is not specified.
  const double x = area.left + random.uniform() * area.width();
  const double y = area.top + random.uniform() * area.height();
  return take(x, y);
}

Rendering Sampler::rendering() const {
  Rendering rendering;
  rendering.width = job_.width;
  rendering.height = job_.height;
  rendering.pixels.assign(counts_.size() * 3, 0.0f);
  rendering.samples = counts_;
  return rendering;
}

void for_each_equal_area(const Rectangle& area, std::uint64_t count, const VisitRectangle& visit) {
  const double total = static_cast<double>(count);
  const auto rows = static_cast<std::uint64_t>(
      std::clamp(std::round(std::sqrt(total * area.height() / area.width())), 1.0, total));
  // Row r holds (r + 1) count / rows - r count / rows cells, without the product, which may
  // overflow.
  const std::uint64_t whole = count / rows;
  const std::uint64_t rest = count % rows;
  std::uint64_t before = 0;
  for (std::uint64_t row = 0; row < rows; ++row) {
    const std::uint64_t columns = whole + (row + 1) * rest / rows - row * rest / rows;
    const double top = area.top + area.height() * (static_cast<double>(before) / total);
    before += columns;
    const double bottom = area.top + area.height() * (static_cast<double>(before) / total);
    const double step = area.width() / static_cast<double>(columns);
    for (std::uint64_t column = 0; column < columns; ++column) {
      const double left = area.left + step * static_cast<double>(column);
      visit({left, top, left + step, bottom});
    }
  }
}

void for_each_stratum(const Job& job, const VisitRectangle& visit) {
  const std::uint64_t pixels = job.width * job.height;
  if (job.samples % pixels != 0) {
    for_each_equal_area(image_plane(job), job.samples, visit);
    return;
  }
  const std::uint64_t per_pixel = job.samples / pixels;
  auto rows = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(per_pixel)));
  while (per_pixel % rows != 0) --rows;
  const std::uint64_t columns = per_pixel / rows;
  const double width = 1 / static_cast<double>(columns);
  const double height = 1 / static_cast<double>(rows);
  for (std::size_t y = 0; y < job.height; ++y) {
    for (std::size_t x = 0; x < job.width; ++x) {
      for (std::uint64_t row = 0; row < rows; ++row) {
        for (std::uint64_t column = 0; column < columns; ++column) {
          const double left = static_cast<double>(x) + width * static_cast<double>(column);
          const double top = static_cast<double>(y) + height * static_cast<double>(row);
          visit({left, top, left + width, top + height});
        }
      }
    }
  }
}

}  // namespace baselines
