// SPDX-License-Identifier: MIT
// Samples straight to JPEG, measured: what a synthesis to a quality costs and gives, and how a file
// made of fitted coefficients compares with one made of pixels. Prints Markdown.

#include <OpenImageIO/argparse.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "baselines/methods.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth/jpeg/jpeg.h"
#include "pixels_to_jpeg.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/scene_radiance.h"
#include "scenes/scene.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
using Pixels = std::vector<float>;  // linear RGB

constexpr std::array qualities{50, 75, 90};

/// A scene, and the pictures to compare with.
struct Subject {
  std::string name;
  std::unique_ptr<scenes::Scene> scene;
  std::size_t size = 0;
  Pixels light;    // averages of radiance
  Pixels display;  // averages of display-encoded values, decoded
};

/// sRGB in 0..1.
float encoded(float linear) { return freqsynth::DisplayEncoding{}.encode(linear) / 255; }

/// The radiance as display-encoded values in 0..1.
baselines::Radiance in_display(const baselines::Radiance& radiance) {
  return [radiance](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    radiance(x, y, id, rgb);
    std::transform(rgb.begin(), rgb.end(), rgb.begin(), encoded);
  };
}

/// Linear values, which is what quality::Metrics takes, of sRGB in 0..1.
Pixels decoded(Pixels pixels) {
  for (float& value : pixels) value = freqsynth::DisplayEncoding{}.decode(255 * value);
  return pixels;
}

Subject make_subject(const std::string& name, std::size_t size, std::size_t samples,
                     freqsynth::ThreadPool& pool) {
  Subject subject{.name = name, .scene = nullptr, .size = size, .light = {}, .display = {}};
  subject.scene = scenes::make_scene(
      {.name = name, .width = static_cast<int>(size), .height = static_cast<int>(size)});
  const baselines::Radiance radiance = quality::radiance_of(*subject.scene);
  const quality::ReferenceSettings settings{size, size, samples, 1};
  subject.light = quality::render_reference(radiance, nullptr, settings, pool).pixels();
  subject.display =
      decoded(quality::render_reference(in_display(radiance), nullptr, settings, pool).pixels());
  return subject;
}

/// The pixels that a decoder makes of a file.
Pixels pixels_of(const Bytes& file) {
  OIIO::Filesystem::IOMemReader memory(file.data(), file.size());
  const auto input = OIIO::ImageInput::open("memory.jpg", nullptr, &memory);
  if (!input) throw std::runtime_error(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  Pixels pixels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) * 3);
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data())) {
    throw std::runtime_error(input->geterror());
  }
  return decoded(std::move(pixels));
}

/// The ordinary way: pixels, rounded to 8 bits, to libjpeg.
Bytes file_of_pixels(const Pixels& linear, std::size_t size, int quality) {
  Bytes bytes(linear.size());
  std::transform(linear.begin(), linear.end(), bytes.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::lround(255 * encoded(value)));
  });
  return freqsynth::bench::pixels_to_jpeg(bytes, size, size,
                                          {.quality = quality, .pixels = JCS_RGB});
}

freqsynth::QuantizationSettings tables_of(int quality) {
  freqsynth::QuantizationSettings settings;
  settings.luminance = freqsynth::scale_table(freqsynth::luminance_table(), quality);
  settings.chrominance = freqsynth::scale_table(freqsynth::chrominance_table(), quality);
  return settings;
}

/// What freqsynth makes of a scene.
struct Synthesis {
  freqsynth::FrequencyImage image;
  std::uint64_t samples = 0;
};

Synthesis synthesize(const Subject& subject, const freqsynth::StopRule& stop, bool display,
                     const std::optional<freqsynth::QuantizationTarget>& target,
                     freqsynth::ThreadPool& pool) {
  freqsynth::SynthesisSettings settings{.width = subject.size, .height = subject.size};
  settings.quantization = target;
  freqsynth::Synthesizer engine(settings);
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      subject.scene->radiance(requests[i].x, requests[i].y, quality::id_of(requests[i], 0),
                              values.subspan(3 * i).first<3>());
    }
  };
  if (display) {
    engine.run(freqsynth::DisplaySampler(sampler, 3), stop, pool);
  } else {
    engine.run(sampler, stop, pool);
  }
  return {engine.finished_image(), engine.stats().samples};
}

Bytes file_of_coefficients(const freqsynth::FrequencyImage& image, int quality) {
  return freqsynth::encode_jpeg(freqsynth::quantize(image, tables_of(quality)));
}

struct Likeness {
  double psnr = 0, ssim = 0;
};

Likeness compare(const Pixels& picture, const Pixels& reference, std::size_t size) {
  const quality::PictureView a{size, size, picture}, b{size, size, reference};
  return {quality::psnr(a, b), quality::ssim(a, b)};
}

/// A synthesis that ends by itself, against the JPEG file of the converged picture.
void print_until_quality(const std::vector<Subject>& subjects, freqsynth::ThreadPool& pool) {
  std::printf(
      "| scene | quality | samples per pixel | file | PSNR | SSIM | unweighted: file | PSNR | SSIM "
      "| converged: file | its PSNR to the scene | ours |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Subject& subject : subjects) {
    for (const int quality : qualities) {
      const Bytes converged = file_of_pixels(subject.display, subject.size, quality);
      const Pixels goal = pixels_of(converged);
      const freqsynth::QuantizationTarget target =
          freqsynth::quantization_target(tables_of(quality), 3);
      const Synthesis weighted = synthesize(subject, {}, true, target, pool);
      const Synthesis unweighted =
          synthesize(subject, {.samples = weighted.samples}, true, std::nullopt, pool);
      const Bytes file = file_of_coefficients(weighted.image, quality);
      const Bytes other = file_of_coefficients(unweighted.image, quality);
      const Likeness ours = compare(pixels_of(file), goal, subject.size);
      const Likeness theirs = compare(pixels_of(other), goal, subject.size);
      std::printf(
          "| %s | %d | %.2f | %zu | %.2f | %.4f | %zu | %.2f | %.4f | %zu | %.2f | %.2f |\n",
          subject.name.c_str(), quality,
          static_cast<double>(weighted.samples) / static_cast<double>(subject.size * subject.size),
          file.size(), ours.psnr, ours.ssim, other.size(), theirs.psnr, theirs.ssim,
          converged.size(), compare(goal, subject.display, subject.size).psnr,
          compare(pixels_of(file), subject.display, subject.size).psnr);
      std::fflush(stdout);
    }
  }
}

/// Files of one sample per pixel, against the converged picture without compression.
void print_direct(const std::vector<Subject>& subjects, freqsynth::ThreadPool& pool) {
  std::printf(
      "| scene | averages of | quality | pixels: file | PSNR | SSIM | coefficients: file | PSNR | "
      "SSIM |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Subject& subject : subjects) {
    const std::uint64_t samples = std::uint64_t{subject.size} * subject.size;
    const baselines::Job job{subject.size, subject.size, samples, 2};
    for (const bool display : {true, false}) {
      const baselines::Radiance radiance = quality::radiance_of(*subject.scene);
      const auto& jittered = baselines::method("jittered-box").render;
      const Pixels ordinary = display ? decoded(jittered(in_display(radiance), job).pixels)
                                      : jittered(radiance, job).pixels;
      const Synthesis fit = synthesize(subject, {.samples = samples}, display, std::nullopt, pool);
      const freqsynth::FrequencyImage image =
          display ? fit.image : freqsynth::encode_pixels(fit.image);
      const Pixels& reference = display ? subject.display : subject.light;
      for (const int quality : qualities) {
        const Bytes pixels = file_of_pixels(ordinary, subject.size, quality);
        const Bytes coefficients = file_of_coefficients(image, quality);
        const Likeness theirs = compare(pixels_of(pixels), reference, subject.size);
        const Likeness ours = compare(pixels_of(coefficients), reference, subject.size);
        std::printf("| %s | %s | %d | %zu | %.2f | %.4f | %zu | %.2f | %.4f |\n",
                    subject.name.c_str(), display ? "display values" : "light", quality,
                    pixels.size(), theirs.psnr, theirs.ssim, coefficients.size(), ours.psnr,
                    ours.ssim);
      }
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    int size = 512;
    int samples = 1024;
    std::vector<std::string> names;
    OIIO::ArgParse parser;
    parser.intro("freqsynth_jpeg_quality: samples straight to JPEG, measured");
    parser.usage("freqsynth_jpeg_quality [options] SCENE...");
    parser.exit_on_error(false);
    parser.arg("--size %d:N", &size).help("Side of the pictures in pixels (512)");
    parser.arg("--reference %d:N", &samples)
        .help("Samples per pixel of the reference, even (1024)");
    parser.arg("filename").hidden().action([&](OIIO::cspan<const char*> words) {
      names.emplace_back(words[0]);
    });
    if (parser.parse_args(argc, argv) < 0) throw std::invalid_argument(parser.geterror());
    if (size < 16 || size > 65500 || samples < 2) {
      throw std::invalid_argument("--size or --reference is out of range");
    }
    freqsynth::ThreadPool pool;
    std::vector<Subject> subjects;
    for (const std::string& name : names) {
      subjects.push_back(make_subject(name, static_cast<std::size_t>(size),
                                      static_cast<std::size_t>(samples), pool));
      Subject& subject = subjects.back();
      // A picture is called by its name alone.
      if (name.starts_with("image:")) subject.name = OIIO::Filesystem::filename(name.substr(6));
    }
    print_direct(subjects, pool);
    std::printf("\n");
    print_until_quality(subjects, pool);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_jpeg_quality: %s\n", error.what());
    return 1;
  }
}
