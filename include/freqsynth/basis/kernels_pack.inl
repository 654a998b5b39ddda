// SPDX-License-Identifier: MIT
// Vectors of numbers for kernels_body.inl, in registers of the size that the instruction set has.

namespace freqsynth::detail::FREQSYNTH_KERNEL_SET {

/// `count` and what is missing to a multiple of `width`.
FREQSYNTH_KERNEL_INLINE std::size_t round_up(std::size_t count, std::size_t width) {
  return (count + width - 1) / width * width;
}

/// `lanes` numbers in one vector register or several.
template <class T, std::size_t lanes>
struct Pack {
  static constexpr std::size_t bytes =
      lanes * sizeof(T) < FREQSYNTH_KERNEL_BYTES ? lanes * sizeof(T) : FREQSYNTH_KERNEL_BYTES;
  static constexpr std::size_t own = bytes / sizeof(T);  ///< lanes of one register
  static constexpr std::size_t count = lanes / own;      ///< registers
  typedef T Register __attribute__((vector_size(bytes)));

  Register part[count];

  /// From, and to, memory that is aligned to 4 * lanes or 8 * lanes bytes.
  FREQSYNTH_KERNEL_INLINE static Pack load(const T* from) {
    Pack pack;
    for (std::size_t k = 0; k < count; ++k) {
      pack.part[k] = *reinterpret_cast<const Register*>(from + k * own);
    }
    return pack;
  }
  FREQSYNTH_KERNEL_INLINE void store(T* to) const {
    for (std::size_t k = 0; k < count; ++k) *reinterpret_cast<Register*>(to + k * own) = part[k];
  }
  /// The same for memory that is aligned to one number.
  FREQSYNTH_KERNEL_INLINE static Pack load_unaligned(const T* from) {
    Pack pack;
    for (std::size_t k = 0; k < count; ++k) __builtin_memcpy(&pack.part[k], from + k * own, bytes);
    return pack;
  }
  FREQSYNTH_KERNEL_INLINE void store_unaligned(T* to) const {
    for (std::size_t k = 0; k < count; ++k) __builtin_memcpy(to + k * own, &part[k], bytes);
  }
  FREQSYNTH_KERNEL_INLINE void add_to(T* sums) const { (load(sums) + *this).store(sums); }

  FREQSYNTH_KERNEL_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
    Pack sum;
    for (std::size_t k = 0; k < count; ++k) sum.part[k] = a.part[k] + b.part[k];
    return sum;
  }
  FREQSYNTH_KERNEL_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
    Pack difference;
    for (std::size_t k = 0; k < count; ++k) difference.part[k] = a.part[k] - b.part[k];
    return difference;
  }
  FREQSYNTH_KERNEL_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
    Pack product;
    for (std::size_t k = 0; k < count; ++k) product.part[k] = a.part[k] * b.part[k];
    return product;
  }
  FREQSYNTH_KERNEL_INLINE friend Pack operator*(T factor, const Pack& a) {
    Pack product;
    for (std::size_t k = 0; k < count; ++k) product.part[k] = factor * a.part[k];
    return product;
  }
  FREQSYNTH_KERNEL_INLINE Pack& operator+=(const Pack& b) {
    for (std::size_t k = 0; k < count; ++k) part[k] += b.part[k];
    return *this;
  }
};

/// The upper half of 8 lanes added to the lower one.
template <class T>
FREQSYNTH_KERNEL_INLINE Pack<T, 4> folded(const Pack<T, 8>& a) {
  using Half = Pack<T, 4>;
  using Register = typename Half::Register;
  Half half;
  if constexpr (Pack<T, 8>::count == 1) {
    const auto& x = a.part[0];
    half.part[0] = Register{x[0], x[1], x[2], x[3]} + Register{x[4], x[5], x[6], x[7]};
  } else {
    for (std::size_t k = 0; k < Half::count; ++k)
      half.part[k] = a.part[k] + a.part[k + Half::count];
  }
  return half;
}

/// The upper half of 16 lanes added to the lower one.
template <class T>
FREQSYNTH_KERNEL_INLINE Pack<T, 8> folded(const Pack<T, 16>& a) {
  using Half = Pack<T, 8>;
  using Register = typename Half::Register;
  Half half;
  if constexpr (Pack<T, 16>::count == 1) {
    const auto& x = a.part[0];
    half.part[0] = Register{x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]} +
                   Register{x[8], x[9], x[10], x[11], x[12], x[13], x[14], x[15]};
  } else {
    for (std::size_t k = 0; k < Half::count; ++k) {
      half.part[k] = a.part[k] + a.part[k + Half::count];
    }
  }
  return half;
}

template <class T>
FREQSYNTH_KERNEL_INLINE T sum_of(const Pack<T, 4>& a) {
  if constexpr (Pack<T, 4>::count == 1) {
    const auto& x = a.part[0];
    return (x[0] + x[2]) + (x[1] + x[3]);
  } else {
    const auto x = a.part[0] + a.part[1];
    return x[0] + x[1];
  }
}

template <class T>
FREQSYNTH_KERNEL_INLINE T sum_of(const Pack<T, 8>& a) {
  return sum_of(folded(a));
}

/// sum_of() of each, side by side.
template <class T>
FREQSYNTH_KERNEL_INLINE Pack<T, 4> sums_of(const Pack<T, 4>& a, const Pack<T, 4>& b,
                                           const Pack<T, 4>& c, const Pack<T, 4>& d) {
  using Register = typename Pack<T, 4>::Register;
  if constexpr (Pack<T, 4>::count == 1) {
    const Register &w = a.part[0], &x = b.part[0], &y = c.part[0], &z = d.part[0];
    const Register low = Register{w[0], w[1], x[0], x[1]} + Register{w[2], w[3], x[2], x[3]};
    const Register high = Register{y[0], y[1], z[0], z[1]} + Register{y[2], y[3], z[2], z[3]};
    return {
        {Register{low[0], low[2], high[0], high[2]} + Register{low[1], low[3], high[1], high[3]}}};
  } else {
    const Register w = a.part[0] + a.part[1], x = b.part[0] + b.part[1];
    const Register y = c.part[0] + c.part[1], z = d.part[0] + d.part[1];
    return {
        {Register{w[0], x[0]} + Register{w[1], x[1]}, Register{y[0], z[0]} + Register{y[1], z[1]}}};
  }
}

template <class T>
FREQSYNTH_KERNEL_INLINE Pack<T, 4> sums_of(const Pack<T, 8>& a, const Pack<T, 8>& b,
                                           const Pack<T, 8>& c, const Pack<T, 8>& d) {
  return sums_of(folded(a), folded(b), folded(c), folded(d));
}

/// The first `count` (1..4) of 4 numbers, anywhere in memory; zeros for the others.
template <class T>
FREQSYNTH_KERNEL_INLINE Pack<T, 4> first_of_4(const T* from, std::size_t count) {
  using Register = typename Pack<T, 4>::Register;
  const T x0 = from[0], x1 = count > 1 ? from[1] : 0;
  const T x2 = count > 2 ? from[2] : 0, x3 = count > 3 ? from[3] : 0;
  if constexpr (Pack<T, 4>::count == 1) {
    return {{Register{x0, x1, x2, x3}}};
  } else {
    return {{Register{x0, x1}, Register{x2, x3}}};
  }
}

/// Copies `count` numbers to memory that is aligned as 8 of them, and zeros up to a multiple of 8.
template <class T>
FREQSYNTH_KERNEL_INLINE void copy_padded(const T* from, std::size_t count, T* to) {
  std::size_t i = 0;
  // A vector is best loaded from memory as wide as it was stored.
  for (; i + 8 <= count; i += 8) Pack<T, 8>::load_unaligned(from + i).store(to + i);
  for (; i < count; i += 4) first_of_4(from + i, count - i).store(to + i);
  if (i % 8 != 0) Pack<T, 4>{}.store(to + i);
}

/// The lesser and the greater of two, lane by lane; b where they are equal.
template <class T, std::size_t lanes>
FREQSYNTH_KERNEL_INLINE Pack<T, lanes> lesser(const Pack<T, lanes>& a, const Pack<T, lanes>& b) {
  Pack<T, lanes> result;
  for (std::size_t k = 0; k < Pack<T, lanes>::count; ++k) {
    result.part[k] = a.part[k] < b.part[k] ? a.part[k] : b.part[k];
  }
  return result;
}
template <class T, std::size_t lanes>
FREQSYNTH_KERNEL_INLINE Pack<T, lanes> greater(const Pack<T, lanes>& a, const Pack<T, lanes>& b) {
  Pack<T, lanes> result;
  for (std::size_t k = 0; k < Pack<T, lanes>::count; ++k) {
    result.part[k] = a.part[k] > b.part[k] ? a.part[k] : b.part[k];
  }
  return result;
}
/// a < b ? yes : no, lane by lane.
template <class T, std::size_t lanes>
FREQSYNTH_KERNEL_INLINE Pack<T, lanes> if_less(const Pack<T, lanes>& a, const Pack<T, lanes>& b,
                                               const Pack<T, lanes>& yes,
                                               const Pack<T, lanes>& no) {
  Pack<T, lanes> result;
  for (std::size_t k = 0; k < Pack<T, lanes>::count; ++k) {
    result.part[k] = a.part[k] < b.part[k] ? yes.part[k] : no.part[k];
  }
  return result;
}
template <class T, std::size_t lanes>
FREQSYNTH_KERNEL_INLINE Pack<T, lanes> quotient(const Pack<T, lanes>& a, const Pack<T, lanes>& b) {
  Pack<T, lanes> result;
  for (std::size_t k = 0; k < Pack<T, lanes>::count; ++k) result.part[k] = a.part[k] / b.part[k];
  return result;
}
template <class P, class T>
FREQSYNTH_KERNEL_INLINE P all_lanes(T value) {
  P result;
  for (std::size_t k = 0; k < P::count; ++k) {
    result.part[k] = value - typename P::Register{};
  }
  return result;
}
using Float8 = Pack<float, 8>;
using Float16 = Pack<float, 16>;
using Double4 = Pack<double, 4>;
using Double8 = Pack<double, 8>;

}  // namespace freqsynth::detail::FREQSYNTH_KERNEL_SET
