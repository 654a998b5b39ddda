// SPDX-License-Identifier: MIT
// The kernels that hold pixels within what lies around them, for all instruction sets like those of
// kernels_body.inl, whose rules hold here.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// Sorts three, lane by lane.
template <class P>
FREQSYNTH_KERNEL_INLINE void sort(P& a, P& b, P& c) {
  const P low = lesser(a, b), high = greater(a, b);
  const P middle = lesser(high, c);
  c = greater(high, c);
  a = lesser(low, middle);
  b = greater(low, middle);
}

/// Sets what lies beside the rows.
FREQSYNTH_KERNEL_INLINE void pad(PaddedBlock& block, float value) {
  for (std::size_t y = 0; y < block_size; ++y) {
    float* row = block.values + PaddedBlock::first + y * PaddedBlock::stride;
    row[-1] = value;
    row[block_size] = value;
  }
}
FREQSYNTH_KERNEL_INLINE const float* row_of(const PaddedBlock& block, std::size_t y) {
  return block.values + PaddedBlock::first + y * PaddedBlock::stride;
}
FREQSYNTH_KERNEL_INLINE float* row_of(PaddedBlock& block, std::size_t y) {
  return block.values + PaddedBlock::first + y * PaddedBlock::stride;
}

FREQSYNTH_KERNEL
void known_means(const float* sums, const float* shares, PaddedBlock& low, PaddedBlock& high) {
  FREQSYNTH_ROUNDING_BEGIN
  const Float8 none = all_lanes<Float8>(PaddedBlock::none);
  pad(low, PaddedBlock::none);
  pad(high, -PaddedBlock::none);
  for (std::size_t y = 0; y < block_size; ++y) {
    const Float8 share = Float8::load(shares + y * block_size);
    const Float8 mean = Float8::load_unaligned(sums + y * block_size) * share;
    if_less(Float8{}, share, mean, none).store(row_of(low, y));
    if_less(Float8{}, share, mean, Float8{} - none).store(row_of(high, y));
  }
}

/// Writes the least lane and the greatest one.
FREQSYNTH_KERNEL_INLINE void ends_of(const Float8& least, const Float8& most, float* out) {
  alignas(32) float lows[8], highs[8];
  least.store(lows);
  most.store(highs);
  out[0] = lows[0];
  out[1] = highs[0];
  for (std::size_t i = 1; i < 8; ++i) {
    out[0] = lows[i] < out[0] ? lows[i] : out[0];
    out[1] = highs[i] > out[1] ? highs[i] : out[1];
  }
}

FREQSYNTH_KERNEL
void least_and_most(const PaddedBlock& low, const PaddedBlock& high, float* out) {
  FREQSYNTH_ROUNDING_BEGIN
  Float8 least = Float8::load(row_of(low, 0)), most = Float8::load(row_of(high, 0));
  for (std::size_t y = 1; y < block_size; ++y) {
    least = lesser(least, Float8::load(row_of(low, y)));
    most = greater(most, Float8::load(row_of(high, y)));
  }
  ends_of(least, most, out);
}

FREQSYNTH_KERNEL
void owned_means(const float* sums, const float* counts, float* out, float* ends) {
  FREQSYNTH_ROUNDING_BEGIN
  const Float8 none = all_lanes<Float8>(PaddedBlock::none);
  Float8 least = none, most = Float8{} - none;
  for (std::size_t i = 0; i < max_terms; i += 8) {
    const Float8 count = Float8::load(counts + i);
    const Float8 mean = quotient(Float8::load_unaligned(sums + i), count);
    const Float8 low = if_less(Float8{}, count, mean, none);
    low.store_unaligned(out + i);
    least = lesser(least, low);
    most = greater(most, if_less(Float8{}, count, mean, Float8{} - none));
  }
  ends_of(least, most, ends);
}

/// A number for each float, with the floats' order.
FREQSYNTH_KERNEL_INLINE int key_of(float value) {
  int key;
  __builtin_memcpy(&key, &value, sizeof key);
  return key ^ ((key >> 31) & 0x7fffffff);
}

/// The lanes in an order in which each `step` of them change places with the next ones.
template <std::size_t step, class Keys>
FREQSYNTH_KERNEL_INLINE Keys swapped(const Keys& x) {
  if constexpr (sizeof(Keys) == 8 * sizeof(int)) {
    if constexpr (step == 4) return Keys{x[4], x[5], x[6], x[7], x[0], x[1], x[2], x[3]};
    if constexpr (step == 2) return Keys{x[2], x[3], x[0], x[1], x[6], x[7], x[4], x[5]};
    if constexpr (step == 1) return Keys{x[1], x[0], x[3], x[2], x[5], x[4], x[7], x[6]};
  } else {
    if constexpr (step == 2) return Keys{x[2], x[3], x[0], x[1]};
    if constexpr (step == 1) return Keys{x[1], x[0], x[3], x[2]};
  }
}

/// Sum, greatest and least of the lanes of three, each in all lanes.
template <std::size_t step, class Keys>
FREQSYNTH_KERNEL_INLINE void fold(Keys& sum, Keys& most, Keys& least) {
  const Keys others = swapped<step>(most), more = swapped<step>(least);
  sum += swapped<step>(sum);
  most = others > most ? others : most;
  least = more < least ? more : least;
}

FREQSYNTH_KERNEL
float value_of_rank(const PaddedBlock& values, std::size_t rank, float least, float most) {
  FREQSYNTH_ROUNDING_BEGIN
  // Halves the range of keys, each time to the keys that there are.
  constexpr std::size_t bytes = FREQSYNTH_KERNEL_BYTES < 32 ? FREQSYNTH_KERNEL_BYTES : 32;
  constexpr std::size_t own = bytes / sizeof(int), count = max_terms / own;
  typedef int Keys __attribute__((vector_size(bytes)));
  Keys keys[count];
  for (std::size_t k = 0; k < count; ++k) {
    __builtin_memcpy(&keys[k], row_of(values, k * own / block_size) + k * own % block_size, bytes);
    keys[k] ^= (keys[k] >> 31) & 0x7fffffff;
  }
  int low = key_of(least), high = key_of(most);
  while (low < high) {
    const int middle = static_cast<int>((static_cast<long long>(low) + high) >> 1);
    const Keys lowest = low - Keys{}, highest = high - Keys{};
    Keys numbers = {}, below = lowest, above = highest;
    for (std::size_t k = 0; k < count; ++k) {
      const Keys is_below = keys[k] <= middle;
      numbers -= is_below;
      const Keys lower = is_below ? keys[k] : lowest;
      const Keys higher = is_below ? highest : keys[k];
      below = lower > below ? lower : below;
      above = higher < above ? higher : above;
    }
    fold<own / 2>(numbers, below, above);
    fold<own / 4>(numbers, below, above);
    if constexpr (own == 8) fold<1>(numbers, below, above);
    if (static_cast<std::size_t>(numbers[0]) > rank) {
      high = below[0];
    } else {
      low = above[0];
    }
  }
  const int bits = low ^ ((low >> 31) & 0x7fffffff);
  float value;
  __builtin_memcpy(&value, &bits, sizeof value);
  return value;
}

FREQSYNTH_KERNEL
bool extremes_around(const PaddedBlock& low, const PaddedBlock& high, const float* pixels,
                     float* least, float* most) {
  FREQSYNTH_ROUNDING_BEGIN
  Float8 lows[block_size], highs[block_size];
  for (std::size_t y = 0; y < block_size; ++y) {
    const float *l = row_of(low, y), *h = row_of(high, y);
    lows[y] = lesser(lesser(Float8::load_unaligned(l - 1), Float8::load(l)),
                     Float8::load_unaligned(l + 1));
    highs[y] = greater(greater(Float8::load_unaligned(h - 1), Float8::load(h)),
                       Float8::load_unaligned(h + 1));
  }
  Float8 outside = {};
  const Float8 one = all_lanes<Float8>(1.0f);
  for (std::size_t y = 0; y < block_size; ++y) {
    const std::size_t above = y > 0 ? y - 1 : 0;
    const std::size_t below = y + 1 < block_size ? y + 1 : block_size - 1;
    const Float8 lowest = lesser(lesser(lows[above], lows[y]), lows[below]);
    const Float8 highest = greater(greater(highs[above], highs[y]), highs[below]);
    lowest.store(least + y * block_size);
    highest.store(most + y * block_size);
    const Float8 pixel = Float8::load(pixels + y * block_size);
    outside = if_less(pixel, lowest, one, if_less(highest, pixel, one, outside));
  }
  alignas(32) float any[8];
  outside.store(any);
  float sum = 0;
  for (std::size_t i = 0; i < 8; ++i) sum += any[i];
  return sum > 0;
}

FREQSYNTH_KERNEL
void clamp_around(const PaddedBlock& low, const float* least, const float* most,
                  const float* counts, float slack, const float* whole, float* pixels) {
  FREQSYNTH_ROUNDING_BEGIN
  // The values in each column of three, sorted.
  PaddedBlock columns[3];
  for (std::size_t k = 0; k < 3; ++k) pad(columns[k], PaddedBlock::none);
  const Float8 none = all_lanes<Float8>(PaddedBlock::none);
  for (std::size_t y = 0; y < block_size; ++y) {
    Float8 a = y > 0 ? Float8::load(row_of(low, y - 1)) : none, b = Float8::load(row_of(low, y));
    Float8 c = y + 1 < block_size ? Float8::load(row_of(low, y + 1)) : none;
    sort(a, b, c);
    a.store(row_of(columns[0], y));
    b.store(row_of(columns[1], y));
    c.store(row_of(columns[2], y));
  }
  const Float8 few = all_lanes<Float8>(4.0f), six = all_lanes<Float8>(6.0f);
  const Float8 eight = all_lanes<Float8>(8.0f);
  const Float8 whole_low = all_lanes<Float8>(whole[0]), whole_high = all_lanes<Float8>(whole[1]);
  for (std::size_t y = 0; y < block_size; ++y) {
    Float8 sorted[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* row = row_of(columns[k], y);
      sorted[k][0] = Float8::load_unaligned(row - 1);
      sorted[k][1] = Float8::load(row);
      sorted[k][2] = Float8::load_unaligned(row + 1);
      sort(sorted[k][0], sorted[k][1], sorted[k][2]);
    }
    // Both ways sorted. The k-th of all is the least that the greatest of k values can be which
    // have all that come before them among them.
    const Float8 &low1 = sorted[0][1], &low2 = sorted[0][2];
    const Float8 &middle0 = sorted[1][0], &middle1 = sorted[1][1], &high0 = sorted[2][0];
    const Float8 third = lesser(lesser(low2, greater(low1, middle0)), high0);
    const Float8 fourth = lesser(lesser(greater(low2, middle0), middle1), greater(low1, high0));
    const Float8 fifth =
        lesser(lesser(greater(low2, middle1), greater(low2, high0)), greater(middle1, high0));
    const std::size_t at = y * block_size;
    const Float8 known = Float8::load(counts + at);
    const Float8 median = if_less(known, six, third, if_less(known, eight, fourth, fifth));
    const Float8 lowest = Float8::load(least + at), highest = Float8::load(most + at);
    const Float8 pixel = Float8::load(pixels + at);
    const Float8 from = if_less(known, few, whole_low, lowest - slack * (median - lowest));
    const Float8 to = if_less(known, few, whole_high, highest + slack * (highest - median));
    const Float8 held = if_less(pixel, from, from, if_less(to, pixel, to, pixel));
    if_less(pixel, lowest, held, if_less(highest, pixel, held, pixel)).store(pixels + at);
  }
}

FREQSYNTH_KERNEL
void hold_flat(const float* means, std::size_t stride, float alike, float most_off, float* pixels) {
  FREQSYNTH_ROUNDING_BEGIN
  const Float8 most = all_lanes<Float8>(alike), one = all_lanes<Float8>(1.0f);
  for (std::size_t y = 0; y < block_size; ++y) {
    const Float8 own = Float8::load_unaligned(means + (y + 1) * stride + 1);
    Float8 low = own, high = own, count = one;
    for (std::size_t row = y; row < y + 3; ++row) {
      for (std::size_t shift = 0; shift < 3; ++shift) {
        if (row == y + 1 && shift == 1) continue;
        const Float8 other = Float8::load_unaligned(means + row * stride + shift);
        const Float8 difference = other - own;
        const Float8 distance = greater(difference, Float8{} - difference);
        // Not alike: the own value and nothing to count.
        const Float8 same = if_less(most, distance, own, other);
        low = lesser(low, same);
        high = greater(high, same);
        count += if_less(most, distance, Float8{}, one);
      }
    }
    const Float8 pixel = Float8::load_unaligned(pixels + y * block_size);
    const Float8 held = if_less(pixel, low, low, if_less(high, pixel, high, pixel));
    const Float8 off = pixel - held;
    const Float8 distance = greater(off, Float8{} - off);
    const Float8 all = all_lanes<Float8>(8.5f), few = all_lanes<Float8>(2.5f);
    const Float8 limit = all_lanes<Float8>(most_off), none = all_lanes<Float8>(PaddedBlock::none);
    const Float8 close = if_less(limit, distance, pixel, held);
    const Float8 either = if_less(all, count, held, close);
    if_less(low, none, if_less(few, count, either, pixel), pixel)
        .store_unaligned(pixels + y * block_size);
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
