// SPDX-License-Identifier: MIT
#include "pictures.h"

#include <array>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "common/picture.h"
#include "measure.h"
#include "named_fields.h"
#include "scenes/scene.h"

namespace field_cases {
namespace {

// A part of a picture: columns and rows from .. to - 1.
struct Window {
  std::size_t left = 0, top = 0, right = 0, bottom = 0;
};

// A window of a picture, gray, each pixel `times` pixels wide and high.
::Picture enlarge(const Picture& picture, const Window& window, std::size_t times) {
  ::Picture large;
  large.width = (window.right - window.left) * times;
  large.height = (window.bottom - window.top) * times;
  for (std::size_t j = 0; j < large.height; ++j) {
    for (std::size_t i = 0; i < large.width; ++i) {
      const double value = picture.at(window.left + i / times, window.top + j / times);
      large.pixels.insert(large.pixels.end(), 3, static_cast<float>(value));
    }
  }
  return large;
}

struct Subject {
  std::string name;
  Sampler sampler;
  Picture right;
  Window window;
  std::size_t times;
};

Subject subject_of(const std::string& name, const Field& field, const Window& window,
                   std::size_t times) {
  Picture right{field.width, field.height, 1, {}, 0};
  for (const double value : right_pixels(field)) right.pixels.push_back(static_cast<float>(value));
  return {name, sampler_of(field), std::move(right), window, times};
}

// The two bars beside the middle of the fan.
Subject fan() {
  const std::shared_ptr<const scenes::Scene> scene =
      scenes::make_scene({.name = "fan", .width = 512, .height = 512});
  Picture right{512, 512, 1, {}, 0};
  std::array<float, 3> rgb{};
  for (long j = 0; j < 512; ++j) {
    for (long i = 0; i < 512; ++i) {
      if (!scene->pixel_average(i, j, rgb)) throw std::runtime_error("fan: no exact averages");
      right.pixels.push_back(rgb[0]);
    }
  }
  const Sampler sampler = [scene](double x, double y, std::uint64_t id, std::span<float> values) {
    std::array<float, 3> colour{};
    scene->radiance(x, y, id, colour);
    values[0] = colour[0];
  };
  return {"fan", sampler, std::move(right), {226, 360, 286, 400}, 6};
}

}  // namespace

void write_pictures(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const std::vector<Subject> subjects{
      subject_of("V5_rectangle", rectangle_and_line(0), {16, 12, 104, 80}, 4),
      subject_of("V5_rectangle_shifted", rectangle_and_line(0.4), {16, 12, 104, 80}, 4),
      subject_of("V6_stems", text_stems(0), {0, 0, 64, 48}, 6),
      subject_of("V8_fence_1", fence(1), {0, 0, 64, 32}, 6),
      subject_of("V8_fence_0.25", fence(0.25), {0, 0, 64, 32}, 6),
      fan()};
  for (const Subject& subject : subjects) {
    const std::size_t width = subject.right.width;
    const std::size_t height = subject.right.height;
    for (const int rate : {1, 4}) {
      const auto samples = static_cast<std::uint64_t>(rate) * width * height;
      std::vector<::Picture> row;
      for (const Picture& picture :
           {subject.right, synthesize(subject.sampler, settings_of(width, height), rate, 1),
            jittered(subject.sampler, width, height, 1, samples, 1)}) {
        row.push_back(enlarge(picture, subject.window, subject.times));
      }
      write_picture(folder + "/" + subject.name + "_" + std::to_string(rate) + "spp.png",
                    contact_sheet(row, row.size()));
    }
  }
}

}  // namespace field_cases
