// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/edge_spectrum.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/inverse_list_exact.inl"
#include "freqsynth/basis/normal_inverse.h"

namespace freqsynth {
namespace detail {

/// Pixel change per unit of amplitude change: by Parseval the mean squared change of the 64 pixels
/// of a block is the sum of squares of these.
inline double pixel_change(double amplitude, std::size_t term) {
  return amplitude / (amplitude_of_coefficient(term) * std::sqrt(double{max_terms}));
}

/// Pixels along one axis that get a share of a sample.
struct TouchedPixels {
  std::size_t first = 0, count = 0;
  double shares[2] = {};
};

/// The pixels of the block that the interval of length `side` <= 1 around `centre` lies in, in
/// pixels.
inline TouchedPixels touched_pixels(double centre, double side) {
  const double low = centre - side / 2, high = centre + side / 2;
  TouchedPixels touched;
  for (std::size_t pixel = 0; pixel < block_size; ++pixel) {
    const auto left = static_cast<double>(pixel);
    const double share = (std::min(high, left + 1) - std::max(low, left)) / side;
    if (share <= 0) continue;
    if (touched.count == 0) touched.first = pixel;
    touched.shares[touched.count++] = share;
  }
  return touched;
}

/// The pixel that a position lies in; none for one on the border between pixels.
inline std::uint8_t own_pixel(const SequencePosition& position) {
  const double x = position.s * block_size, y = position.t * block_size;
  const double column = std::floor(x), row = std::floor(y);
  if (x == column || y == row) return SampleRow::no_pixel;
  return static_cast<std::uint8_t>(row * block_size + column);
}

/// A sample stands for the square around it that reaches to its neighbours, but for no more than
/// the area of a pixel; each pixel of the block gets the share of the square that lies in it. What
/// lies beyond the block's border falls to the neighbour's pixels, which get theirs there; and of a
/// sample on that border half is left out, because both blocks would be wrong where the border is
/// an edge, too.
inline void set_pixels(const SequencePosition& position, SampleRow& row) {
  // A little narrower than the distance to the neighbours, which is rounder than a square.
  constexpr double reach = 0.85;
  const double side = std::min(1.0, reach * double{position.spacing} * block_size);
  const TouchedPixels columns = touched_pixels(position.s * block_size, side);
  const TouchedPixels rows = touched_pixels(position.t * block_size, side);
  const auto inside = [](double place) { return place > 0 && place < 1; };
  const double counts = inside(position.s) && inside(position.t) ? 1 : 0.5;
  row.pixel_count = 0;
  for (std::size_t y = 0; y < rows.count; ++y) {
    for (std::size_t x = 0; x < columns.count; ++x) {
      const double share = counts * rows.shares[y] * columns.shares[x];
      row.pixel_weights[row.pixel_count] = static_cast<float>(share);
      const std::size_t pixel = (rows.first + y) * block_size + columns.first + x;
      row.pixels[row.pixel_count++] = static_cast<std::uint8_t>(pixel);
    }
  }
  // Those without a share lie in the same lines of the cache.
  for (std::size_t p = row.pixel_count; p < 4; ++p) {
    row.pixels[p] = row.pixels[p % row.pixel_count];
    row.pixel_weights[p] = 0;
  }
}

}  // namespace detail

FREQSYNTH_INLINE InverseList::Chunk::~Chunk() {
  for (const auto& one : exact) delete one.load(std::memory_order_relaxed);
  for (const detail::SampleRow& row : rows) delete row.border;
}

/// The state after the newest entry.
struct InverseList::Builder {
  explicit Builder(const InverseListSettings& settings)
      : samples_per_term(settings.samples_per_term),
        most_terms(settings.max_terms),
        sequence(settings.seed, settings.positions) {}

  void build(Chunk& chunk, std::size_t index);
  void border(std::size_t terms, std::span<const double> gain, detail::SampleRow& row,
              std::unique_ptr<detail::BorderRow> memory);
  void set_variances(std::span<float, max_terms> variances) const;

  double samples_per_term;
  std::size_t most_terms;
  std::array<std::uint32_t, max_terms> owned_samples = {};  // of each pixel
  std::mutex growing;
  SampleSequence sequence;
  NormalInverse normal;
};

/// Builds the next entry. What may throw comes first, so that an entry is built whole or not at
/// all.
FREQSYNTH_INLINE void InverseList::Builder::build(Chunk& chunk, std::size_t index) {
  const std::size_t slot = index % chunk_size;
  const SequencePosition position = sequence[index];
  const double scheduled = 1 + std::floor(static_cast<double>(index) / samples_per_term);
  const std::size_t terms = std::max<std::size_t>(normal.terms(), 1);
  const bool term_is_due = terms < most_terms && static_cast<double>(terms) < scheduled;
  auto memory = term_is_due ? std::make_unique<detail::BorderRow>() : nullptr;

  chunk.positions[slot] = position;
  std::array<double, max_terms> a, gain;
  evaluate_terms(position.s, position.t, a);
  normal.add_sample(a);
  detail::multiply(normal.inverse().values.data(), a.data(), terms, gain.data());

  detail::SampleRow& row = chunk.rows[slot];
  detail::set_pixels(position, row);
  row.own_pixel = detail::own_pixel(position);
  if (row.own_pixel != detail::SampleRow::no_pixel) {
    std::uint32_t& owned = owned_samples[row.own_pixel];
    row.own_share = owned > 0 ? 1 / static_cast<float>(owned) : 0;
    ++owned;
  }
  row.terms = static_cast<std::uint32_t>(terms);
  double change = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    row.gain[i] = static_cast<float>(i < terms ? gain[i] : a[i]);
    if (i >= terms) continue;
    row.fit[i] = static_cast<float>(a[i]);
    change += std::pow(detail::pixel_change(gain[i], i), 2);
  }
  row.change = static_cast<float>(change);
  double fitted = 0;
  for (std::size_t i = 0; i < terms; ++i) fitted += a[i] * gain[i];
  row.residual = static_cast<float>(1 - fitted);

  if (term_is_due) border(terms, gain, row, std::move(memory));
  chunk.terms[slot] = static_cast<std::uint8_t>(normal.terms());
  set_variances(chunk.variances[slot]);
}

/// Adds a term, if the samples determine it.
FREQSYNTH_INLINE void InverseList::Builder::border(std::size_t terms, std::span<const double> gain,
                                                   detail::SampleRow& row,
                                                   std::unique_ptr<detail::BorderRow> memory) {
  std::array<double, max_terms> steps;
  const std::span<double> step = std::span(steps).first(terms);
  const double delta = normal.add_term(step);
  if (!(delta > 0)) return;
  detail::BorderRow& border = *memory;
  const double own = detail::pixel_change(1, terms);
  double change = own * own;
  double cross = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    border.b[i] = static_cast<float>(normal.normal()(terms, i));
    border.step[i] = static_cast<float>(step[i]);
    const double moved = detail::pixel_change(step[i], i);
    change += moved * moved;
    cross += moved * detail::pixel_change(gain[i], i);
  }
  border.step[terms] = 1;
  border.inverse_delta = static_cast<float>(1 / delta);
  border.change = static_cast<float>(change);
  border.cross = static_cast<float>(cross);
  border.delta = static_cast<float>(delta);
  row.border = memory.release();
}

FREQSYNTH_INLINE void InverseList::Builder::set_variances(
    std::span<float, max_terms> variances) const {
  const detail::EdgeSpectrum& spectrum = detail::edge_spectrum();
  for (std::size_t i = 0; i < max_terms; ++i) {
    // A term in the fit has the variance of least squares. One that is not is wrong by all that it
    // holds, a share of what the fit leaves over.
    variances[i] = static_cast<float>(
        i < normal.terms() ? normal.inverse()(i, i) / std::pow(amplitude_of_coefficient(i), 2)
                           : max_terms * spectrum.energy[i] / spectrum.tail[normal.terms()]);
  }
}

FREQSYNTH_INLINE InverseList::InverseList(const InverseListSettings& settings)
    : settings_(settings), chunks_((SampleSequence::max_size + chunk_size - 1) / chunk_size) {
  const double rate = settings.samples_per_term;
  detail::require(rate >= 1 && detail::is_finite(rate), "samples_per_term", rate,
                  "a finite number of at least 1");
  if (settings.max_terms == 0 || settings.max_terms > freqsynth::max_terms) {
    detail::refuse("max_terms is " + std::to_string(settings.max_terms) + ", not in 1..64");
  }
  auto builder = std::make_unique<Builder>(settings);
  replay_ = new Replay;
  builder_ = builder.release();
}

FREQSYNTH_INLINE InverseList::~InverseList() {
  for (const auto& chunk : chunks_) delete chunk.load(std::memory_order_relaxed);
  delete replay_;
  delete builder_;
}

FREQSYNTH_INLINE void InverseList::reserve(std::size_t count) const {
  if (count > size()) grow(count);
}

FREQSYNTH_INLINE void InverseList::grow(std::size_t count) const {
  // A count of 0 comes from the largest index there is, plus 1.
  if (count == 0 || count > SampleSequence::max_size) {
    detail::refuse("an inverse list of " + std::to_string(count) + " entries exceeds " +
                   std::to_string(SampleSequence::max_size));
  }
  // A chunk at a time, so that others need not wait for the last one.
  while (size() < count) {
    const std::lock_guard lock(builder_->growing);
    const std::size_t first = size();
    const std::size_t end = std::min(count, (first / chunk_size + 1) * chunk_size);
    auto& chunk = chunks_[first / chunk_size];
    if (chunk.load(std::memory_order_relaxed) == nullptr) {
      chunk.store(new Chunk, std::memory_order_relaxed);
    }
    for (std::size_t index = first; index < end; ++index) {
      builder_->build(*chunk.load(std::memory_order_relaxed), index);
      size_.store(index + 1, std::memory_order_release);
    }
  }
}

}  // namespace freqsynth
