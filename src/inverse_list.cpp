#include "freqsynth/inverse_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "freqsynth/dct.h"

namespace freqsynth {
namespace {

/// Pixel change per unit of amplitude change: by Parseval the mean squared change of the 64 pixels
/// of a block is the sum of squares of these.
double pixel_change(double amplitude, std::size_t term) {
  return amplitude / (amplitude_of_coefficient(term) * std::sqrt(double{max_terms}));
}

}  // namespace

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

  row.terms = static_cast<std::uint32_t>(terms);
  double change = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    (i < terms ? row.fit : row.rest)[i] = static_cast<float>(a[i]);
    if (i >= terms) continue;
    row.gain[i] = static_cast<float>(cold.gain[i]);
    change += std::pow(pixel_change(cold.gain[i], i), 2);
  }
  row.change = static_cast<float>(change);

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
      cold.border = std::move(step);
      row.border = &border;
    }
  }

  cold.terms = normal.terms();
  const TermMatrix& inverse = normal.inverse();
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
