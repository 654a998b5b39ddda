// SPDX-License-Identifier: MIT
// Functions of many numbers, whose scalar forms are in covariance.inl, for all instruction sets
// like those of kernels_body.inl, whose rules hold here.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// As many doubles as a register holds, and whole numbers for them.
typedef double Doubles __attribute__((vector_size(FREQSYNTH_KERNEL_BYTES)));
typedef int HalfInts __attribute__((vector_size(FREQSYNTH_KERNEL_BYTES / 2)));
typedef long long LongInts __attribute__((vector_size(FREQSYNTH_KERNEL_BYTES)));

/// Without what is behind the point.
FREQSYNTH_KERNEL_INLINE Doubles truncated(const Doubles& x) {
  return __builtin_convertvector(__builtin_convertvector(x, HalfInts), Doubles);
}

/// exp_minus() of each lane.
FREQSYNTH_KERNEL_INLINE Doubles exponential(const Doubles& given) {
  FREQSYNTH_ROUNDING_BEGIN
  const Doubles limit = 700 - Doubles{}, zero = {};
  const LongInts small = given < limit;
  const Doubles x = small ? given : zero;
  constexpr double inverses[] = {0,       1,       1.0 / 2, 1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,
                                 1.0 / 7, 1.0 / 8, 1.0 / 9, 1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13};
  constexpr double leading = 0x1.62e42feep-1, rest = 0x1.a39ef35793c76p-33;
  constexpr double per_turn = 0x1.71547652b82fep+0;  // log2(e)
  const Doubles turns = truncated(x * per_turn + 0.5);
  const Doubles r = (x - turns * leading) - turns * rest;
  Doubles sum = 1 - Doubles{};
  for (std::size_t k = 13; k > 0; --k) sum = 1 - (r * inverses[k]) * sum;
  // 1023 - turns as a whole number stands in the last digits; an exponent is made of it.
  const Doubles shifted = (1023 - turns) + 0x1.8p52;
  LongInts bits;
  __builtin_memcpy(&bits, &shifted, sizeof bits);
  bits <<= 52;
  Doubles power;
  __builtin_memcpy(&power, &bits, sizeof power);
  return small ? sum * power : zero;
}

/// cos_turns() of each lane.
FREQSYNTH_KERNEL_INLINE Doubles cosine(const Doubles& given) {
  FREQSYNTH_ROUNDING_BEGIN
  const Doubles middle = given + 0.5, towards_zero = truncated(middle);
  const Doubles whole = towards_zero > middle ? towards_zero - 1 : towards_zero;
  Doubles turns = given - whole;
  turns = turns < 0.0 ? -turns : turns;
  const LongInts negative = turns > 0.25;
  turns = negative ? 0.5 - turns : turns;
  const Doubles x = 0x1.921fb54442d18p+2 * turns;  // 2 pi
  const Doubles square = x * x;
  constexpr double inverses[] = {1.0 / 2,   1.0 / 12,  1.0 / 30,  1.0 / 56,  1.0 / 90, 1.0 / 132,
                                 1.0 / 182, 1.0 / 240, 1.0 / 306, 1.0 / 380, 1.0 / 462};
  Doubles sum = 1 - Doubles{};
  for (std::size_t k = sizeof inverses / sizeof *inverses; k > 0; --k) {
    sum = 1 - (square * inverses[k - 1]) * sum;
  }
  return negative ? -sum : sum;
}

/// A register's worth of `count` numbers, or what is left of them.
FREQSYNTH_KERNEL_INLINE Doubles load_some(const double* from, std::size_t count) {
  Doubles value = {};
  if (count >= sizeof value / sizeof *from) {
    __builtin_memcpy(&value, from, sizeof value);
  } else {
    for (std::size_t k = 0; k < count; ++k) value[k] = from[k];
  }
  return value;
}
FREQSYNTH_KERNEL_INLINE void store_some(const Doubles& value, std::size_t count, double* to) {
  if (count >= sizeof value / sizeof *to) {
    __builtin_memcpy(to, &value, sizeof value);
  } else {
    for (std::size_t k = 0; k < count; ++k) to[k] = value[k];
  }
}

FREQSYNTH_KERNEL
void exponentials(const double* x, std::size_t count, double* out) {
  FREQSYNTH_ROUNDING_BEGIN
  for (std::size_t i = 0; i < count; i += sizeof(Doubles) / sizeof(double)) {
    store_some(exponential(load_some(x + i, count - i)), count - i, out + i);
  }
}

FREQSYNTH_KERNEL
void cosines(const double* turns, std::size_t count, double* out) {
  FREQSYNTH_ROUNDING_BEGIN
  for (std::size_t i = 0; i < count; i += sizeof(Doubles) / sizeof(double)) {
    store_some(cosine(load_some(turns + i, count - i)), count - i, out + i);
  }
}

FREQSYNTH_KERNEL
void flux_densities(const double* distances, std::size_t count, const double* series, bool rough,
                    double* out) {
  FREQSYNTH_ROUNDING_BEGIN
  for (std::size_t i = 0; i < count; i += sizeof(Doubles) / sizeof(double)) {
    const Doubles q = load_some(distances + i, count - i);
    Doubles sum = {};
    for (std::size_t k = flux_series; k-- > 0;) sum = sum * q + series[k];
    const Doubles square = q * q, left = exponential(q);
    const Doubles far =
        rough ? (1 - (1 + q) * left) / square : (3 - (square + 3 * q + 3) * left) / square;
    store_some(q < 0.7 ? sum : far, count - i, out + i);
  }
}

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
