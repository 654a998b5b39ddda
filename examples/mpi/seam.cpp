// SPDX-License-Identifier: MIT
// Whether a picture in windows shows where they meet: its errors there and elsewhere, and those of
// a picture that was made in one piece.
//   freqsynth_mpi_seam CxR WHOLE WINDOWS TRUTH

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "scenes/picture_file.h"
#include "window_plan.h"

namespace {

/// A mean of squares.
class Squares {
 public:
  void add(double value) {
    sum_ += value * value;
    ++count_;
  }
  [[nodiscard]] double root() const { return std::sqrt(sum_ / static_cast<double>(count_)); }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

struct Errors {
  Squares all;   ///< of all pixels
  Squares near;  ///< of those within 8 pixels of where windows meet
  Squares step;  ///< of the difference of two pixels that lie in two windows
};

Errors errors_of(const scenes::PictureFile& picture, const scenes::PictureFile& truth,
                 const std::vector<freqsynth::PixelWindow>& windows) {
  // Whether two windows meet on the left of a column, or above a row.
  std::vector<bool> left(truth.width), top(truth.height);
  for (const auto& window : windows) {
    if (window.x > 0) left[window.x] = true;
    if (window.y > 0) top[window.y] = true;
  }
  const auto near = [](const std::vector<bool>& places, std::size_t at) {
    for (std::size_t i = at < 8 ? 0 : at - 7; i <= at + 8 && i < places.size(); ++i) {
      if (places[i]) return true;
    }
    return false;
  };
  const auto error = [&](std::size_t x, std::size_t y, std::size_t c) {
    const std::size_t i = (y * truth.width + x) * truth.channels + c;
    return double{picture.values[i]} - double{truth.values[i]};
  };
  Errors errors;
  for (std::size_t y = 0; y < truth.height; ++y) {
    for (std::size_t x = 0; x < truth.width; ++x) {
      const bool is_near = near(left, x) || near(top, y);
      for (std::size_t c = 0; c < truth.channels; ++c) {
        const double here = error(x, y, c);
        errors.all.add(here);
        if (is_near) errors.near.add(here);
        if (left[x]) errors.step.add(here - error(x - 1, y, c));
        if (top[y]) errors.step.add(here - error(x, y - 1, c));
      }
    }
  }
  return errors;
}

void compare(const char** arguments) {
  std::size_t columns = 0, rows = 0;
  read_size("CxR", arguments[1], columns, rows);
  const auto truth = scenes::read_picture_file(arguments[4]);
  const auto windows = farm::cut_windows(truth.width, truth.height, columns, rows);
  std::printf("              all  near borders  steps across\n");
  for (const auto& [name, file] : {std::pair{"whole", arguments[2]}, {"windows", arguments[3]}}) {
    const auto picture = scenes::read_picture_file(file);
    if (picture.size() != truth.size() || picture.width != truth.width) {
      throw std::runtime_error(std::string(file) + ": has another size than the truth");
    }
    const Errors errors = errors_of(picture, truth, windows);
    std::printf("%-8s %8.5f      %8.5f      %8.5f\n", name, errors.all.root(), errors.near.root(),
                errors.step.root());
  }
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    if (argc != 5) throw UsageError("usage: freqsynth_mpi_seam CxR WHOLE WINDOWS TRUTH");
    compare(argv);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_mpi_seam: %s\n", error.what());
    return 1;
  }
}
