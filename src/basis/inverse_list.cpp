#include "freqsynth/basis/inverse_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "freqsynth/basis/dct.h"

namespace freqsynth {
namespace {

/// Pixel change per unit of amplitude change: by Parseval the mean squared change of the 64 pixels
/// of a block is the sum of squares of these.
double pixel_change(double amplitude, std::size_t term) {
  return amplitude / (amplitude_of_coefficient(term) * std::sqrt(double{max_terms}));
}

}  // namespace

/// The pixels of the block that a position lies in, or on the border of, in equal shares. Beyond
/// the block's own border lie the neighbour's pixels, which get theirs there.
void set_pixels(const SequencePosition& position, detail::SampleRow& row) {
  const auto touched = [](double s) {
    const double x = s * block_size;
    const double below = std::floor(x);
    std::vector<std::size_t> pixels;
    if (below == x && x > 0) pixels.push_back(static_cast<std::size_t>(below) - 1);
    if (x < block_size) pixels.push_back(static_cast<std::size_t>(below));
    return std::pair(pixels, below == x ? 0.5f : 1.0f);
  };
  const auto [columns, across] = touched(position.s);
  const auto [rows, down] = touched(position.t);
  row.pixel_weight = across * down;
  for (const std::size_t y : rows) {
    for (const std::size_t x : columns) {
      row.pixels[row.pixel_count++] = static_cast<std::uint8_t>(y * block_size + x);
    }
  }
}

/// Expected energy of the terms when it falls with the third power of the frequency, as that of
/// edges does.
struct EdgeSpectrum {
  std::array<double, max_terms> energy{};  // of each term but the constant one
  std::array<double, max_terms> tail{};    // of it and of all frequencies that come later

  EdgeSpectrum() {
    constexpr std::size_t finest = 64;  // frequencies beyond hold next to nothing
    const auto density = [](std::size_t u, std::size_t v) {
      return std::pow(static_cast<double>(u * u + v * v), -1.5);
    };
    double rest = 0;
    for (std::size_t v = 0; v < finest; ++v) {
      for (std::size_t u = v == 0 ? 1 : 0; u < finest; ++u) rest += density(u, v);
    }
    for (std::size_t i = 1; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      energy[i] = density(f.u, f.v);
      tail[i] = rest;
      rest -= energy[i];
    }
  }
};

/// The state after the newest entry.
struct InverseList::Builder {
  explicit Builder(const InverseListSettings& s) : settings(s), sequence(s.seed) {}

  void build(Chunk& chunk, std::size_t index);

  InverseListSettings settings;
  SampleSequence sequence;
  NormalInverse normal;
};

void InverseList::Builder::build(Chunk& chunk, std::size_t index) {
  const std::size_t slot = index % chunk_size;
  Chunk::Cold& cold = chunk.cold[slot];
  detail::SampleRow& row = chunk.rows[slot];
  const SequencePosition position = sequence[index];
  chunk.positions[slot] = position;

  std::array<double, max_terms> a;
  evaluate_terms(position.s, position.t, a);
  normal.add_sample(a);
  const std::size_t terms = normal.terms();
  cold.gain.assign(terms, 0);
  detail::multiply(normal.inverse().values.data(), a.data(), terms, cold.gain.data());

  set_pixels(position, row);
  row.terms = static_cast<std::uint32_t>(terms);
  double change = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    (i < terms ? row.fit : row.rest)[i] = static_cast<float>(a[i]);
    if (i >= terms) continue;
    row.gain[i] = static_cast<float>(cold.gain[i]);
    change += std::pow(pixel_change(cold.gain[i], i), 2);
  }
  row.change = static_cast<float>(change);
  double fitted = 0;
  for (std::size_t i = 0; i < terms; ++i) fitted += a[i] * cold.gain[i];
  row.residual = static_cast<float>(1 - fitted);

  const double scheduled = 1 + std::floor(static_cast<double>(index) / settings.samples_per_term);
  if (terms < settings.max_terms && static_cast<double>(terms) < scheduled) {
    std::vector<double> step(terms);
    if (const double delta = normal.add_term(step); delta > 0) {
      cold.border_row = std::make_unique<detail::BorderRow>();
      detail::BorderRow& border = *cold.border_row;
      const double own = pixel_change(1, terms);
      double border_change = own * own;
      double cross = 0;
      for (std::size_t i = 0; i < terms; ++i) {
        border.b[i] = static_cast<float>(normal.normal()(terms, i));
        border.step[i] = static_cast<float>(step[i]);
        const double moved = pixel_change(step[i], i);
        border_change += moved * moved;
        cross += moved * pixel_change(cold.gain[i], i);
      }
      border.step[terms] = 1;
      border.inverse_delta = static_cast<float>(1 / delta);
      border.change = static_cast<float>(border_change);
      border.cross = static_cast<float>(cross);
      border.delta = static_cast<float>(delta);
      cold.border = std::move(step);
      row.border = &border;
    }
  }

  cold.terms = normal.terms();
  const TermMatrix& inverse = normal.inverse();
  static const EdgeSpectrum spectrum;
  for (std::size_t i = 0; i < max_terms; ++i) {
    // A term in the fit has the variance of least squares. One that is not is wrong by all that it
    // holds, a share of what the fit leaves over.
    cold.variances[i] = static_cast<float>(
        i < cold.terms ? inverse(i, i) / std::pow(amplitude_of_coefficient(i), 2)
                       : max_terms * spectrum.energy[i] / spectrum.tail[cold.terms]);
  }
  cold.inverse.reserve(cold.terms * (cold.terms + 1) / 2);
  for (std::size_t i = 0; i < cold.terms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      cold.inverse.push_back(0.5 * (inverse(i, j) + inverse(j, i)));
    }
  }
}

InverseList::InverseList(const InverseListSettings& settings)
    : settings_(settings), chunks_((SampleSequence::max_size + chunk_size - 1) / chunk_size) {
  if (!(settings.samples_per_term >= 1 && std::isfinite(settings.samples_per_term))) {
    throw std::invalid_argument("freqsynth: samples_per_term is " +
                                std::to_string(settings.samples_per_term) +
                                ", not a finite number of at least 1");
  }
  if (settings.max_terms == 0 || settings.max_terms > freqsynth::max_terms) {
    throw std::invalid_argument("freqsynth: max_terms is " + std::to_string(settings.max_terms) +
                                ", not in 1..64");
  }
  builder_ = std::make_unique<Builder>(settings);
}

InverseList::~InverseList() {
  for (const auto& chunk : chunks_) delete chunk.load(std::memory_order_relaxed);
}

void InverseList::reserve(std::size_t count) const {
  if (count > size()) grow(count);
}

void InverseList::grow(std::size_t count) const {
  // A count of 0 comes from the largest index there is, plus 1.
  if (count == 0 || count > SampleSequence::max_size) {
    throw std::invalid_argument("freqsynth: an inverse list of " + std::to_string(count) +
                                " entries exceeds " + std::to_string(SampleSequence::max_size));
  }
  const std::lock_guard lock(growing_);
  for (std::size_t index = size(); index < count; ++index) {
    auto& chunk = chunks_[index / chunk_size];
    if (index % chunk_size == 0) chunk.store(new Chunk, std::memory_order_relaxed);
    builder_->build(*chunk.load(std::memory_order_relaxed), index);
    size_.store(index + 1, std::memory_order_release);
  }
}

}  // namespace freqsynth
